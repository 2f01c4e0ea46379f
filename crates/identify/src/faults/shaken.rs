//! Rests in which the muscle is shaken: a hand that holds it trembles at 6 to 13 Hz, by less than the sensor of the length resolves,
//! and friction turns over with every swing.
//!
//! The force then swings at one frequency, by up to twice the friction, while the length rests and the pressure does not swing, and
//! what friction is at any sample nobody knows. Such samples are not counted. A frame that rings after a step dies away sooner, a pump
//! beats more slowly, and noise, however large, has every frequency.

use std::f64::consts::TAU;
use std::io;
use std::ops::{Range, RangeInclusive};

use pam_recording::quality::RecordingQuality;
use pam_recording::{CHUNK_ROWS, Chunk, Recording};

/// Windows that are looked at, in s: two swings of a hand at least.
const WINDOW_S: f64 = 0.3;
/// Samples that a window holds at least: fewer show no swings.
const LEAST_IN_WINDOW: usize = 9;
/// Frequencies at which hands tremble, in Hz: 8 to 12, physiologically, and what so short a window takes for them. The lower end was chosen
/// with pumps of 4 and 5 Hz in sight.
const HANDS_HZ: RangeInclusive<u32> = 6..=13;
/// Frequencies that are looked at, in Hz: a pump that beats more slowly is the muscle's own.
const FREQUENCIES_HZ: RangeInclusive<u32> = 3..=16;
/// The same as a share of the sampling rate, at most: four samples make a swing.
const PER_SAMPLE: f64 = 0.25;
/// Share of what the force has beside a straight line that one frequency must explain: a swing has one, noise has all. Of 32 recordings that
/// were held by a hand 26 are found, and 1 of 510 others; with 0.5, 26 and 3, with 0.85, 18 and none.
const OF_ONE_FREQUENCY: f64 = 0.7;
/// Windows, each half a window after the one before, that are shaken, at least.
const LEAST_WINDOWS: usize = 2;
/// Times its noise, and what the other channels explain, that a force swings by. With half of it 27 and 4 of those are found, with twice
/// of it 20 and none.
const TIMES_EXPLAINED: f64 = 2.0;
/// Squared deviations of noise that the swing nearest to it has once in a thousand windows: `χ²` of two degrees of freedom.
const SURELY: f64 = 13.8;
/// How steep the force of a muscle is at most, in units of its largest force over its range of pressure or of length.
const STEEPEST: f64 = 3.0;

/// What is left of `values` beside a straight line, and the rise of that over all of them.
fn beside_a_line(values: &[f64]) -> (f64, Vec<f64>) {
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
    let left = values.iter().enumerate().map(|(at, value)| value - mean - slope * (at as f64 - middle)).collect();
    (slope * (n - 1.0), left)
}

/// Standard deviation of what is `left` beside a straight line.
fn spread(left: &[f64]) -> f64 {
    (left.iter().map(|value| value * value).sum::<f64>() / (left.len() as f64 - 2.0)).sqrt()
}

/// Root mean square of the swing in `values` that is nearest to them, of so many radians per value.
fn swing(values: &[f64], radians: f64) -> f64 {
    let (step_sin, step_cos) = libm::sincos(radians);
    let (mut sin, mut cos) = (0.0, 1.0);
    let (mut cos_cos, mut cos_sin, mut sin_sin, mut cos_value, mut sin_value) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for value in values {
        cos_cos += cos * cos;
        cos_sin += cos * sin;
        sin_sin += sin * sin;
        cos_value += cos * value;
        sin_value += sin * value;
        (sin, cos) = (sin * step_cos + cos * step_sin, cos * step_cos - sin * step_sin);
    }
    let determinant = cos_cos * sin_sin - cos_sin * cos_sin;
    let explained = (sin_sin * cos_value * cos_value - 2.0 * cos_sin * cos_value * sin_value
        + cos_cos * sin_value * sin_value)
        / determinant;
    (explained.max(0.0) / values.len() as f64).sqrt()
}

/// What a channel explains of a force.
struct Drive {
    /// By how much it may rise within a window, and scatter beside that, to rest: what its noise and its steps allow.
    most: f64,
    /// Newtons that a unit of it explains at most.
    steepness: f64,
    /// Its noise.
    noise: f64,
}

impl Drive {
    fn of(quality: &RecordingQuality, name: &str, range_n: f64) -> Option<Self> {
        let channel = quality.channel(name)?;
        let most = channel.play_threshold().max(channel.quantization_step.unwrap_or(0.0));
        let range = channel.highest - channel.lowest;
        let steepness = if range > 4.0 * most { STEEPEST * range_n / range } else { 0.0 };
        Some(Self { most, steepness, noise: channel.any_noise() })
    }

    /// What its values have beside a straight line, where they rest.
    fn at_rest(&self, values: &[f64]) -> Option<Vec<f64>> {
        let (rise, left) = beside_a_line(values);
        (rise.abs() <= self.most && spread(&left) <= self.most).then_some(left)
    }

    /// Whether a swing of this size is surely more than its noise has at one frequency, in so many values.
    fn swings(&self, size: f64, n: usize) -> bool {
        size * size * n as f64 > SURELY * self.noise * self.noise
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
    let drives = ["pressure", "length"].map(|name| Drive::of(quality, name, range_n));
    let [Some(pressure), Some(length)] = drives else { return Ok(Vec::new()) };
    let noise_n = force.any_noise();
    let is_shaken = |chunk: &Chunk, here: Range<usize>| {
        let Some(left_m) = length.at_rest(&chunk.length_m()[here.clone()]) else { return false };
        let lasts_s = chunk.time_s()[here.end - 1] - chunk.time_s()[here.start];
        let (_, left_n) = beside_a_line(&chunk.force_n()[here.clone()]);
        let spread_n = spread(&left_n);
        if lasts_s > 2.0 * WINDOW_S || spread_n < TIMES_EXPLAINED * noise_n {
            return false;
        }
        let radians = |hz: u32| TAU * f64::from(hz) * quality.period_s;
        let swings = FREQUENCIES_HZ.filter(|&hz| radians(hz) <= TAU * PER_SAMPLE);
        let sized = swings.map(|hz| (swing(&left_n, radians(hz)), hz));
        let Some((size_n, hz)) = sized.max_by(|one, other| one.0.total_cmp(&other.0)) else { return false };
        if !HANDS_HZ.contains(&hz) || size_n * size_n < OF_ONE_FREQUENCY * spread_n * spread_n {
            return false;
        }
        // A pressure may go on rising: a swing of the force that it does not have itself is none of its own.
        let (_, left_pa) = beside_a_line(&chunk.pressure_pa()[here.clone()]);
        let (size_pa, size_m) = (swing(&left_pa, radians(hz)), swing(&left_m, radians(hz)));
        let explained_n = (pressure.steepness * size_pa).hypot(length.steepness * size_m);
        !pressure.swings(size_pa, here.len()) && size_n > TIMES_EXPLAINED * explained_n.hypot(noise_n)
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
            "{}: the force swings for {lasts_s:.1} s while the length rests, as where a hand holds the muscle or a pump beats; these \
             samples are not counted, as nobody knows which way friction acts in them; clamp it",
            recording.path
        )
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    use pam_recording::Samples;

    use crate::testing::recording;

    /// A ramp and a rest in turn, at 200 Hz, with noise of 0.2 N; within the second rest, from 10.5 to 14.5 s, the force has `swing_n` more.
    fn shaken(swing_n: impl Fn(f64) -> f64) -> Vec<Range<usize>> {
        shaken_by(swing_n, |_| 0.0)
    }

    /// The same with so much more pressure over the same time, in Pa.
    fn shaken_by(swing_n: impl Fn(f64) -> f64, swing_pa: impl Fn(f64) -> f64) -> Vec<Range<usize>> {
        let within = |t: f64| (10.5..14.5).contains(&t);
        let time_s: Vec<f64> = (0..5000).map(|row| 0.005 * f64::from(row)).collect();
        let noise = |row: usize| ((row * 7919 % 1013) as f64 / 506.0 - 1.0) * 0.35;
        let path = |t: f64| {
            0.25 + 0.01 * ((t / 5.0).floor() / 2.0).floor()
                + if (t / 5.0) as u32 % 2 == 1 { 0.002 * (t % 5.0) } else { 0.0 }
        };
        let length_m: Vec<f64> = time_s.iter().enumerate().map(|(row, &t)| path(t) + 1e-5 * noise(row + 500)).collect();
        let pushed_pa = |t: f64| if within(t) { swing_pa(t - 10.5) } else { 0.0 };
        let pressure_pa: Vec<f64> =
            time_s.iter().enumerate().map(|(row, &t)| 3e5 + 300.0 * noise(row + 77) + pushed_pa(t)).collect();
        let force = |(row, &t): (usize, &f64)| {
            let swing_n = if within(t) { swing_n(t - 10.5) } else { 0.0 };
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
    fn a_swing_of_a_few_times_the_noise_is_found_and_one_within_it_is_not() {
        let swing = |size_n: f64| shaken(|t| size_n * (TAU * 9.0 * t).sin());
        assert_eq!(swing(1.2).len(), 1);
        assert!(swing(0.3).is_empty());
    }

    #[test]
    fn a_pump_that_beats_more_slowly_and_a_pressure_that_swings_itself_are_none() {
        assert!(shaken(|t| 8.0 * (TAU * 4.0 * t).sin()).is_empty());
        let swing = |t: f64| (TAU * 9.0 * t).sin();
        assert_eq!(shaken_by(|t| 8.0 * swing(t), |_| 0.0).len(), 1);
        assert!(shaken_by(|t| 8.0 * swing(t), |t| 500.0 * swing(t)).is_empty());
    }

    #[test]
    fn a_ringing_that_dies_away_and_a_relaxation_are_none() {
        assert!(shaken(|t| 10.0 * (TAU * 12.0 * t).sin() * (-t / 0.12).exp()).is_empty());
        assert!(shaken(|t| 10.0 * (-t / 0.5).exp()).is_empty());
    }
}
