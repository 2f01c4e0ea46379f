//! Samples stuck at the ends of a channel, over consecutive values that may be looked at in several places.

use std::io;

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parts::{COLUMNS, Extent};
use crate::Recording;

/// Length of a run of equal values that counts as stuck.
const STUCK_RUN: usize = 10;

/// Equal values in a row.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// The value, in SI.
    pub value: f64,
    /// How many.
    pub n: usize,
}

/// Runs of equal values at the ends of a channel. The first and the last may go on beyond the rows that were looked at.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StuckRuns {
    /// The first run, once it has ended.
    pub first: Option<Run>,
    /// The last one, which is the only one where there is no first.
    pub last: Option<Run>,
    /// Values stuck at the lowest one, between these.
    pub low: usize,
    /// Values stuck at the highest one, between these.
    pub high: usize,
    /// Values altogether.
    pub n_rows: usize,
}

impl StuckRuns {
    /// Pressure, length and force of `recording`, whose ends are those of `extent`.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn of(recording: &Recording, extent: &Extent) -> io::Result<[Self; 3]> {
        let mut runs: [Self; 3] = Default::default();
        for chunk in recording.samples.chunks() {
            let chunk = chunk?;
            for (index, runs) in runs.iter_mut().enumerate() {
                let (lowest, highest) = (extent.lowest[index], extent.highest[index]);
                COLUMNS[index](&chunk).iter().for_each(|&value| runs.push(value, lowest, highest));
            }
        }
        Ok(runs)
    }

    pub(super) fn push(&mut self, value: f64, lowest: f64, highest: f64) {
        self.go_on(Run { value, n: 1 }, lowest, highest);
        self.n_rows += 1;
    }

    /// Goes on with a run, which may be one with the last.
    fn go_on(&mut self, run: Run, lowest: f64, highest: f64) {
        if let Some(last) = self.last.as_mut().filter(|last| last.value == run.value) {
            last.n += run.n;
            return;
        }
        let ended = self.last.replace(run);
        if self.first.is_none() {
            self.first = ended;
        } else if let Some(ended) = ended {
            self.count(ended, lowest, highest);
        }
    }

    fn count(&mut self, run: Run, lowest: f64, highest: f64) {
        if run.n >= STUCK_RUN {
            if run.value == lowest {
                self.low += run.n;
            } else if run.value == highest {
                self.high += run.n;
            }
        }
    }

    /// Goes on with the rows of `next`.
    pub fn join(&mut self, next: &Self, lowest: f64, highest: f64) {
        // A run that has ended is followed by another value.
        for run in next.first.iter().chain(&next.last) {
            self.go_on(*run, lowest, highest);
        }
        self.low += next.low;
        self.high += next.high;
        self.n_rows += next.n_rows;
    }

    /// Shares stuck at the lowest and at the highest value.
    pub(super) fn shares(&self, lowest: f64, highest: f64) -> (f64, f64) {
        let mut all = self.clone();
        self.first.iter().chain(&self.last).for_each(|run| all.count(*run, lowest, highest));
        let total = self.n_rows.max(1) as f64;
        (all.low as f64 / total, all.high as f64 / total)
    }

    #[cfg(test)]
    fn stuck(values: impl Iterator<Item = f64>, lowest: f64, highest: f64) -> (f64, f64) {
        let mut runs = Self::default();
        values.for_each(|value| runs.push(value, lowest, highest));
        runs.shares(lowest, highest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_channel_stuck_at_its_end_is_counted() {
        let values = (0..100).map(|index| if index < 40 { -9.0 } else { f64::from(index % 7) - 1.0 });
        assert_eq!(StuckRuns::stuck(values, -9.0, 5.0), (0.4, 0.0));
    }
}
