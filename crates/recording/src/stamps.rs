//! Time stamps: equal ones are spread, gaps are found.
//!
//! A clock that ticks more slowly than the logger writes gives neighbouring rows one stamp. A run of `k` rows at
//! `t`, followed by `t₂`, becomes `t + i (t₂ - t) / k`. Before a gap, and at the end, the typical step takes the
//! place of `(t₂ - t) / k`.
//!
//! With the typical step `s` (the median per row) and the typical tick `T` (the median between distinct stamps)
//! of the rows around, the time `D` from a run of `k` rows to the next stamp is a gap where
//!
//! ```text
//! D - k s > 20 s,   D > 3 T,   D > 5 min(D before, D after)
//! ```
//!
//! The medians belong to some 16,000 rows around, and the last condition looks at the neighbours, so a logger that
//! samples more slowly for a while has one gap at most, not one at every row.

use super::error::ReadErrorKind;
use super::samples::CHUNK_ROWS;

/// Steps that must be missing.
const GAP_STEPS: f64 = 20.0;
/// Ticks that must be missing, as a coarse clock makes every tick long.
const GAP_TICKS: f64 = 3.0;
/// How much longer than the shorter of its neighbours a gap is.
const GAP_NEIGHBORS: f64 = 5.0;
/// Intervals needed to tell a gap from a slow logger.
const GAP_MIN_INTERVALS: usize = 4;
/// Intervals remembered from rows already settled.
const RECENT: usize = 64;
/// Longest run of rows at one stamp: two minutes at 1 kHz.
const LONGEST_RUN: usize = 8 * CHUNK_ROWS;

/// Time between two distinct stamps.
#[derive(Debug, Clone, Copy)]
struct Interval {
    tick_s: f64,
    step_s: f64,
}

/// What is settled about the first rows of a stretch.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Settled {
    /// Rows whose stamps are final.
    pub(crate) n_rows: usize,
    /// Rows among them, or the one after, before which there is a gap.
    pub(crate) breaks: Vec<usize>,
    /// The longest of the gaps, in s.
    pub(crate) longest_gap_s: f64,
    /// Rows that were moved.
    pub(crate) n_spread: u64,
}

/// Repairs stamps, stretch by stretch.
#[derive(Debug, Default)]
pub(crate) struct StampRepair {
    recent: Vec<Interval>,
}

impl StampRepair {
    /// Settles as many rows as later ones cannot change: all but the last two runs, or all where `last`.
    /// `time_s` never decreases and begins with the rows that an earlier call left over.
    pub(crate) fn settle(&mut self, time_s: &mut [f64], last: bool) -> Result<Settled, ReadErrorKind> {
        let (mut shortest_s, mut longest_s) = (f64::INFINITY, 0.0_f64);
        for pair in time_s.windows(2) {
            let step_s = pair[1] - pair[0];
            shortest_s = shortest_s.min(step_s);
            longest_s = longest_s.max(step_s);
        }
        let usual_s = self.recent.last().map_or(shortest_s, |interval| interval.tick_s.min(shortest_s));
        if shortest_s > 0.0 && longest_s <= GAP_STEPS * usual_s {
            let n_rows = if last { time_s.len() } else { time_s.len().saturating_sub(2) };
            let from = n_rows.saturating_sub(RECENT + 1);
            for pair in time_s[from..n_rows].windows(2) {
                let step_s = pair[1] - pair[0];
                self.remember(Interval { tick_s: step_s, step_s });
            }
            return Ok(Settled { n_rows, ..Settled::default() });
        }
        self.settle_runs(time_s, last)
    }

    fn settle_runs(&mut self, time_s: &mut [f64], last: bool) -> Result<Settled, ReadErrorKind> {
        let mut starts: Vec<usize> = vec![0];
        starts.extend((1..time_s.len()).filter(|row| time_s[*row] > time_s[row - 1]));
        let stamps: Vec<f64> = starts.iter().map(|row| time_s[*row]).collect();
        let ends: Vec<usize> = starts.iter().skip(1).copied().chain([time_s.len()]).collect();
        let n_runs = starts.len();
        if let Some(run) = (0..n_runs).find(|run| ends[*run] - starts[*run] > LONGEST_RUN) {
            return Err(ReadErrorKind::ClockStands { time_s: stamps[run], rows: LONGEST_RUN });
        }
        let mut intervals = std::mem::take(&mut self.recent);
        let n_before = intervals.len();
        for run in 0..n_runs - 1 {
            let tick_s = stamps[run + 1] - stamps[run];
            intervals.push(Interval { tick_s, step_s: tick_s / (ends[run] - starts[run]) as f64 });
        }
        let typical = Interval {
            tick_s: median(intervals.iter().map(|interval| interval.tick_s)),
            step_s: median(intervals.iter().map(|interval| interval.step_s)),
        };
        let n_settled = if last { n_runs } else { n_runs.saturating_sub(2) };
        let mut settled =
            Settled { n_rows: if n_settled == 0 { 0 } else { ends[n_settled - 1] }, ..Settled::default() };
        for run in 0..n_settled {
            let n_rows = ends[run] - starts[run];
            let interval = n_before + run;
            let is_gap = is_gap(&intervals, interval, n_rows, typical);
            let follows = run + 1 < n_runs;
            if n_rows > 1 {
                let span_s =
                    if is_gap || !follows { typical.step_s * n_rows as f64 } else { intervals[interval].tick_s };
                spread(&mut time_s[starts[run]..ends[run]], span_s)?;
                settled.n_spread += n_rows as u64 - 1;
            }
            if is_gap {
                settled.breaks.push(ends[run]);
                settled.longest_gap_s = settled.longest_gap_s.max(stamps[run + 1] - time_s[ends[run] - 1]);
            }
        }
        for interval in intervals.into_iter().take(n_before + n_settled) {
            self.remember(interval);
        }
        Ok(settled)
    }

    fn remember(&mut self, interval: Interval) {
        if self.recent.len() >= 2 * RECENT {
            self.recent.drain(..RECENT);
        }
        self.recent.push(interval);
    }
}

fn is_gap(intervals: &[Interval], index: usize, n_rows: usize, typical: Interval) -> bool {
    let Some(Interval { tick_s, .. }) = intervals.get(index).copied() else { return false };
    let tick_at = |index: Option<usize>| index.and_then(|index| intervals.get(index)).map(|interval| interval.tick_s);
    let before_s = tick_at(index.checked_sub(1)).unwrap_or(f64::INFINITY);
    let after_s = tick_at(Some(index + 1)).unwrap_or(f64::INFINITY);
    intervals.len() >= GAP_MIN_INTERVALS
        && tick_s - n_rows as f64 * typical.step_s > GAP_STEPS * typical.step_s
        && tick_s > GAP_TICKS * typical.tick_s
        && tick_s > GAP_NEIGHBORS * before_s.min(after_s)
}

/// Spreads rows at one stamp evenly over `span_s`.
fn spread(run: &mut [f64], span_s: f64) -> Result<(), ReadErrorKind> {
    let (start_s, n_rows) = (run[0], run.len() as f64);
    let end_s = start_s + span_s;
    let mut previous_s = start_s;
    for (index, time_s) in run.iter_mut().enumerate().skip(1) {
        *time_s = start_s + index as f64 * span_s / n_rows;
        // Also false where the span is not a number, that is where all rows of the file have one stamp.
        if !(*time_s > previous_s && *time_s < end_s) {
            return Err(ReadErrorKind::StampsTooLarge { time_s: start_s });
        }
        previous_s = *time_s;
    }
    Ok(())
}

/// The lower median; NaN of nothing.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    if values.is_empty() {
        return f64::NAN;
    }
    let middle = (values.len() - 1) / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
