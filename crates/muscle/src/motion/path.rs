//! A channel along a stretch of rows, with its knees, and where a length stands still.

use crate::knees::Knees;
use crate::smoothing::{Average, Parabola, Sliding, Window};

/// A channel of a stretch of rows.
pub(super) struct Path {
    /// Straight on where it has a knee.
    rest: Vec<f64>,
    pub(super) knees: Knees,
}

impl Path {
    /// `channel`, whose white noise has the deviation `noise`.
    pub(super) fn of(mut channel: Vec<f64>, [near, window]: [&Window; 2], noise: f64) -> Self {
        let knees = Knees::take_from(&mut channel, [window, near], noise);
        Self { rest: channel, knees }
    }

    pub(super) fn recorded(&self, at: usize) -> f64 {
        self.rest[at] + self.knees.added(at)
    }

    /// The average around row `at`, in which a move that has ended does not go on.
    pub(super) fn average(&self, average: &Average, at: usize) -> f64 {
        average.at(&self.rest, at) + self.knees.added(at)
    }

    /// Value and curvature by the first of the windows, slope by the second; what knees change changes at once.
    pub(super) fn sharp<'a>(&'a self, windows: [&'a Window; 2]) -> Sharp<'a> {
        Sharp { path: self, windows: windows.map(|window| Sliding::along(window, &self.rest)) }
    }

    /// The same where knees are as smooth as all else; none where there is no knee to smooth.
    pub(super) fn smooth_near_knee(&self, [near, window]: [&Window; 2], at: usize) -> Option<Parabola> {
        let around = window.around(at, self.rest.len());
        if !self.knees.any_within(&around) {
            return None;
        }
        let recorded: Vec<f64> = around.clone().map(|row| self.recorded(row)).collect();
        let Parabola { value, curvature, .. } = near.parabola(&recorded, at - around.start);
        Some(Parabola { value, curvature, ..window.parabola(&recorded, at - around.start) })
    }
}

/// A channel as it is read from row to row, with its knees.
pub(super) struct Sharp<'a> {
    path: &'a Path,
    windows: [Sliding<'a>; 2],
}

impl Sharp<'_> {
    pub(super) fn at(&mut self, at: usize) -> Parabola {
        let [near, window] = &mut self.windows;
        let knees = &self.path.knees;
        Parabola {
            value: near.value(at) + knees.added(at),
            slope: window.slope(at) + knees.rate(at),
            curvature: near.curvature(at) + knees.bend(at),
        }
    }
}

/// Time to either side in which a length that stands still does not move, in s. The direction waits for longer, because it is
/// wrong for long where it is wrong; what slides under pressure slides at once.
const STILL_S: f64 = 0.1;

/// Where the length stands still: it has no speed and moves by less than a threshold within the time around, but for what it
/// did before it stopped or does after its start at a knee.
pub(super) struct Still<'a> {
    path: &'a Path,
    /// Smooth lengths at every `every` rows.
    lengths: Vec<f64>,
    every: usize,
    /// Rows to either side that are compared.
    reach: usize,
    threshold_m: f64,
    /// Speed at which it passes the threshold while it is averaged, in m/s.
    speed_m_per_s: f64,
}

impl<'a> Still<'a> {
    pub(super) fn of(path: &'a Path, window: &Window, threshold_m: f64) -> Self {
        let every = window.half;
        let rows = (0..path.rest.len()).step_by(every);
        Self {
            path,
            lengths: rows.map(|at| window.parabola(&path.rest, at).value + path.knees.added(at)).collect(),
            every,
            reach: every * ((STILL_S / (every as f64 * window.period_s)).ceil() as usize).clamp(1, 20),
            threshold_m,
            speed_m_per_s: threshold_m / window.width_s(),
        }
    }

    pub(super) fn at(&self, row: usize, speed_m_per_s: f64) -> bool {
        if speed_m_per_s.abs() > self.speed_m_per_s {
            return false;
        }
        let (stop, start) = self.path.knees.around(row);
        let from = row.saturating_sub(self.reach).max(stop).div_ceil(self.every);
        let to = ((row + self.reach).min(start) / self.every + 1).min(self.lengths.len());
        let range = |(low, high): (f64, f64), &length: &f64| (low.min(length), high.max(length));
        let lengths = self.lengths.get(from..to).unwrap_or_default();
        let (low, high) = lengths.iter().fold((f64::INFINITY, f64::NEG_INFINITY), range);
        high - low <= self.threshold_m
    }
}
