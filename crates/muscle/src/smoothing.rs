//! Channels smooth, and what remembers their path.
//!
//! Rates of noisy channels come from a parabola fitted to a centered window of [`HALF_WINDOW_S`] to either side
//! (Savitzky and Golay, 1964): value, slope and curvature in one go, the same window for every channel, so that smoothing
//! shifts none against the other. What slides and remembers its path gets an average with positive weights instead, which
//! never overshoots, and goes on only where it moves and turns back only by more than the noise of that average.

use std::ops::Range;

/// Half of the window of the parabola that rates come from, in s; at least four samples and at most fifty to either side.
pub const HALF_WINDOW_S: f64 = 0.04;
/// The same for the values themselves, which need less smoothing than their rates, and for the acceleration, which lasts
/// no longer where a rig starts or stops.
pub const HALF_VALUE_WINDOW_S: f64 = 0.02;

/// A channel around one row.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Parabola {
    pub(crate) value: f64,
    /// Per second.
    pub(crate) slope: f64,
    /// Second derivative, per second squared.
    pub(crate) curvature: f64,
}

/// Rows to either side that a slope comes from at least.
const LEAST_HALF: usize = 2;

/// The window of the parabola over evenly sampled rows.
pub(crate) struct Window {
    /// Rows to either side.
    pub(crate) half: usize,
    pub(crate) period_s: f64,
    /// `Σ u²` and the determinant terms of the normal equations over `u = -half..=half`.
    sum2: f64,
    sum4: f64,
}

impl Window {
    pub(crate) fn over(time_s: &[f64], half_s: f64) -> Self {
        Self::every(period_s(time_s), half_s)
    }

    /// The same over rows that are `period_s` apart.
    pub(crate) fn every(period_s: f64, half_s: f64) -> Self {
        let half = half_rows(half_s, period_s);
        let h = half as f64;
        let sum2 = h * (h + 1.0) * (2.0 * h + 1.0) / 3.0;
        let sum4 = sum2 * (3.0 * h * h + 3.0 * h - 1.0) / 5.0;
        Self { half, period_s, sum2, sum4 }
    }

    /// The rows of `n_rows` that the parabola at row `at` is fitted to: the nearest whole window.
    pub(crate) fn around(&self, at: usize, n_rows: usize) -> Range<usize> {
        let center = at.min((n_rows - 1).saturating_sub(self.half)).max(self.half);
        center - self.half..(center + self.half + 1).min(n_rows)
    }

    /// Time that it spans, in s.
    pub(crate) fn width_s(&self) -> f64 {
        2.0 * self.half as f64 * self.period_s
    }

    /// Deviation of a curvature over that of the white noise of the rows, per second squared.
    pub(crate) fn curvature_noise(&self) -> f64 {
        let n = (2 * self.half + 1) as f64;
        2.0 * (n / (n * self.sum4 - self.sum2 * self.sum2)).sqrt() / (self.period_s * self.period_s)
    }

    /// The parabola at row `at`; near the ends that of the nearest whole window, carried on.
    pub(crate) fn parabola(&self, channel: &[f64], at: usize) -> Parabola {
        if channel.len() <= 2 * self.half {
            return short(channel, at);
        }
        let center = self.around(at, channel.len()).start + self.half;
        self.carried_on(channel, at, center, &Sums::around(self, channel, center))
    }

    /// The parabola of `sums`, those around row `center`, at row `at`.
    fn carried_on(&self, channel: &[f64], at: usize, center: usize, sums: &Sums) -> Parabola {
        let u = at as f64 - center as f64;
        let (c1, c2) = (self.first_order(sums), self.second_order(sums));
        Parabola {
            value: self.middle(sums) + c1 * u + c2 * u * u,
            slope: if u == 0.0 { c1 / self.period_s } else { self.slope_near_end(channel, at) },
            curvature: self.bend(sums),
        }
    }

    /// `n Σ u⁴ - (Σ u²)²`.
    fn determinant(&self) -> f64 {
        (2 * self.half + 1) as f64 * self.sum4 - self.sum2 * self.sum2
    }

    /// Value of the parabola of `sums` in the middle of its window.
    fn middle(&self, sums: &Sums) -> f64 {
        sums.origin + (self.sum4 * sums.sum - self.sum2 * sums.second) / self.determinant()
    }

    fn first_order(&self, sums: &Sums) -> f64 {
        sums.first / self.sum2
    }

    fn second_order(&self, sums: &Sums) -> f64 {
        ((2 * self.half + 1) as f64 * sums.second - self.sum2 * sums.sum) / self.determinant()
    }

    /// Its curvature, per second squared.
    fn bend(&self, sums: &Sums) -> f64 {
        2.0 * self.second_order(sums) / (self.period_s * self.period_s)
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

/// The whole of a channel that is shorter than a window, or empty.
fn short(channel: &[f64], at: usize) -> Parabola {
    channel.get(at).map_or(Parabola::default(), |&value| Parabola { value, ..Parabola::default() })
}

/// Moments of a channel over a window, less its value `origin`: `Σ x`, `Σ u x` and `Σ u² x`.
#[derive(Debug, Clone, Copy)]
struct Sums {
    origin: f64,
    sum: f64,
    first: f64,
    second: f64,
}

impl Sums {
    fn around(window: &Window, channel: &[f64], center: usize) -> Self {
        let origin = channel[center];
        let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
        for (offset, value) in channel[center - window.half..=center + window.half].iter().enumerate() {
            let u = offset as f64 - window.half as f64;
            let value = value - origin;
            sum += value;
            first += u * value;
            second += u * u * value;
        }
        Self { origin, sum, first, second }
    }

    /// The same around the next row, where `gone` is the first value of the window and `come` the next after its last.
    fn step(&mut self, half: usize, gone: f64, come: f64) {
        let (half, next) = (half as f64, half as f64 + 1.0);
        let (gone, come) = (gone - self.origin, come - self.origin);
        self.sum += come - gone;
        let first = self.first + half * gone + next * come;
        self.second += next * next * come - half * half * gone - 2.0 * first + self.sum;
        self.first = first - self.sum;
    }
}

/// Rows after which the moments of a window that slides are summed anew, so that what rounds off does not add up.
const ANEW: usize = 32;

/// A window that slides along a channel, from row to row at the same cost however long it is. What it gives at a row does not
/// depend on the rows that it was asked for before.
pub(crate) struct Sliding<'a> {
    window: &'a Window,
    channel: &'a [f64],
    /// The row that the moments are around; none before the first.
    center: Option<usize>,
    sums: Sums,
}

impl<'a> Sliding<'a> {
    pub(crate) fn along(window: &'a Window, channel: &'a [f64]) -> Self {
        Self { window, channel, center: None, sums: Sums { origin: 0.0, sum: 0.0, first: 0.0, second: 0.0 } }
    }

    /// As [`Window::parabola`].
    pub(crate) fn parabola(&mut self, at: usize) -> Parabola {
        let Self { window, channel, .. } = *self;
        match self.slide_to(at) {
            Some(center) => window.carried_on(channel, at, center, &self.sums),
            None => short(channel, at),
        }
    }

    /// Its value alone, at less than half the cost.
    pub(crate) fn value(&mut self, at: usize) -> f64 {
        match self.slide_to(at) {
            Some(center) if center == at => self.window.middle(&self.sums),
            _ => self.parabola(at).value,
        }
    }

    /// Its slope alone, per second.
    pub(crate) fn slope(&mut self, at: usize) -> f64 {
        match self.slide_to(at) {
            Some(center) if center == at => self.window.first_order(&self.sums) / self.window.period_s,
            _ => self.parabola(at).slope,
        }
    }

    /// Its curvature alone, per second squared.
    pub(crate) fn curvature(&mut self, at: usize) -> f64 {
        match self.slide_to(at) {
            Some(_) => self.window.bend(&self.sums),
            None => self.parabola(at).curvature,
        }
    }

    /// Slides to the window that tells of row `at`; its middle, or none where the channel is shorter.
    fn slide_to(&mut self, at: usize) -> Option<usize> {
        let Self { window, channel, .. } = *self;
        let half = window.half;
        if channel.len() <= 2 * half {
            return None;
        }
        let center = window.around(at, channel.len()).start + half;
        let anew = (center - center % ANEW).max(half);
        let mut row = match self.center {
            Some(row) if (anew..=center).contains(&row) => row,
            _ => {
                self.sums = Sums::around(window, channel, anew);
                anew
            }
        };
        while row < center {
            self.sums.step(half, channel[row - half], channel[row + half + 1]);
            row += 1;
        }
        self.center = Some(center);
        Some(center)
    }
}

/// Half of a window of `half_s` to either side, in rows.
fn half_rows(half_s: f64, period_s: f64) -> usize {
    ((half_s / period_s).round() as usize).clamp(4, 50)
}

/// Time between evenly sampled rows, in s.
fn period_s(time_s: &[f64]) -> f64 {
    let ends_s = [time_s.first(), time_s.last()].map(|time_s| time_s.copied().unwrap_or_default());
    period_between_s(time_s.len(), ends_s)
}

/// The same of `n_rows` from the times of the first and the last.
pub(crate) fn period_between_s(n_rows: usize, [first_s, last_s]: [f64; 2]) -> f64 {
    if n_rows > 1 { (last_s - first_s) / (n_rows - 1) as f64 } else { 1.0 }
}

/// Weights with which the acceleration of an [`Instant`](crate::motion::Instant) averages the true one over the rows
/// around, at a period of `period_s`: a force that is to be compared with it has to be averaged alike. They are symmetric
/// and sum to one.
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

/// An average with positive weights, for what remembers its path: a parabola overshoots after a step, which would be a
/// reversal that never was.
pub(crate) struct Average {
    weights: Vec<f64>,
}

impl Average {
    /// Over rows that are `period_s` apart.
    pub(crate) fn every(period_s: f64) -> Self {
        Self { weights: acceleration_weights(period_s) }
    }

    pub(crate) fn at(&self, channel: &[f64], at: usize) -> f64 {
        let half = self.weights.len() / 2;
        let origin = channel[at];
        if let Some(around) = at.checked_sub(half).and_then(|from| channel.get(from..=at + half)) {
            return origin + weighted(&self.weights, around, origin);
        }
        let last = channel.len() - 1;
        let around: Vec<f64> =
            (0..self.weights.len()).map(|index| channel[(at + index).saturating_sub(half).min(last)]).collect();
        origin + weighted(&self.weights, &around, origin)
    }

    /// Deviation of an average over that of the white noise of its rows.
    pub(crate) fn share_of_noise(&self) -> f64 {
        self.weights.iter().map(|weight| weight * weight).sum::<f64>().sqrt()
    }
}

/// `Σ w (x − origin)`, summed in lanes.
fn weighted(weights: &[f64], values: &[f64], origin: f64) -> f64 {
    let mut lanes = [0.0; 4];
    let (weights, weights_left) = weights.as_chunks::<4>();
    let (values, values_left) = values.as_chunks::<4>();
    for (weights, values) in weights.iter().zip(values) {
        for lane in 0..4 {
            lanes[lane] += weights[lane] * (values[lane] - origin);
        }
    }
    let left: f64 = weights_left.iter().zip(values_left).map(|(weight, value)| weight * (value - origin)).sum();
    lanes.iter().sum::<f64>() + left
}

/// What follows a channel but not its noise: to what remembers its path, noise at rest would be a way to and fro. It has no
/// lag while it goes on one way; a creep comes along in steps of the noise.
pub(crate) struct Onward {
    /// A way that is none.
    noise: f64,
    /// Time in which what moves passes it, in s.
    within_s: f64,
    position: f64,
    /// ±1; 0 before the first move.
    way: f64,
}

impl Onward {
    pub(crate) fn new(noise: f64, within_s: f64) -> Self {
        Self { noise, within_s, position: f64::NAN, way: 0.0 }
    }

    /// Follows to a place that is reached at a `rate`, per second.
    pub(crate) fn follow(&mut self, to: f64, rate: f64) -> f64 {
        let by = to - self.position;
        if by.is_nan() {
            self.position = to;
        } else if by.abs() > self.noise || by * self.way > 0.0 && rate * self.way * self.within_s > self.noise {
            self.position = to;
            self.way = by.signum();
        }
        self.position
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
    fn a_parabola_is_found_exactly_but_for_the_slope_of_the_last_two_rows() {
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
    fn a_window_that_slides_gives_the_same_whatever_rows_it_is_asked_for() {
        let time_s: Vec<f64> = (0..400).map(|row| f64::from(row) * 0.001).collect();
        let channel: Vec<f64> = (0..400).map(|row| 0.25 + 1e-3 * f64::from(row * row * 37 % 101)).collect();
        let window = Window::over(&time_s, HALF_WINDOW_S);
        let parts = |parabola: Parabola| [parabola.value, parabola.slope, parabola.curvature];
        let (mut each, mut some) = (Sliding::along(&window, &channel), Sliding::along(&window, &channel));
        for at in 0..400 {
            let (direct, sliding) = (parts(window.parabola(&channel, at)), parts(each.parabola(at)));
            for (direct, sliding) in direct.into_iter().zip(sliding) {
                assert!((sliding - direct).abs() < 1e-11 * direct.abs().max(1.0), "{at}: {sliding} {direct}");
            }
            if at % 23 == 0 || at > 380 {
                assert_eq!(parts(some.parabola(at)), sliding, "{at}");
            }
        }
        assert_eq!(parts(some.parabola(7)), parts(Sliding::along(&window, &channel).parabola(7)));
    }

    #[test]
    fn an_average_of_a_step_never_turns_back() {
        let channel: Vec<f64> = (0..60).map(|row| if row < 30 { 0.0 } else { 1.0 }).collect();
        let average = Average::every(0.005);
        let path: Vec<f64> = (0..60).map(|at| average.at(&channel, at)).collect();
        assert!(path.windows(2).all(|pair| pair[1] >= pair[0]));
        assert_eq!((path[0], path[59]), (0.0, 1.0));
    }

    #[test]
    fn noise_at_rest_is_no_way() {
        let mut onward = Onward::new(0.3, 1.0);
        let moving = [(0.0, 1.0), (1.0, 1.0), (2.0, 1.0), (2.1, 0.5)];
        let resting = [(1.9, -0.2), (2.2, 0.1), (1.85, 0.0), (2.3, 0.2)];
        let turning = [(1.7, -0.1), (1.75, 0.4), (1.6, -0.4)];
        let path = [&moving[..], &resting, &turning].concat();
        let path: Vec<f64> = path.into_iter().map(|(to, rate)| onward.follow(to, rate)).collect();
        assert_eq!(path, [0.0, 1.0, 2.0, 2.1, 2.1, 2.1, 2.1, 2.1, 1.7, 1.7, 1.6]);
    }

    #[test]
    fn what_creeps_comes_along() {
        let mut onward = Onward::new(0.3, 1.0);
        let path: Vec<f64> = (0..100).map(|step| onward.follow(f64::from(step) * 0.01, 0.01)).collect();
        assert!((0..100).all(|step| (path[step] - step as f64 * 0.01).abs() < 0.31));
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
