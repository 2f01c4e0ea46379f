//! Base and effects fitted together, within what physics allows, and judged on blocks that the fit never saw.

use pam_identification::problem::ForceProblem;
use pam_identification::search_space::{Free, SearchSpace};
use pam_muscle::force::columns::ForceColumns;
use pam_muscle::force::{BaseParameters, Parameter};
use pam_optim::polish::descend;
use rayon::prelude::*;

use crate::normal::Extended;
use crate::track::FOLDS;

/// The one parameter, but for the compliance of the strands, that eq. 11 is not linear in.
const K2: Free = Free::One(Parameter::K2);
/// The ranges of k₂ are the same for every modulus of the strands.
const ANY_MODULUS_PA: f64 = 3e9;

/// Parameters of a joint fit.
#[derive(Debug, Clone, PartialEq)]
pub struct JointFit {
    /// Point of the unit box: coordinates of the base, then of the amplitudes.
    pub x: Vec<f64>,
    /// Which coordinates press against their range.
    pub at_bound: Vec<bool>,
    /// Weights of all columns.
    pub weights: Vec<f64>,
    /// Coefficients of the nuisances.
    pub nuisances: Vec<f64>,
    /// Parameters of eq. 11.
    pub parameters: BaseParameters,
    /// Amplitudes of the effects, in order.
    pub amplitudes: Vec<f64>,
    /// Mean square of the residual over what it was fitted to, in N².
    pub mean_square: f64,
}

/// Times its mean square that a block may be foretold worse.
const MOST_LOST: f64 = 2.0;

/// Mean squares over held-out blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldOut {
    /// Mean square of each block under a fit that never saw its fold, in N².
    pub blocks: Vec<f64>,
    /// Rows of each block that count.
    pub counts: Vec<f64>,
    /// What the sensors leave, in N²: no block is known better.
    pub floor_square: f64,
}

impl HeldOut {
    /// Over all blocks, in N².
    pub fn mean_square(&self) -> f64 {
        let rows: f64 = self.counts.iter().sum();
        self.blocks.iter().zip(&self.counts).map(|(square, count)| square * count).sum::<f64>() / rows.max(1.0)
    }

    /// What `with` takes off the mean square, in N². A block that others foretell worse with it than without counts as twice as bad at
    /// most: where what was fitted is carried on, it may miss by anything, which says that it is lost there and not how much.
    pub fn gain(&self, with: &Self) -> f64 {
        let rows: f64 = self.counts.iter().sum();
        let gain = |((before, after), count): ((&f64, &f64), &f64)| (before - after.min(MOST_LOST * before)) * count;
        self.blocks.iter().zip(&with.blocks).zip(&self.counts).map(gain).sum::<f64>() / rows.max(1.0)
    }

    /// `Σ ln(without / with)` over the blocks, each weighed by its rows so that all together weigh as many as there are.
    pub fn log_ratio(&self, with: &Self) -> f64 {
        let rows: f64 = self.counts.iter().sum();
        let each = self.counts.len() as f64 / rows.max(1.0);
        self.log_ratios(with).zip(&self.counts).map(|(ratio, count)| ratio * count * each).sum()
    }

    /// `ln(without / with)` of every block, the sensors' floor in both, so that what is gained or lost below it counts for
    /// nothing; 0 where a block has no rows.
    pub fn log_ratios<'a>(&'a self, with: &'a Self) -> impl Iterator<Item = f64> + 'a {
        let floor = self.floor_square;
        self.blocks.iter().zip(&with.blocks).zip(&self.counts).map(move |((before, after), &count)| {
            if count > 0.0 && *before > 0.0 && *after > 0.0 { ((before + floor) / (after + floor)).ln() } else { 0.0 }
        })
    }
}

/// What is fitted.
#[derive(Debug, Clone, Copy)]
pub struct Joint<'a> {
    /// Columns of eq. 11.
    pub columns: &'a ForceColumns,
    /// Base parameters that move, and their ranges.
    pub space: &'a SearchSpace,
    /// Ranges of the amplitudes.
    pub ranges: &'a [(f64, f64)],
    /// What the sensors leave, in N².
    pub floor_square: f64,
}

impl Joint<'_> {
    /// Fits the blocks in which `takes` is true, from `start` (base coordinates; amplitudes start at zero).
    pub fn fit(&self, rows: &Extended<'_>, start: &[f64], takes: &dyn Fn(usize) -> bool) -> Option<JointFit> {
        let reduced = rows.reduced(takes)?;
        let problem =
            ForceProblem { summary: &reduced.summary, columns: self.columns, space: self.space, steps: self.ranges };
        let n_free = self.space.free.len();
        let mut x = start[..n_free].to_vec();
        for (index, &(low, high)) in self.ranges.iter().enumerate() {
            let at_zero = -low / (high - low);
            x.push(start.get(n_free + index).copied().unwrap_or(at_zero));
        }
        let mut polished = descend(&problem, &x);
        if let Some(other) = self.elsewhere(&x, &polished.x) {
            let second = descend(&problem, &other);
            if second.cost < polished.cost {
                polished = second;
            }
        }
        let weights = problem.weights(&polished.x);
        Some(JointFit {
            parameters: self.space.parameters(&polished.x[..n_free]),
            amplitudes: weights[weights.len() - self.ranges.len()..].to_vec(),
            mean_square: 2.0 * polished.cost,
            at_bound: polished.at_bound,
            nuisances: rows.nuisances(&reduced, &weights),
            weights,
            x: polished.x,
        })
    }

    /// Another start than `start`, if the descent from there came to an `end` with a k₂ that no muscle has: eq. 11 is not
    /// linear in it, and one that has grown to stand in for an effect keeps the descent from finding that.
    fn elsewhere(&self, start: &[f64], end: &[f64]) -> Option<Vec<f64>> {
        let k2 = self.space.free.iter().position(|free| *free == K2)?;
        let (low, high) = K2.ranges(ANY_MODULUS_PA).plausible;
        (!(low..=high).contains(&self.space.value(k2, end[k2]))).then(|| {
            let mut other = start.to_vec();
            other[k2] = self.space.nominal_coordinate(k2, ANY_MODULUS_PA);
            other
        })
    }

    /// Fits everything.
    pub fn fit_all(&self, rows: &Extended<'_>, start: &[f64]) -> Option<JointFit> {
        self.fit(rows, start, &|_| true)
    }

    /// Fits that each leave one fold out.
    pub fn fold_fits(&self, rows: &Extended<'_>, start: &[f64], fold_of_block: &[usize]) -> Option<Vec<JointFit>> {
        (0..FOLDS).into_par_iter().map(|fold| self.fit(rows, start, &|block| fold_of_block[block] != fold)).collect()
    }

    /// Holds each fold out in turn.
    pub fn hold_out(&self, rows: &Extended<'_>, start: &[f64], fold_of_block: &[usize]) -> Option<HeldOut> {
        let folds = self.fold_fits(rows, start, fold_of_block)?;
        let counts = rows.counts();
        let blocks = (0..rows.n_blocks())
            .map(|block| {
                let fit = &folds[fold_of_block[block]];
                rows.square_sum(block, &fit.weights, &fit.nuisances) / counts[block].max(1.0)
            })
            .collect();
        Some(HeldOut { blocks, counts, floor_square: self.floor_square })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_that_is_lost_costs_no_more_than_twice_its_own_mean_square() {
        let held =
            |blocks: [f64; 3]| HeldOut { blocks: blocks.to_vec(), counts: vec![10.0, 10.0, 20.0], floor_square: 0.01 };
        let without = held([4.0, 1.0, 2.0]);
        assert_eq!(without.gain(&held([1.0, 1.5, 2.0])), (30.0 - 5.0) / 40.0);
        assert_eq!(without.gain(&held([1.0, 900.0, 2.0])), (30.0 - 10.0) / 40.0);
        assert_eq!(without.gain(&without), 0.0);
    }
}
