//! What a fit leaves, ready to judge sentences on: the residual beside everything that base, effects and nuisances could still
//! take of it.
//!
//! A sentence is fitted in the tangent space of the joint fit, on the instants that searches look at, and judged on blocks
//! that its fit did not see. Nothing of eq. 11 is evaluated again, so that hundreds of sentences cost less than a second.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use pam_muscle::effects::sentence::{Argument, Curve, Scale, Sentence};

use crate::joint::HeldOut;
use crate::state::{Setting, State};
use crate::structure::ProjectedResidual;
use crate::track::FOLDS;

/// Squares of a curve's values count as much as this many instants of the full grid: neighbors share their noise.
const RIDGE: f64 = 10.0;

/// The residual of a state, and what a sentence needs to be judged on it.
pub(super) struct Field<'a> {
    setting: &'a Setting<'a>,
    state: &'a State,
    remainder: ProjectedResidual,
    /// Factor of each scale at every instant, in the order of [`Scale::ALL`], as much of it as the load cell reads.
    factors: Vec<Vec<f64>>,
    /// Instants that are looked at, of each block.
    looked_at: Vec<Vec<usize>>,
    /// Products of the tangent space and the residual, of each block.
    products: Vec<DMatrix<f64>>,
    counts: Vec<f64>,
    /// Ridge of a curve's values.
    ridge: f64,
    /// What is left without a sentence.
    pub(super) nothing: HeldOut,
}

/// Products of one sentence with the tangent space and the residual, block by block.
pub(super) struct Products {
    blocks: Vec<DMatrix<f64>>,
    /// Size of the curve's columns is one newton, root mean square, over what is looked at: what they were divided by.
    size: f64,
}

impl<'a> Field<'a> {
    pub(super) fn of(setting: &'a Setting<'a>, state: &'a State) -> Option<Self> {
        let track = setting.track;
        let remainder = ProjectedResidual::of(setting, state);
        let base = |at: usize| (&state.sheet.seen[at], &state.sheet.base[at]);
        let factors = Scale::ALL.map(|scale| {
            (0..track.n())
                .map(|at| {
                    let (now, base) = base(at);
                    state.read.slopes[at] * scale.factor(now, base)
                })
                .collect()
        });
        let block = |range: &Range<usize>| -> Vec<usize> { range.clone().filter(|&at| track.sampled[at]).collect() };
        let looked_at: Vec<Vec<usize>> = track.blocks.iter().map(block).collect();
        let counts: Vec<f64> = looked_at.iter().map(|rows| rows.len() as f64).collect();
        let width = remainder.n_directions + 1;
        let products = looked_at
            .iter()
            .map(|rows| {
                let mut sums = DMatrix::zeros(width, width);
                for &at in rows {
                    let row = DVector::from_column_slice(&remainder.rows[at * width..(at + 1) * width]);
                    sums.syger(1.0, &row, &row, 1.0);
                }
                sums.fill_upper_triangle_with_lower_triangle();
                sums
            })
            .collect();
        let thinned = counts.iter().sum::<f64>() / track.n_counted().max(1) as f64;
        let nothing = HeldOut { blocks: Vec::new(), counts: counts.clone(), floor_square: setting.floor_square };
        let mut field = Self {
            setting,
            state,
            remainder,
            factors: factors.into(),
            looked_at,
            products,
            counts,
            ridge: RIDGE * thinned,
            nothing,
        };
        let alone = Products { blocks: field.products.clone(), size: 1.0 };
        field.nothing = field.held_out(&alone)?;
        Some(field)
    }

    /// What `sentence` would be evaluated at, at every instant.
    pub(super) fn arguments(&self, sentence: &Sentence) -> Vec<f64> {
        let State { sheet, .. } = self.state;
        let mut values = Vec::with_capacity(sheet.seen.len());
        for range in &self.setting.track.recordings {
            let mut argument = Argument::of(sentence);
            values.extend(range.clone().map(|at| argument.follow(&sheet.seen[at], &sheet.base[at])));
        }
        values
    }

    /// Values at the instants that are looked at, rising.
    pub(super) fn sorted(&self, arguments: &[f64]) -> Vec<f64> {
        let mut sorted: Vec<f64> =
            self.looked_at.iter().flatten().map(|&at| arguments[at]).filter(|value| value.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted
    }

    /// Products of a curve over `arguments` in proportion to `scale`; none where it is nothing anywhere.
    pub(super) fn products(&self, arguments: &[f64], scale: Scale, curve: &Curve) -> Option<Products> {
        let (q, k) = (self.remainder.n_directions, curve.n_amplitudes());
        let factors = &self.factors[scale as usize];
        let mut size = 0.0;
        let mut blocks: Vec<DMatrix<f64>> = Vec::with_capacity(self.products.len());
        let mut row: Vec<(usize, f64)> = Vec::new();
        for (rows, known) in self.looked_at.iter().zip(&self.products) {
            let mut cross = vec![0.0; k * (q + 1)];
            let mut own = DMatrix::<f64>::zeros(k, k);
            for &at in rows {
                row.clear();
                curve.each(arguments[at], &mut |index, value| row.push((index, value * factors[at])));
                let tangent = &self.remainder.rows[at * (q + 1)..(at + 1) * (q + 1)];
                for &(index, value) in &row {
                    size += value * value;
                    for (sum, entry) in cross[index * (q + 1)..(index + 1) * (q + 1)].iter_mut().zip(tangent) {
                        *sum += value * entry;
                    }
                    for &(other, factor) in &row {
                        own[(index, other)] += value * factor;
                    }
                }
            }
            let width = q + k + 1;
            let place = |index: usize| if index < q { index } else { width - 1 };
            let mut out = DMatrix::zeros(width, width);
            for i in 0..=q {
                for j in 0..=q {
                    out[(place(i), place(j))] = known[(i, j)];
                }
                for index in 0..k {
                    out[(place(i), q + index)] = cross[index * (q + 1) + i];
                    out[(q + index, place(i))] = cross[index * (q + 1) + i];
                }
            }
            out.view_mut((q, q), (k, k)).copy_from(&own);
            blocks.push(out);
        }
        let size = (size / (self.counts.iter().sum::<f64>().max(1.0))).sqrt();
        if !(size.is_finite() && size > 1e-12) {
            return None;
        }
        for block in &mut blocks {
            let last = block.ncols() - 1;
            for index in q..last {
                block.column_mut(index).scale_mut(1.0 / size);
                block.row_mut(index).scale_mut(1.0 / size);
            }
        }
        Some(Products { blocks, size })
    }

    /// Mean squares of every block under a fit to all but its fold.
    pub(super) fn held_out(&self, products: &Products) -> Option<HeldOut> {
        let fold_of = &self.setting.track.fold_of_block;
        let total = products.sum(|_| 1.0);
        let folds: Option<Vec<DVector<f64>>> = (0..FOLDS)
            .map(|fold| {
                let left_out = products.sum(|block| if fold_of[block] == fold { 1.0 } else { 0.0 });
                self.solve(&(&total - left_out))
            })
            .collect();
        let folds = folds?;
        let square = |(block, sums): (usize, &DMatrix<f64>)| {
            let coefficients = &folds[fold_of[block]];
            coefficients.dot(&(sums * coefficients)).max(0.0) / self.counts[block].max(1.0)
        };
        let blocks = products.blocks.iter().enumerate().map(square).collect();
        Some(HeldOut { blocks, counts: self.counts.clone(), floor_square: self.setting.floor_square })
    }

    /// The same for blocks drawn so many times each: fitted to what was drawn, judged on what was not; blocks that were drawn
    /// leave nothing and count for nothing.
    pub(super) fn out_of_bag(&self, products: &Products, times: &[f64]) -> Option<HeldOut> {
        let coefficients = self.solve(&products.sum(|block| times[block]))?;
        let judge = |(block, sums): (usize, &DMatrix<f64>)| {
            let left = coefficients.dot(&(sums * &coefficients)).max(0.0) / self.counts[block].max(1.0);
            if times[block] > 0.0 { (0.0, 0.0) } else { (left, self.counts[block]) }
        };
        let (blocks, counts) = products.blocks.iter().enumerate().map(judge).unzip();
        Some(HeldOut { blocks, counts, floor_square: self.setting.floor_square })
    }

    /// Products without a sentence.
    pub(super) fn alone(&self) -> Products {
        Products { blocks: self.products.clone(), size: 1.0 }
    }

    /// Values of the curve fitted to everything, in its unit.
    pub(super) fn amplitudes(&self, products: &Products) -> Option<Vec<f64>> {
        let solved = self.solve(&products.sum(|_| 1.0))?;
        let q = self.remainder.n_directions;
        Some(solved.rows(q, solved.len() - q - 1).iter().map(|value| value / products.size).collect())
    }

    /// Coefficients of the tangent space and the curve, with -1 for the residual.
    fn solve(&self, sums: &DMatrix<f64>) -> Option<DVector<f64>> {
        let last = sums.ncols() - 1;
        let mut left = sums.view((0, 0), (last, last)).into_owned();
        for index in 0..last {
            left[(index, index)] += self.remainder.ridges.get(index).copied().unwrap_or(self.ridge);
        }
        let right = sums.column(last).rows(0, last).into_owned();
        Some(left.cholesky()?.solve(&right).push(-1.0))
    }

    /// Instants of each block that are looked at.
    pub(super) fn n_blocks(&self) -> usize {
        self.counts.len()
    }
}

impl Products {
    fn sum(&self, times: impl Fn(usize) -> f64) -> DMatrix<f64> {
        let width = self.blocks.first().map_or(0, DMatrix::ncols);
        let mut sum = DMatrix::zeros(width, width);
        for (block, products) in self.blocks.iter().enumerate() {
            let times = times(block);
            if times != 0.0 {
                sum.zip_apply(products, |entry, product| *entry += times * product);
            }
        }
        sum
    }
}
