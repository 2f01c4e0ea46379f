//! Later recordings beside the baseline, over time: for a page to show.

use super::hypothesis::Later;
use super::point::Point;
use super::search::Found;

/// One later recording, its channels smoothed; all columns are as long.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LaterTrace {
    /// Time since the recording began, in s.
    pub time_s: Vec<f64>,
    /// Measured force, in N.
    pub force_n: Vec<f64>,
    /// Force of the baseline, in N.
    pub baseline_n: Vec<f64>,
    /// Force of the baseline with what has changed, within its standard errors, in N.
    pub changed_n: Vec<f64>,
    /// Whether an instant was compared.
    pub counted: Vec<bool>,
}

/// The recordings in their order.
pub(super) fn traces(later: &Later<'_>, then: &Point, found: &Found) -> Vec<LaterTrace> {
    let track = later.track;
    let baseline_n = then.force_n(track);
    let changed_n = found.now.hypothesis.point.force_n(track);
    let within_n = later.rows.force_n(&found.now.fit.nuisances);
    let of_recording = |rows: &std::ops::Range<usize>| {
        let mut trace = LaterTrace::default();
        // An instant that was not compared has the tare of the one before it.
        let mut last_n = rows.clone().find(|&at| track.counted[at]).map_or(0.0, |at| within_n[at]);
        for at in rows.clone() {
            last_n = if track.counted[at] { within_n[at] } else { last_n };
            trace.time_s.push(track.instants[at].moment.time_s);
            trace.force_n.push(later.measured_n[at]);
            trace.baseline_n.push(baseline_n[at]);
            trace.changed_n.push(changed_n[at] + last_n);
            trace.counted.push(track.counted[at]);
        }
        trace
    };
    track.recordings.iter().map(of_recording).collect()
}
