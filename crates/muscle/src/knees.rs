//! Knees: instants at which a drive changes its speed faster than the sampling shows.
//!
//! Rigs run ramps, triangles and holds. Where such a path bends, a parabola over some tens of milliseconds smears the
//! acceleration, and a mass that hangs on the drive would be knocked softly where it is knocked hard. So each bend is asked
//! whether two straight lines that meet describe it down to the noise of the sensor. If they do, the path is taken as smooth
//! but for that knee: rates come from what is left of the path without its knees, which lend their own.

use std::cmp::Ordering;
use std::ops::Range;

use crate::smoothing::{Sliding, Window};

/// A curvature above so many of its own deviations is a bend.
const BEND: f64 = 6.0;
/// Two lines describe a bend if what they leave exceeds noise by no more than so many of its own deviations, as mean squares.
const STRAIGHT: f64 = 3.0;
/// Squared deviations of the noise by which two lines must describe it better than a parabola.
const CLEARLY: f64 = 9.0;
/// Steps of the search for the instant, per row.
const STEPS_PER_ROW: usize = 10;

/// The knees of a path and the bent line that they make: nothing before the first, its slope added after each.
#[derive(Debug, Default)]
pub(crate) struct Knees {
    bent: Vec<Bent>,
    period_s: f64,
}

/// Where the rate changes, in rows, and by how much per row.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Knee {
    at: f64,
    change: f64,
}

/// The line from a knee to the next, `slope row + height`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bent {
    knee: Knee,
    slope: f64,
    height: f64,
}

impl Knees {
    /// Takes the knees from `path`, whose white noise has the deviation `noise`, so that it goes straight on at each: first
    /// what is seen in the first of `windows`, then, in what is left, what stands too close to another and is seen in the
    /// second.
    pub(crate) fn take_from(path: &mut [f64], windows: [&Window; 2], noise: f64) -> Self {
        let mut all: Vec<Knee> = Vec::new();
        for window in windows {
            let found = Self::new(found(path, window, noise), window.period_s);
            if !found.bent.is_empty() {
                path.iter_mut().enumerate().for_each(|(row, value)| *value -= found.added(row));
            }
            all.extend(found.bent.iter().map(|bent| bent.knee));
        }
        all.sort_by(ascending);
        Self::new(all, windows[0].period_s)
    }

    /// `knees` ascend.
    fn new(knees: Vec<Knee>, period_s: f64) -> Self {
        let (mut slope, mut height) = (0.0, 0.0);
        let bent = knees.into_iter().map(|knee| {
            slope += knee.change;
            height -= knee.change * knee.at;
            Bent { knee, slope, height }
        });
        Self { bent: bent.collect(), period_s }
    }

    /// Sum that the knees so far have added to the path at `row`.
    pub(crate) fn added(&self, row: usize) -> f64 {
        let row = row as f64;
        match self.bent.partition_point(|bent| bent.knee.at <= row) {
            0 => 0.0,
            behind => self.bent[behind - 1].slope * row + self.bent[behind - 1].height,
        }
    }

    /// Whether one lies within `rows` or in the step before them.
    pub(crate) fn any_within(&self, rows: &Range<usize>) -> bool {
        let first = self.bent.partition_point(|bent| bent.knee.at + 2.0 <= rows.start as f64);
        self.bent.get(first).is_some_and(|bent| bent.knee.at <= rows.end as f64)
    }

    /// The rows that no knee parts from `row`: the first after the last knee, and the last before the next.
    pub(crate) fn around(&self, row: usize) -> (usize, usize) {
        let next = self.bent.partition_point(|bent| bent.knee.at <= row as f64);
        let first = next.checked_sub(1).map_or(0, |last| self.bent[last].knee.at.ceil() as usize);
        (first, self.bent.get(next).map_or(usize::MAX, |bent| bent.knee.at as usize))
    }

    /// Rate that they have added, averaged over the step before `row`, per second.
    pub(crate) fn rate(&self, row: usize) -> f64 {
        row.checked_sub(1).map_or(0.0, |before| (self.added(row) - self.added(before)) / self.period_s)
    }

    /// Second derivative by the knees over the step before `row`, per second squared; shared by two steps so that it acts,
    /// on average, when it does.
    pub(crate) fn bend(&self, row: usize) -> f64 {
        let row = row as f64;
        let first = self.bent.partition_point(|bent| bent.knee.at <= row - 1.5);
        let near = self.bent[first..].iter().map(|bent| bent.knee).take_while(|knee| knee.at < row + 0.5);
        near.map(|knee| (1.0 - (knee.at + 0.5 - row).abs()) * knee.change).sum::<f64>() / self.period_s.powi(2)
    }
}

fn ascending(left: &Knee, right: &Knee) -> Ordering {
    left.at.total_cmp(&right.at)
}

/// Knees of `path`, ascending.
fn found(path: &[f64], window: &Window, noise: f64) -> Vec<Knee> {
    let half = window.half;
    let mut knees = Vec::new();
    if path.len() <= 4 * half {
        return knees;
    }
    // Nearer to an end the whole window nearest to it speaks.
    let (first, end) = (half, path.len() - half);
    let gate = BEND * noise * window.curvature_noise();
    let mut sliding = Sliding::along(window, path);
    let mut row = first;
    while row < end {
        let (start, mut peak, mut highest) = (row, row, 0.0);
        let begins = sliding.curvature(row);
        let (sign, mut bend) = (begins.signum(), begins.abs());
        while bend > gate {
            if bend > highest {
                (peak, highest) = (row, bend);
            }
            row += 1;
            if row == end {
                break;
            }
            bend = sign * sliding.curvature(row);
        }
        // A longer bend is one that lasts.
        if row > start && row - start <= 3 * half {
            knees.extend(Knee::near(path, peak, half, noise));
        }
        row += 1;
    }
    // Of two bends that overlap the second may have the earlier corner.
    knees.sort_by(ascending);
    knees
}

impl Knee {
    /// The one within `half` rows of `peak`, if two lines describe the path there.
    fn near(path: &[f64], peak: usize, half: usize, noise: f64) -> Option<Self> {
        let n = 2 * half + 1;
        let squares = (half * (half + 1) * n) as f64 / 3.0;
        // Without level and slope.
        let straightened = |values: &mut [f64]| {
            let mean = values.iter().sum::<f64>() / n as f64;
            let along = |index: usize| index as f64 - half as f64;
            let slope = values.iter().enumerate().map(|(index, value)| along(index) * value).sum::<f64>() / squares;
            values.iter_mut().enumerate().for_each(|(index, value)| *value -= mean + slope * along(index));
        };
        let mut around: Vec<f64> = path[peak - half..=peak + half].iter().map(|value| value - path[peak]).collect();
        straightened(&mut around);
        let dot = |left: &[f64], right: &[f64]| left.iter().zip(right).map(|(left, right)| left * right).sum::<f64>();
        let reach = (half * STEPS_PER_ROW - STEPS_PER_ROW) as i32;
        // A path that may as well bend evenly has no knee.
        let mut bow: Vec<f64> = (0..n).map(|index| (index as f64 - half as f64).powi(2)).collect();
        straightened(&mut bow);
        let bowed = dot(&bow, &around).powi(2) / dot(&bow, &bow);
        let tried = (-reach..=reach).map(|step| {
            let from = f64::from(step) / STEPS_PER_ROW as f64;
            let mut hinge: Vec<f64> = (0..n).map(|index| (index as f64 - half as f64 - from).max(0.0)).collect();
            straightened(&mut hinge);
            let (share, size) = (dot(&hinge, &around), dot(&hinge, &hinge));
            (share * share / size, Self { at: peak as f64 + from, change: share / size })
        });
        let (explained, knee) = tried.max_by(|left, right| left.0.total_cmp(&right.0))?;
        let freedom = (n - 4) as f64;
        let left = dot(&around, &around) - explained;
        let most = freedom + STRAIGHT * (2.0 * freedom).sqrt();
        (left < most * noise * noise && explained - bowed > CLEARLY * noise * noise).then_some(knee)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::smoothing::{HALF_VALUE_WINDOW_S, HALF_WINDOW_S};
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    const PERIOD_S: f64 = 0.005;
    const NOISE_M: f64 = 30e-6;

    /// The knees of a noisy path, and what is left of it.
    fn noisy(place_m: impl Fn(f64) -> f64) -> (Knees, Vec<f64>) {
        let normal = Normal::new(0.0, NOISE_M).unwrap();
        let mut generator = rand_pcg::Pcg64::seed_from_u64(2);
        let time_s: Vec<f64> = (0..1000).map(|row| f64::from(row) * PERIOD_S).collect();
        let mut path: Vec<f64> = time_s.iter().map(|&t| place_m(t) + normal.sample(&mut generator)).collect();
        let windows = [HALF_WINDOW_S, HALF_VALUE_WINDOW_S].map(|half_s| Window::over(&time_s, half_s));
        let knees = Knees::take_from(&mut path, [&windows[0], &windows[1]], NOISE_M);
        (knees, path)
    }

    #[test]
    fn a_start_and_a_stop_between_rows_are_found() {
        let (knees, path) = noisy(|t| 0.05 * (t.clamp(1.0012, 2.0031) - 1.0));
        let bent: Vec<usize> = (0..1000).filter(|&row| knees.bend(row) != 0.0).collect();
        assert!(bent.len() <= 4 && bent.iter().all(|row| row.abs_diff(200) <= 2 || row.abs_diff(401) <= 2), "{bent:?}");
        // In time, and in size.
        let moment = |rows: Range<usize>| rows.map(|row| knees.bend(row) * PERIOD_S).collect::<Vec<_>>();
        let (start, stop) = (moment(150..250), moment(350..450));
        let size = |changes: &[f64]| changes.iter().sum::<f64>();
        let middle_s = |changes: &[f64], first: f64| {
            let rows = changes.iter().enumerate().map(|(index, change)| change * (index as f64 - 0.5)).sum::<f64>();
            (first + rows / size(changes)) * PERIOD_S
        };
        assert!((size(&start) - 0.05).abs() < 2e-3 && (size(&stop) + 0.05).abs() < 2e-3);
        assert!((middle_s(&start, 150.0) - 1.0012).abs() < 1e-3, "{}", middle_s(&start, 150.0));
        assert!((middle_s(&stop, 350.0) - 2.0031).abs() < 1e-3, "{}", middle_s(&stop, 350.0));
        // What is left and what the knees add make the speed.
        for (row, speed) in [(50, 0.0), (210, 0.05), (380, 0.05), (405, 0.0), (900, 0.0)] {
            let rest = (path[row + 15] - path[row]) / (15.0 * PERIOD_S);
            assert!((rest + knees.rate(row) - speed).abs() < 2e-3, "{row}");
        }
    }

    #[test]
    fn a_short_move_has_both_its_knees() {
        let (knees, _) = noisy(|t| 0.5 * (t.clamp(1.0012, 1.0431) - 1.0));
        let change = |rows: Range<usize>| rows.map(|row| knees.bend(row) * PERIOD_S).sum::<f64>();
        assert!((change(198..203) - 0.5).abs() < 0.02 && (change(206..211) + 0.5).abs() < 0.02);
    }

    #[test]
    fn a_bend_that_lasts_and_noise_have_no_knees() {
        for (knees, _) in [noisy(|t| 0.005 * (12.0 * t).sin()), noisy(|_| 0.0), noisy(|t| 0.03 * (t - 2.5).powi(2))] {
            assert!(knees.bent.is_empty());
        }
    }
    /// A hand that jerks: straight lines of some rows each, whose slopes are drawn.
    fn jerks(seed: u64) -> Vec<f64> {
        let mut generator = rand_pcg::Pcg64::seed_from_u64(seed);
        let mut draw = || Normal::new(0.0, 1.0).unwrap().sample(&mut generator);
        let (mut place_m, mut step_m) = (0.0, 0.0);
        let row = |row: usize| {
            if row.is_multiple_of(5) {
                step_m = 2.0 * NOISE_M * draw();
            }
            place_m += step_m;
            place_m + NOISE_M * draw()
        };
        (0..1000).map(row).collect()
    }

    #[test]
    fn what_is_left_of_a_path_and_what_its_knees_add_are_the_path() {
        let time_s: Vec<f64> = (0..1000).map(|row| f64::from(row) * PERIOD_S).collect();
        let windows = [HALF_WINDOW_S, HALF_VALUE_WINDOW_S].map(|half_s| Window::over(&time_s, half_s));
        let mut n_knees = 0;
        for seed in 0..30 {
            let path = jerks(seed);
            let mut left = path.clone();
            let knees = Knees::take_from(&mut left, [&windows[0], &windows[1]], NOISE_M);
            n_knees += knees.bent.len();
            for (row, (left, whole)) in left.iter().zip(&path).enumerate() {
                assert!((left + knees.added(row) - whole).abs() < 1e-9, "seed {seed}, row {row}");
            }
        }
        assert!(n_knees > 100, "{n_knees}");
    }
}
