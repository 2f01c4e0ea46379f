//! Structure without a name: smooth functions of the coordinates, fitted to a residual.
//!
//! Piecewise linear functions over one coordinate at a time, even or odd in the direction of motion, and over pressure and
//! contraction together. They are fitted beside the base parameters (in the tangent space of the joint fit, so that what the
//! parameters can absorb is never taken for structure), drawn towards zero, and judged on held-out blocks like any
//! candidate. They tell how much of a residual is still structured, and over which coordinate it is concentrated.

use nalgebra::{DMatrix, DVector};
use pam_core::artifact::diagnosis::Coordinate;
use pam_core::force::columns::N_COLUMNS;
use pam_identification::problem::ForceProblem;
use rayon::prelude::*;

use crate::coordinates::Coordinates;
use crate::hypothesis::ranges;
use crate::joint::HeldOut;
use crate::state::{Setting, State};
use crate::track::FOLDS;

/// Squares of the coefficients count as much as this many instants: neighbors share their noise.
const RIDGE: f64 = 10.0;

/// Knots over the force.
const FORCE_KNOTS: usize = 32;

/// Functions over one coordinate, or over pressure and contraction.
#[derive(Debug, Clone)]
pub struct Feature {
    /// What it is a function of; pressure and contraction together count as contraction.
    pub coordinate: Coordinate,
    /// Whether it changes sign with the direction.
    pub odd: bool,
    /// Whether it is a function of pressure and contraction together.
    pub plane: bool,
    /// Functions.
    n: usize,
    /// Up to four functions that an instant belongs to, with their values.
    entries: Vec<[(u32, f64); 4]>,
    /// Knots of a function of one coordinate.
    pub knots: Vec<f64>,
}

/// What a feature says of a residual.
#[derive(Debug, Clone)]
pub struct Structure {
    /// Mean squares over held-out blocks.
    pub held_out: HeldOut,
    /// What the functions fitted to everything say at each instant, in N.
    pub values_n: Vec<f64>,
}

/// Every feature that the track has room for.
pub fn features(setting: &Setting<'_>, coordinates: &Coordinates) -> Vec<Feature> {
    let track = setting.track;
    let direction: Vec<f64> = track.instants.iter().map(|instant| instant.moment.direction).collect();
    let mut features = Vec::new();
    for (coordinate, knots, odd) in [
        (Coordinate::Pressure, 14, true),
        (Coordinate::Contraction, 20, true),
        (Coordinate::Force, FORCE_KNOTS, true),
        (Coordinate::Speed, 10, true),
        (Coordinate::TravelSinceReversal, 12, true),
        (Coordinate::TimeSinceLastMove, 8, true),
        (Coordinate::Cycle, 8, false),
    ] {
        let values = coordinates.of_kind(coordinate);
        features.extend(over(values, &track.counted, coordinate, knots, None));
        if odd {
            features.extend(over(values, &track.counted, coordinate, knots, Some(&direction)));
        }
    }
    features.push(over_time(setting, coordinates));
    for odd in [false, true] {
        features.push(over_plane(setting, coordinates, &direction, odd));
    }
    features
}

/// Functions of one coordinate, odd in `direction` where it is given; none where too little counts.
fn over(
    values: &[f64],
    counted: &[bool],
    coordinate: Coordinate,
    knots: usize,
    direction: Option<&[f64]>,
) -> Option<Feature> {
    let knots = quantile_knots(values, counted, knots, coordinate);
    if knots.len() < 3 {
        return None;
    }
    let factor = |at: usize| direction.map_or(1.0, |direction| direction[at]);
    let entries = values.iter().enumerate().map(|(at, &value)| hats(&knots, value, factor(at))).collect();
    Some(Feature { coordinate, odd: direction.is_some(), plane: false, n: knots.len(), entries, knots })
}

/// The force that orders the residual of `state` best: as measured, or as it should have been measured. What a load cell does
/// wrong over part of its range is a function of that, while its reading may pass the same value twice.
pub fn telling_force_n(setting: &Setting<'_>, state: &State, remainder: &Remainder) -> Vec<f64> {
    let measured_n: Vec<f64> = setting.track.instants.iter().map(|instant| instant.force_n).collect();
    let due_n: Vec<f64> =
        measured_n.iter().zip(setting.residuals_n(state)).map(|(force_n, residual_n)| force_n - residual_n).collect();
    let left = |force_n: &[f64]| {
        over(force_n, &setting.track.counted, Coordinate::Force, FORCE_KNOTS, None)
            .and_then(|feature| remainder.structure(&[&feature]))
            .map_or(f64::INFINITY, |structure| structure.held_out.mean_square())
    };
    if left(&due_n) < left(&measured_n) { due_n } else { measured_n }
}

/// Knots such that about as many counted instants lie between any two; fewer where values repeat.
fn quantile_knots(values: &[f64], counted: &[bool], n: usize, coordinate: Coordinate) -> Vec<f64> {
    let mut sorted: Vec<f64> =
        values.iter().zip(counted).filter(|(value, counted)| **counted && value.is_finite()).map(|(&v, _)| v).collect();
    if sorted.len() < 10 * n {
        return Vec::new();
    }
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len() - 1;
    let (low, high) = (sorted[last / 1000], sorted[last - last / 1000]);
    let even =
        matches!(coordinate, Coordinate::Pressure | Coordinate::Contraction | Coordinate::Force | Coordinate::Cycle);
    let mut knots: Vec<f64> = (0..n)
        .map(|index| {
            let share = index as f64 / (n - 1) as f64;
            let even_value = low + share * (high - low);
            let quantile = sorted[(share * last as f64) as usize];
            // Half by number, half by distance: neither an empty interval nor one that holds nearly everything.
            if even { 0.7 * even_value + 0.3 * quantile } else { quantile }
        })
        .collect();
    let span = high - low;
    knots.dedup_by(|next, before| *next - *before <= 1e-3 * span);
    knots
}

/// Shares of the two knots around `value`, times `factor`.
fn hats(knots: &[f64], value: f64, factor: f64) -> [(u32, f64); 4] {
    let last = knots.len() - 1;
    let above = knots.partition_point(|&knot| knot <= value).clamp(1, last);
    let share = ((value - knots[above - 1]) / (knots[above] - knots[above - 1])).clamp(0.0, 1.0);
    [(above as u32 - 1, factor * (1.0 - share)), (above as u32, factor * share), (0, 0.0), (0, 0.0)]
}

/// Functions of time, each recording its own.
fn over_time(setting: &Setting<'_>, coordinates: &Coordinates) -> Feature {
    const KNOTS: usize = 10;
    let values = coordinates.of_kind(Coordinate::Time);
    let mut entries = vec![[(0, 0.0); 4]; values.len()];
    let mut n = 0;
    for range in &setting.track.recordings {
        let Some(last) = range.clone().last() else { continue };
        let end_s = values[last].max(f64::MIN_POSITIVE);
        let knots: Vec<f64> = (0..KNOTS).map(|index| end_s * index as f64 / (KNOTS - 1) as f64).collect();
        for at in range.clone() {
            entries[at] = hats(&knots, values[at], 1.0).map(|(index, value)| (index + n as u32, value));
        }
        n += KNOTS;
    }
    Feature { coordinate: Coordinate::Time, odd: false, plane: false, n, entries, knots: Vec::new() }
}

/// Functions of pressure and contraction together.
fn over_plane(setting: &Setting<'_>, coordinates: &Coordinates, direction: &[f64], odd: bool) -> Feature {
    const KNOTS: usize = 8;
    let counted = &setting.track.counted;
    let pressures = coordinates.of_kind(Coordinate::Pressure);
    let contractions = coordinates.of_kind(Coordinate::Contraction);
    let mut by_pressure = quantile_knots(pressures, counted, KNOTS, Coordinate::Pressure);
    let mut by_contraction = quantile_knots(contractions, counted, KNOTS, Coordinate::Contraction);
    for knots in [&mut by_pressure, &mut by_contraction] {
        if knots.len() < 2 {
            *knots = vec![0.0, 1.0];
        }
    }
    let width = by_contraction.len() as u32;
    let entries = (0..setting.track.n())
        .map(|at| {
            let factor = if odd { direction[at] } else { 1.0 };
            let p = hats(&by_pressure, pressures[at], factor);
            let c = hats(&by_contraction, contractions[at], 1.0);
            let entry = |i: usize, j: usize| (p[i].0 * width + c[j].0, p[i].1 * c[j].1);
            [entry(0, 0), entry(0, 1), entry(1, 0), entry(1, 1)]
        })
        .collect();
    Feature {
        coordinate: Coordinate::Contraction,
        odd,
        plane: true,
        n: by_pressure.len() * by_contraction.len(),
        entries,
        knots: Vec::new(),
    }
}

/// The residual of a state in the tangent space of its fit, ready for features.
#[derive(Debug)]
pub struct Remainder {
    /// Orthonormal directions that the parameters can move the model in, and the residual: `n_directions + 1` per row.
    rows: Vec<f64>,
    n_directions: usize,
    blocks: Vec<std::ops::Range<usize>>,
    fold_of_block: Vec<usize>,
    counts: Vec<f64>,
    counted: Vec<bool>,
}

impl Remainder {
    /// Of `state`.
    pub fn of(setting: &Setting<'_>, state: &State) -> Self {
        let limits = ranges(&state.guesses);
        let width = state.sheet.width;
        let empty = pam_optim::summary::Summary::new(width);
        let problem = ForceProblem { summary: &empty, columns: setting.columns, space: setting.space, steps: &limits };
        let slopes = problem.weight_jacobian(&state.fit.x);
        let free: Vec<usize> = (0..slopes.ncols()).filter(|&index| !state.fit.at_bound[index]).collect();
        let mut directions = DMatrix::zeros(width, free.len());
        for (column, &index) in free.iter().enumerate() {
            let slope: Vec<f64> = slopes.column(index).iter().copied().collect();
            directions.set_column(column, &DVector::from_vec(state.normal.direction(&slope)));
        }
        // Orthonormal in weight space is orthonormal over the rows: the columns of Z are.
        let q = if free.is_empty() { directions } else { directions.qr().q() };
        let n_directions = q.ncols();
        let residuals_n = setting.residuals_n(state);
        let n = setting.track.n();
        let counted = setting.track.counted.clone();
        let mut rows = vec![0.0; n * (n_directions + 1)];
        for (at, columns) in state.normal.rows() {
            let row = &mut rows[at * (n_directions + 1)..(at + 1) * (n_directions + 1)];
            for (direction, value) in row[..n_directions].iter_mut().enumerate() {
                *value = columns[..width].iter().zip(q.column(direction).iter()).map(|(a, b)| a * b).sum();
            }
            row[n_directions] = residuals_n[at];
        }
        debug_assert!(width >= N_COLUMNS);
        Self {
            rows,
            n_directions,
            blocks: setting.track.blocks.clone(),
            fold_of_block: setting.track.fold_of_block.clone(),
            counts: state.normal.counts().to_vec(),
            counted,
        }
    }

    /// What `features` together say of the residual; none of them gives the residual after the tangent space alone.
    pub fn structure(&self, features: &[&Feature]) -> Option<Structure> {
        let q = self.n_directions;
        let n_hats: usize = features.iter().map(|feature| feature.n).sum();
        let width = q + n_hats + 1;
        let products: Vec<DMatrix<f64>> =
            self.blocks.par_iter().map(|block| self.products(block.clone(), features, width)).collect();
        let mut total = DMatrix::zeros(width, width);
        for product in &products {
            total += product;
        }
        let solve = |sum: &DMatrix<f64>| -> Option<DVector<f64>> {
            let mut left = sum.view((0, 0), (width - 1, width - 1)).into_owned();
            for index in 0..width - 1 {
                left[(index, index)] += if index < q { 1e-6 } else { RIDGE };
            }
            let right = sum.view((0, width - 1), (width - 1, 1)).into_owned();
            Some(left.cholesky()?.solve(&right).column(0).into_owned())
        };
        let folds: Option<Vec<DVector<f64>>> = (0..FOLDS)
            .into_par_iter()
            .map(|fold| {
                let mut sum = total.clone();
                for (block, product) in products.iter().enumerate() {
                    if self.fold_of_block[block] == fold {
                        sum -= product;
                    }
                }
                solve(&sum)
            })
            .collect();
        let folds = folds?;
        let blocks = products
            .iter()
            .enumerate()
            .map(|(block, product)| {
                let mut u = folds[self.fold_of_block[block]].clone().insert_row(width - 1, -1.0);
                u = product.transpose() * &u;
                let coefficients = &folds[self.fold_of_block[block]];
                let inner: f64 = coefficients.iter().zip(u.iter()).map(|(a, b)| a * b).sum::<f64>() - u[width - 1];
                inner.max(0.0) / self.counts[block].max(1.0)
            })
            .collect();
        let coefficients = solve(&total)?;
        let values_n = (0..self.counted.len())
            .map(|at| {
                let mut offset = q;
                let mut sum = 0.0;
                for feature in features {
                    for (index, value) in feature.entries[at] {
                        sum += value * coefficients[offset + index as usize];
                    }
                    offset += feature.n;
                }
                sum
            })
            .collect();
        Some(Structure { held_out: HeldOut { blocks, counts: self.counts.clone() }, values_n })
    }

    fn products(&self, block: std::ops::Range<usize>, features: &[&Feature], width: usize) -> DMatrix<f64> {
        let q = self.n_directions;
        let mut sums = vec![0.0; width * width];
        let mut row: Vec<(usize, f64)> = Vec::with_capacity(q + 4 * features.len() + 1);
        for at in block.filter(|&at| self.counted[at]) {
            row.clear();
            let dense = &self.rows[at * (q + 1)..(at + 1) * (q + 1)];
            row.extend(dense[..q].iter().copied().enumerate());
            let mut offset = q;
            for feature in features {
                row.extend(
                    feature.entries[at]
                        .iter()
                        .filter(|(_, value)| *value != 0.0)
                        .map(|&(index, value)| (offset + index as usize, value)),
                );
                offset += feature.n;
            }
            row.push((width - 1, dense[q]));
            for (position, &(i, left)) in row.iter().enumerate() {
                for &(j, right) in &row[position..] {
                    sums[i.min(j) * width + i.max(j)] += left * right;
                }
            }
        }
        let mut out = DMatrix::zeros(width, width);
        for i in 0..width {
            for j in i..width {
                out[(i, j)] = sums[i * width + j];
                out[(j, i)] = sums[i * width + j];
            }
        }
        out
    }
}
