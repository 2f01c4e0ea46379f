//! Inertial transients: what a mass does to the load cell where a drive starts, stops or turns.
//!
//! They last some tens of milliseconds, much of that where the direction is not settled: the grid of a [`crate::track`]
//! smooths them over or does not count them. So they are looked for in the samples as recorded, in what the model leaves
//! there. Around each knock, the residual is cleared of a level, a slope and, until something explains that, what goes with
//! the speed (friction, damping, delays); what remains must be one mass times the acceleration behind one mount
//! ([`pam_muscle::effects::Mount`]), the same in all knocks.

mod line;

use std::ops::Range;

use pam_artifact::ModelArtifact;
use pam_artifact::diagnosis::Region;
use pam_artifact::model::ParameterEntry;
use pam_identification::error::IdentifyError;
use pam_identification::predict::walk_augmented;
use pam_identification::prepare::Prepared;
use pam_muscle::Coordinate;
use pam_muscle::direction::Thresholds;
use pam_muscle::effects::{AugmentedModel, Effect, Mount, Term, effect};
use rayon::prelude::*;

use crate::joint::HeldOut;
use crate::search::{Limits, chance};
use crate::track::FOLDS;
use crate::uncertainty::entry;
use crate::verdict::Sizes;

use line::{Knock, Line, Sums};

/// Catalogue id of what knocks.
pub const ID: &str = "inertia";

/// Transients that are needed.
const LEAST_KNOCKS: usize = 8;
/// The largest mass may be passed by so much as long as its size is not all that well known.
const PASSED: f64 = 1.5;
/// Times the noise floor that it must amount to in them, root mean square.
const TIMES_FLOOR: f64 = 3.0;
/// Probability by chance that is still believed.
const CHANCE: f64 = 1e-3;
/// Rounds in which the frequency of the mount is looked for between its neighbors.
const ROUNDS: usize = 3;
/// Frequencies of the mount that are tried first, in Hz.
const MOUNTS_HZ: [f64; 8] = [12.0, 16.0, 20.0, 25.0, 30.0, 40.0, 60.0, 120.0];

/// What the residual around knocks may still hold beside them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Residual {
    /// Friction, damping or a delay that nobody has looked for yet: what goes with the speed is cleared away, and knees are
    /// averaged over some rows. A mass is found beside it whatever its mount, and its size less well: the speed takes up what
    /// the mount has of another shape.
    WithSpeed,
    /// All of that has been looked for without the knocks. A mass has been found; this is its size.
    Explained,
}

impl Residual {
    /// How many of level, slope and speed are cleared away.
    fn n_cleared(self) -> usize {
        match self {
            Self::WithSpeed => 3,
            Self::Explained => 2,
        }
    }

    /// Share of what is left in the knocks that one mass must explain where it was not fitted.
    fn least_explained(self) -> f64 {
        match self {
            Self::WithSpeed => 0.75,
            Self::Explained => 0.5,
        }
    }
}

/// A mass that knocks.
#[derive(Debug, Clone)]
pub struct InertialTransient {
    mass_kg: f64,
    mass_stderr_kg: f64,
    mount_hz: f64,
    /// Mean squares of every knock without the mass and with it, each with the mass of the other folds.
    pub without: HeldOut,
    /// With it.
    pub with: HeldOut,
    /// What the mass explains, root mean square over all rows, in N.
    pub all_rows_n: f64,
    /// Rows around every knock, with the number of the recording.
    pub touched: Vec<(usize, Range<usize>)>,
    /// Lowest and highest speed that is come from or gone to, in m/s.
    speeds_m_per_s: (f64, f64),
}

impl InertialTransient {
    /// Those in what `explained` leaves, where they matter and a mass may be named beside what it has.
    ///
    /// # Errors
    /// [`IdentifyError::Samples`] where samples cannot be read back.
    pub fn that_matter(
        recordings: &[Prepared],
        explained: &AugmentedModel,
        model: &ModelArtifact,
        limits: &Limits,
        sizes: &Sizes,
        residual: Residual,
    ) -> Result<Option<Self>, IdentifyError> {
        if explained.terms().len() >= limits.max_effects || limits.excluded.iter().any(|id| id == ID) {
            return Ok(None);
        }
        let knocks = Self::all(recordings, explained, model.direction, residual)?;
        if knocks.len() < LEAST_KNOCKS {
            return Ok(None);
        }
        let n_rows: usize = recordings.iter().map(|prepared| prepared.recording.samples.n_rows()).sum();
        let knocks = Self::fitted(&knocks, n_rows, sizes.floor_n, residual);
        // Averaged as accelerations are, a knock keeps about half of its size.
        let matters_n = if sizes.limited { sizes.matters_n } else { 0.5 * sizes.matters_n };
        Ok(knocks.filter(|knocks| knocks.all_rows_n > matters_n))
    }

    /// All in `recordings`, with what `model` leaves around them. `thresholds` are those of the direction.
    fn all(
        recordings: &[Prepared],
        model: &AugmentedModel,
        thresholds: Thresholds,
        residual: Residual,
    ) -> Result<Vec<Knock>, IdentifyError> {
        let found: Result<Vec<Vec<Knock>>, IdentifyError> = recordings
            .par_iter()
            .enumerate()
            .map(|(index, prepared)| {
                let mut lines: Vec<Line> = Vec::new();
                walk_augmented(prepared, model, thresholds, index, &mut |instant, model_n| {
                    if instant.moment.step_s == 0.0 || lines.is_empty() {
                        let n_rows = prepared.recording.segments.get(lines.len()).map_or(0, ExactSizeIterator::len);
                        lines.push(Line::of_rows(n_rows, index, instant));
                    }
                    if let Some(line) = lines.last_mut() {
                        line.ends_s[1] = instant.moment.time_s;
                        line.accelerations.push(instant.moment.acceleration_m_per_s2);
                        line.speeds.push(instant.moment.speed_m_per_s);
                        line.knees.push(instant.knee);
                        line.residuals_n.push(instant.force_n - model_n);
                    }
                })
                .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
                Ok(lines.iter().flat_map(|line| line.knocks(residual)).collect())
            })
            .collect();
        Ok(found?.into_iter().flatten().collect())
    }

    /// The mass that explains `knocks` in `n_rows` rows, where noise leaves `floor_n` of any model; none where there is none.
    fn fitted(knocks: &[Knock], n_rows: usize, floor_n: f64, residual: Residual) -> Option<Self> {
        let (mount_hz, sums) = Self::mounted(knocks, residual);
        let rest = |fold: usize| sums.iter().enumerate().filter(move |(index, _)| index % FOLDS != fold);
        let others: Vec<f64> = (0..FOLDS).map(|fold| Sums::total(rest(fold).map(|(_, sums)| sums)).slope()).collect();
        let mean = others.iter().sum::<f64>() / FOLDS as f64;
        let n = FOLDS as f64;
        let variance = (n - 1.0) / n * others.iter().map(|slope| (slope - mean).powi(2)).sum::<f64>();
        let counts: Vec<f64> = sums.iter().map(|sums| sums.rows).collect();
        let without = HeldOut {
            blocks: sums.iter().map(|sums| sums.yy / sums.rows).collect(),
            counts: counts.clone(),
            floor_square: 0.0,
        };
        let with = HeldOut {
            blocks: sums
                .iter()
                .enumerate()
                .map(|(index, sums)| sums.left_by(others[index % FOLDS]) / sums.rows)
                .collect(),
            counts,
            floor_square: 0.0,
        };
        let explained = without.mean_square() - with.mean_square();
        // The columns of the effect are the negative acceleration.
        let mass_kg = -Sums::total(&sums).slope();
        let (_, heaviest_kg) = Self::effect().amplitudes()[0].range;
        let passed = if residual == Residual::WithSpeed { PASSED } else { 1.0 };
        let believed = mass_kg.abs() <= passed * heaviest_kg
            && explained > residual.least_explained() * (without.mean_square() - floor_n.powi(2))
            && explained > (TIMES_FLOOR * floor_n).powi(2)
            && chance(&without, &with) < CHANCE;
        let mut speeds: Vec<f64> = knocks.iter().map(|knock| knock.fastest_m_per_s).collect();
        speeds.sort_by(f64::total_cmp);
        believed.then(|| Self {
            mass_kg,
            mass_stderr_kg: variance.sqrt(),
            mount_hz,
            all_rows_n: (explained * Sums::total(&sums).rows / n_rows.max(1) as f64).sqrt(),
            without,
            with,
            touched: knocks.iter().map(|knock| knock.place.clone()).collect(),
            speeds_m_per_s: (speeds[speeds.len() / 20], speeds[speeds.len() - 1]),
        })
    }

    /// The mount that explains most of `knocks`, in Hz, and the sums behind it.
    fn mounted(knocks: &[Knock], residual: Residual) -> (f64, Vec<Sums>) {
        let tried = |mount_hz: f64| {
            let sums: Vec<Sums> = knocks.iter().map(|knock| knock.sums(mount_hz, residual)).collect();
            (Sums::total(&sums).left(), mount_hz, sums)
        };
        let better = |best: (f64, f64, Vec<Sums>), mount_hz: f64| {
            let trial = tried(mount_hz);
            if trial.0 < best.0 { trial } else { best }
        };
        let (softest, stiffest) = (MOUNTS_HZ[0], MOUNTS_HZ[MOUNTS_HZ.len() - 1]);
        let mut best = MOUNTS_HZ.into_iter().fold((f64::INFINITY, softest, Vec::new()), better);
        let mut factor: f64 = 1.12;
        for _ in 0..ROUNDS {
            let center = best.1;
            best = [center / factor, center * factor]
                .into_iter()
                .fold(best, |best, mount_hz| better(best, mount_hz.clamp(softest, stiffest)));
            factor = factor.sqrt();
        }
        (best.1, best.2)
    }

    /// The effect.
    ///
    /// # Panics
    /// Never: the catalogue has it.
    #[expect(clippy::expect_used, reason = "the catalogue is fixed")]
    pub fn effect() -> &'static dyn Effect {
        effect(ID).expect("the catalogue has inertia")
    }

    /// The same with a mass that physics has.
    #[must_use]
    pub fn within_range(mut self) -> Self {
        let (lightest_kg, heaviest_kg) = Self::effect().amplitudes()[0].range;
        self.mass_kg = self.mass_kg.clamp(lightest_kg, heaviest_kg);
        self
    }

    /// The mass, in kg.
    pub fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// What it hangs on, at rest.
    pub fn mount(&self) -> Mount {
        Mount::new(self.mount_hz)
    }

    /// The effect with its values.
    pub fn term(&self) -> Term {
        Term::new(Self::effect(), vec![self.mount_hz], vec![self.mass_kg])
    }

    /// Its parameters, as an artifact has them.
    pub fn entries(&self) -> Vec<ParameterEntry> {
        let (shape, amplitude) = (&Self::effect().shape()[0], &Self::effect().amplitudes()[0]);
        vec![
            entry(shape.name, shape.unit, self.mount_hz, shape.range, None),
            entry(amplitude.name, amplitude.unit, self.mass_kg, amplitude.range, Some(self.mass_stderr_kg)),
        ]
    }

    /// Where it shows: at speeds that are come from or gone to at once; `mismatch_n` is the whole mismatch.
    pub fn region(&self, mismatch_n: f64) -> Region {
        Region {
            coordinate: Coordinate::Speed,
            from: self.speeds_m_per_s.0,
            to: self.speeds_m_per_s.1,
            unit: Coordinate::Speed.unit().to_owned(),
            share_of_excess: (self.all_rows_n / mismatch_n).powi(2).min(1.0),
            p_value: chance(&self.without, &self.with),
            recording: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use pam_muscle::smoothing::acceleration_weights;

    use super::*;

    const PERIOD_S: f64 = 0.005;
    /// Steps of the truth in one period.
    const FINE: usize = 50;

    /// Moves between two lengths with holds, at speeds that change from move to move. `pull` gives the force at a speed and an
    /// acceleration of an underdamped mount, which is another one than the fit has.
    fn line(pull: impl Fn(f64, f64) -> f64) -> Line {
        let mut line = Line::default();
        let (mut place_m, mut along_m, mut along_m_per_s) = (0.0, 0.0, 0.0);
        let rad_per_s = TAU * 30.0;
        let mut fine = Vec::new();
        for index in 0..24 {
            let speed = 0.02 * f64::from(1 + index % 5) * if index % 2 == 0 { 1.0 } else { -1.0 };
            for (drive_m_per_s, duration_s) in [(speed, 0.1), (0.0, 0.4)] {
                for _ in 0..(duration_s / PERIOD_S * FINE as f64).round() as usize {
                    let step_s = PERIOD_S / FINE as f64;
                    place_m += drive_m_per_s * step_s;
                    let acceleration = rad_per_s * (rad_per_s * (place_m - along_m) - 1.4 * along_m_per_s);
                    along_m_per_s += acceleration * step_s;
                    along_m += along_m_per_s * step_s;
                    fine.push((place_m, pull(drive_m_per_s, acceleration)));
                }
            }
        }
        let rows: Vec<(f64, f64)> = fine.iter().skip(FINE / 2).step_by(FINE).copied().collect();
        let weights = acceleration_weights(PERIOD_S);
        let half = weights.len() / 2;
        for at in 0..rows.len() {
            let place = |row: usize| rows[row.clamp(1, rows.len() - 2)].0;
            let bend = |row: usize| place(row + 1) - 2.0 * place(row) + place(row.max(1) - 1);
            let averaged: f64 =
                weights.iter().enumerate().map(|(index, weight)| weight * bend((at + index).max(half) - half)).sum();
            line.ends_s[1] = at as f64 * PERIOD_S;
            line.accelerations.push(averaged / (PERIOD_S * PERIOD_S));
            line.speeds.push((place(at + 8) - place(at.max(8) - 8)) / (16.0 * PERIOD_S));
            line.knees.push(false);
            line.residuals_n.push(rows[at].1);
        }
        line
    }

    fn found(pull: impl Fn(f64, f64) -> f64) -> Option<InertialTransient> {
        let line = line(pull);
        let knocks = line.knocks(Residual::WithSpeed);
        assert!(knocks.len() >= 40, "{}", knocks.len());
        InertialTransient::fitted(&knocks, line.accelerations.len(), 0.05, Residual::WithSpeed)
    }

    #[test]
    fn a_mass_is_found_behind_another_mount() {
        let knocks = found(|_, acceleration| -2.0 * acceleration).expect("a mass");
        assert!((knocks.mass_kg / 2.0 - 1.0).abs() < 0.2, "{knocks:?}");
    }

    #[test]
    fn damping_and_friction_are_no_mass() {
        assert!(found(|speed, _| 100.0 * speed).is_none());
        assert!(found(|speed, _| 5.0 * speed.signum() * f64::from(u8::from(speed != 0.0))).is_none());
        assert!(found(|_, _| 0.0).is_none());
    }

    #[test]
    fn what_differs_from_knock_to_knock_is_no_mass() {
        let sign = std::cell::Cell::new(0_u64);
        let odd = |_: f64, acceleration: f64| {
            sign.set(sign.get().wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1));
            acceleration * if sign.get() >> 63 == 0 { 1.0 } else { -1.0 }
        };
        assert!(found(odd).is_none());
    }
}
