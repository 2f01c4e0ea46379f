//! Normal equations of a sheet, block by block, in coordinates in which they are well conditioned.
//!
//! With `X = Z T` (`T` the triangle of all rows together, `Z` orthonormal columns) the products `ZᵀZ` of a block
//! are of order one however ill-conditioned the columns of eq. 11 are, and so are those of any group of blocks. The force
//! enters less what reference weights say. Nuisances stand before the columns, so that a factorization eliminates them first:
//! a fit of base and effects never sees them, and finds its way back to them afterwards. A triangle for a group of blocks follows from a Cholesky factorization, and
//! candidates that only add columns are appended without touching the rows of eq. 11 again.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use nalgebra::DMatrix;
use pam_optim::summary::{BLOCK_ROWS, Summary};
use rayon::prelude::*;

use crate::nuisance::{self, Nuisance};

/// Rows in coordinates in which they are well conditioned, with their products.
#[derive(Debug, Clone)]
pub struct Normal {
    /// Nuisances, before the columns.
    q: usize,
    /// Prior precision of each.
    precision: Vec<f64>,
    /// Columns.
    n: usize,
    /// `T`, `n × n`, row-major.
    triangle: Vec<f64>,
    /// Reference weights, `n` of them.
    reference: Vec<f64>,
    /// Instants of the rows, ascending.
    listed: Vec<usize>,
    blocks: Vec<Block>,
}

/// Rows that are fitted, or held out, together.
#[derive(Debug, Clone)]
struct Block {
    /// Those of the rows that count.
    range: Range<usize>,
    /// Nuisances as the load cell reads them, one row in each column.
    nuisances: Arc<DMatrix<f64>>,
    /// `Z` and the force less the reference, `n + 1` columns.
    rows: DMatrix<f64>,
    /// Products: nuisances, columns, force.
    products: DMatrix<f64>,
}

/// A [`Normal`] with more columns behind those it has, block by block; the force is last.
#[derive(Debug, Clone)]
pub struct Extended<'a> {
    normal: &'a Normal,
    /// Columns that were added.
    added: usize,
    /// Scale of each added column, and of the force.
    scales: Vec<f64>,
    /// Prior precision of each added column, in units of its scale.
    drawn: Vec<f64>,
    /// Products of each block: nuisances, columns, added columns, force.
    products: Vec<Cow<'a, DMatrix<f64>>>,
}

impl Normal {
    /// Normal equations of the instants `listed`, in blocks of which each is a range of these: `columns` in rows (row-major) and the
    /// force of each, in N. `slopes` is how much of the nuisances the load cell reads at every instant of the recordings.
    pub fn new(
        listed: Vec<usize>,
        ranges: Vec<Range<usize>>,
        columns: &[f64],
        forces_n: &[f64],
        reference: Vec<f64>,
        nuisance: &Nuisance,
        slopes: &[f64],
    ) -> Self {
        let n = reference.len();
        let rows_of = |range: &Range<usize>| {
            let here = &columns[range.start * n..range.end * n];
            let mut rows = DMatrix::zeros(range.len(), n + 1);
            for (index, (row, force_n)) in here.chunks_exact(n).zip(&forces_n[range.clone()]).enumerate() {
                row.iter().enumerate().for_each(|(column, value)| rows[(index, column)] = *value);
                rows[(index, n)] =
                    force_n - row.iter().zip(&reference).map(|(column, weight)| column * weight).sum::<f64>();
            }
            let mut summary = Summary::new(n);
            for first in (0..range.len()).step_by(BLOCK_ROWS) {
                let some = first..range.len().min(first + BLOCK_ROWS);
                let columns: Vec<&[f64]> =
                    rows.as_slice().chunks_exact(range.len()).map(|column| &column[some.clone()]).collect();
                summary.fold(&mut columns.concat(), some.len());
            }
            (rows, summary)
        };
        let of_blocks: Vec<(DMatrix<f64>, Summary)> = ranges.par_iter().map(rows_of).collect();
        let mut total = Summary::new(n);
        of_blocks.iter().for_each(|(_, summary)| total.merge(summary));
        let mut triangle = vec![0.0; n * n];
        for row in 0..n {
            triangle[row * n..(row + 1) * n].copy_from_slice(&total.row(row)[..n]);
        }
        let known = nuisance.blocks(&listed, &ranges);
        let is_read_in_full = listed.iter().all(|&at| slopes[at] == 1.0);
        let blocks = of_blocks
            .into_par_iter()
            .zip(ranges)
            .zip(known.par_iter())
            .map(|(((mut rows, _), range), known)| {
                orthonormalize(&mut rows, &triangle, n);
                let (nuisances, own) = if is_read_in_full {
                    (known.rows.clone(), Cow::Borrowed(&known.products))
                } else {
                    let mut read = DMatrix::clone(&known.rows);
                    read.column_iter_mut().zip(&listed[range.clone()]).for_each(|(mut row, &at)| row *= slopes[at]);
                    let products = &read * read.transpose();
                    (Arc::new(read), Cow::Owned(products))
                };
                let q = nuisances.nrows();
                let mut products = DMatrix::zeros(q + n + 1, q + n + 1);
                products.view_mut((0, 0), (q, q)).copy_from(&own);
                products.view_mut((0, q), (q, n + 1)).gemm(1.0, &nuisances, &rows, 0.0);
                products.view_mut((q, q), (n + 1, n + 1)).gemm(1.0, &rows.transpose(), &rows, 0.0);
                products.fill_lower_triangle_with_upper_triangle();
                Block { range, nuisances, rows, products }
            })
            .collect();
        Self { q: nuisance.n(), precision: nuisance.precision.clone(), n, triangle, reference, listed, blocks }
    }

    /// Instants of the rows, ascending.
    pub fn listed(&self) -> &[usize] {
        &self.listed
    }

    /// Rows of each block that count.
    pub fn counts(&self) -> Vec<f64> {
        self.blocks.iter().map(|block| block.range.len() as f64).collect()
    }

    /// Instants of the rows that count, of one block after the other, each with the row's `Z`, `n` values.
    pub fn rows(&self) -> impl Iterator<Item = (usize, impl Iterator<Item = f64>)> {
        self.blocks.iter().flat_map(move |block| {
            let here = self.listed[block.range.clone()].iter().enumerate();
            here.map(move |(row, &at)| (at, (0..self.n).map(move |column| block.rows[(row, column)])))
        })
    }

    /// Weights of the columns in the coordinates of `Z`, less the reference.
    fn coordinates(&self, weights: &[f64]) -> Vec<f64> {
        let n = self.n;
        (0..n)
            .map(|row| {
                (row..n)
                    .map(|column| self.triangle[row * n + column] * (weights[column] - self.reference[column]))
                    .sum()
            })
            .collect()
    }

    /// A direction in weight space (`n` values) in the coordinates of `Z`.
    pub fn direction(&self, slope: &[f64]) -> Vec<f64> {
        let n = self.n;
        (0..n).map(|row| (row..n).map(|column| self.triangle[row * n + column] * slope[column]).sum()).collect()
    }

    /// With `more` columns (row-major, `k` for each of the rows) behind, of which the `firm` first are free and the others drawn to zero as
    /// nuisances are.
    pub fn extend(&self, more: &[f64], k: usize, firm: usize) -> Extended<'_> {
        let (q, n) = (self.q, self.n);
        if k == 0 {
            return self.alone();
        }
        let (mut squares, mut there) = (vec![0.0; k], vec![0_usize; k]);
        for row in more.chunks_exact(k) {
            for ((square, there), value) in squares.iter_mut().zip(&mut there).zip(row) {
                *square += value * value;
                *there += usize::from(*value != 0.0);
            }
        }
        let size = |square: f64| if square.is_finite() { square.sqrt() } else { 0.0 };
        let scales: Vec<f64> = squares.into_iter().map(size).collect();
        let precision = |there: usize| nuisance::LOOSE / there.max(1) as f64;
        let drawn = there.into_iter().enumerate();
        let drawn = drawn.map(|(column, there)| if column < firm { 0.0 } else { precision(there) }).collect();
        let products = self
            .blocks
            .par_iter()
            .map(|block| {
                let here = &more[block.range.start * k..block.range.end * k];
                let mut added = DMatrix::from_row_slice(block.range.len(), k, here);
                for (mut column, &scale) in added.column_iter_mut().zip(&scales) {
                    if scale > 0.0 { column /= scale } else { column.fill(0.0) }
                }
                let last = q + n;
                let mut out = DMatrix::zeros(last + k + 1, last + k + 1);
                out.view_mut((0, 0), (last, last)).copy_from(&block.products.view((0, 0), (last, last)));
                out.view_mut((0, last), (q, k)).gemm(1.0, &*block.nuisances, &added, 0.0);
                let of_columns = block.rows.transpose() * &added;
                out.view_mut((q, last), (n, k)).copy_from(&of_columns.rows(0, n));
                out.view_mut((last, last), (k, k)).gemm(1.0, &added.transpose(), &added, 0.0);
                out.view_mut((0, last + k), (last, 1)).copy_from(&block.products.view((0, last), (last, 1)));
                out.view_mut((last, last + k), (k, 1)).copy_from(&of_columns.row(n).transpose());
                out[(last + k, last + k)] = block.products[(last, last)];
                out.fill_lower_triangle_with_upper_triangle();
                Cow::Owned(out)
            })
            .collect();
        Extended { normal: self, added: k, scales, drawn, products }
    }

    /// With nothing behind.
    pub fn alone(&self) -> Extended<'_> {
        let products = self.blocks.iter().map(|block| Cow::Borrowed(&block.products)).collect();
        Extended { normal: self, added: 0, scales: Vec::new(), drawn: Vec::new(), products }
    }
}

/// The first `n` columns of `rows` in the coordinates of `triangle`, `n × n` and row-major: `Z` of `X = Z T`. A column that is a
/// combination of those before it has no coordinate of its own.
fn orthonormalize(rows: &mut DMatrix<f64>, triangle: &[f64], n: usize) {
    for column in 0..n {
        let entry = |row: usize| triangle[row * n + column];
        let largest = (0..=column).map(|row| entry(row).abs()).fold(1e-300, f64::max);
        let (done, mut rest) = rows.columns_range_pair_mut(0..column, column);
        if entry(column).abs() <= 1e-11 * largest {
            rest.fill(0.0);
            continue;
        }
        for (before, own) in done.column_iter().enumerate() {
            rest.axpy(-entry(before), &own, 1.0);
        }
        rest /= entry(column);
    }
}

impl Extended<'_> {
    /// Columns, added ones included.
    pub fn n_columns(&self) -> usize {
        self.normal.n + self.added
    }

    /// Blocks.
    pub fn n_blocks(&self) -> usize {
        self.products.len()
    }

    /// Rows of each block that count.
    pub fn counts(&self) -> Vec<f64> {
        self.normal.counts()
    }

    /// The triangle that stands for the blocks in which `takes` is true, with the way back to the nuisances that it is
    /// without; none where they do not determine one.
    pub fn reduced(&self, takes: &dyn Fn(usize) -> bool) -> Option<Reduced> {
        let (q, n, m) = (self.normal.q, self.normal.n, self.n_columns());
        let mut sum: DMatrix<f64> = DMatrix::zeros(q + m + 1, q + m + 1);
        let mut count = 0;
        for (block, product) in self.products.iter().enumerate() {
            if takes(block) {
                sum += &**product;
                count += self.normal.blocks[block].range.len();
            }
        }
        let force_square = sum[(q + m, q + m)].max(f64::MIN_POSITIVE);
        for (index, precision) in self.normal.precision.iter().enumerate() {
            sum[(index, index)] += precision;
        }
        // A ridge far below anything that the data say: it keeps what they do not say at all finite.
        for index in q..q + m {
            sum[(index, index)] += 1e-11;
        }
        for (index, precision) in self.drawn.iter().enumerate() {
            sum[(q + n + index, q + n + index)] += precision;
        }
        sum[(q + m, q + m)] += 1e-12 * force_square;
        let factor = sum.cholesky()?.l().transpose();
        let width = m + 1;
        let mut triangle = vec![0.0; width * width];
        for row in 0..width {
            for column in row..width {
                let entry = |k: usize| factor[(q + row, q + k)];
                let value = if column < n {
                    // Through T, which is upper triangular as well.
                    (row..=column).map(|k| entry(k) * self.normal.triangle[k * n + column]).sum()
                } else if column < m {
                    entry(column) * self.scales[column - n]
                } else {
                    entry(column)
                };
                triangle[row * width + column] = value;
            }
        }
        // The force itself: what the reference weights say comes back.
        for row in 0..n {
            let back: f64 = (row..n).map(|column| triangle[row * width + column] * self.normal.reference[column]).sum();
            triangle[row * width + m] += back;
        }
        let summary = Summary::from_triangle(m, triangle, count as u64);
        Some(Reduced { summary, back: factor.rows(0, q).into_owned() })
    }

    /// `weights` of the columns in the coordinates of the products, with `-1` for the force behind.
    fn coordinates(&self, weights: &[f64]) -> Vec<f64> {
        let (n, m) = (self.normal.n, self.n_columns());
        let mut u = self.normal.coordinates(&weights[..n]);
        u.extend(weights[n..m].iter().zip(&self.scales).map(|(weight, scale)| weight * scale));
        u.push(-1.0);
        u
    }

    /// The nuisances that go with `weights` in the fit that `reduced` stands for.
    pub fn nuisances(&self, reduced: &Reduced, weights: &[f64]) -> Vec<f64> {
        let q = self.normal.q;
        let u = self.coordinates(weights);
        let mut coefficients = vec![0.0; q];
        for row in (0..q).rev() {
            let entry = |column: usize| reduced.back[(row, column)];
            let rest: f64 = u.iter().enumerate().map(|(column, value)| entry(q + column) * value).sum();
            let behind: f64 = (row + 1..q).map(|column| entry(column) * coefficients[column]).sum();
            coefficients[row] = -(rest + behind) / entry(row);
        }
        coefficients
    }

    /// Sum of squares of the residual of `weights` and `nuisances` over one block.
    pub fn square_sum(&self, block: usize, weights: &[f64], nuisances: &[f64]) -> f64 {
        let u = [nuisances, &self.coordinates(weights)].concat();
        let product = &self.products[block];
        let mut sum = 0.0;
        for (j, right) in u.iter().enumerate() {
            let inner: f64 = product.column(j).iter().zip(&u).map(|(entry, left)| entry * left).sum();
            sum += right * inner;
        }
        sum.max(0.0)
    }
}

/// A least-squares problem without the nuisances.
#[derive(Debug, Clone)]
pub struct Reduced {
    /// What is left of it.
    pub summary: Summary,
    /// Rows of the factorization that belong to the nuisances.
    back: DMatrix<f64>,
}

#[cfg(test)]
mod tests;
