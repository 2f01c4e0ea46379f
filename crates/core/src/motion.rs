//! How a recording moves: its channels smooth, with their rates, as effects see them.
//!
//! Rates of noisy channels come from a parabola fitted to a centered window of [`HALF_WINDOW_S`] to either side
//! (Savitzky and Golay, 1964): value, slope and curvature in one go, the same window for every channel, so that smoothing
//! shifts none against the other.

use std::io;

use crate::direction::{Direction, Thresholds};
use crate::effects::Moment;
use crate::effects::moment::SLIDE_M_PER_PA;
use crate::recording::Recording;

/// Half of the window of the parabola that rates come from, in s; at least four samples and at most fifty to either side.
pub const HALF_WINDOW_S: f64 = 0.04;
/// The same for the values themselves, which need less smoothing than their rates, and for the acceleration, which lasts
/// no longer where a rig starts or stops.
pub const HALF_VALUE_WINDOW_S: f64 = 0.02;

/// One row of a recording with everything that effects need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// Row of the recording.
    pub row: usize,
    /// What effects see.
    pub moment: Moment,
    /// Force, in N; as recorded or smooth like the other channels.
    pub force_n: f64,
    /// Whether the direction is certain, all through the window where channels are smooth.
    pub settled: bool,
}

/// Which values of the channels an instant carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channels {
    /// As recorded.
    Recorded,
    /// Smooth.
    Smooth,
}

/// Walks over every `stride`-th row of `recording`, in order, a segment at a time. `index` is the number of the recording,
/// `rest_length_m` that of the muscle.
///
/// # Errors
/// Where the samples cannot be read back.
#[expect(clippy::too_many_arguments, reason = "what to walk over and how; every caller names them all")]
pub fn walk(
    recording: &Recording,
    direction: &Direction,
    thresholds: Thresholds,
    rest_length_m: f64,
    index: usize,
    stride: usize,
    channels: Channels,
    visit: &mut dyn FnMut(Instant),
) -> io::Result<()> {
    let mut first_s = None;
    for segment in &recording.segments {
        let rows = Rows::read(recording, segment.clone())?;
        let Some(&begin_s) = rows.time_s.first() else { continue };
        let origin_s = *first_s.get_or_insert(begin_s);
        let window = Window::over(&rows.time_s, HALF_WINDOW_S);
        let near = Window::over(&rows.time_s, HALF_VALUE_WINDOW_S);
        let average = Average::over(&rows.time_s);
        let still = Still::of(&rows, &window, thresholds.length_m);
        let mut last: Option<(f64, f64)> = None;
        let noise = average.share_of_noise() * NOISE_PER_THRESHOLD;
        let mut contraction = Onward::new(noise * thresholds.length_m);
        let mut slide = Onward::new(noise * (thresholds.length_m + SLIDE_M_PER_PA * thresholds.pressure_pa));
        let mut by_pressure_m = 0.0;
        let mut at = 0;
        while at < rows.time_s.len() {
            let [pressure, length, force] = [&rows.pressure_pa, &rows.length_m, &rows.force_n].map(|channel| {
                let Parabola { value, curvature, .. } = near.parabola(channel, at);
                Parabola { value, curvature, ..window.parabola(channel, at) }
            });
            let row = segment.start + at;
            let average_pa = average.at(&rows.pressure_pa, at);
            let (step_s, pressure_step_pa) =
                last.map_or((0.0, 0.0), |(time_s, pressure_pa)| (rows.time_s[at] - time_s, average_pa - pressure_pa));
            let resting = still.at(at);
            if resting {
                by_pressure_m += SLIDE_M_PER_PA * pressure_step_pa;
            }
            last = Some((rows.time_s[at], average_pa));
            let contraction_m = contraction.follow(rest_length_m - average.at(&rows.length_m, at));
            let slide_m = slide.follow(rest_length_m - average.at(&rows.length_m, at) + by_pressure_m);
            let smooth = channels == Channels::Smooth;
            let choose = |smooth_value: f64, recorded: f64| if smooth { smooth_value } else { recorded };
            let force_n = choose(force.value, rows.force_n.get(at).copied().unwrap_or(0.0));
            visit(Instant {
                row,
                moment: Moment {
                    recording: index,
                    time_s: rows.time_s[at] - origin_s,
                    step_s,
                    pressure_pa: choose(pressure.value, rows.pressure_pa[at]),
                    pressure_rate_pa_per_s: pressure.slope,
                    length_m: choose(length.value, rows.length_m[at]),
                    contraction_ratio: contraction_m / rest_length_m,
                    speed_m_per_s: -length.slope,
                    slide_speed_m_per_s: if resting { SLIDE_M_PER_PA * pressure.slope } else { -length.slope },
                    acceleration_m_per_s2: -length.curvature,
                    direction: direction.sign(row),
                    came: false,
                    slide_m,
                    force_n: force.value,
                },
                force_n,
                settled: if smooth {
                    let (from, to) = (at.saturating_sub(near.half), (at + near.half).min(rows.time_s.len() - 1));
                    direction.is_settled(segment.start + from)
                        && direction.is_settled(row)
                        && direction.is_settled(segment.start + to)
                } else {
                    direction.is_settled(row)
                },
            });
            at += stride;
        }
    }
    Ok(())
}

/// Columns of one segment.
struct Rows {
    time_s: Vec<f64>,
    pressure_pa: Vec<f64>,
    length_m: Vec<f64>,
    /// Empty where none was recorded.
    force_n: Vec<f64>,
}

impl Rows {
    fn read(recording: &Recording, segment: std::ops::Range<usize>) -> io::Result<Self> {
        let mut rows = Self { time_s: Vec::new(), pressure_pa: Vec::new(), length_m: Vec::new(), force_n: Vec::new() };
        for index in 0..recording.samples.n_chunks() {
            let here = recording.samples.chunk_rows(index);
            let (from, to) = (segment.start.max(here.start), segment.end.min(here.end));
            if from >= to {
                continue;
            }
            let chunk = recording.samples.chunk(index)?;
            let range = from - here.start..to - here.start;
            rows.time_s.extend_from_slice(&chunk.time_s()[range.clone()]);
            rows.pressure_pa.extend_from_slice(&chunk.pressure_pa()[range.clone()]);
            rows.length_m.extend_from_slice(&chunk.length_m()[range.clone()]);
            if recording.samples.has_force() {
                rows.force_n.extend_from_slice(&chunk.force_n()[range]);
            }
        }
        Ok(rows)
    }
}

/// Weights with which the acceleration of an [`Instant`] averages the true one over the rows around, at a period of
/// `period_s`: a force that is to be compared with it has to be averaged alike. They are symmetric and sum to one.
///
/// The curvature of a parabola is a weighted sum of values; summing those weights up twice gives the weights of second
/// differences.
pub fn acceleration_weights(period_s: f64) -> Vec<f64> {
    let half = half_rows(HALF_VALUE_WINDOW_S, period_s) as i32;
    let rows = -half..=half;
    let mean = rows.clone().map(|u| f64::from(u * u)).sum::<f64>() / f64::from(2 * half + 1);
    let (mut slope, mut weight) = (0.0, 0.0);
    // The first and the last would be zero: a straight line has no curvature.
    let weights: Vec<f64> = rows
        .map(|u| {
            weight += slope;
            slope += f64::from(u * u) - mean;
            weight
        })
        .skip(1)
        .take(2 * half as usize - 1)
        .collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

/// Rows to either side that a slope comes from at least.
const LEAST_HALF: usize = 2;

/// Half of a window of `half_s` to either side, in rows.
fn half_rows(half_s: f64, period_s: f64) -> usize {
    ((half_s / period_s).round() as usize).clamp(4, 50)
}

/// A channel around one row.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Parabola {
    value: f64,
    /// Per second.
    slope: f64,
    /// Second derivative, per second squared.
    curvature: f64,
}

/// An average with positive weights, for what remembers its path: a parabola overshoots behind a step, which would be a
/// reversal that never was.
struct Average {
    weights: Vec<f64>,
}

impl Average {
    fn over(time_s: &[f64]) -> Self {
        Self { weights: acceleration_weights(period_s(time_s)) }
    }

    fn at(&self, channel: &[f64], at: usize) -> f64 {
        let half = self.weights.len() / 2;
        let origin = channel[at];
        let sum: f64 = self
            .weights
            .iter()
            .enumerate()
            .map(|(index, weight)| {
                weight * (channel[(at + index).max(half).min(half + channel.len() - 1) - half] - origin)
            })
            .sum();
        origin + sum
    }

    /// Deviation of an average over that of the white noise of its rows.
    fn share_of_noise(&self) -> f64 {
        self.weights.iter().map(|weight| weight * weight).sum::<f64>().sqrt()
    }
}

/// Six deviations of the noise, from peak to peak, over a threshold of the direction, which is five.
const NOISE_PER_THRESHOLD: f64 = 1.2;

/// What follows a channel but does not turn back for its noise: to what remembers its path, noise at rest would be a way to
/// and fro. It has no lag while it goes on one way.
struct Onward {
    /// A way back that is none.
    noise: f64,
    position: f64,
    /// ±1; 0 before the first move.
    way: f64,
}

impl Onward {
    fn new(noise: f64) -> Self {
        Self { noise, position: f64::NAN, way: 0.0 }
    }

    fn follow(&mut self, to: f64) -> f64 {
        let by = to - self.position;
        if by.is_nan() {
            self.position = to;
        } else if by * self.way > 0.0 || by.abs() > self.noise {
            self.position = to;
            self.way = by.signum();
        }
        self.position
    }
}

/// Time between evenly sampled rows, in s.
fn period_s(time_s: &[f64]) -> f64 {
    let n_rows = time_s.len();
    if n_rows > 1 { (time_s[n_rows - 1] - time_s[0]) / (n_rows - 1) as f64 } else { 1.0 }
}

/// The window of the parabola over evenly sampled rows.
struct Window {
    half: usize,
    period_s: f64,
    n_rows: usize,
    /// `Σ u²` and the determinant terms of the normal equations over `u = -half..=half`.
    sum2: f64,
    sum4: f64,
}

impl Window {
    fn over(time_s: &[f64], half_s: f64) -> Self {
        let n_rows = time_s.len();
        let period_s = period_s(time_s);
        let half = half_rows(half_s, period_s);
        let h = half as f64;
        let sum2 = h * (h + 1.0) * (2.0 * h + 1.0) / 3.0;
        let sum4 = sum2 * (3.0 * h * h + 3.0 * h - 1.0) / 5.0;
        Self { half, period_s, n_rows, sum2, sum4 }
    }

    /// The parabola at row `at`; near the ends that of the nearest whole window, carried on.
    fn parabola(&self, channel: &[f64], at: usize) -> Parabola {
        if channel.is_empty() {
            return Parabola::default();
        }
        let width = 2 * self.half + 1;
        if self.n_rows < width {
            return Parabola { value: channel[at], ..Parabola::default() };
        }
        let center = at.clamp(self.half, self.n_rows - 1 - self.half);
        let origin = channel[center];
        let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
        for (offset, value) in channel[center - self.half..=center + self.half].iter().enumerate() {
            let u = offset as f64 - self.half as f64;
            let value = value - origin;
            sum += value;
            first += u * value;
            second += u * u * value;
        }
        let n = width as f64;
        let determinant = n * self.sum4 - self.sum2 * self.sum2;
        let c0 = (self.sum4 * sum - self.sum2 * second) / determinant;
        let c1 = first / self.sum2;
        let c2 = (n * second - self.sum2 * sum) / determinant;
        let u = at as f64 - center as f64;
        Parabola {
            value: origin + c0 + c1 * u + c2 * u * u,
            slope: if u == 0.0 { c1 / self.period_s } else { self.slope_near_end(channel, at) },
            curvature: 2.0 * c2 / (self.period_s * self.period_s),
        }
    }

    /// The slope at a row nearer to an end than half a window: that of the widest window around it, where the parabola
    /// carried on would make a turn in it twice the turn that it is. The last two rows take that of their neighbor.
    fn slope_near_end(&self, channel: &[f64], at: usize) -> f64 {
        let last = channel.len() - 1;
        let center = at.clamp(LEAST_HALF, last - LEAST_HALF);
        let half = self.half.min(center).min(last - center);
        let (mut first, mut squares) = (0.0, 0.0);
        for u in 1..=half {
            let distance = u as f64;
            first += distance * (channel[center + u] - channel[center - u]);
            squares += 2.0 * distance * distance;
        }
        first / (squares * self.period_s)
    }
}

/// Time to either side in which a length that stands still does not move, in s. The direction waits for longer, because it is
/// wrong for long where it is wrong; what slides under pressure slides at once.
const STILL_S: f64 = 0.1;

/// Where the length stands still: it moves by less than a threshold within the time around.
struct Still {
    /// Smooth lengths at every `every` rows.
    lengths: Vec<f64>,
    every: usize,
    /// Lengths to either side that are compared.
    reach: usize,
    threshold_m: f64,
}

impl Still {
    fn of(rows: &Rows, window: &Window, threshold_m: f64) -> Self {
        let every = window.half;
        let lengths =
            (0..rows.length_m.len()).step_by(every).map(|at| window.parabola(&rows.length_m, at).value).collect();
        let reach = ((STILL_S / (every as f64 * window.period_s)).ceil() as usize).clamp(1, 20);
        Self { lengths, every, reach, threshold_m }
    }

    fn at(&self, row: usize) -> bool {
        let center = (row / self.every).min(self.lengths.len().saturating_sub(1));
        let around =
            &self.lengths[center.saturating_sub(self.reach)..(center + self.reach + 1).min(self.lengths.len())];
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for &length in around {
            low = low.min(length);
            high = high.max(length);
        }
        high - low <= self.threshold_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_acceleration_is_the_true_one_averaged() {
        let period_s = 0.005;
        let weights = acceleration_weights(period_s);
        let half = weights.len() / 2;
        assert!(weights.iter().all(|weight| *weight > 0.0));
        // Second differences of any row of numbers are its accelerations.
        let channel: Vec<f64> = (0..60).map(|row| f64::from(row * row * 37 % 101)).collect();
        let window =
            Window::over(&(0..60).map(|row| f64::from(row) * period_s).collect::<Vec<_>>(), HALF_VALUE_WINDOW_S);
        let averaged: f64 = weights
            .iter()
            .enumerate()
            .map(|(index, weight)| {
                let at = 30 + index - half;
                weight * (channel[at + 1] - 2.0 * channel[at] + channel[at - 1]) / (period_s * period_s)
            })
            .sum();
        let found = window.parabola(&channel, 30).curvature;
        assert!((found / averaged - 1.0).abs() < 1e-12, "{found} {averaged}");
    }

    #[test]
    fn a_parabola_is_found_exactly_up_to_the_ends() {
        let time_s: Vec<f64> = (0..60).map(|row| f64::from(row) * 0.005).collect();
        let channel: Vec<f64> = time_s.iter().map(|t| 3.0 - 2.0 * t + 5.0 * t * t).collect();
        let window = Window::over(&time_s, HALF_WINDOW_S);
        for at in [0, 3, 30, 59] {
            let t = time_s[at];
            let found = window.parabola(&channel, at);
            assert!((found.value - channel[at]).abs() < 1e-12);
            let t = t.clamp(time_s[LEAST_HALF], time_s[59 - LEAST_HALF]);
            assert!((found.slope - (10.0 * t - 2.0)).abs() < 1e-9);
            assert!((found.curvature - 10.0).abs() < 1e-7);
        }
    }

    #[test]
    fn an_average_of_a_step_never_turns_back() {
        let time_s: Vec<f64> = (0..60).map(|row| f64::from(row) * 0.005).collect();
        let channel: Vec<f64> = (0..60).map(|row| if row < 30 { 0.0 } else { 1.0 }).collect();
        let average = Average::over(&time_s);
        let path: Vec<f64> = (0..60).map(|at| average.at(&channel, at)).collect();
        assert!(path.windows(2).all(|pair| pair[1] >= pair[0]));
        assert_eq!((path[0], path[59]), (0.0, 1.0));
    }

    #[test]
    fn noise_at_rest_is_no_way_back() {
        let mut onward = Onward::new(0.3);
        let path: Vec<f64> = [0.0, 1.0, 2.0, 1.9, 2.1, 1.85, 2.05, 1.5, 1.6, 1.0].map(|to| onward.follow(to)).into();
        assert_eq!(path, [0.0, 1.0, 2.0, 2.0, 2.1, 2.1, 2.1, 1.5, 1.5, 1.0]);
    }

    #[test]
    fn a_start_just_before_the_end_is_no_faster_than_it_is() {
        let time_s: Vec<f64> = (0..60).map(|row| f64::from(row) * 0.005).collect();
        let channel: Vec<f64> = (0..60).map(|row| f64::from(row - 55).max(0.0)).collect();
        let window = Window::over(&time_s, HALF_WINDOW_S);
        for at in 0..60 {
            let slope = window.parabola(&channel, at).slope;
            assert!((-1e-9..=200.0 + 1e-9).contains(&slope), "{at}: {slope}");
        }
    }
}
