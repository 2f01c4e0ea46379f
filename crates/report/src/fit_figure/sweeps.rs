//! Slow sweeps: stretches in which one channel moves far while the other stands still.
//!
//! Only there is force a curve over one channel. Whatever else a recording holds would be a tangle in the same panel, and is
//! shown as measured against modelled force instead.

use std::ops::Range;

use super::Role;
use super::characteristic::Abscissa;
use super::clean::{Clean, extent, mean};
use crate::plot::round_levels;

/// Share of the range of the other channel within which it stands still.
const STILL: f64 = 0.05;
/// Share of the range of the channel that a sweep spans at least.
const LEAST_SPAN: f64 = 0.25;
/// Share of the range per second above which a sweep is not slow.
const FASTEST_PER_S: f64 = 0.6;
/// Sweeps of one panel, one for each level of the other channel.
const LEVELS: usize = 7;
/// Fewer samples are no sweep.
const FEWEST: usize = 12;

/// One sweep.
#[derive(Debug, Clone)]
pub(super) struct Sweep<'a> {
    pub(super) recording: &'a Clean,
    pub(super) rows: Range<usize>,
    /// Mean of the other channel.
    pub(super) level: f64,
    span: f64,
}

/// The widest sweep at each level of the other channel.
pub(super) fn sweeps<'a>(abscissa: Abscissa, recordings: &'a [Clean]) -> Vec<Sweep<'a>> {
    let range = |values: &dyn Fn(&'a Clean) -> &'a [f64]| {
        let (lowest, highest) = extent(recordings.iter().flat_map(|recording| values(recording).iter().copied()));
        highest - lowest
    };
    let along_range = range(&|recording| abscissa.along(recording));
    let across_range = range(&|recording| abscissa.across(recording));
    let mut found = Vec::new();
    for recording in recordings {
        let (along, across) = (abscissa.along(recording), abscissa.across(recording));
        for rows in still(recording, across, STILL * across_range) {
            let (lowest, highest) = extent(along[rows.clone()].iter().copied());
            let lasts_s = recording.time_s[rows.end - 1] - recording.time_s[rows.start];
            let span = highest - lowest;
            let travel: f64 = along[rows.clone()].windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
            // Noise travels as well; a sweep goes to its end and back a few times at most, each way slowly.
            let is_slow =
                span <= FASTEST_PER_S * along_range * lasts_s && travel <= 40.0 * span.max(1e-12) * (1.0 + lasts_s);
            if rows.len() >= FEWEST && span >= LEAST_SPAN * along_range && is_slow {
                let level = mean(&across[rows.clone()]);
                found.push(Sweep { recording, rows, level, span });
            }
        }
    }
    widest_of_each_level(found)
}

/// Stretches in which `across` stays within `tolerance`. Samples that are left out around a reversal are no gap: a sweep and its
/// way back belong together.
fn still(recording: &Clean, across: &[f64], tolerance: f64) -> Vec<Range<usize>> {
    let mut stretches = Vec::new();
    let (mut start, mut low, mut high) = (0, f64::INFINITY, f64::NEG_INFINITY);
    for (row, &value) in across.iter().enumerate() {
        let (lower, higher) = (low.min(value), high.max(value));
        let step_s = if row > 0 { recording.time_s[row] - recording.time_s[row - 1] } else { 0.0 };
        if higher - lower > tolerance || !(0.0..=LONGEST_GAP_S).contains(&step_s) {
            stretches.push(start..row);
            (start, low, high) = (row, value, value);
        } else {
            (low, high) = (lower, higher);
        }
    }
    stretches.push(start..across.len());
    stretches.retain(|rows| !rows.is_empty());
    stretches
}

/// A gap that ends a sweep, in s.
const LONGEST_GAP_S: f64 = 2.0;

fn widest_of_each_level(found: Vec<Sweep<'_>>) -> Vec<Sweep<'_>> {
    let (lowest, highest) = extent(found.iter().map(|sweep| sweep.level));
    if found.is_empty() {
        return found;
    }
    let levels = round_levels(lowest, highest, LEVELS - 1);
    let nearest = |level: f64| {
        let distance = |index: &usize| (levels[*index] - level).abs();
        (0..levels.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
    };
    let mut chosen: Vec<Option<Sweep<'_>>> = vec![None; levels.len().max(1)];
    for sweep in found {
        // Fitted recordings are shown before held-out ones, which have panels of their own.
        let worth = |sweep: &Sweep<'_>| (sweep.recording.role == Role::Estimation, sweep.span);
        let place = &mut chosen[nearest(sweep.level)];
        if place.as_ref().is_none_or(|best| worth(best) < worth(&sweep)) {
            *place = Some(sweep);
        }
    }
    chosen.into_iter().flatten().collect()
}
