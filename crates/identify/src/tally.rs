//! Sums over samples beside a model, which merge.

use pam_artifact::model::FitStatistics;
use pam_artifact::summary::TallySums;
use pam_muscle::force::ForceModel;

use crate::error::IdentifyError;
use crate::evaluate::without_force;
use crate::prepare::Prepared;

/// Where a model first gave no number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoForceAt {
    /// Time, in s.
    pub time_s: f64,
    /// Gauge pressure, in Pa.
    pub pressure_pa: f64,
    /// Length, in m.
    pub length_m: f64,
}

/// Sums over samples whose direction is settled.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Tally {
    n_samples: usize,
    n_unsettled: usize,
    /// Samples that would count, had the model a force for them, and the first of them.
    n_without_force: usize,
    first_without_force: Option<NoForceAt>,
    residuals: f64,
    residual_squares: f64,
    unsettled_squares: f64,
    largest: f64,
    forces: f64,
    force_squares: f64,
    first_force_n: f64,
}

impl Tally {
    pub(crate) fn push(&mut self, force_n: f64, model_n: f64, at: impl FnOnce() -> NoForceAt) {
        let residual_n = force_n - model_n;
        // Its square is what is summed.
        if !(residual_n * residual_n).is_finite() {
            self.n_without_force += 1;
            self.first_without_force.get_or_insert_with(at);
            return;
        }
        if self.n_samples == 0 {
            self.first_force_n = force_n;
        }
        self.n_samples += 1;
        self.residuals += residual_n;
        self.residual_squares += residual_n * residual_n;
        self.largest = self.largest.max(residual_n.abs());
        // Relative to the first force, so that a large mean costs no digits.
        let relative_n = force_n - self.first_force_n;
        self.forces += relative_n;
        self.force_squares += relative_n * relative_n;
    }

    pub(crate) fn push_unsettled(&mut self, force_n: f64, model_n: f64) {
        let residual_n = force_n - model_n;
        if (residual_n * residual_n).is_finite() {
            self.n_unsettled += 1;
            self.unsettled_squares += residual_n * residual_n;
        }
    }

    pub(crate) fn merge(&mut self, other: &Self) {
        self.n_unsettled += other.n_unsettled;
        self.unsettled_squares += other.unsettled_squares;
        self.n_without_force += other.n_without_force;
        self.first_without_force = self.first_without_force.or(other.first_without_force);
        if other.n_samples == 0 {
            return;
        }
        if self.n_samples == 0 {
            self.first_force_n = other.first_force_n;
        }
        let shift_n = other.first_force_n - self.first_force_n;
        let n = other.n_samples as f64;
        self.force_squares += other.force_squares + 2.0 * shift_n * other.forces + n * shift_n * shift_n;
        self.forces += other.forces + n * shift_n;
        self.n_samples += other.n_samples;
        self.residuals += other.residuals;
        self.residual_squares += other.residual_squares;
        self.largest = self.largest.max(other.largest);
    }

    /// Refuses statistics over nothing, or over what is left after a model gave no force.
    pub(crate) fn judge(&self, prepared: &Prepared, model: &ForceModel) -> Result<(), IdentifyError> {
        let path = || prepared.recording.path.clone();
        if let Some(at) = self.first_without_force {
            let n_counted = self.n_samples + self.n_without_force;
            return Err(without_force(path(), self.n_without_force, n_counted, at, model));
        }
        if self.n_samples == 0 {
            return Err(IdentifyError::NothingCounted { path: path(), n_rows: prepared.quality.n_rows });
        }
        Ok(())
    }

    /// As a summary of a shard has it.
    pub(crate) fn sums(&self, noise_floor: [f64; 2]) -> TallySums {
        TallySums {
            n_samples: self.n_samples,
            n_unsettled: self.n_unsettled,
            n_without_force: self.n_without_force,
            first_without_force: self.first_without_force.map(|at| [at.time_s, at.pressure_pa, at.length_m]),
            residuals: self.residuals,
            residual_squares: self.residual_squares,
            unsettled_squares: self.unsettled_squares,
            largest: self.largest,
            first_force_n: self.first_force_n,
            forces: self.forces,
            force_squares: self.force_squares,
            noise_floor,
        }
    }

    /// From a summary of a shard.
    pub(crate) fn of_sums(sums: &TallySums) -> Self {
        let at = |[time_s, pressure_pa, length_m]: [f64; 3]| NoForceAt { time_s, pressure_pa, length_m };
        Self {
            n_samples: sums.n_samples,
            n_unsettled: sums.n_unsettled,
            n_without_force: sums.n_without_force,
            first_without_force: sums.first_without_force.map(at),
            residuals: sums.residuals,
            residual_squares: sums.residual_squares,
            unsettled_squares: sums.unsettled_squares,
            largest: sums.largest,
            forces: sums.forces,
            force_squares: sums.force_squares,
            first_force_n: sums.first_force_n,
        }
    }

    /// Mean residual, in N.
    pub(crate) fn mean_n(&self) -> f64 {
        self.residuals / self.n_samples.max(1) as f64
    }

    pub(crate) fn statistics(&self) -> FitStatistics {
        let n = self.n_samples.max(1) as f64;
        let spread = (self.force_squares - self.forces * self.forces / n).max(f64::MIN_POSITIVE);
        let share = self.residual_squares / spread;
        // A force that never varies, as under a dead weight, leaves nothing of itself to explain.
        let share = if share.is_finite() { share } else { 1.0 };
        FitStatistics {
            rmse_n: (self.residual_squares / n).sqrt(),
            rmse_all_n: ((self.residual_squares + self.unsettled_squares)
                / (self.n_samples + self.n_unsettled).max(1) as f64)
                .sqrt(),
            max_n: self.largest,
            r2: 1.0 - share,
            fit_percent: 100.0 * (1.0 - share.sqrt()),
            n_samples: self.n_samples,
            n_unsettled: self.n_unsettled,
        }
    }
}
