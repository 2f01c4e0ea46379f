//! Knocks in one segment of a recording, and the mass that each weighs.

use std::ops::Range;

use pam_muscle::effects::Mount;
use pam_muscle::motion::Instant;
use pam_muscle::smoothing::acceleration_weights;

use super::Residual;

/// An acceleration is a knock above so many times the usual one of its segment.
const TIMES_USUAL: f64 = 8.0;
/// The same in m/s², where the usual one is nothing.
const LEAST_M_PER_S2: f64 = 0.3;
/// The speed of a knock changes within this time, in s: a slower one is seen by the ordinary search.
const LONGEST_S: f64 = 0.045;

/// One segment of a recording, row by row.
#[derive(Debug, Default)]
pub(in crate::mass) struct Line {
    /// Number of the recording, and the first row of the segment in it.
    pub(super) recording: usize,
    pub(super) first_row: usize,
    /// Times of the first and the last row, in s.
    pub(super) ends_s: [f64; 2],
    /// In m/s².
    pub(super) accelerations: Vec<f64>,
    /// In m/s.
    pub(super) speeds: Vec<f64>,
    pub(super) residuals_n: Vec<f64>,
    /// Whether the speed changes at once before a row.
    pub(super) knees: Vec<bool>,
}

/// A knock with the rows around it.
#[derive(Debug, Clone)]
pub(in crate::mass) struct Knock {
    pub(super) period_s: f64,
    /// From some time before the window, for the mount to come to rest.
    pub(super) accelerations: Vec<f64>,
    /// Rows before the window.
    pub(super) before: usize,
    /// In the window, averaged as the acceleration is.
    pub(super) residuals_n: Vec<f64>,
    pub(super) fastest_m_per_s: f64,
    /// Number of the recording, and the rows of the window in it.
    pub(super) place: (usize, Range<usize>),
}

impl Line {
    /// Nothing yet of `n_rows` rows of recording `recording`, of which `first` is the first.
    pub(in crate::mass) fn of_rows(n_rows: usize, recording: usize, first: &Instant) -> Self {
        let column = || Vec::with_capacity(n_rows);
        Self {
            recording,
            first_row: first.row,
            ends_s: [first.moment.time_s; 2],
            accelerations: column(),
            speeds: column(),
            residuals_n: column(),
            knees: Vec::with_capacity(n_rows),
        }
    }

    /// One more row, where the model says `model_n`.
    pub(in crate::mass) fn push(&mut self, instant: &Instant, model_n: f64) {
        self.ends_s[1] = instant.moment.time_s;
        self.accelerations.push(instant.moment.acceleration_m_per_s2);
        self.speeds.push(instant.moment.speed_m_per_s);
        self.knees.push(instant.knee);
        self.residuals_n.push(instant.force_n - model_n);
    }

    pub(in crate::mass) fn knocks(&self, residual: Residual) -> Vec<Knock> {
        let (n, [first_s, last_s]) = (self.accelerations.len(), self.ends_s);
        if n < 2 {
            return Vec::new();
        }
        let period_s = (last_s - first_s) / (n - 1) as f64;
        let weights = acceleration_weights(period_s);
        let half = weights.len() / 2 + 1;
        let (before, after) = (8 * half, 4 * half);
        let mut sizes: Vec<f64> = self.accelerations.iter().map(|acceleration| acceleration.abs()).collect();
        if n <= before + after + 2 * half {
            return Vec::new();
        }
        let (_, usual, _) = sizes.select_nth_unstable_by(n / 2, f64::total_cmp);
        let threshold = (TIMES_USUAL * 1.4826 * *usual).max(LEAST_M_PER_S2);
        let mut knocks = Vec::new();
        let mut at = before + half;
        while at < n - after - half {
            if self.accelerations[at].abs() <= threshold {
                at += 1;
                continue;
            }
            let end = (at..n - after - half).find(|&row| self.accelerations[row].abs() <= threshold);
            let end = end.unwrap_or(n - after - half);
            let peak = (at..end)
                .max_by(|&left, &right| self.accelerations[left].abs().total_cmp(&self.accelerations[right].abs()))
                .unwrap_or(at);
            at = end + half;
            let (came, went) = (self.speeds[peak - 2 * half], self.speeds[peak + 2 * half]);
            if ((went - came) / self.accelerations[peak]).abs() > LONGEST_S {
                continue;
            }
            let window = peak - 3 * half..peak + after;
            let averaged = |values: &[f64], row: usize| -> f64 {
                values[row + 1 - half..row + half].iter().zip(&weights).map(|(value, weight)| value * weight).sum()
            };
            // What is no knee is an average already; forces are to be averaged alike.
            let is_knee = self.knees[window.clone()].contains(&true);
            let as_it_is = is_knee && residual == Residual::Explained;
            let choose =
                |values: &[f64], row: usize, plain: bool| if plain { values[row] } else { averaged(values, row) };
            let residuals_n: Vec<f64> = window.clone().map(|row| choose(&self.residuals_n, row, as_it_is)).collect();
            let accelerations =
                (peak - before..window.end).map(|row| choose(&self.accelerations, row, as_it_is || !is_knee)).collect();
            if residuals_n.iter().all(|residual| residual.is_finite()) {
                knocks.push(Knock {
                    period_s,
                    accelerations,
                    before: before - 3 * half,
                    residuals_n,
                    fastest_m_per_s: came.abs().max(went.abs()),
                    place: (self.recording, self.first_row + window.start..self.first_row + window.end),
                });
            }
        }
        knocks
    }
}

/// Sums over the rows of knocks of residual and acceleration, both cleared of level, slope and perhaps speed.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Sums {
    pub(super) rows: f64,
    /// Residual squared, in N².
    pub(super) yy: f64,
    /// Acceleration squared, in m²/s⁴.
    pub(super) aa: f64,
    /// Their product.
    pub(super) ay: f64,
}

impl Sums {
    pub(super) fn total<'a>(sums: impl IntoIterator<Item = &'a Self>) -> Self {
        sums.into_iter().fold(Self::default(), |total, sums| Self {
            rows: total.rows + sums.rows,
            yy: total.yy + sums.yy,
            aa: total.aa + sums.aa,
            ay: total.ay + sums.ay,
        })
    }

    pub(super) fn slope(&self) -> f64 {
        if self.aa > 0.0 { self.ay / self.aa } else { 0.0 }
    }

    pub(super) fn left_by(&self, slope: f64) -> f64 {
        (self.yy - 2.0 * slope * self.ay + slope * slope * self.aa).max(0.0)
    }

    pub(super) fn left(&self) -> f64 {
        self.left_by(self.slope())
    }
}

impl Knock {
    pub(super) fn sums(&self, mount_hz: f64, residual: Residual) -> Sums {
        let rows = self.residuals_n.len();
        let mut mount = Mount::new(mount_hz);
        let behind = self.accelerations.iter().map(|&acceleration| mount.follow(acceleration, self.period_s));
        // What the acceleration sums up to is the speed, averaged as it is.
        let mut speed = 0.0;
        let speeds = self.accelerations[self.before..].iter().map(|&acceleration| {
            speed += 0.5 * acceleration;
            let here = speed;
            speed += 0.5 * acceleration;
            here
        });
        let mut cleared: Vec<Vec<f64>> = Vec::new();
        let columns = [
            vec![1.0; rows],
            (0..rows).map(|row| row as f64).collect(),
            speeds.collect(),
            behind.skip(self.before).collect(),
            self.residuals_n.clone(),
        ];
        for mut column in columns {
            for basis in cleared.iter().take(residual.n_cleared()) {
                let share = dot(basis, &column) / dot(basis, basis).max(f64::MIN_POSITIVE);
                column.iter_mut().zip(basis).for_each(|(value, basis)| *value -= share * basis);
            }
            cleared.push(column);
        }
        let (acceleration, residual) = (&cleared[3], &cleared[4]);
        Sums {
            rows: rows as f64,
            yy: dot(residual, residual),
            aa: dot(acceleration, acceleration),
            ay: dot(acceleration, residual),
        }
    }
}

pub(super) fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(left, right)| left * right).sum()
}
