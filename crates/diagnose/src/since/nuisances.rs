//! What may differ from then without having changed.

use pam_muscle::force::ForceModel;

use super::baseline::Baseline;
use super::point::Point;
use super::quantity::Quantity;
use crate::coordinates::Coordinates;
use crate::nuisance::{Group, Nuisance};
use crate::track::Track;

/// Tare of a load cell that is zeroed before a recording, in N.
const TARE_N: f64 = 0.5;
/// What friction around reversals and a beginning may amount to, root mean square, in N.
const TURN_N: f64 = 0.5;
/// Times what it leaves of itself that a lasting memory may bring with it.
const BROUGHT: f64 = 3.0;

/// Change of the force by a unit of `quantity` at `point`, whose force is `force_n`.
pub(crate) fn slope_n(point: &Point, quantity: Quantity, force_n: &[f64], track: &Track) -> Vec<f64> {
    let step = quantity.step(point);
    let mut moved = point.clone();
    quantity.set(&mut moved, quantity.of(point) + step);
    moved.force_n(track).iter().zip(force_n).map(|(moved, force_n)| (moved - force_n) / step).collect()
}

/// Columns and their priors, around the model of then.
pub(crate) fn nuisances(then: &Point, baseline: &Baseline, track: &Track, floor_n: f64) -> Vec<(Vec<f64>, f64)> {
    let force_n = then.force_n(track);
    let mut columns = Vec::new();
    let slopes: Vec<Vec<f64>> =
        baseline.free.iter().map(|&free| slope_n(then, Quantity::Base(free), &force_n, track)).collect();
    for direction in &baseline.directions {
        let sum = |at: usize| slopes.iter().zip(direction).map(|(slope, value)| value * slope[at]).sum();
        columns.push(((0..track.n()).map(sum).collect(), 1.0));
    }
    for &(quantity, stderr) in &baseline.of_terms {
        columns.push((slope_n(then, quantity, &force_n, track), stderr));
    }
    columns.extend(brought(then, track));
    columns.extend(of_recordings(then.model().base(), baseline, track, floor_n));
    columns.retain(|(column, sigma): &(Vec<f64>, f64)| *sigma > 0.0 && column.iter().any(|value| *value != 0.0));
    columns
        .retain(|(column, _)| column.iter().zip(&track.counted).all(|(value, counted)| !counted || value.is_finite()));
    columns
}

/// What a lasting memory of then brings into each recording.
fn brought(then: &Point, track: &Track) -> Vec<(Vec<f64>, f64)> {
    let mut columns = Vec::new();
    for (index, _) in then.terms.iter().enumerate().filter(|(_, term)| term.effect.outlasts()) {
        let own = then.brought_by_n(index, track);
        columns.extend(by_recording(&own, track).map(|column| (column, BROUGHT)));
    }
    columns
}

/// `values` of each recording, zero elsewhere.
pub(crate) fn by_recording<'a>(values: &'a [f64], track: &'a Track) -> impl Iterator<Item = Vec<f64>> + 'a {
    track.recordings.iter().map(|range| {
        let mut column = vec![0.0; values.len()];
        column[range.clone()].copy_from_slice(&values[range.clone()]);
        column
    })
}

/// Tares, friction around reversals, and what the model of then missed of its own recordings.
fn of_recordings(base: &ForceModel, baseline: &Baseline, track: &Track, floor_n: f64) -> Vec<(Vec<f64>, f64)> {
    let coordinates = Coordinates::of(track);
    let tares = track.recordings.iter().map(|range| {
        let mut column = vec![0.0; track.n()];
        column[range.clone()].fill(1.0);
        (column, TARE_N)
    });
    let mut columns: Vec<(Vec<f64>, f64)> = tares.collect();
    let others = Nuisance::default().with_reversals(track, &coordinates, base);
    let missed = baseline.missed_n > 0.1 * floor_n;
    let others = if missed { others.with_map(track, &coordinates) } else { others };
    let n_map: usize = others
        .groups
        .iter()
        .filter(|(group, _)| matches!(group, Group::EvenMap | Group::OddMap))
        .map(|(_, range)| range.len())
        .sum();
    for (group, range) in &others.groups {
        // Every column has a root mean square of one newton.
        let sigma = match group {
            Group::EvenMap | Group::OddMap => baseline.missed_n / (n_map.max(1) as f64).sqrt(),
            _ => TURN_N,
        };
        columns.extend(range.clone().map(|index| ((0..track.n()).map(|at| others.row(at)[index]).collect(), sigma)));
    }
    columns
}
