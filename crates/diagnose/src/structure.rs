//! Structure without a name: smooth functions of the coordinates, fitted to a residual.
//!
//! Piecewise linear functions over one coordinate at a time, even or odd in the direction of motion, and over pressure and
//! contraction together. They are fitted beside the base parameters (in the tangent space of the joint fit, so that what the
//! parameters can absorb is never taken for structure), drawn towards zero, and judged on held-out blocks like any
//! candidate. They tell how much of a residual is still structured, and over which coordinate it is concentrated.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use pam_identification::problem::ForceProblem;
use pam_muscle::Coordinate;
use pam_muscle::force::columns::N_COLUMNS;
use rayon::prelude::*;

use crate::coordinates::Coordinates;
use crate::design_matrix::rows_of;
use crate::hypothesis::ranges;
use crate::joint::HeldOut;
use crate::state::{Setting, State};
use crate::track::FOLDS;

/// Squares of the coefficients count as much as this many instants: neighbors share their noise.
const RIDGE: f64 = 10.0;

/// Share of what all functions gain that may be lost with those that are left out.
const LOST: f64 = 0.05;

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
        let knots = quantile_knots(values, &track.counted, knots, coordinate);
        if knots.len() < 3 {
            continue;
        }
        features.push(over(values, knots.clone(), coordinate, None));
        if odd {
            features.push(over(values, knots, coordinate, Some(&direction)));
        }
    }
    features.push(over_time(setting, coordinates));
    for odd in [false, true] {
        features.push(over_plane(setting, coordinates, &direction, odd));
    }
    features
}

/// Functions of one coordinate between `knots`, odd in `direction` where it is given.
fn over(values: &[f64], knots: Vec<f64>, coordinate: Coordinate, direction: Option<&[f64]>) -> Feature {
    let factor = |at: usize| direction.map_or(1.0, |direction| direction[at]);
    let entries = values.iter().enumerate().map(|(at, &value)| hats(&knots, value, factor(at))).collect();
    Feature { coordinate, odd: direction.is_some(), plane: false, n: knots.len(), entries, knots }
}

/// The force that orders the residual of `state` best: as measured, or as it should have been measured. What a load cell does
/// wrong over part of its range is a function of that, while its reading may pass the same value twice.
pub fn telling_force_n(setting: &Setting<'_>, state: &State, remainder: &ProjectedResidual) -> Vec<f64> {
    let measured_n: Vec<f64> = setting.track.instants.iter().map(|instant| instant.force_n).collect();
    let due_n: Vec<f64> =
        measured_n.iter().zip(setting.residuals_n(state)).map(|(force_n, residual_n)| force_n - residual_n).collect();
    let left = |force_n: &[f64]| {
        let knots = quantile_knots(force_n, &setting.track.counted, FORCE_KNOTS, Coordinate::Force);
        let structure =
            if knots.len() < 3 { None } else { remainder.structure(&[&over(force_n, knots, Coordinate::Force, None)]) };
        structure.map_or(f64::INFINITY, |structure| structure.held_out.mean_square())
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
pub(crate) fn hats(knots: &[f64], value: f64, factor: f64) -> [(u32, f64); 4] {
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

/// Products of columns, summed over the rows that count: the tangent space, functions, and the residual.
struct Products {
    blocks: Vec<DMatrix<f64>>,
    total: DMatrix<f64>,
    without_fold: Vec<DMatrix<f64>>,
    width: usize,
}

/// The residual of a state in the tangent space of its fit, ready for features.
#[derive(Debug)]
pub struct ProjectedResidual {
    /// Orthonormal directions that the parameters can move the model in, and the residual: `n_directions + 1` per row.
    pub(crate) rows: Vec<f64>,
    pub(crate) n_directions: usize,
    /// Ridge of each direction.
    pub(crate) ridges: Vec<f64>,
    blocks: Vec<Range<usize>>,
    fold_of_block: Vec<usize>,
    counts: Vec<f64>,
    counted: Vec<bool>,
    floor_square: f64,
}

impl ProjectedResidual {
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
        let n_own = q.ncols();
        let nuisance = setting.nuisance;
        let n_directions = n_own + nuisance.n();
        let mut ridges = vec![1e-6; n_own];
        ridges.extend_from_slice(&nuisance.precision);
        let residuals_n = setting.residuals_n(state);
        let n = setting.track.n();
        let counted = setting.track.counted.clone();
        let mut rows = vec![0.0; n * (n_directions + 1)];
        for (at, columns) in state.normal.rows() {
            let row = &mut rows[at * (n_directions + 1)..(at + 1) * (n_directions + 1)];
            for (column, factors) in columns.zip(q.row_iter()) {
                row[..n_own].iter_mut().zip(factors.iter()).for_each(|(value, factor)| *value += column * factor);
            }
            for (value, column) in row[n_own..n_directions].iter_mut().zip(nuisance.row(at)) {
                *value = state.read.slopes[at] * column;
            }
            row[n_directions] = residuals_n[at];
        }
        debug_assert!(width >= N_COLUMNS);
        Self {
            rows,
            n_directions,
            ridges,
            blocks: setting.track.blocks.clone(),
            fold_of_block: setting.track.fold_of_block.clone(),
            counts: state.normal.counts(),
            counted,
            floor_square: setting.floor_square,
        }
    }

    /// What `features` together say of the residual; none of them gives the residual after the tangent space alone.
    pub fn structure(&self, features: &[&Feature]) -> Option<Structure> {
        let products = self.all_products(features);
        let every: Vec<usize> = (0..products.width).collect();
        self.said(features, &products, &every)
    }

    /// What the fewest neighboring functions of `feature` say that together gain nearly as much as all of them; functions of
    /// one coordinate only. What the base parameters took of a mismatch in one place lies about everywhere else; without
    /// functions there, it goes back to where it came from.
    pub fn narrowest(&self, feature: &Feature) -> Option<Structure> {
        let products = self.all_products(&[feature]);
        let q = self.n_directions;
        let kept = |window: &Range<usize>| -> Vec<usize> {
            (0..q).chain(q + window.start..q + window.end).chain([products.width - 1]).collect()
        };
        let left = |window: &Range<usize>| {
            self.held_out(&products, &kept(window)).map_or(f64::INFINITY, |held_out| held_out.mean_square())
        };
        let (nothing, all) = (left(&(0..0)), left(&(0..feature.n)));
        let most = all + LOST * (nothing - all);
        let mut window = 0..feature.n;
        while window.len() > 1 {
            let shorter = [window.start + 1..window.end, window.start..window.end - 1];
            let [from_below, from_above] = shorter.each_ref().map(&left);
            if from_below.min(from_above) > most {
                break;
            }
            let [above, below] = shorter;
            window = if from_below < from_above { above } else { below };
        }
        self.said(&[feature], &products, &kept(&window))
    }

    fn all_products(&self, features: &[&Feature]) -> Products {
        let width = self.n_directions + features.iter().map(|feature| feature.n).sum::<usize>() + 1;
        let blocks: Vec<DMatrix<f64>> =
            self.blocks.par_iter().map(|block| self.products(block.clone(), features, width)).collect();
        let mut total = DMatrix::zeros(width, width);
        for block in &blocks {
            total += block;
        }
        let without_fold = (0..FOLDS).into_par_iter().map(|fold| {
            let mut sum = total.clone();
            for (_, block) in blocks.iter().enumerate().filter(|&(block, _)| self.fold_of_block[block] == fold) {
                sum -= block;
            }
            sum
        });
        Products { without_fold: without_fold.collect(), blocks, total, width }
    }

    /// Coefficients of the columns `kept`, the last of which is the residual, from the sums of some rows.
    fn solve(&self, sum: &DMatrix<f64>, kept: &[usize]) -> Option<DVector<f64>> {
        let (&residual, columns) = kept.split_last()?;
        let mut left = sum.select_columns(columns).select_rows(columns);
        for (index, &column) in columns.iter().enumerate() {
            left[(index, index)] += self.ridges.get(column).copied().unwrap_or(RIDGE);
        }
        let right = DVector::from_iterator(columns.len(), columns.iter().map(|&column| sum[(column, residual)]));
        Some(left.cholesky()?.solve(&right))
    }

    /// Mean squares that the columns `kept` leave of every block, fitted to all but its fold.
    fn held_out(&self, products: &Products, kept: &[usize]) -> Option<HeldOut> {
        let folds: Option<Vec<DVector<f64>>> = products
            .without_fold
            .par_iter()
            .map(|sum| self.solve(sum, kept).map(|coefficients| coefficients.push(-1.0)))
            .collect();
        let folds = folds?;
        let blocks = products
            .blocks
            .iter()
            .enumerate()
            .map(|(block, product)| {
                let coefficients = &folds[self.fold_of_block[block]];
                let product = product.select_columns(kept).select_rows(kept);
                (coefficients.dot(&(product * coefficients))).max(0.0) / self.counts[block].max(1.0)
            })
            .collect();
        Some(HeldOut { blocks, counts: self.counts.clone(), floor_square: self.floor_square })
    }

    /// What the columns `kept` say, held out and at every instant.
    fn said(&self, features: &[&Feature], products: &Products, kept: &[usize]) -> Option<Structure> {
        let held_out = self.held_out(products, kept)?;
        let mut coefficients = vec![0.0; products.width];
        for (&column, value) in kept.iter().zip(self.solve(&products.total, kept)?.iter()) {
            coefficients[column] = *value;
        }
        let values_n = (0..self.counted.len())
            .map(|at| {
                let mut offset = self.n_directions;
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
        Some(Structure { held_out, values_n })
    }

    fn products(&self, block: Range<usize>, features: &[&Feature], width: usize) -> DMatrix<f64> {
        let q = self.n_directions;
        let counted: Vec<usize> = block.filter(|&at| self.counted[at]).collect();
        let rows = DMatrix::from_vec(q + 1, counted.len(), rows_of(&self.rows, q + 1, &counted));
        let of_dense = &rows * rows.transpose();
        // Of the functions, of which few are anything at an instant, with the dense columns and among themselves.
        let n = width - q - 1;
        let (mut crossed, mut own) = (vec![0.0; n * (q + 1)], DMatrix::zeros(n, n));
        let mut here: Vec<(usize, f64)> = Vec::with_capacity(4 * features.len());
        for (&at, dense) in counted.iter().zip(rows.as_slice().chunks_exact(q + 1)) {
            here.clear();
            let mut offset = 0;
            for feature in features {
                let entries = feature.entries[at].iter().filter(|(_, value)| *value != 0.0);
                here.extend(entries.map(|&(index, value)| (offset + index as usize, value)));
                offset += feature.n;
            }
            for (position, &(i, left)) in here.iter().enumerate() {
                let sums = &mut crossed[i * (q + 1)..(i + 1) * (q + 1)];
                sums.iter_mut().zip(dense).for_each(|(sum, column)| *sum += left * column);
                for &(j, right) in &here[position..] {
                    own[(i.min(j), i.max(j))] += left * right;
                }
            }
        }
        let crossed = DMatrix::from_vec(q + 1, n, crossed);
        let mut products = DMatrix::zeros(width, width);
        products.view_mut((0, 0), (q, q)).copy_from(&of_dense.view((0, 0), (q, q)));
        products.view_mut((0, q), (q, n)).copy_from(&crossed.rows(0, q));
        products.view_mut((q, q), (n, n)).copy_from(&own);
        products.view_mut((0, width - 1), (q, 1)).copy_from(&of_dense.view((0, q), (q, 1)));
        products.view_mut((q, width - 1), (n, 1)).tr_copy_from(&crossed.row(q));
        products[(width - 1, width - 1)] = of_dense[(q, q)];
        products.fill_lower_triangle_with_upper_triangle();
        products
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_parameter_took_of_a_mismatch_goes_back_to_its_place() {
        const N: usize = 4000;
        const BLOCKS: usize = 20;
        let values: Vec<f64> = (0..N).map(|at| (at * 37 % N) as f64 / N as f64).collect();
        let bump = |value: f64| if (0.4..0.6).contains(&value) { 1.0 } else { 0.0 };
        let mean = values.iter().map(|value| bump(*value)).sum::<f64>() / N as f64;
        // One parameter, a constant, which has taken the mean.
        let rows = values.iter().flat_map(|value| [1.0 / (N as f64).sqrt(), bump(*value) - mean]).collect();
        let each = N / BLOCKS;
        let remainder = ProjectedResidual {
            rows,
            n_directions: 1,
            ridges: vec![1e-6],
            floor_square: 0.0,
            blocks: (0..BLOCKS).map(|block| block * each..(block + 1) * each).collect(),
            fold_of_block: (0..BLOCKS).map(|block| block % FOLDS).collect(),
            counts: vec![each as f64; BLOCKS],
            counted: vec![true; N],
        };
        let knots: Vec<f64> = (0..=20).map(|knot| f64::from(knot) / 20.0).collect();
        let feature = over(&values, knots, Coordinate::Contraction, None);
        let beyond = |structure: &Structure| {
            let far = values.iter().zip(&structure.values_n).filter(|(value, _)| !(0.35..0.65).contains(*value));
            far.map(|(_, value_n)| value_n.abs()).fold(0.0, f64::max)
        };
        let all = remainder.structure(&[&feature]).unwrap();
        let narrow = remainder.narrowest(&feature).unwrap();
        assert!(beyond(&all) > 0.1, "{}", beyond(&all));
        assert!(beyond(&narrow) < 1e-9, "{}", beyond(&narrow));
        let middle = values.iter().position(|value| *value == 0.5).unwrap();
        // Less what the ridge takes of 133 instants.
        assert!((0.85..1.05).contains(&narrow.values_n[middle]), "{}", narrow.values_n[middle]);
    }
}
