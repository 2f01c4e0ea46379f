//! What a fit leaves, ready to judge sentences on: the residual beside everything that base, effects and nuisances could still
//! take of it.
//!
//! A sentence is fitted in the tangent space of the joint fit, on the instants that searches look at, and judged on blocks
//! that its fit did not see. Nothing of eq. 11 is evaluated again, so that hundreds of sentences cost less than a second.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use pam_muscle::effects::sentence::{Argument, Curve, Scale, Sentence};

use crate::design_matrix::rows_of;
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
    /// Ridge of each direction of the tangent space.
    ridges: Vec<f64>,
    /// Factor of each scale at every instant, in the order of [`Scale::ALL`], as much of it as the load cell reads.
    factors: Vec<Vec<f64>>,
    /// Instants that are looked at, of each block.
    looked_at: Vec<Vec<usize>>,
    /// Tangent space and residual of each block, one instant in each column.
    rows: Vec<DMatrix<f64>>,
    /// Their products.
    products: Vec<DMatrix<f64>>,
    /// The tangent space over all blocks but those of each fold, and over all.
    folds: Vec<Tangent>,
    all: Tangent,
    counts: Vec<f64>,
    /// Ridge of a curve's values.
    ridge: f64,
    /// What is left without a sentence.
    pub(super) nothing: HeldOut,
}

/// Products of one sentence with the tangent space and the residual, and with itself, block by block.
pub(super) struct Products {
    cross: Vec<DMatrix<f64>>,
    own: Vec<DMatrix<f64>>,
    /// Size of the curve's columns is one newton, root mean square, over what is looked at: what they were divided by.
    size: f64,
}

/// The tangent space over some blocks, factorized: what a sentence adds is solved on top of it.
pub(super) struct Tangent {
    /// Lower triangle.
    factor: DMatrix<f64>,
    /// The residual in its coordinates.
    residual: DVector<f64>,
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
        let rows: Vec<DMatrix<f64>> = looked_at
            .iter()
            .map(|instants| DMatrix::from_vec(width, instants.len(), rows_of(&remainder.rows, width, instants)))
            .collect();
        let products: Vec<DMatrix<f64>> = rows.iter().map(|rows| rows * rows.transpose()).collect();
        let fold_of = &track.fold_of_block;
        let tangent = |fold: Option<usize>| {
            Tangent::of(&sum(&products, |block| f64::from(Some(fold_of[block]) != fold)), &remainder.ridges)
        };
        let folds: Option<Vec<Tangent>> = (0..FOLDS).map(|fold| tangent(Some(fold))).collect();
        let (folds, all) = (folds?, tangent(None)?);
        let thinned = counts.iter().sum::<f64>() / track.n_counted().max(1) as f64;
        let nothing = HeldOut { blocks: Vec::new(), counts: counts.clone(), floor_square: setting.floor_square };
        let mut field = Self {
            setting,
            state,
            ridges: remainder.ridges,
            factors: factors.into(),
            looked_at,
            rows,
            products,
            folds,
            all,
            counts,
            ridge: RIDGE * thinned,
            nothing,
        };
        field.nothing = field.held_out(&field.alone())?;
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
        self.products_by(arguments, &[scale], curve).pop()?
    }

    /// The same in proportion to each of `scales`.
    pub(super) fn products_by(&self, arguments: &[f64], scales: &[Scale], curve: &Curve) -> Vec<Option<Products>> {
        let k = curve.n_amplitudes();
        let (mut crosses, mut owns) = (vec![Vec::new(); scales.len()], vec![Vec::new(); scales.len()]);
        for (instants, rows) in self.looked_at.iter().zip(&self.rows) {
            let mut columns = DMatrix::zeros(instants.len(), scales.len() * k);
            for (row, &at) in instants.iter().enumerate() {
                curve.each(arguments[at], &mut |index, value| {
                    for (place, &scale) in scales.iter().enumerate() {
                        columns[(row, place * k + index)] += value * self.factors[scale as usize][at];
                    }
                });
            }
            let cross = rows * &columns;
            for place in 0..scales.len() {
                let columns = columns.columns(place * k, k);
                crosses[place].push(cross.columns(place * k, k).into_owned());
                owns[place].push(columns.transpose() * columns);
            }
        }
        crosses.into_iter().zip(owns).map(|(cross, own)| self.of_size_one(cross, own)).collect()
    }

    fn of_size_one(&self, mut cross: Vec<DMatrix<f64>>, mut own: Vec<DMatrix<f64>>) -> Option<Products> {
        let square: f64 = own.iter().map(DMatrix::trace).sum();
        let size = (square / (self.counts.iter().sum::<f64>().max(1.0))).sqrt();
        if !(size.is_finite() && size > 1e-12) {
            return None;
        }
        cross.iter_mut().for_each(|cross| *cross /= size);
        own.iter_mut().for_each(|own| *own /= size * size);
        Some(Products { cross, own, size })
    }

    /// Mean squares of every block under a fit to all but its fold.
    pub(super) fn held_out(&self, products: &Products) -> Option<HeldOut> {
        let fold_of = &self.setting.track.fold_of_block;
        // What each fold adds is summed once.
        let of_folds = |blocks: &[DMatrix<f64>]| -> Vec<DMatrix<f64>> {
            (0..FOLDS).map(|fold| sum(blocks, |block| f64::from(fold_of[block] == fold))).collect()
        };
        let (cross, own) = (of_folds(&products.cross), of_folds(&products.own));
        let folds: Option<Vec<DVector<f64>>> = (0..FOLDS)
            .map(|fold| {
                let others = |of: &[DMatrix<f64>]| sum(of, |other| f64::from(other != fold));
                self.solved(&self.folds[fold], &others(&cross), others(&own))
            })
            .collect();
        let folds = folds?;
        let left = |block| self.left(products, block, &folds[fold_of[block]]);
        let blocks = (0..self.n_blocks()).map(left).collect();
        Some(HeldOut { blocks, counts: self.counts.clone(), floor_square: self.setting.floor_square })
    }

    /// The tangent space over blocks drawn so many times each; none where they do not determine it.
    pub(super) fn drawn(&self, times: &[f64]) -> Option<Tangent> {
        Tangent::of(&sum(&self.products, |block| times[block]), &self.ridges)
    }

    /// Mean squares of every block under a fit to blocks drawn so many `times` each, over which the tangent space is `drawn`; blocks
    /// that were drawn leave nothing and count for nothing.
    pub(super) fn out_of_bag(&self, products: &Products, drawn: &Tangent, times: &[f64]) -> Option<HeldOut> {
        let coefficients = self.solve(drawn, products, |block| times[block])?;
        let judge = |block: usize| {
            let is_drawn = times[block] > 0.0;
            if is_drawn { (0.0, 0.0) } else { (self.left(products, block, &coefficients), self.counts[block]) }
        };
        let (blocks, counts) = (0..self.n_blocks()).map(judge).unzip();
        Some(HeldOut { blocks, counts, floor_square: self.setting.floor_square })
    }

    /// Products without a sentence.
    pub(super) fn alone(&self) -> Products {
        let cross = self.rows.iter().map(|rows| DMatrix::zeros(rows.nrows(), 0)).collect();
        Products { cross, own: vec![DMatrix::zeros(0, 0); self.n_blocks()], size: 1.0 }
    }

    /// Values of the curve fitted to everything, in its unit.
    pub(super) fn amplitudes(&self, products: &Products) -> Option<Vec<f64>> {
        let solved = self.solve(&self.all, products, |_| 1.0)?;
        let q = self.ridges.len();
        Some(solved.rows(q + 1, solved.len() - q - 1).iter().map(|value| value / products.size).collect())
    }

    /// Coefficients of the tangent space, -1 for the residual, and those of the curve, fitted to every block so many `times`, over
    /// which the tangent space is `tangent`.
    fn solve(&self, tangent: &Tangent, products: &Products, times: impl Fn(usize) -> f64) -> Option<DVector<f64>> {
        self.solved(tangent, &sum(&products.cross, &times), sum(&products.own, &times))
    }

    /// The same from sums over the blocks of the curve's products with tangent space and residual, and with itself.
    fn solved(&self, tangent: &Tangent, cross: &DMatrix<f64>, mut own: DMatrix<f64>) -> Option<DVector<f64>> {
        let q = self.ridges.len();
        let k = own.ncols();
        (0..k).for_each(|index| own[(index, index)] += self.ridge);
        // Without what the tangent space takes of the curve.
        let taken = tangent.factor.solve_lower_triangular(&cross.rows(0, q))?;
        let right = cross.row(q).transpose() - taken.tr_mul(&tangent.residual);
        let curve = match k {
            0 => DVector::zeros(0),
            _ => (own - taken.tr_mul(&taken)).cholesky()?.solve(&right),
        };
        let rest = tangent.factor.tr_solve_lower_triangular(&(&tangent.residual - taken * &curve))?;
        let mut solved = DVector::from_element(q + 1 + k, -1.0);
        solved.rows_mut(0, q).copy_from(&rest);
        solved.rows_mut(q + 1, k).copy_from(&curve);
        Some(solved)
    }

    /// Mean square that `coefficients` leave of a block.
    fn left(&self, products: &Products, block: usize, coefficients: &DVector<f64>) -> f64 {
        let q = self.ridges.len();
        let (tangent, curve) = (coefficients.rows(0, q + 1), coefficients.rows(q + 1, coefficients.len() - q - 1));
        let square = tangent.dot(&(&self.products[block] * tangent))
            + 2.0 * tangent.dot(&(&products.cross[block] * curve))
            + curve.dot(&(&products.own[block] * curve));
        square.max(0.0) / self.counts[block].max(1.0)
    }

    /// Instants of each block that are looked at.
    pub(super) fn n_blocks(&self) -> usize {
        self.counts.len()
    }
}

impl Tangent {
    /// Of products of tangent space and residual; none where they do not determine it.
    fn of(products: &DMatrix<f64>, ridges: &[f64]) -> Option<Self> {
        let q = ridges.len();
        let mut left = products.view((0, 0), (q, q)).into_owned();
        ridges.iter().enumerate().for_each(|(index, ridge)| left[(index, index)] += ridge);
        let factor = left.cholesky()?.unpack();
        let residual = factor.solve_lower_triangular(&products.view((0, q), (q, 1)).column(0))?;
        Some(Self { factor, residual })
    }
}

/// Sum of `blocks`, each so many `times`.
fn sum(blocks: &[DMatrix<f64>], times: impl Fn(usize) -> f64) -> DMatrix<f64> {
    let (rows, columns) = blocks.first().map_or((0, 0), DMatrix::shape);
    let mut sum = DMatrix::zeros(rows, columns);
    for (block, products) in blocks.iter().enumerate() {
        let times = times(block);
        if times != 0.0 {
            sum.zip_apply(products, |entry, product| *entry += times * product);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use pam_muscle::effects::sentence::{Driver, Recall};

    use super::*;
    use crate::rehearsal::tests::Given;

    /// Least squares of tangent space and curve together over the looked-at instants of the blocks in which `takes` is true: the
    /// coefficients, and the mean square that they leave of `block`.
    fn together(
        field: &Field<'_>,
        columns: &dyn Fn(usize) -> Vec<f64>,
        takes: &dyn Fn(usize) -> bool,
        block: usize,
    ) -> (DVector<f64>, f64) {
        let remainder = ProjectedResidual::of(field.setting, field.state);
        let q = remainder.n_directions;
        let row = |at: usize| {
            let own = &remainder.rows[at * (q + 1)..(at + 1) * (q + 1)];
            (DVector::from_vec([&own[..q], &columns(at)].concat()), own[q])
        };
        let width = row(field.looked_at[0][0]).0.len();
        let (mut left, mut right) = (DMatrix::zeros(width, width), DVector::zeros(width));
        for at in (0..field.n_blocks()).filter(|&block| takes(block)).flat_map(|block| &field.looked_at[block]) {
            let (row, residual_n) = row(*at);
            left += &row * row.transpose();
            right += row * residual_n;
        }
        for index in 0..width {
            left[(index, index)] += remainder.ridges.get(index).copied().unwrap_or(field.ridge);
        }
        let solved = left.lu().solve(&right).expect("a solution");
        let squares = field.looked_at[block].iter().map(|&at| {
            let (row, residual_n) = row(at);
            (residual_n - row.dot(&solved)).powi(2)
        });
        let square = squares.sum::<f64>() / field.looked_at[block].len() as f64;
        (solved, square)
    }

    #[test]
    fn a_sentence_on_top_of_the_tangent_space_is_fitted_as_both_together_are() {
        let mut given = Given::of(&["isobaric-triangles", "multisine"], &[]);
        for instant in &mut given.track.instants {
            let off = (instant.moment.contraction_ratio - 0.1) / 0.02;
            instant.force_n += 8.0 * (-off * off).exp();
        }
        given.disturb();
        let setting = given.setting();
        let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let field = Field::of(&setting, &state).expect("a field");
        let shape = Curve::Spline { knots: vec![0.0, 0.05, 0.09, 0.11, 0.15, 0.25] };
        let memory = Recall::None;
        let sentence =
            Sentence { driver: Driver::Contraction, memory, scale: Scale::Pressure, shape, seen: [0.0, 1.0] };
        let arguments = field.arguments(&sentence);
        let products = field.products(&arguments, sentence.scale, &sentence.shape).expect("products");
        let columns = |at: usize| {
            let mut columns = vec![0.0; sentence.shape.n_amplitudes()];
            sentence.shape.columns(arguments[at], &mut columns);
            columns.iter().map(|column| column * field.factors[Scale::Pressure as usize][at] / products.size).collect()
        };
        let close = |one: f64, other: f64, of: f64| assert!((one - other).abs() < 1e-7 * of, "{one} {other}");

        let found = field.amplitudes(&products).expect("a fit");
        let (all, _) = together(&field, &columns, &|_| true, 0);
        let largest = found.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        for (value, other) in found.iter().zip(all.iter().skip(field.ridges.len())) {
            close(*value, other / products.size, largest);
        }

        let held_out = field.held_out(&products).expect("folds");
        let fold_of = &given.track.fold_of_block;
        for block in 0..field.n_blocks() {
            let (_, square) = together(&field, &columns, &|other| fold_of[other] != fold_of[block], block);
            close(held_out.blocks[block], square, square);
        }

        // Drawn once each, all blocks are as they are.
        let once = vec![1.0; field.n_blocks()];
        let drawn = field.drawn(&once).expect("a tangent space");
        let out = field.out_of_bag(&products, &drawn, &once).expect("a fit");
        assert!(out.counts.iter().all(|count| *count == 0.0));
    }
}
