//! The lines of one recording: at which frequencies the residual swings by far more than at those beside, and at which a drive does.

use nalgebra::DMatrix;
use pam_identification::trace::Trace;
use std::f64::consts::TAU;
use std::ops::RangeInclusive;

/// Length of the windows that are averaged, in s: they tell frequencies apart by its inverse, and hold a pump that runs for some strokes.
const WINDOW_S: f64 = 10.0;
/// Time that values are averaged over before, in s, where a recording is not slower: of an amplitude at 15 Hz that takes a seventh.
const BIN_S: f64 = 0.02;
/// Share of the bins of a window that may be without a sample.
const EMPTY: f64 = 0.1;
/// Lowest and highest frequency of a line of the residual, in inverses of [`WINDOW_S`]: 1 and 15 Hz. What is slower drifts, and what is faster is averaged
/// away, or noise.
const LINES: (usize, usize) = (10, 150);
/// Frequencies to either side that a line is compared with, and how many next to it are its own flanks.
const BESIDE: usize = 8;
/// See [`BESIDE`].
const FLANK: usize = 2;
/// Times the mean square beside it from which on the residual has a line: noise passes it by chance once in some thousand frequencies of a
/// recording, and seldom in a third of the recordings at the same.
const LINE: f64 = 12.0;
/// The same of a drive.
const DRIVE: f64 = 6.0;
/// Lowest frequency of a line of a drive, in inverses of [`WINDOW_S`]; the multiples of what is slower lie so close that none of them stands out.
const SLOWEST: usize = 4;
/// By how much a frequency of a drive is off at most, in Hz; the frequency of a multiple is, so many times.
const OFF_HZ: f64 = 0.01;
/// Share of the rate of the bins up to which a frequency is seen.
const SEEN: f64 = 0.4;

/// Spectrum of one recording.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spectrum {
    /// Amplitude of the residual at every frequency that is compared, in N, averaged over the recording; up to a seventh too little halfway
    /// between two of them.
    amplitude_n: Vec<f64>,
    /// Mean square of the residual there over the median of those beside.
    residual: Vec<f64>,
    /// The larger of pressure's and length's.
    drives: Vec<f64>,
    /// Frequencies of the lines of pressure and length, in Hz: a friction that turns over with them has lines at their multiples.
    drives_hz: Vec<f64>,
}

impl Spectrum {
    /// Of the recording of `trace`; none where it is shorter than a window.
    pub(super) fn of(trace: &Trace) -> Option<Self> {
        let n = trace.time_s.len();
        let period_s = (trace.time_s.last()? - trace.time_s[0]) / (n.max(2) - 1) as f64;
        let bin_s = BIN_S.max(period_s);
        let n_bins = (WINDOW_S / bin_s) as usize;
        let highest = (SEEN * n_bins as f64) as usize;
        if highest < LINES.1 + BESIDE {
            return None;
        }
        let residual_n: Vec<f64> =
            trace.force_n.iter().zip(&trace.model_n).map(|(force, model)| force - model).collect();
        let waves = waves(n_bins);
        let squares = |values: &[f64]| -> Option<Vec<f64>> {
            let windows = windows(&trace.time_s, values, bin_s, n_bins);
            (windows.ncols() > 0).then(|| squares(&waves, &windows))
        };
        let residual = squares(&residual_n)?;
        let (pressure, length) = (squares(&trace.pressure_pa)?, squares(&trace.length_m)?);
        let [over, over_pressure, over_length] = [&residual, &pressure, &length].map(|squares| beside(squares));
        let mut drives_hz = lines_hz(&pressure, &over_pressure);
        drives_hz.extend(lines_hz(&length, &over_length));
        Some(Self {
            amplitude_n: residual.iter().map(|square| square.sqrt()).collect(),
            residual: over,
            drives: over_pressure.iter().zip(&over_length).map(|(one, other)| one.max(*other)).collect(),
            drives_hz,
        })
    }

    /// Frequencies at which the residual may have a line, in inverses of [`WINDOW_S`].
    pub(super) fn frequencies() -> RangeInclusive<usize> {
        LINES.0..=LINES.1
    }

    /// Amplitude of the residual in N at the frequency `k`, where it swings there by far more than it does beside, and no drive does,
    /// neither there nor at a frequency of which it is a multiple.
    pub(super) fn line_n(&self, k: usize) -> Option<f64> {
        let at = k - 1;
        let is_multiple = |drive_hz: &f64| {
            let times = (hz(k) / drive_hz).round();
            (hz(k) - times * drive_hz).abs() <= hz(1) + OFF_HZ * times
        };
        let is_top = is_top(&self.amplitude_n, at);
        let is_line = is_top && self.residual[at] > LINE && self.drives[at] < DRIVE;
        (is_line && !self.drives_hz.iter().any(is_multiple)).then(|| self.amplitude_n[at])
    }
}

/// A frequency, in Hz.
pub(super) fn hz(k: usize) -> f64 {
    k as f64 / WINDOW_S
}

/// Frequencies up to the highest that a line is compared with, in inverses of [`WINDOW_S`].
fn compared() -> RangeInclusive<usize> {
    1..=LINES.1 + BESIDE
}

/// Whether neither of the values next to that `at` is larger.
fn is_top(values: &[f64], at: usize) -> bool {
    values[at] >= values[at - 1] && values[at] >= values[at + 1]
}

/// Frequencies of the lines of a drive, in Hz, from the amplitudes next to the largest: for this taper those of a line between two of them,
/// at a share d of the step from the larger, are as 1 + d to 2 - d.
fn lines_hz(squares: &[f64], over: &[f64]) -> Vec<f64> {
    let is_line = |&at: &usize| over[at] > DRIVE && is_top(squares, at);
    let between = |at: usize| {
        let [below, own, above] = [at - 1, at, at + 1].map(|at| squares[at].sqrt());
        let share = |next: f64| ((2.0 * next - own) / (next + own)).clamp(0.0, 0.5);
        hz(at + 1) + hz(1) * if above >= below { share(above) } else { -share(below) }
    };
    (SLOWEST - 1..squares.len() - 1).filter(is_line).map(between).collect()
}

/// Cosines, and sines below, of every frequency in windows of `n_bins`, tapered so that a line has narrow flanks and an amplitude of one
/// gives one.
fn waves(n_bins: usize) -> DMatrix<f64> {
    let n = n_bins as f64;
    let taper = |bin: usize| 0.5 - 0.5 * (TAU * (bin as f64 + 0.5) / n).cos();
    let whole: f64 = (0..n_bins).map(taper).sum();
    let n_hz = compared().count();
    DMatrix::from_fn(2 * n_hz, n_bins, |row, bin| {
        let turn = TAU * (compared().start() + row % n_hz) as f64 * bin as f64 / n;
        2.0 * taper(bin) / whole * if row < n_hz { turn.cos() } else { turn.sin() }
    })
}

/// `values` at `time_s`, averaged over bins of `bin_s`, in windows of `n_bins` that overlap by half, a column each, less the line through
/// them; windows with gaps are left out.
fn windows(time_s: &[f64], values: &[f64], bin_s: f64, n_bins: usize) -> DMatrix<f64> {
    let bin = |time_s_here: &f64| ((time_s_here - time_s[0]) / bin_s).round() as usize;
    let n_all = time_s.last().map_or(0, |last_s| bin(last_s) + 1);
    let mut sums = vec![(0.0, 0_usize); n_all];
    for (at_s, value) in time_s.iter().zip(values) {
        let (sum, count) = &mut sums[bin(at_s).min(n_all - 1)];
        (*sum, *count) = (*sum + value, *count + 1);
    }
    let mut last = values.first().copied().unwrap_or(0.0);
    let means: Vec<f64> = sums
        .iter()
        .map(|&(sum, count)| {
            if count > 0 {
                last = sum / count as f64;
            }
            last
        })
        .collect();
    let starts = (0..(n_all + 1).saturating_sub(n_bins)).step_by(n_bins / 2);
    let is_whole = |&start: &usize| {
        let empty = sums[start..start + n_bins].iter().filter(|(_, count)| *count == 0).count();
        empty as f64 <= EMPTY * n_bins as f64
    };
    let columns: Vec<Vec<f64>> =
        starts.filter(is_whole).map(|start| less_line(&means[start..start + n_bins])).collect();
    DMatrix::from_fn(n_bins, columns.len(), |bin, window| columns[window][bin])
}

/// `values` less the straight line that is nearest to them.
fn less_line(values: &[f64]) -> Vec<f64> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let from_middle = |at: usize| at as f64 - 0.5 * (n - 1.0);
    let along: f64 = values.iter().enumerate().map(|(at, value)| from_middle(at) * value).sum();
    let slope = along / (n * (n * n - 1.0) / 12.0);
    values.iter().enumerate().map(|(at, value)| value - mean - slope * from_middle(at)).collect()
}

/// Squares of the amplitudes at every frequency that is compared, averaged over `windows`.
fn squares(waves: &DMatrix<f64>, windows: &DMatrix<f64>) -> Vec<f64> {
    let parts = waves * windows;
    let n_hz = compared().count();
    let square = |row: usize| parts.row(row).norm_squared() + parts.row(row + n_hz).norm_squared();
    (0..n_hz).map(|row| square(row) / windows.ncols() as f64).collect()
}

/// Every square that is compared over the median of those beside its flanks.
fn beside(squares: &[f64]) -> Vec<f64> {
    let ratio = |at: usize| {
        let near = at.saturating_sub(BESIDE)..(at + BESIDE + 1).min(squares.len());
        let mut others: Vec<f64> =
            near.filter(|other| other.abs_diff(at) > FLANK).map(|other| squares[other]).collect();
        let middle = others.len() / 2;
        let median = *others.select_nth_unstable_by(middle, f64::total_cmp).1;
        squares[at] / median.max(f64::MIN_POSITIVE)
    };
    (0..squares.len()).map(ratio).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::periodic::tests::{PERIOD_S, swinging};

    /// Frequencies of the lines of the residual, in Hz.
    fn lines(spectrum: &Spectrum) -> Vec<f64> {
        Spectrum::frequencies().filter(|&k| spectrum.line_n(k).is_some()).map(hz).collect()
    }

    #[test]
    fn a_sine_has_its_amplitude_at_its_frequency_and_no_line_elsewhere() {
        let spectrum = Spectrum::of(&swinging(30.0, 3.5, 2.0, 0.0)).expect("a spectrum");
        let amplitude_n = spectrum.line_n(35).expect("a line");
        assert!((amplitude_n - 2.0).abs() < 0.1, "{amplitude_n}");
        assert!(lines(&spectrum).iter().all(|line_hz| (line_hz - 3.5).abs() < 0.11), "{:?}", lines(&spectrum));
    }

    #[test]
    fn what_the_pressure_does_as_well_is_no_line_of_the_residual() {
        let spectrum = Spectrum::of(&swinging(30.0, 3.5, 2.0, 1e3)).expect("a spectrum");
        assert_eq!(lines(&spectrum), Vec::<f64>::new());
    }

    #[test]
    fn friction_that_turns_over_with_a_drive_has_lines_at_its_multiples_that_are_none() {
        for drive_hz in [0.2, 0.3, 0.38, 0.45, 0.55, 0.7, 1.03, 1.37, 2.0] {
            let mut trace = swinging(30.0, 9.0, 0.0, 0.0);
            let turn = |time_s: f64| TAU * drive_hz * time_s;
            for at in 0..trace.time_s.len() {
                trace.length_m[at] += 5e-3 * turn(trace.time_s[at]).sin();
                trace.force_n[at] +=
                    4.0 * turn(trace.time_s[at]).cos().signum() + 2.0 * turn(trace.time_s[at]).sin().powi(2);
            }
            let spectrum = Spectrum::of(&trace).expect("a spectrum");
            assert_eq!(lines(&spectrum), Vec::<f64>::new(), "{drive_hz} Hz");
            let found_hz = &spectrum.drives_hz;
            let is_found = found_hz.iter().any(|found_hz| (found_hz - drive_hz).abs() < OFF_HZ);
            assert!(is_found || drive_hz < hz(SLOWEST), "{drive_hz}: {found_hz:?}");
        }
    }

    #[test]
    fn a_recording_that_is_too_short_too_slow_or_full_of_gaps_has_none() {
        assert_eq!(Spectrum::of(&swinging(9.0, 3.5, 2.0, 0.0)), None);
        assert_eq!(Spectrum::of(&Trace::default()), None);
        let trace = swinging(30.0, 3.5, 2.0, 0.0);
        let every = |stride: usize, keeps: &dyn Fn(f64) -> bool| {
            let rows = (0..trace.time_s.len()).step_by(stride);
            trace.only(&rows.filter(|&row| keeps(trace.time_s[row])).collect::<Vec<usize>>())
        };
        assert!(Spectrum::of(&every(1, &|_| true)).is_some());
        assert_eq!(Spectrum::of(&every((0.1 / PERIOD_S) as usize, &|_| true)), None, "at 10 Hz");
        assert_eq!(Spectrum::of(&every(1, &|time_s| time_s % 5.0 < 4.0)), None, "a second of five is missing");
    }

    #[test]
    fn a_line_through_the_values_is_taken_off() {
        let left = less_line(&[1.0, 3.0, 5.0, 7.0]);
        assert!(left.iter().all(|value| value.abs() < 1e-12), "{left:?}");
    }
}
