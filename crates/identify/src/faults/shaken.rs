//! Rests in which the muscle is shaken: a hand that holds it trembles at some hertz, by less than the sensor of the length resolves,
//! and friction turns over with every swing.
//!
//! The force then swings by twice the friction while the length rests and the pressure does not swing, and what friction is at any sample nobody knows. Such
//! samples are not counted. A frame that rings after a step dies away sooner, and noise, however large, is in the rest of the
//! recording, too.

use std::io;
use std::ops::Range;

use pam_recording::quality::RecordingQuality;
use pam_recording::{CHUNK_ROWS, Chunk, Recording};

/// Windows that are looked at, in s: two swings of a hand, which trembles at 6 to 12 Hz.
const WINDOW_S: f64 = 0.3;
/// Samples that a window holds at least: fewer show no swings.
const LEAST_IN_WINDOW: usize = 9;
/// Times that a force changes its side of a straight line within a window, at least, to swing.
const LEAST_CROSSINGS: usize = 3;
/// Windows, each half a window after the one before, that are shaken, at least.
const LEAST_WINDOWS: usize = 3;
/// Times what the noise of all channels explains that a force swings by. Only where it is most of what is recorded is a sample
/// worth nothing.
const TIMES_EXPLAINED: f64 = 5.0;
/// How steep the force of a muscle is at most, in units of its largest force over its range of pressure or of length.
const STEEPEST: f64 = 3.0;

/// Residual of a straight line through `values`: its rise over all of them, the standard deviation beside it and how often they
/// cross it.
fn beside_a_line(values: &[f64]) -> (f64, f64, usize) {
    let n = values.len() as f64;
    let middle = 0.5 * (n - 1.0);
    let mean = values.iter().sum::<f64>() / n;
    let (mut along, mut square) = (0.0, 0.0);
    for (at, value) in values.iter().enumerate() {
        let from = at as f64 - middle;
        along += from * (value - mean);
        square += from * from;
    }
    let slope = along / square;
    let residuals = values.iter().enumerate().map(|(at, value)| value - mean - slope * (at as f64 - middle));
    let (mut squares, mut crossings, mut last) = (0.0, 0, 0.0_f64);
    for residual in residuals {
        squares += residual * residual;
        crossings += usize::from(residual * last < 0.0);
        last = residual;
    }
    (slope * (n - 1.0), (squares / (n - 2.0)).sqrt(), crossings)
}

/// Share of a force that a channel explains.
struct Drive {
    /// By how much it may rise within a window, and scatter beside that.
    most: f64,
    /// Newtons that a unit of it explains at most.
    steepness: f64,
}

impl Drive {
    /// The channel `name`, which is to rest: within what its noise and its steps allow.
    fn at_rest(quality: &RecordingQuality, name: &str, range_n: f64) -> Option<Self> {
        let channel = quality.channel(name)?;
        let most = channel.play_threshold().max(channel.quantization_step.unwrap_or(0.0));
        let range = channel.highest - channel.lowest;
        Some(Self { most, steepness: if range > 4.0 * most { STEEPEST * range_n / range } else { 0.0 } })
    }

    /// Share of a force in N that its values explain, where it does not move by more than it may.
    fn explains_n(&self, values: &[f64]) -> Option<f64> {
        let (rise, spread, _) = beside_a_line(values);
        (rise.abs() <= self.most && spread <= self.most).then_some(self.steepness * spread)
    }
}

/// Rows of a recording in which the muscle is shaken while it rests.
///
/// # Errors
/// Where samples cannot be read back.
pub fn rows(recording: &Recording, quality: &RecordingQuality) -> io::Result<Vec<Range<usize>>> {
    Ok(in_a_row(&windows(recording, quality)?, quality))
}

/// Rows of a window; none where the clock is too slow for any.
fn window_rows(quality: &RecordingQuality) -> Option<usize> {
    let n = (WINDOW_S / quality.period_s).round() as usize;
    (n >= LEAST_IN_WINDOW).then_some(n)
}

/// First rows of the windows in a chunk of so many rows, counted from its first.
fn starts(n: usize, chunk_rows: usize) -> impl Iterator<Item = usize> {
    (0..(chunk_rows + 1).saturating_sub(n)).step_by(n / 2)
}

/// First rows of the windows of `recording` in which a muscle is shaken, if enough of them follow one another. The ranges of its
/// channels are those of `quality`.
///
/// # Errors
/// Where samples cannot be read back.
pub fn windows(recording: &Recording, quality: &RecordingQuality) -> io::Result<Vec<usize>> {
    let Some((force, n)) = quality.channel("force").zip(window_rows(quality)) else { return Ok(Vec::new()) };
    let range_n = force.highest.abs().max(force.lowest.abs());
    let drives = ["pressure", "length"].map(|name| Drive::at_rest(quality, name, range_n));
    let [Some(pressure), Some(length)] = drives else { return Ok(Vec::new()) };
    // A pressure may go on rising: a swing of the force that it does not have itself is none of its own.
    let pressure = Drive { most: f64::INFINITY, ..pressure };
    let is_shaken = |chunk: &Chunk, here: Range<usize>| {
        let lasts_s = chunk.time_s()[here.end - 1] - chunk.time_s()[here.start];
        let (_, spread_n, crossings) = beside_a_line(&chunk.force_n()[here.clone()]);
        let explained =
            pressure.explains_n(&chunk.pressure_pa()[here.clone()]).zip(length.explains_n(&chunk.length_m()[here]));
        lasts_s < 2.0 * WINDOW_S
            && crossings >= LEAST_CROSSINGS
            && explained.is_some_and(|(by_pressure_n, by_length_n)| {
                spread_n > TIMES_EXPLAINED * by_pressure_n.hypot(by_length_n).hypot(force.any_noise())
            })
    };
    let mut found = Vec::new();
    for chunk in recording.samples.chunks() {
        let chunk = chunk?;
        let shaken = starts(n, chunk.n_rows()).filter(|&start| is_shaken(&chunk, start..start + n));
        found.extend(shaken.map(|start| chunk.first_row() + start));
    }
    Ok(found)
}

/// Rows of a recording with that `quality` in which its shaken [`windows`] make it one stretch after the other.
pub fn in_a_row(windows: &[usize], quality: &RecordingQuality) -> Vec<Range<usize>> {
    let (Some(n), n_rows) = (window_rows(quality), quality.n_rows) else { return Vec::new() };
    // The window after the last one of a chunk is the first one of the next chunk that has any.
    let next = |start: usize| {
        let first = start / CHUNK_ROWS * CHUNK_ROWS;
        let chunk_rows = CHUNK_ROWS.min(n_rows - first);
        let after = start + n / 2;
        if after - first + n <= chunk_rows { after } else { first + CHUNK_ROWS }
    };
    let mut found: Vec<Range<usize>> = Vec::new();
    let mut together_now: Vec<Range<usize>> = Vec::new();
    for &start in windows {
        if together_now.last().is_some_and(|last| next(last.start) != start) {
            found.extend(together(&together_now));
            together_now.clear();
        }
        together_now.push(start..start + n);
    }
    found.extend(together(&together_now));
    // A shake begins and ends within a window.
    found.into_iter().map(|rows| rows.start.saturating_sub(n / 2)..(rows.end + n / 2).min(n_rows)).collect()
}

/// Windows one after the other as one stretch, where they are enough.
fn together(windows: &[Range<usize>]) -> Option<Range<usize>> {
    (windows.len() >= LEAST_WINDOWS).then(|| windows[0].start..windows[windows.len() - 1].end)
}

/// Message about a recording that is shaken; nothing of one that is not.
///
/// # Errors
/// Where samples cannot be read back.
pub fn warning(recording: &Recording, quality: &RecordingQuality) -> io::Result<Option<String>> {
    let shaken = rows(recording, quality)?;
    let lasts_s = shaken.iter().map(Range::len).sum::<usize>() as f64 * quality.period_s;
    Ok((!shaken.is_empty()).then(|| {
        format!(
            "{}: the force swings for {lasts_s:.1} s while the length rests, as where a hand holds the muscle; these samples are \
             not counted, as nobody knows which way friction acts in them; clamp it",
            recording.path
        )
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    use pam_recording::Samples;

    use crate::testing::recording;

    /// A ramp and a rest in turn, at 200 Hz, with noise of 0.2 N; within the second rest, from 10.5 to 14.5 s, the force has `swing_n` more.
    fn shaken(swing_n: impl Fn(f64) -> f64) -> Vec<Range<usize>> {
        let time_s: Vec<f64> = (0..5000).map(|row| 0.005 * f64::from(row)).collect();
        let noise = |row: usize| ((row * 7919 % 1013) as f64 / 506.0 - 1.0) * 0.35;
        let path = |t: f64| {
            0.25 + 0.01 * ((t / 5.0).floor() / 2.0).floor()
                + if (t / 5.0) as u32 % 2 == 1 { 0.002 * (t % 5.0) } else { 0.0 }
        };
        let length_m: Vec<f64> = time_s.iter().enumerate().map(|(row, &t)| path(t) + 1e-5 * noise(row + 500)).collect();
        let pressure_pa: Vec<f64> = (0..5000).map(|row| 3e5 + 300.0 * noise(row + 77)).collect();
        let force = |(row, &t): (usize, &f64)| {
            let swing_n = if (10.5..14.5).contains(&t) { swing_n(t - 10.5) } else { 0.0 };
            200.0 + 5e3 * (path(t) - 0.25) + noise(row) + swing_n
        };
        let force_n: Vec<f64> = time_s.iter().enumerate().map(force).collect();
        let samples = Samples::from_columns(&time_s, &pressure_pa, &length_m, &force_n);
        let recording = recording("shaken.csv", samples);
        let quality = RecordingQuality::of(&recording).expect("a quality");
        rows(&recording, &quality).expect("rows")
    }

    #[test]
    fn a_force_that_swings_at_rest_is_found_where_it_swings() {
        assert!(shaken(|_| 0.0).is_empty());
        let found = shaken(|t| 8.0 * (TAU * 8.0 * t).sin().signum());
        assert_eq!(found.len(), 1, "{found:?}");
        let (start_s, end_s) = (0.005 * found[0].start as f64, 0.005 * found[0].end as f64);
        assert!((9.8..=10.55).contains(&start_s) && (14.45..15.2).contains(&end_s), "{start_s} {end_s}");
    }

    #[test]
    fn a_ringing_that_dies_away_and_a_relaxation_are_none() {
        assert!(shaken(|t| 10.0 * (TAU * 12.0 * t).sin() * (-t / 0.12).exp()).is_empty());
        assert!(shaken(|t| 10.0 * (-t / 0.5).exp()).is_empty());
    }
}
