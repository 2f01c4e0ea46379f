//! A mass that swings, in all that changes within half a second.
//!
//! Where a drive moves smoothly, a mass pulls with the square of the frequency: it is all in what changes fast. What eq. 11 misses and
//! what remembers change slowly, and are many times larger over all. So residual and length are averaged alike over some hundredths of
//! a second, which gives an acceleration that is more than noise, and what changes slowly is taken off both. What is left of the
//! residual must follow the acceleration beside all that goes with pressure, length, their rates and the direction: a misfit of eq. 11,
//! damping, delays, friction.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{SMatrix, SVector};
use pam_muscle::motion::Instant;

use super::{Motion, MovingMass};
use crate::joint::HeldOut;
use crate::track::FOLDS;
use crate::uncertainty::jackknife_stderr;
use crate::verdict::Sizes;

/// Time between two bins that rows are averaged in, in s.
const BIN_S: f64 = 0.02;
/// Half of the window that residual and length are averaged over, in s. Of 51 masses and 1,400 cases without one that it was chosen by,
/// half as much more or a quarter less finds as many, within two, and as few.
const HALF_S: f64 = 0.04;
/// Time whose average is what changes slowly, in s; three fifths of it and eight fifths find as many, within three.
const SLOW_S: f64 = 0.5;
/// Times the usual deviation from which on a bin counts less: friction turns over a little earlier or later than a model has it.
const OUTLYING: f64 = 4.0;
/// Pieces that stand for independent ones.
const PIECES: usize = 32;
/// Bins that are needed in each.
const LEAST: usize = 20;
/// Standard errors by which a mass differs from none. Noise never gives it; of what else there is, two of 1,400 cases have more (none has
/// more than 10, three have more than 6), and of 51 masses 37 (35, 37).
const SURELY: f64 = 8.0;
/// Share of its pull that is left of it where that is averaged like this, about.
const KEPT: f64 = 0.6;

/// What is cleared away: pressure and length to the third power together, their rates, friction.
const CLEARED: usize = 13;
/// That, and the acceleration behind it.
const COLUMNS: usize = CLEARED + 1;

/// Rows of one segment, averaged in bins.
#[derive(Debug)]
pub(super) struct Stretch {
    period_s: f64,
    /// Rows of a bin.
    stride: usize,
    /// Sums over the rows of the bin that is not full yet, and their number.
    sums: Bin,
    n: usize,
    bins: Vec<Bin>,
}

/// Gauge pressure in Pa, length in m, direction, residual in N.
type Bin = [f64; 4];

impl Stretch {
    /// Nothing yet, of rows that are `period_s` apart.
    pub(super) fn every(period_s: f64) -> Self {
        let stride = ((BIN_S / period_s).round() as usize).max(1);
        Self { period_s: stride as f64 * period_s, stride, sums: Bin::default(), n: 0, bins: Vec::new() }
    }

    /// One more row, where the model says `model_n`.
    pub(super) fn push(&mut self, instant: &Instant, model_n: f64) {
        let moment = &instant.moment;
        let row = [moment.pressure_pa, moment.length_m, moment.direction, instant.force_n - model_n];
        self.sums.iter_mut().zip(row).for_each(|(sum, value)| *sum += value);
        self.n += 1;
        if self.n == self.stride {
            self.bins.push(self.sums.map(|sum| sum / self.stride as f64));
            (self.sums, self.n) = (Bin::default(), 0);
        }
    }

    /// What changes fast: columns, the residual, and the acceleration of lengthening with what is slow of it, in m/s²; pressures and
    /// lengths in shares of `ranges`.
    fn fast(&self, ranges: &[(f64, f64); 2]) -> Vec<Row> {
        let (n, half) = (self.bins.len(), ((HALF_S / self.period_s).round() as usize).max(1));
        let slow = (0.5 * SLOW_S / self.period_s).round() as usize;
        if slow <= half || n < 4 * slow {
            return Vec::new();
        }
        let bell: Vec<f64> = (0..=2 * half)
            .map(|at| (FRAC_PI_2 * (at as f64 - half as f64) / (half + 1) as f64).cos().powi(2))
            .collect();
        let even = vec![1.0; 2 * slow + 1];
        let of = |channel: usize| averaged(&self.bins.iter().map(|bin| bin[channel]).collect::<Vec<f64>>(), &bell);
        let [pressures, lengths, directions, residuals] = [0, 1, 2, 3].map(of);
        let share = |values: &[f64], (low, high): (f64, f64)| -> Vec<f64> {
            values.iter().map(|value| (value - low) / (high - low).max(f64::MIN_POSITIVE)).collect()
        };
        let [p, l] = [share(&pressures, ranges[0]), share(&lengths, ranges[1])];
        let rate = |values: &[f64]| -> Vec<f64> {
            let around = |at: usize| (at.saturating_sub(1), (at + 1).min(n - 1));
            (0..n).map(|at| values[around(at).1] - values[around(at).0]).collect()
        };
        let of_both =
            |of: &dyn Fn(f64, f64) -> f64| -> Vec<f64> { p.iter().zip(&l).map(|(&p, &l)| of(p, l)).collect() };
        let bent: Vec<f64> = (0..n)
            .map(|at| {
                let (before, after) = (lengths[at.saturating_sub(1)], lengths[(at + 1).min(n - 1)]);
                (after - 2.0 * lengths[at] + before) / self.period_s.powi(2)
            })
            .collect();
        let columns: [Vec<f64>; COLUMNS + 1] = [
            of_both(&|p, _| p),
            of_both(&|_, l| l),
            of_both(&|p, _| p * p),
            of_both(&|p, l| p * l),
            of_both(&|_, l| l * l),
            of_both(&|p, _| p * p * p),
            of_both(&|p, l| p * p * l),
            of_both(&|p, l| p * l * l),
            of_both(&|_, l| l * l * l),
            rate(&p),
            rate(&l),
            directions.iter().zip(&p).map(|(direction, p)| direction * p).collect(),
            directions,
            bent.clone(),
            residuals,
        ];
        let columns = columns.map(|values| {
            let slowly = averaged(&values, &even);
            values.iter().zip(slowly).map(|(value, slow)| value - slow).collect::<Vec<f64>>()
        });
        (half + 1..n - half - 1)
            .map(|at| Row {
                columns: SVector::from_fn(|index, _| columns[index][at]),
                residual_n: columns[COLUMNS][at],
                acceleration_m_per_s2: bent[at],
            })
            .filter(|row| row.residual_n.is_finite() && row.columns.iter().all(|value| value.is_finite()))
            .collect()
    }
}

/// What changes fast at one time.
struct Row {
    columns: SVector<f64, COLUMNS>,
    residual_n: f64,
    acceleration_m_per_s2: f64,
}

/// Averages of `values` with `weights` around each; the window is cut at either end.
fn averaged(values: &[f64], weights: &[f64]) -> Vec<f64> {
    let half = weights.len() / 2;
    let at_most = |at: usize| (at + half + 1).min(values.len());
    (0..values.len())
        .map(|at| {
            let first = at.saturating_sub(half);
            let near = values[first..at_most(at)].iter().zip(&weights[first + half - at..]);
            let (sum, all) = near.fold((0.0, 0.0), |(sum, all), (value, weight)| (sum + weight * value, all + weight));
            sum / all
        })
        .collect()
}

/// Normal equations of a piece.
#[derive(Clone)]
struct Sums {
    products: SMatrix<f64, COLUMNS, COLUMNS>,
    with_residual: SVector<f64, COLUMNS>,
    /// Residual squared, in N².
    square: f64,
    /// Weights of the rows.
    n: f64,
}

impl Sums {
    fn of(rows: &[Row], scales: &SVector<f64, COLUMNS>, usual_n: f64) -> Self {
        let mut sums = Self::total(&[]);
        for row in rows {
            let weight = (OUTLYING * usual_n / row.residual_n.abs().max(f64::MIN_POSITIVE)).min(1.0);
            let columns = row.columns.component_div(scales);
            sums.products += weight * columns * columns.transpose();
            sums.with_residual += weight * row.residual_n * columns;
            sums.square += weight * row.residual_n.powi(2);
            sums.n += weight;
        }
        sums
    }

    fn total(pieces: &[&Self]) -> Self {
        let none = Self { products: SMatrix::zeros(), with_residual: SVector::zeros(), square: 0.0, n: 0.0 };
        pieces.iter().fold(none, |sums, piece| Self {
            products: sums.products + piece.products,
            with_residual: sums.with_residual + piece.with_residual,
            square: sums.square + piece.square,
            n: sums.n + piece.n,
        })
    }

    /// Weights of the columns; that of the acceleration is zero unless `with_mass`.
    fn solved(&self, with_mass: bool) -> Option<SVector<f64, COLUMNS>> {
        let Self { mut products, mut with_residual, .. } = self.clone();
        if !with_mass {
            products.column_mut(CLEARED).fill(0.0);
            products.row_mut(CLEARED).fill(0.0);
            with_residual[CLEARED] = 0.0;
        }
        products.svd(true, true).solve(&with_residual, 1e-9 * products.norm()).ok()
    }

    /// Mean square in N² that `weights` leave.
    fn left(&self, weights: &SVector<f64, COLUMNS>) -> f64 {
        let square = self.square - 2.0 * weights.dot(&self.with_residual) + weights.dot(&(self.products * weights));
        square.max(0.0) / self.n.max(f64::MIN_POSITIVE)
    }
}

/// The mass that swings in `stretches`, where it is surely there and matters.
pub(super) fn mass(stretches: &[Stretch], sizes: &Sizes) -> Option<MovingMass> {
    fitted(stretches).filter(|mass| {
        let (_, heaviest_kg) = MovingMass::effect().amplitudes()[0].range;
        mass.mass_kg.abs() < heaviest_kg
            && mass.mass_kg.abs() > SURELY * mass.mass_stderr_kg
            && mass.all_rows_n > KEPT * sizes.beyond_noise_n()
    })
}

/// The mass that follows `stretches` best, of any size; none where these are too short.
fn fitted(stretches: &[Stretch]) -> Option<MovingMass> {
    let bins = || stretches.iter().flat_map(|stretch| &stretch.bins);
    let range = |channel: usize| crate::coverage::range(bins().map(|bin| bin[channel]));
    let ranges = [range(0), range(1)];
    let rows: Vec<Row> = stretches.iter().flat_map(|stretch| stretch.fast(&ranges)).collect();
    if rows.len() < LEAST * PIECES {
        return None;
    }
    let mut deviations: Vec<f64> = rows.iter().map(|row| row.residual_n.abs()).collect();
    let middle = deviations.len() / 2;
    let usual_n = 1.4826 * *deviations.select_nth_unstable_by(middle, f64::total_cmp).1;
    let mean_square =
        |of: &dyn Fn(&Row) -> f64| rows.iter().map(|row| of(row).powi(2)).sum::<f64>() / rows.len() as f64;
    let scales = SVector::from_fn(|index, _| mean_square(&|row| row.columns[index]).sqrt().max(f64::MIN_POSITIVE));
    let pieces: Vec<Sums> =
        rows.chunks(rows.len().div_ceil(PIECES)).map(|piece| Sums::of(piece, &scales, usual_n)).collect();
    let total = |takes: &dyn Fn(usize) -> bool| {
        let taken: Vec<&Sums> =
            pieces.iter().enumerate().filter(|(at, _)| takes(*at)).map(|(_, piece)| piece).collect();
        Sums::total(&taken)
    };
    let mass_kg = |sums: &Sums| Some(sums.solved(true)?[CLEARED] / scales[CLEARED]);
    let others: Option<Vec<f64>> = (0..pieces.len()).map(|out| mass_kg(&total(&|at| at != out))).collect();
    let left = |with_mass: bool| -> Option<HeldOut> {
        let folds: Option<Vec<_>> = (0..FOLDS).map(|fold| total(&|at| at % FOLDS != fold).solved(with_mass)).collect();
        let folds = folds?;
        let blocks = pieces.iter().enumerate().map(|(at, piece)| piece.left(&folds[at % FOLDS])).collect();
        Some(HeldOut { blocks, counts: pieces.iter().map(|piece| piece.n).collect(), floor_square: 0.0 })
    };
    let mass_kg = mass_kg(&total(&|_| true))?;
    Some(MovingMass {
        mass_kg,
        mass_stderr_kg: jackknife_stderr(others?.into_iter()),
        // What is averaged over so long says nothing of a mount.
        mount_hz: MovingMass::effect().shape()[0].range.1,
        without: left(false)?,
        with: left(true)?,
        all_rows_n: mass_kg.abs() * mean_square(&|row| row.acceleration_m_per_s2).sqrt(),
        motion: Motion::Swings,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    use pam_artifact::model::ParameterStatus;
    use std::f64::consts::TAU;

    const PERIOD_S: f64 = 0.005;

    /// Two minutes of a length that swings at one and three hertz while the pressure rises and falls slowly, with what `left_n` says of
    /// pressure in Pa, length in m, speed of lengthening in m/s and its rate, and time in s.
    fn swung(left_n: impl Fn(f64, f64, f64, f64, f64) -> f64) -> Vec<Stretch> {
        let first = Given::of(&["isobaric-triangles"], &[]).track.instants[0];
        let mut stretch = Stretch::every(PERIOD_S);
        for row in 0..24_000 {
            let time_s = PERIOD_S * f64::from(row);
            let swings = [(0.008, 1.0), (0.002, 3.0)];
            let [length_m, speed, rate] = [0, 1, 2].map(|times| {
                let each = swings.map(|(size_m, hz)| {
                    let angle = TAU * hz * time_s + FRAC_PI_2 * f64::from(times);
                    size_m * (TAU * hz).powi(times) * angle.sin()
                });
                each.iter().sum::<f64>()
            });
            let pressure_pa = 2e5 + 1e5 * (0.2 * time_s).sin();
            let wobble_n = 0.3 * (f64::from(row * 7919 % 1013) / 506.0 - 1.0);
            let mut instant = first;
            instant.moment.pressure_pa = pressure_pa;
            instant.moment.length_m = 0.25 + length_m;
            instant.moment.direction = -speed.signum();
            instant.force_n = left_n(pressure_pa, length_m, speed, rate, time_s) + wobble_n;
            stretch.push(&instant, 0.0);
        }
        vec![stretch]
    }

    /// Sizes where noise leaves 0.2 N.
    fn sizes() -> Sizes {
        let mut sizes = crate::verdict::cases::SIZES;
        (sizes.sensors_n, sizes.limited) = (0.2, false);
        sizes
    }

    #[test]
    fn a_mass_is_found_beside_what_is_slow_and_many_times_larger() {
        let drifts = |pressure_pa: f64, length_m: f64, _: f64, rate: f64, time_s: f64| {
            1.5 * rate + 8.0 * (0.05 * time_s).sin() + 4e-11 * pressure_pa.powi(2) + 2e5 * length_m.powi(2)
        };
        let mass = mass(&swung(drifts), &sizes()).expect("a mass");
        assert!((mass.mass_kg / 1.5 - 1.0).abs() < 0.05 && mass.mass_stderr_kg < 0.05, "{mass:?}");
        assert!(mass.with.mean_square() < 0.5 * mass.without.mean_square() && !mass.knocks(), "{mass:?}");
        assert!(mass.region(1.0).is_none());
        assert_eq!(mass.entries()[0].status, ParameterStatus::Fixed);
    }

    #[test]
    fn damping_a_late_channel_and_friction_are_no_mass() {
        assert!(mass(&swung(|_, _, speed, _, _| 40.0 * speed), &sizes()).is_none());
        // It turns over only where a quarter of the speed is reached.
        assert!(mass(&swung(|_, _, speed, _, _| -3.0 * (speed / 0.02).tanh()), &sizes()).is_none());
        assert!(mass(&swung(|_, length_m, _, _, _| 2000.0 * length_m), &sizes()).is_none());
        assert!(mass(&swung(|_, _, _, _, _| 0.0), &sizes()).is_none());
    }

    #[test]
    fn a_mass_that_pulls_less_than_the_sensors_leave_does_not_matter() {
        let stretches = swung(|_, _, _, rate, _| 0.1 * rate);
        let found = fitted(&stretches).expect("a fit");
        assert!((found.mass_kg - 0.1).abs() < 0.02 && found.mass_kg > SURELY * found.mass_stderr_kg, "{found:?}");
        assert!(mass(&stretches, &Sizes { sensors_n: 2.0 * found.all_rows_n, ..sizes() }).is_none());
    }

    #[test]
    fn what_is_too_short_or_too_coarse_tells_nothing() {
        let mut short = swung(|_, _, _, rate, _| 1.5 * rate);
        short[0].bins.truncate(LEAST * PIECES);
        assert!(fitted(&short).is_none());
        // Half a second of two bins has nothing that is fast.
        let mut coarse = swung(|_, _, _, rate, _| 1.5 * rate);
        coarse[0].period_s = 0.3;
        assert!(fitted(&coarse).is_none());
    }
}
