//! The regression that every hypothesis is judged by.
//!
//! ```text
//! minimize  Σ (y − B β − C α)² / w  +  Σ (β / σ)²
//! ```
//!
//! | symbol | code       | unit | meaning                                                        |
//! |--------|------------|------|----------------------------------------------------------------|
//! | `y`    | `left_n`   | N    | force less what the hypothesis gives                           |
//! | `B`    | `columns`  | N    | nuisances, each with its prior `σ`                             |
//! | `C`    | `free`     | N    | what the hypothesis moves, without a prior                     |
//! | `w`    | `weight`   | N²   | variance of the residual times the instants that share one     |
//!
//! Sums are kept block by block, so that what is fitted to some blocks is judged on the others.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use crate::joint::HeldOut;
use crate::track::{FOLDS, Track};

/// Nuisances over the instants of a track.
#[derive(Debug)]
pub(crate) struct Rows<'a> {
    track: &'a Track,
    /// Instants that count, those of each block together.
    listed: Vec<Vec<usize>>,
    /// Row-major, `sigma.len()` per instant that counts, block by block.
    columns: Vec<Vec<f64>>,
    /// Prior of each, in units of its column.
    sigma: Vec<f64>,
    /// Products of the columns of each block.
    products: Vec<DMatrix<f64>>,
    /// What no block is known better than, in N².
    floor_square: f64,
}

/// Sums of a hypothesis.
#[derive(Debug)]
pub(crate) struct Sums<'a, 'b> {
    rows: &'b Rows<'a>,
    n_free: usize,
    /// Size of each column that is free.
    scales: Vec<f64>,
    /// Products of each block: nuisances, free columns, `y`.
    products: Vec<DMatrix<f64>>,
}

/// A fit of [`Sums`].
#[derive(Debug, Clone)]
pub(crate) struct Fit {
    /// Nuisances.
    pub nuisances: Vec<f64>,
    /// What was free.
    pub free: Vec<f64>,
    /// Covariance of what was free.
    pub covariance: DMatrix<f64>,
    /// Mean square of the residual, in N².
    pub mean_square: f64,
    /// The same with what the priors add.
    pub cost: f64,
}

impl<'a> Rows<'a> {
    /// Nuisances `columns` over all instants of `track` with their priors.
    pub(crate) fn new(track: &'a Track, columns: &[(Vec<f64>, f64)], floor_square: f64) -> Self {
        let listed: Vec<Vec<usize>> =
            track.blocks.iter().map(|block| block.clone().filter(|&at| track.counted[at]).collect()).collect();
        let of_block = |listed: &Vec<usize>| -> Vec<f64> {
            listed.iter().flat_map(|&at| columns.iter().map(move |(column, _)| column[at])).collect()
        };
        let rows: Vec<Vec<f64>> = listed.iter().map(of_block).collect();
        let q = columns.len();
        let products = rows
            .par_iter()
            .map(|rows| {
                let matrix = DMatrix::from_row_slice(rows.len() / q.max(1), q, rows);
                matrix.tr_mul(&matrix)
            })
            .collect();
        let sigma = columns.iter().map(|(_, sigma)| *sigma).collect();
        Self { track, listed, columns: rows, sigma, products, floor_square }
    }

    /// Instants that count.
    pub(crate) fn n(&self) -> usize {
        self.listed.iter().map(Vec::len).sum()
    }

    /// What `nuisances` add at every instant that counts, and zero elsewhere, in N.
    pub(crate) fn force_n(&self, nuisances: &[f64]) -> Vec<f64> {
        let mut force_n = vec![0.0; self.track.n()];
        for (listed, rows) in self.listed.iter().zip(&self.columns) {
            for (&at, row) in listed.iter().zip(rows.chunks_exact(self.sigma.len().max(1))) {
                force_n[at] = row.iter().zip(nuisances).map(|(column, value)| column * value).sum();
            }
        }
        force_n
    }

    /// Sums with columns `free` and `left_n`; none where a value that counts is not finite.
    pub(crate) fn sums<'b>(&'b self, free: &[Vec<f64>], left_n: &[f64]) -> Option<Sums<'a, 'b>> {
        let (q, k) = (self.sigma.len(), free.len());
        let counted = || self.listed.iter().flatten();
        let size = |column: &[f64]| (counted().map(|&at| column[at] * column[at]).sum::<f64>()).sqrt();
        let scales: Vec<f64> = free.iter().map(|column| size(column)).collect();
        let finite = scales.iter().all(|scale| scale.is_finite()) && size(left_n).is_finite();
        if !finite {
            return None;
        }
        let per = |scale: f64| if scale > 0.0 { 1.0 / scale } else { 0.0 };
        let products = (0..self.listed.len())
            .map(|block| {
                let (listed, rows) = (&self.listed[block], &self.columns[block]);
                let own: Vec<f64> = free
                    .iter()
                    .zip(&scales)
                    .map(|(column, &scale)| (column.as_slice(), per(scale)))
                    .chain([(left_n, 1.0)])
                    .flat_map(|(column, scale)| listed.iter().map(move |&at| scale * column[at]))
                    .collect();
                let own = DMatrix::from_column_slice(listed.len(), k + 1, &own);
                let nuisances = DMatrix::from_row_slice(listed.len(), q, rows);
                let (across, within) = (nuisances.tr_mul(&own), own.tr_mul(&own));
                let mut all = DMatrix::zeros(q + k + 1, q + k + 1);
                all.view_mut((0, 0), (q, q)).copy_from(&self.products[block]);
                all.view_mut((0, q), (q, k + 1)).copy_from(&across);
                all.view_mut((q, 0), (k + 1, q)).copy_from(&across.transpose());
                all.view_mut((q, q), (k + 1, k + 1)).copy_from(&within);
                all
            })
            .collect();
        Some(Sums { rows: self, n_free: k, scales, products })
    }
}

impl Sums<'_, '_> {
    fn solved(
        &self,
        total: &DMatrix<f64>,
        weight: f64,
        held: &[bool],
    ) -> Option<(DVector<f64>, Cholesky<f64, nalgebra::Dyn>)> {
        let (q, k) = (self.rows.sigma.len(), self.n_free);
        let mut normal = total.view((0, 0), (q + k, q + k)).clone_owned();
        let mut right = total.view((0, q + k), (q + k, 1)).column(0).clone_owned();
        for (index, sigma) in self.rows.sigma.iter().enumerate() {
            normal[(index, index)] += weight / (sigma * sigma);
        }
        for index in 0..k {
            // A column of nothing, and one that is held, stay at zero.
            if held[index] || normal[(q + index, q + index)] <= 0.0 {
                normal.row_mut(q + index).fill(0.0);
                normal.column_mut(q + index).fill(0.0);
                normal[(q + index, q + index)] = 1.0;
                right[q + index] = 0.0;
            } else {
                normal[(q + index, q + index)] *= 1.0 + 1e-12;
            }
        }
        let factor = Cholesky::new(normal)?;
        Some((factor.solve(&right), factor))
    }

    fn total(&self, takes: &dyn Fn(usize) -> bool) -> DMatrix<f64> {
        let size = self.rows.sigma.len() + self.n_free + 1;
        let taken = self.products.iter().enumerate().filter(|(block, _)| takes(*block));
        taken.fold(DMatrix::zeros(size, size), |sum, (_, products)| sum + products)
    }

    fn square_sum(products: &DMatrix<f64>, x: &DVector<f64>) -> f64 {
        let n = x.len();
        let (gram, right) = (products.view((0, 0), (n, n)), products.view((0, n), (n, 1)));
        (products[(n, n)] - 2.0 * x.dot(&right.column(0)) + x.dot(&(gram * x))).max(0.0)
    }

    /// Fits everything; what `held` marks stays at zero.
    pub(crate) fn fit(&self, weight: f64, held: &[bool]) -> Option<Fit> {
        let (q, k) = (self.rows.sigma.len(), self.n_free);
        let total = self.total(&|_| true);
        let (x, factor) = self.solved(&total, weight, held)?;
        let per = |index: usize| if self.scales[index] > 0.0 { 1.0 / self.scales[index] } else { 0.0 };
        let inverse = factor.inverse();
        let covariance =
            DMatrix::from_fn(k, k, |row, column| weight * per(row) * per(column) * inverse[(q + row, q + column)]);
        let n = self.rows.n().max(1) as f64;
        let square = Self::square_sum(&total, &x);
        let drawn: f64 = x.iter().zip(&self.rows.sigma).map(|(value, sigma)| (value / sigma).powi(2)).sum();
        Some(Fit {
            nuisances: x.rows(0, q).iter().copied().collect(),
            free: (0..k).map(|index| x[q + index] * per(index)).collect(),
            covariance,
            mean_square: square / n,
            cost: (square + weight * drawn) / n,
        })
    }

    /// Mean squares of blocks left out of the fit.
    pub(crate) fn hold_out(&self, weight: f64, held: &[bool]) -> Option<HeldOut> {
        let folds = &self.rows.track.fold_of_block;
        let fits: Option<Vec<DVector<f64>>> = (0..FOLDS)
            .map(|fold| Some(self.solved(&self.total(&|block| folds[block] != fold), weight, held)?.0))
            .collect();
        let fits = fits?;
        let counts: Vec<f64> = self.rows.listed.iter().map(|listed| listed.len() as f64).collect();
        let blocks = self
            .products
            .iter()
            .enumerate()
            .map(|(block, products)| Self::square_sum(products, &fits[folds[block]]) / counts[block].max(1.0));
        Some(HeldOut { blocks: blocks.collect(), counts, floor_square: self.rows.floor_square })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    /// A track of triangles, with `n` random columns on it.
    fn columns(given: &Given, n: usize) -> Vec<Vec<f64>> {
        let value = |at: usize, column: usize| ((at * 7919 + column * 104_729) % 1009) as f64 / 1009.0 - 0.5;
        (0..n).map(|column| (0..given.track.n()).map(|at| value(at, column)).collect()).collect()
    }

    #[test]
    fn what_is_free_takes_nothing_that_a_loose_nuisance_explains_as_well() {
        let given = Given::of(&["isobaric-triangles"], &[]);
        let columns = columns(&given, 1);
        let left_n: Vec<f64> = columns[0].iter().map(|value| 3.0 * value).collect();
        let rows = Rows::new(&given.track, &[(columns[0].clone(), 1.0)], 0.0);
        let fit = rows.sums(&columns, &left_n).unwrap().fit(1e-3, &[false]).unwrap();
        // The sum is known exactly, the difference as well as the prior is.
        assert!((fit.free[0] + fit.nuisances[0] - 3.0).abs() < 1e-6);
        assert!((fit.covariance[(0, 0)].sqrt() - 1.0).abs() < 0.01, "{}", fit.covariance);
    }

    #[test]
    fn a_column_that_is_held_stays_at_zero() {
        let given = Given::of(&["isobaric-triangles"], &[]);
        let columns = columns(&given, 2);
        let left_n: Vec<f64> = columns[0].iter().zip(&columns[1]).map(|(a, b)| 3.0 * a - 2.0 * b).collect();
        let rows = Rows::new(&given.track, &[], 0.0);
        let sums = rows.sums(&columns, &left_n).unwrap();
        let free = sums.fit(1.0, &[false, false]).unwrap();
        assert!((free.free[0] - 3.0).abs() < 1e-9 && (free.free[1] + 2.0).abs() < 1e-9);
        let held = sums.fit(1.0, &[false, true]).unwrap();
        assert_eq!(held.free[1], 0.0);
        assert!(held.mean_square > free.mean_square + 0.1);
    }
}
