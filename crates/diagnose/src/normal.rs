//! Normal equations of a sheet, block by block, in coordinates in which they are well conditioned.
//!
//! With `X = Z T` (`T` the triangle of all rows together, `Z` orthonormal columns) the products `ZᵀZ` of a block
//! are of order one however ill-conditioned the columns of eq. 11 are, and so are those of any group of blocks. The force
//! enters less what reference weights say. Nuisances stand before the columns, so that a factorization eliminates them first:
//! a fit of base and effects never sees them, and finds its way back to them afterwards. A triangle for a group of blocks follows from a Cholesky factorization, and
//! candidates that only add columns are appended without touching the rows of eq. 11 again.

use std::ops::Range;

use fearless_simd::{Level, dispatch};
use nalgebra::DMatrix;
use pam_optim::summary::{BLOCK_ROWS, Summary};
use rayon::prelude::*;

use crate::nuisance::{self, Nuisance};
use crate::track::Track;

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
    /// `Z` and the force less the reference of the rows that count, row-major, `n + 1` values each.
    rows: Vec<f64>,
    /// Which rows count, ascending.
    counted: Vec<usize>,
    /// Those of each block, as a range of the counted ones.
    of_block: Vec<Range<usize>>,
    /// Products of the rows of each block, `(q + n + 1)²`.
    products: Vec<DMatrix<f64>>,
    /// Rows of each block that count.
    counts: Vec<f64>,
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
    products: Vec<DMatrix<f64>>,
}

impl Normal {
    /// Normal equations of rows of `n` columns with the forces `force_n`, at the instants that `counted` says count;
    /// `slopes` is how much of the nuisances the load cell reads.
    #[expect(clippy::too_many_arguments, reason = "rows, what they are compared with, and what counts")]
    pub fn new(
        track: &Track,
        columns: &[f64],
        n: usize,
        force_n: &[f64],
        counted: &[bool],
        reference: Vec<f64>,
        nuisance: &Nuisance,
        slopes: &[f64],
    ) -> Self {
        let width = n + 1;
        let residual = |at: usize| {
            let row = &columns[at * n..(at + 1) * n];
            force_n[at] - row.iter().zip(&reference).map(|(column, weight)| column * weight).sum::<f64>()
        };
        let triangles: Vec<Summary> = track
            .blocks
            .par_iter()
            .map(|block| {
                let mut summary = Summary::new(n);
                let here: Vec<usize> = block.clone().filter(|&at| counted[at]).collect();
                for rows in here.chunks(BLOCK_ROWS) {
                    let mut buffer = vec![0.0; rows.len() * width];
                    for (index, &at) in rows.iter().enumerate() {
                        for column in 0..n {
                            buffer[column * rows.len() + index] = columns[at * n + column];
                        }
                        buffer[n * rows.len() + index] = residual(at);
                    }
                    summary.fold(&mut buffer, rows.len());
                }
                summary
            })
            .collect();
        let mut total = Summary::new(n);
        for triangle in &triangles {
            total.merge(triangle);
        }
        let mut triangle = vec![0.0; n * n];
        for row in 0..n {
            triangle[row * n..(row + 1) * n].copy_from_slice(&total.row(row)[..n]);
        }
        let largest: Vec<f64> =
            (0..n).map(|column| (0..=column).map(|row| triangle[row * n + column].abs()).fold(0.0, f64::max)).collect();
        // A column that is a combination of those before it has no coordinate of its own.
        let alive: Vec<bool> =
            (0..n).map(|column| triangle[column * n + column].abs() > 1e-11 * largest[column].max(1e-300)).collect();
        let mut of_block = Vec::with_capacity(track.blocks.len());
        let mut listed: Vec<usize> = Vec::with_capacity(track.n());
        for block in &track.blocks {
            let first = listed.len();
            listed.extend(block.clone().filter(|&at| counted[at]));
            of_block.push(first..listed.len());
        }
        let mut rows = vec![0.0; listed.len() * width];
        rows.par_chunks_exact_mut(width).zip(&listed).for_each(|(row, &at)| {
            for column in 0..n {
                if !alive[column] {
                    continue;
                }
                let mut value = columns[at * n + column];
                for before in 0..column {
                    value -= row[before] * triangle[before * n + column];
                }
                row[column] = value / triangle[column * n + column];
            }
            row[n] = residual(at);
        });
        let q = nuisance.n();
        let products = of_block
            .par_iter()
            .map(|block| {
                let full = q + width;
                let mut joined = vec![0.0; block.len() * full];
                for (row, index) in joined.chunks_exact_mut(full).zip(block.clone()) {
                    let at = listed[index];
                    for (value, column) in row[..q].iter_mut().zip(nuisance.row(at)) {
                        *value = slopes[at] * column;
                    }
                    row[q..].copy_from_slice(&rows[index * width..(index + 1) * width]);
                }
                products_of(&joined, full)
            })
            .collect();
        let counts = of_block.iter().map(|block| block.len() as f64).collect();
        Self {
            q,
            precision: nuisance.precision.clone(),
            n,
            triangle,
            reference,
            rows,
            counted: listed,
            of_block,
            products,
            counts,
        }
    }

    /// Rows of each block that count.
    pub fn counts(&self) -> &[f64] {
        &self.counts
    }

    /// Rows that count, each with its instant: `Z` and the force less the reference, `n + 1` values.
    pub fn rows(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.counted.iter().copied().zip(self.rows.chunks_exact(self.n + 1))
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

    /// With `more` columns (row-major, `k` per row) behind, of which the `firm` first are free and the others drawn to zero as
    /// nuisances are; `nuisance` and `slopes` are those that it was made with.
    pub fn extend(&self, more: &[f64], k: usize, firm: usize, nuisance: &Nuisance, slopes: &[f64]) -> Extended<'_> {
        let (q, width) = (self.q, self.n + 1);
        let scales: Vec<f64> = (0..k)
            .map(|column| {
                let squares: f64 = self.counted.iter().map(|&at| more[at * k + column].powi(2)).sum();
                if squares.is_finite() { squares.sqrt() } else { 0.0 }
            })
            .collect();
        let drawn = (0..k)
            .map(|column| {
                let there = self.counted.iter().filter(|&&at| more[at * k + column] != 0.0).count();
                if column < firm { 0.0 } else { nuisance::LOOSE / there.max(1) as f64 }
            })
            .collect();
        let inverse: Vec<f64> = scales.iter().map(|&scale| if scale > 0.0 { 1.0 / scale } else { 0.0 }).collect();
        let total = q + width + k;
        let products: Vec<DMatrix<f64>> = self
            .of_block
            .par_iter()
            .zip(&self.products)
            .map(|(block, own)| {
                let mut out = DMatrix::zeros(total, total);
                // Nuisances, columns, added columns, force: the force moves to the end.
                let place = |index: usize| if index < q + self.n { index } else { total - 1 };
                for j in 0..q + width {
                    for i in 0..q + width {
                        out[(place(i), place(j))] = own[(i, j)];
                    }
                }
                if k == 0 {
                    return out;
                }
                let full = q + width;
                let mut cross = vec![0.0; k * full];
                let mut squares = vec![0.0; k * k];
                let rows = self.rows[block.start * width..block.end * width].chunks_exact(width);
                for (row, &at) in rows.zip(&self.counted[block.clone()]) {
                    for column in 0..k {
                        let value = more[at * k + column] * inverse[column];
                        if value == 0.0 {
                            continue;
                        }
                        let (before, behind) = cross[column * full..(column + 1) * full].split_at_mut(q);
                        let read = value * slopes[at];
                        for (sum, entry) in before.iter_mut().zip(nuisance.row(at)) {
                            *sum += read * entry;
                        }
                        for (sum, entry) in behind.iter_mut().zip(row) {
                            *sum += value * entry;
                        }
                        for other in 0..k {
                            squares[column * k + other] += value * more[at * k + other] * inverse[other];
                        }
                    }
                }
                for column in 0..k {
                    for i in 0..full {
                        out[(q + self.n + column, place(i))] = cross[column * full + i];
                        out[(place(i), q + self.n + column)] = cross[column * full + i];
                    }
                    for other in 0..k {
                        out[(q + self.n + column, q + self.n + other)] = squares[column * k + other];
                    }
                }
                out
            })
            .collect();
        Extended { normal: self, added: k, scales, drawn, products }
    }

    /// With nothing behind.
    pub fn alone(&self) -> Extended<'_> {
        self.extend(&[], 0, 0, &Nuisance::default(), &[])
    }
}

/// `rowsᵀ rows`, of rows of `width` values.
fn products_of(rows: &[f64], width: usize) -> DMatrix<f64> {
    let mut sums = vec![0.0; width * width];
    // The widest vectors that the processor has; nothing is fused, so that every processor gives the same bits.
    dispatch!(Level::new(), _ => sum_products(rows, width, &mut sums));
    mirrored(&sums, width)
}

/// The symmetric matrix whose upper triangle `sums` holds, row by row.
pub(crate) fn mirrored(sums: &[f64], width: usize) -> DMatrix<f64> {
    let mut out = DMatrix::from_row_slice(width, width, sums);
    out.fill_lower_triangle_with_upper_triangle();
    out
}

#[inline(always)]
fn sum_products(rows: &[f64], width: usize, sums: &mut [f64]) {
    for row in rows.chunks_exact(width) {
        for i in 0..width {
            let value = row[i];
            if value == 0.0 {
                continue;
            }
            for (sum, other) in sums[i * width + i..(i + 1) * width].iter_mut().zip(&row[i..]) {
                *sum += value * other;
            }
        }
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
    pub fn counts(&self) -> &[f64] {
        &self.normal.counts
    }

    /// The triangle that stands for the blocks in which `takes` is true, with the way back to the nuisances that it is
    /// without; none where they do not determine one.
    pub fn reduced(&self, takes: &dyn Fn(usize) -> bool) -> Option<Reduced> {
        let (q, n, m) = (self.normal.q, self.normal.n, self.n_columns());
        let mut sum: DMatrix<f64> = DMatrix::zeros(q + m + 1, q + m + 1);
        let mut count = 0.0;
        for (block, product) in self.products.iter().enumerate() {
            if takes(block) {
                sum += product;
                count += self.normal.counts[block];
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
