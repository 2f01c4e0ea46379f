//! What is always in beside base and effects, and is never named: columns with priors.
//!
//! | group          | columns                                                                              |
//! |----------------|--------------------------------------------------------------------------------------|
//! | static map     | products of Legendre polynomials in pressure and contraction, and the same times the direction of friction: what caliper, rubber and the form of eq. 11 leave of a smooth static force |
//! | tare           | one constant per recording                                                           |
//! | ends           | what a muscle grows longer by as it pulls, since it is clamped at its ends             |
//! | reversal       | friction within a tenth of a millimetre after each reversal: no strand turns over at once, and no length sensor tells when |
//! | beginning      | what a named effect with a lasting memory keeps of what went before every recording |
//! | term           | values of the curve of a term without a name                                         |
//! | form of effect | changes of the shape of an effect that was named, and of its size over pressure and contraction |
//!
//! Every column has a root mean square of one newton over the instants that count (that of a tare where it is
//! not zero), so that a coefficient is a size in newtons, and a prior precision in units of an instant's square: a
//! coefficient is drawn to zero as by so many instants.

use std::ops::Range;
use std::sync::{Arc, LazyLock};

use nalgebra::DMatrix;
use pam_muscle::Coordinate;
use pam_muscle::effects::static_map::{self, EVEN_DEGREE, ODD_DEGREE, legendre, scaled};
use pam_muscle::effects::{Base, Moment, Term, effect, end_stretch};
use pam_muscle::force::ForceModel;
use pam_muscle::force::rubber_friction::normal_force_n;
use rayon::prelude::*;

use crate::coordinates::Coordinates;
use crate::design_matrix::rows_of;
use crate::structure;
use crate::track::Track;
use remembered::{NuisanceBlock, RememberedBlocks};

mod remembered;

/// A kind of nuisance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// A smooth static force, the same in both directions.
    EvenMap,
    /// The same, with the sign of friction.
    OddMap,
    /// A muscle that is clamped at its ends.
    Ends,
    /// A constant per recording.
    Tare,
    /// Friction that turns over a little later than the length.
    Reversal,
    /// Other forms of a named effect.
    Form,
    /// What a named effect remembers of what went before a recording.
    Beginning,
    /// The curve of a term without a name.
    Term,
}

/// Columns of nuisances over the instants of a track.
#[derive(Debug, Clone, Default)]
pub struct Nuisance {
    n: usize,
    /// Row-major, `n` per instant.
    rows: Arc<Vec<f64>>,
    /// Prior precision of each column.
    pub precision: Vec<f64>,
    /// What each column was multiplied by.
    scales: Vec<f64>,
    /// Which columns belong together.
    pub groups: Vec<(Group, Range<usize>)>,
    /// Blocks of `rows` that were asked for.
    blocks: Arc<RememberedBlocks>,
}

/// No nuisances at all.
pub static NONE: LazyLock<Nuisance> = LazyLock::new(Nuisance::default);

/// Id of the static map in models.
pub const MAP_ID: &str = "static-map";

/// Id of the stretch of the ends in models.
pub const ENDS_ID: &str = "end-stretch";

/// What the static map is a function of.
const MAPPED: [Coordinate; 2] = [Coordinate::Pressure, Coordinate::Contraction];

/// Travel in which friction turns over, in m: half of the least that pages call pre-sliding.
const TURN_M: f64 = 1e-4;

/// Knots of a free static map over pressure and contraction, the same in both directions and with the sign of friction.
const FREE_EVEN: [usize; 2] = [8, 7];
/// See [`FREE_EVEN`].
const FREE_ODD: [usize; 2] = [4, 4];

/// Prior precision of the static map and of forms: hardly any, enough to keep what the data do not see finite.
pub(crate) const LOOSE: f64 = 20.0;

/// Instants that share an error with one, about: half a second on the grid.
const CORRELATED: f64 = 25.0;

/// Tares of a load cell that is zeroed before a recording, in N.
pub(crate) const TARE_N: f64 = 0.5;

impl Nuisance {
    /// Columns at each instant; none for no nuisances at all.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Columns at instant `at`.
    pub fn row(&self, at: usize) -> &[f64] {
        &self.rows[at * self.n..(at + 1) * self.n]
    }

    /// Rows of the instants `listed`, in blocks of which each is a range of these, and their products.
    pub(crate) fn blocks(&self, listed: &[usize], ranges: &[Range<usize>]) -> Arc<Vec<NuisanceBlock>> {
        self.blocks.of(listed, ranges, || {
            let block = |range: &Range<usize>| {
                let rows = DMatrix::from_vec(self.n, range.len(), rows_of(&self.rows, self.n, &listed[range.clone()]));
                NuisanceBlock { products: &rows * rows.transpose(), rows: Arc::new(rows) }
            };
            ranges.par_iter().map(block).collect()
        })
    }

    /// What `coefficients` add at every one of `n_instants`, in N.
    pub fn force_n(&self, coefficients: &[f64], n_instants: usize) -> Vec<f64> {
        (0..n_instants).into_par_iter().map(|at| self.force_at_n(at, coefficients)).collect()
    }

    /// The same at instant `at` alone.
    pub fn force_at_n(&self, at: usize, coefficients: &[f64]) -> f64 {
        self.row(at).iter().zip(coefficients).map(|(column, value)| column * value).sum()
    }

    /// With `columns` (one vector each, over all instants) of `group` behind.
    #[must_use]
    pub fn with(&self, group: Group, columns: Vec<Vec<f64>>, counted: &[bool], precision: f64) -> Self {
        let (columns, scales): (Vec<Vec<f64>>, Vec<f64>) =
            columns.into_par_iter().map(|column| normalized(column, counted)).unzip();
        let rows = self.rows_with(columns.len(), counted.len(), |at, new| {
            new.iter_mut().zip(&columns).for_each(|(value, column)| *value = column[at]);
        });
        self.behind(group, rows, &scales, precision)
    }

    /// With `columns` as other forms of an effect that was named.
    #[must_use]
    pub fn with_forms(&self, columns: Vec<Vec<f64>>, counted: &[bool]) -> Self {
        self.with(Group::Form, columns, counted, LOOSE)
    }

    /// With `columns` of what named effects remember of what went before every recording.
    #[must_use]
    pub fn with_beginnings(&self, columns: Vec<Vec<f64>>, counted: &[bool]) -> Self {
        self.with(Group::Beginning, columns, counted, LOOSE)
    }

    /// Tare of every recording, and other forms of effects that are known; `floor_n` is what the sensors leave.
    pub fn of_recordings(track: &Track, floor_n: f64) -> Self {
        let n = track.n();
        let variance = CORRELATED * floor_n * floor_n;
        let mut out = Self::default();
        if track.recordings.len() > 1 {
            let tares = track.recordings.iter().map(|range| {
                let mut column = vec![0.0; n];
                column[range.clone()].fill(1.0);
                column
            });
            out = out.with(Group::Tare, tares.collect(), &track.counted, variance / (TARE_N * TARE_N));
        }
        if !track.known_forms_n.is_empty() {
            out = out.with_forms(track.known_forms_n.clone(), &track.counted);
        }
        out
    }

    /// The same with friction that takes [`TURN_M`] to turn over.
    #[must_use]
    pub fn with_reversals(&self, track: &Track, coordinates: &Coordinates, model: &ForceModel) -> Self {
        let travel_m = coordinates.of_kind(Coordinate::TravelSinceReversal);
        let column = track.instants.iter().zip(travel_m).map(|(instant, travel_m)| {
            let Moment { pressure_pa, length_m, direction, .. } = instant.moment;
            let normal_n = normal_force_n(pressure_pa, model.kinematics().diameter_m(length_m), length_m);
            direction * normal_n * (-travel_m / TURN_M).exp()
        });
        self.with(Group::Reversal, vec![column.collect()], &track.counted, LOOSE)
    }

    /// The same with a stretch of the ends, beside the force of `model`.
    #[must_use]
    pub(crate) fn with_ends(&self, track: &Track, model: &ForceModel) -> Self {
        let column = track.instants.par_iter().map(|instant| {
            end_stretch::per_m_per_n(&Base::of(model, instant.moment.pressure_pa, instant.moment.length_m))
        });
        self.with(Group::Ends, vec![column.collect()], &track.counted, LOOSE)
    }

    /// The stretch of the ends with `coefficients`, in m/N; none where there is none.
    pub(crate) fn stretch_m_per_n(&self, coefficients: &[f64]) -> Option<f64> {
        let (_, columns) = self.groups.iter().find(|(group, _)| *group == Group::Ends)?;
        Some(self.in_their_units(coefficients, columns.clone())[0])
    }

    /// What of it a model carries, with `coefficients`: the stretch of the ends and the static map, as far as they are in.
    pub fn carried(&self, coefficients: &[f64], track: &Track, coordinates: &Coordinates) -> Vec<Term> {
        let ends = self.stretch_m_per_n(coefficients).zip(effect(ENDS_ID));
        let ends = ends.map(|(stretch_m_per_n, effect)| Term::new(effect, Vec::new(), vec![stretch_m_per_n]));
        ends.into_iter().chain(self.map_term(coefficients, track, coordinates)).collect()
    }

    /// The same with a smooth static map.
    #[must_use]
    pub fn with_map(&self, track: &Track, coordinates: &Coordinates) -> Self {
        let [pressure, contraction] = MAPPED.map(|kind| over_range(coordinates.of_kind(kind), &track.counted));
        let products = |least: usize, degree: usize, sign: &dyn Fn(usize) -> f64| {
            let product = |(i, j): (usize, usize)| {
                (0..track.n()).map(|at| sign(at) * legendre(i, pressure[at]) * legendre(j, contraction[at])).collect()
            };
            static_map::terms(least, degree).map(product).collect::<Vec<Vec<f64>>>()
        };
        let even = products(1, EVEN_DEGREE, &|_| 1.0);
        let odd = products(0, ODD_DEGREE, &|at| track.instants[at].moment.direction);
        self.with(Group::EvenMap, even, &track.counted, LOOSE).with(Group::OddMap, odd, &track.counted, LOOSE)
    }

    /// The same with a static map that follows bends as well: piecewise linear over pressure and contraction, which no effect
    /// of time, rate or history can hide behind or grow from.
    #[must_use]
    pub fn with_free_map(&self, track: &Track, coordinates: &Coordinates) -> Self {
        let plane = |n: [usize; 2], sign: &dyn Fn(usize) -> f64| -> (usize, Vec<[(usize, f64); 4]>) {
            let values = MAPPED.map(|kind| coordinates.of_kind(kind));
            let [rows, columns] = [0, 1].map(|index| knots(values[index], &track.counted, n[index]));
            let entries = values[0].iter().zip(values[1]).enumerate().map(|(at, (pressure, contraction))| {
                let [below, above] = hats(&rows, *pressure);
                let [before, behind] = hats(&columns, *contraction);
                [(below, before), (below, behind), (above, before), (above, behind)].map(
                    |((i, by_pressure), (j, by_contraction))| {
                        (i * columns.len() + j, sign(at) * by_pressure * by_contraction)
                    },
                )
            });
            (rows.len() * columns.len(), entries.collect())
        };
        let even = plane(FREE_EVEN, &|_| 1.0);
        let odd = plane(FREE_ODD, &|at| track.instants[at].moment.direction);
        self.with_sparse(Group::EvenMap, even, &track.counted).with_sparse(Group::OddMap, odd, &track.counted)
    }

    /// With so many columns of `group` behind, of which every instant has up to four that are not zero.
    fn with_sparse(&self, group: Group, (more, entries): (usize, Vec<[(usize, f64); 4]>), counted: &[bool]) -> Self {
        let mut sums = vec![(0.0, 0.0); more];
        for (entries, _) in entries.iter().zip(counted).filter(|(_, counted)| **counted) {
            for &(column, value) in entries.iter().filter(|(_, value)| *value != 0.0) {
                sums[column].0 += value * value;
                sums[column].1 += 1.0;
            }
        }
        let scales: Vec<f64> = sums.into_iter().map(|(squares, count)| scale(squares, count)).collect();
        let rows = self.rows_with(more, entries.len(), |at, new| {
            for &(column, value) in &entries[at] {
                new[column] += value * scales[column];
            }
        });
        self.behind(group, rows, &scales, LOOSE)
    }

    /// The rows of all instants with so many columns more, which `fill` has of each; they come to it as zeros.
    fn rows_with(&self, more: usize, n_instants: usize, fill: impl Fn(usize, &mut [f64]) + Sync) -> Vec<f64> {
        let n = self.n + more;
        let mut rows = vec![0.0; n * n_instants];
        rows.par_chunks_exact_mut(n.max(1)).enumerate().for_each(|(at, row)| {
            let (known, new) = row.split_at_mut(self.n);
            known.copy_from_slice(self.row(at));
            fill(at, new);
        });
        rows
    }

    /// `rows`, of which those of `self` are the first columns, with the `scales` and the `precision` of the others.
    fn behind(&self, group: Group, rows: Vec<f64>, scales: &[f64], precision: f64) -> Self {
        let n = self.n + scales.len();
        let mut groups = self.groups.clone();
        groups.push((group, self.n..n));
        Self {
            n,
            rows: Arc::new(rows),
            precision: self.precision.iter().copied().chain(std::iter::repeat_n(precision, scales.len())).collect(),
            scales: [&self.scales, scales].concat(),
            groups,
            blocks: Arc::default(),
        }
    }

    /// With `columns` of the curve of a term without a name.
    #[must_use]
    pub(crate) fn with_term(&self, columns: Vec<Vec<f64>>, counted: &[bool]) -> Self {
        self.with(Group::Term, columns, counted, LOOSE)
    }

    /// `coefficients` of some columns in the units that these had before they were given a size of one newton.
    pub(crate) fn in_their_units(&self, coefficients: &[f64], columns: Range<usize>) -> Vec<f64> {
        columns.map(|column| coefficients[column] * self.scales[column]).collect()
    }

    /// The same without the columns of `groups`.
    #[must_use]
    pub(crate) fn without(&self, groups: &[Group]) -> Self {
        let keeps = |(group, _): &&(Group, Range<usize>)| !groups.contains(group);
        let kept: Vec<(Group, Range<usize>)> = self.groups.iter().filter(keeps).cloned().collect();
        let columns: Vec<usize> = kept.iter().flat_map(|(_, columns)| columns.clone()).collect();
        let of = |values: &[f64]| columns.iter().map(|&column| values[column]).collect();
        let mut first = 0;
        let renumbered = kept.into_iter().map(|(group, columns)| {
            let range = first..first + columns.len();
            first = range.end;
            (group, range)
        });
        Self {
            n: columns.len(),
            rows: Arc::new(
                self.rows
                    .chunks_exact(self.n.max(1))
                    .flat_map(|row| columns.iter().map(|&column| row[column]))
                    .collect(),
            ),
            precision: of(&self.precision),
            scales: of(&self.scales),
            groups: renumbered.collect(),
            blocks: Arc::default(),
        }
    }

    /// The same with a static map that is drawn to zero `factor` times as strongly.
    #[must_use]
    pub fn tightened(&self, factor: f64) -> Self {
        let mut out = self.clone();
        for (_, columns) in self.groups.iter().filter(|(group, _)| matches!(group, Group::EvenMap | Group::OddMap)) {
            out.precision[columns.clone()].iter_mut().for_each(|precision| *precision *= factor);
        }
        out
    }

    /// The static map with `coefficients` as a model carries it; none where there is no map.
    pub(crate) fn map_term(&self, coefficients: &[f64], track: &Track, coordinates: &Coordinates) -> Option<Term> {
        let columns =
            |wanted: Group| self.groups.iter().find(|(group, _)| *group == wanted).map(|(_, columns)| columns);
        let even = columns(Group::EvenMap)?;
        // Friction that was named stands in the place of the odd part.
        let n_odd = static_map::terms(0, ODD_DEGREE).count();
        let odd = columns(Group::OddMap).cloned().unwrap_or(0..0);
        let [(lowest_pa, highest_pa), (least, most)] =
            MAPPED.map(|kind| range(coordinates.of_kind(kind), &track.counted));
        let missing = n_odd - odd.len();
        let amplitudes = even.clone().chain(odd).map(|column| coefficients[column] * self.scales[column]);
        let amplitudes = amplitudes.chain(std::iter::repeat_n(0.0, missing));
        Some(Term::new(effect(MAP_ID)?, vec![lowest_pa, highest_pa, least, most], amplitudes.collect()))
    }
}

/// With a root mean square of one over what counts and is not zero, and the factor for it; nothing where hardly anything is
/// there.
fn normalized(mut column: Vec<f64>, counted: &[bool]) -> (Vec<f64>, f64) {
    let (mut squares, mut count) = (0.0, 0.0);
    for (value, _) in column.iter().zip(counted).filter(|(value, counted)| **counted && **value != 0.0) {
        squares += value * value;
        count += 1.0;
    }
    let scale = scale(squares, count);
    column.iter_mut().for_each(|value| *value = if scale > 0.0 { *value * scale } else { 0.0 });
    (column, scale)
}

/// The factor that gives `count` values with such a sum of `squares` a root mean square of one; zero for hardly anything.
fn scale(squares: f64, count: f64) -> f64 {
    let size = f64::sqrt(squares / f64::max(count, 1.0));
    if size.is_finite() && size > 1e-9 { 1.0 / size } else { 0.0 }
}

/// Lowest and highest of `values` over what counts.
pub(crate) fn range(values: &[f64], counted: &[bool]) -> (f64, f64) {
    let kept = values.iter().zip(counted).filter(|(_, counted)| **counted);
    kept.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (value, _)| (low.min(*value), high.max(*value)))
}

/// Between -1 and 1 over what counts, and no further elsewhere.
pub(crate) fn over_range(values: &[f64], counted: &[bool]) -> Vec<f64> {
    let (low, high) = range(values, counted);
    values.iter().map(|value| scaled(*value, low, high)).collect()
}

/// Knots between the lowest and the highest value that count, half by distance and half by number; one where nothing varies.
fn knots(values: &[f64], counted: &[bool], n: usize) -> Vec<f64> {
    let kept = values.iter().zip(counted).filter(|(value, counted)| **counted && value.is_finite());
    let mut sorted: Vec<f64> = kept.map(|(value, _)| *value).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else { return vec![0.0] };
    let last = sorted.len() - 1;
    let mut knots: Vec<f64> = (0..n)
        .map(|index| {
            let share = index as f64 / (n - 1) as f64;
            0.5 * (low + share * (high - low)) + 0.5 * sorted[(share * last as f64) as usize]
        })
        .collect();
    knots.dedup_by(|next, before| *next - *before <= 1e-3 * (high - low));
    knots
}

/// The two piecewise linear functions between `knots` that are not zero at `value`; they sum to one.
fn hats(knots: &[f64], value: f64) -> [(usize, f64); 2] {
    if knots.len() < 2 {
        return [(0, 1.0), (0, 0.0)];
    }
    let [below, above, ..] = structure::hats(knots, value, 1.0);
    [below, above].map(|(index, share)| (index as usize, share))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    /// Root mean square of what the base leaves beside `nuisance`, in N.
    fn left_n(given: &Given, nuisance: &Nuisance) -> f64 {
        let plain = given.setting();
        let setting = plain.beside(nuisance);
        let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let residuals_n = setting.residuals_n(&state);
        (residuals_n.iter().map(|residual| residual * residual).sum::<f64>() / residuals_n.len() as f64).sqrt()
    }

    #[test]
    fn piecewise_linear_functions_sum_to_one() {
        let knots = [0.0, 1.0, 4.0, 5.0];
        for value in [-3.0, 0.0, 0.3, 1.0, 3.9, 5.0, 70.0] {
            assert!((hats(&knots, value).iter().map(|hat| hat.1).sum::<f64>() - 1.0).abs() < 1e-12, "{value}");
        }
        assert_eq!(hats(&[2.0], 7.0)[0], (0, 1.0));
    }

    #[test]
    fn a_column_has_a_size_of_one_newton_where_it_is() {
        let counted = [true, true, true, false];
        let (column, scale) = normalized(vec![3.0, 0.0, -3.0, 100.0], &counted);
        assert_eq!(column[..3], [1.0, 0.0, -1.0]);
        assert!((scale - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(normalized(vec![0.0; 4], &counted), (vec![0.0; 4], 0.0));
    }

    #[test]
    fn a_tare_is_taken_up_as_far_as_load_cells_have_one() {
        let mut given = Given::of(&["isobaric-triangles", "isometric-ramps"], &[]);
        let second = given.track.recordings[1].clone();
        for instant in &mut given.track.instants[second] {
            instant.force_n += 0.5;
        }
        let without_n = left_n(&given, &NONE);
        let with_n = left_n(&given, &Nuisance::of_recordings(&given.track, 0.1));
        assert!(with_n < 0.2 * without_n, "{with_n} of {without_n}");
    }

    #[test]
    fn a_smooth_static_misfit_is_the_maps_and_a_bump_is_not() {
        let bumpy = |width: f64| {
            let mut given = Given::of(&["isobaric-triangles", "isometric-ramps"], &[]);
            for instant in &mut given.track.instants {
                let off = (instant.moment.contraction_ratio - 0.1) / width;
                instant.force_n += 8.0 * (-off * off).exp();
            }
            let nuisance = NONE.with_map(&given.track, &Coordinates::of(&given.track));
            left_n(&given, &nuisance)
        };
        assert!(bumpy(0.15) < 0.15, "{}", bumpy(0.15));
        assert!(bumpy(0.01) > 0.6, "{}", bumpy(0.01));
    }

    #[test]
    fn the_map_that_a_model_carries_is_the_one_that_was_fitted() {
        let mut given = Given::of(&["isobaric-triangles"], &[]);
        for instant in &mut given.track.instants {
            instant.force_n += 1e-4 * instant.moment.pressure_pa * instant.moment.contraction_ratio;
        }
        let coordinates = Coordinates::of(&given.track);
        let nuisance = NONE.with_map(&given.track, &coordinates);
        let plain = given.setting();
        let setting = plain.beside(&nuisance);
        let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let term = nuisance.map_term(&state.fit.nuisances, &given.track, &coordinates).expect("a map");
        let mut memory = term.effect.start(&given.muscle, &term.shape);
        let mut columns = vec![0.0; term.amplitudes.len()];
        for (at, instant) in given.track.instants.iter().enumerate().filter(|(at, _)| given.track.counted[*at]) {
            memory.pulls(&instant.moment, &state.sheet.base[at], &mut columns);
            let carried_n: f64 = columns.iter().zip(&term.amplitudes).map(|(column, size)| column * size).sum();
            assert!((carried_n - state.nuisance_n[at]).abs() < 1e-6, "{carried_n} {}", state.nuisance_n[at]);
        }
    }

    #[test]
    fn a_map_that_is_drawn_to_zero_takes_up_nothing() {
        let mut given = Given::of(&["isobaric-triangles", "isometric-ramps"], &[]);
        for instant in &mut given.track.instants {
            instant.force_n += 8.0 * (20.0 * instant.moment.contraction_ratio).sin();
        }
        let map = NONE.with_map(&given.track, &Coordinates::of(&given.track));
        let (loose_n, tight_n) = (left_n(&given, &map), left_n(&given, &map.tightened(1e7)));
        let bare_n = left_n(&given, &NONE);
        assert!(loose_n < 0.3 * bare_n && tight_n > 0.95 * bare_n, "{loose_n} {tight_n} {bare_n}");
    }
}
