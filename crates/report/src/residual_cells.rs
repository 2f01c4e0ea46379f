//! Cells of two channels over which residuals are averaged.

use crate::number::with_minus;
use crate::plot::{Axis, Bins};

/// With more standstill values than this, equal bins serve better than one each.
const MOST_LEVELS: usize = 14;

/// One coordinate: a channel of several recordings, cut into bins, one per level where it stands still in each.
#[derive(Debug)]
pub(crate) struct Channel<'a> {
    recordings: Vec<&'a [f64]>,
    bins: Bins,
    /// Bin of each recording, where the channel stands still.
    fixed: Option<Vec<usize>>,
}

impl<'a> Channel<'a> {
    /// `same`: how far values may lie apart and count as one level, relative to the largest value; `decimals`: of a
    /// level's name; `cells`: number of bins where the channel moves.
    pub(crate) fn new(title: &str, recordings: Vec<&'a [f64]>, same: f64, decimals: usize, cells: usize) -> Self {
        let all = || recordings.iter().flat_map(|values| values.iter().copied());
        let same = same * all().filter(|value| value.is_finite()).map(f64::abs).fold(0.0, f64::max);
        let Some(levels) = levels(&recordings, same) else {
            let (lowest, highest) =
                all().fold((f64::NAN, f64::NAN), |(low, high): (f64, f64), value| (low.min(value), high.max(value)));
            return Self { bins: Bins::Equal(Axis::linear(title, lowest, highest, 5), cells), recordings, fixed: None };
        };
        let fixed = recordings.iter().map(|values| nearest(&levels, finite_mean(values))).collect();
        let names = levels.iter().map(|level| with_minus(format!("{level:.decimals$}"))).collect();
        Self { bins: Bins::Named(title.to_owned(), names), recordings, fixed: Some(fixed) }
    }

    /// How it is cut.
    pub(crate) fn bins(&self) -> &Bins {
        &self.bins
    }

    /// Whether values can be found along it; levels have no scale.
    pub(crate) fn is_scale(&self) -> bool {
        self.fixed.is_none()
    }

    /// Bin of a sample.
    pub(crate) fn bin_of(&self, recording: usize, sample: usize) -> Option<usize> {
        match &self.fixed {
            Some(fixed) => fixed.get(recording).copied(),
            None => self.bins.bin_of(self.recordings[recording][sample]),
        }
    }
}

/// The values at which a channel stands still, rising, if it does so in every recording.
fn levels(recordings: &[&[f64]], same: f64) -> Option<Vec<f64>> {
    let mut levels = Vec::new();
    for values in recordings.iter().filter(|values| values.iter().any(|value| value.is_finite())) {
        if quantile(values, 0.98) - quantile(values, 0.02) > same {
            return None;
        }
        levels.push(finite_mean(values));
    }
    levels.sort_by(f64::total_cmp);
    let levels: Vec<f64> = levels.chunk_by(|a, b| b - a <= same).map(mean).collect();
    (!levels.is_empty() && levels.len() <= MOST_LEVELS).then_some(levels)
}

fn finite_mean(values: &[f64]) -> f64 {
    let finite = values.iter().filter(|value| value.is_finite());
    let (n, sum) = finite.fold((0.0, 0.0), |(n, sum), value| (n + 1.0, sum + value));
    sum / n
}

fn nearest(levels: &[f64], value: f64) -> usize {
    let distance = |index: &usize| (levels[*index] - value).abs();
    (0..levels.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

/// The value that `share` of the finite `values` lie below; NaN for none.
pub(crate) fn quantile(values: &[f64], share: f64) -> f64 {
    // Every few samples are enough for a picture.
    let every = values.len().div_ceil(20_000).max(1);
    let mut drawn: Vec<f64> = values.iter().copied().step_by(every).filter(|value| value.is_finite()).collect();
    if drawn.is_empty() {
        return f64::NAN;
    }
    let rank = ((drawn.len() - 1) as f64 * share).round() as usize;
    *drawn.select_nth_unstable_by(rank, f64::total_cmp).1
}

/// Mean of `values`; NaN for none.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
