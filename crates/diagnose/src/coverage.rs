//! Where in pressure and length the fitted recordings have been: what a model says elsewhere is extrapolated, and a hold-out that
//! differs there says nothing of what is missing.

use pam_identification::trace::Trace;

/// Cells along pressure and along length.
const CELLS: usize = 10;
/// Cells about one that was visited that count as visited, too.
const MARGIN: usize = 1;

/// Cells of pressure and length that some recordings have visited.
#[derive(Debug, Clone)]
pub(crate) struct Coverage {
    pressure_pa: (f64, f64),
    length_m: (f64, f64),
    /// `CELLS` by `CELLS`, pressure first, with a border of [`MARGIN`] around.
    visited: Vec<bool>,
}

/// Cells along one side, border included.
const SIDE: usize = CELLS + 2 * MARGIN;

impl Coverage {
    /// Of the samples of `traces`.
    pub(crate) fn of(traces: &[Trace]) -> Self {
        let pressure_pa = range(traces.iter().flat_map(|trace| trace.pressure_pa.iter().copied()));
        let length_m = range(traces.iter().flat_map(|trace| trace.length_m.iter().copied()));
        let mut coverage = Self { pressure_pa, length_m, visited: vec![false; SIDE * SIDE] };
        for trace in traces {
            for (&pressure_pa, &length_m) in trace.pressure_pa.iter().zip(&trace.length_m) {
                let Some((row, column)) = coverage.cell(pressure_pa, length_m) else { continue };
                let around = |at: usize| at.saturating_sub(MARGIN)..(at + MARGIN + 1).min(SIDE);
                for row in around(row) {
                    coverage.visited[row * SIDE..][around(column)].fill(true);
                }
            }
        }
        coverage
    }

    /// Whether the recordings have been at or next to this pressure and length.
    pub(crate) fn holds(&self, pressure_pa: f64, length_m: f64) -> bool {
        self.cell(pressure_pa, length_m).is_some_and(|(row, column)| self.visited[row * SIDE + column])
    }

    /// The samples of `trace` at which they have been.
    pub(crate) fn within(&self, trace: &Trace) -> Trace {
        let kept: Vec<usize> =
            (0..trace.time_s.len()).filter(|&at| self.holds(trace.pressure_pa[at], trace.length_m[at])).collect();
        trace.only(&kept)
    }

    fn cell(&self, pressure_pa: f64, length_m: f64) -> Option<(usize, usize)> {
        let along = |value: f64, (low, high): (f64, f64)| {
            let cell = (CELLS as f64 * (value - low) / (high - low).max(f64::MIN_POSITIVE)).floor();
            // The highest value belongs to the cell below it.
            let cell = if value == high { cell.min(CELLS as f64 - 1.0) } else { cell } + MARGIN as f64;
            (0.0..SIDE as f64).contains(&cell).then_some(cell as usize)
        };
        Some((along(pressure_pa, self.pressure_pa)?, along(length_m, self.length_m)?))
    }
}

/// Lowest and highest of `values`.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    fn trace(samples: &[(f64, f64)]) -> Trace {
        let (pressure_pa, length_m) = samples.iter().copied().unzip();
        Trace { pressure_pa, length_m, ..Trace::default() }
    }

    #[test]
    fn what_lies_beside_the_path_is_covered_and_the_far_corner_is_not() {
        let path: Vec<(f64, f64)> = (0..=100).map(|at| (f64::from(at) * 1e3, 0.2 + 1e-4 * f64::from(at))).collect();
        let coverage = Coverage::of(&[trace(&path)]);
        assert!(path.iter().all(|&(pressure_pa, length_m)| coverage.holds(pressure_pa, length_m)));
        assert!(coverage.holds(52e3, 0.2045) && coverage.holds(105e3, 0.2105));
        assert!(!coverage.holds(90e3, 0.201) && !coverage.holds(50e3, 0.23) && !coverage.holds(-30e3, 0.2));
    }

    /// Four samples, of which the last does not count.
    pub(crate) fn trace_of(pressure_pa: [f64; 4], missed_n: [f64; 4]) -> Trace {
        Trace {
            time_s: vec![0.0, 0.1, 0.2, 0.3],
            pressure_pa: pressure_pa.to_vec(),
            length_m: vec![0.25, 0.24, 0.23, 0.22],
            force_n: missed_n.map(|missed_n| 100.0 + missed_n).to_vec(),
            model_n: vec![100.0; 4],
            direction: vec![1.0; 4],
            settled: vec![true, true, true, false],
        }
    }

    #[test]
    fn only_samples_where_recordings_have_been_are_kept() {
        let coverage = Coverage::of(&[trace_of([1e5, 1.1e5, 1.2e5, 1.3e5], [0.0; 4])]);
        let all = coverage.within(&trace_of([1e5, 1.1e5, 1.2e5, 1.3e5], [1.0; 4]));
        assert_eq!((all.time_s.len(), all.settled.len()), (4, 4));
        let some = coverage.within(&trace_of([1e5, 9e5, 1.2e5, 9e5], [1.0, 2.0, 3.0, 4.0]));
        assert_eq!(some.time_s, [0.0, 0.2]);
        assert_eq!(some.force_n, [101.0, 103.0]);
        assert_eq!(some.settled, [true, true]);
    }

    #[test]
    fn one_held_length_covers_no_other() {
        let held: Vec<(f64, f64)> = (0..=100).map(|at| (f64::from(at) * 1e3, 0.2)).collect();
        let coverage = Coverage::of(&[trace(&held)]);
        assert!(coverage.holds(50e3, 0.2) && !coverage.holds(50e3, 0.205));
    }
}
