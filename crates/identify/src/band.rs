//! The interval in which a force is to be expected where a model predicts one.
//!
//! ```text
//! F ± z √(gᵀ C g + r²),   gᵢ = ∂F/∂θᵢ,   C = covariance of the estimates
//! ```
//!
//! | symbol | code         | unit | meaning                                                                     |
//! |--------|--------------|------|-----------------------------------------------------------------------------|
//! | `z`    | [`Z`]        | 1    | quantile of the normal distribution, 95 % to both sides                     |
//! | `r`    | `residual_n` | N    | RMSE over all samples of recordings held out of the fit, or else of its own |
//!
//! The residual holds noise, missing physics and what effects' parameters are uncertain by; the covariance is that of the base
//! parameters. It is what the recordings of the fit tell: outside their operating range the force may be anywhere. The
//! gradient is a central difference over a standard error to either side, so that it sees the curvature that matters.

use pam_artifact::ModelArtifact;
use pam_artifact::estimates::{Estimates, EstimatesError};
use pam_muscle::force::ForceModel;

/// Share of samples that the interval is meant to hold.
pub const LEVEL: f64 = 0.95;
/// Half of the interval in standard deviations.
pub const Z: f64 = 1.959_963_984_540_054;

/// What makes up the interval of a model.
#[derive(Debug, Clone)]
pub struct PredictiveBand {
    /// The model with each estimate a standard error lower and higher.
    moved: Vec<[ForceModel; 2]>,
    correlation: Vec<Vec<f64>>,
    /// Residual, in N.
    pub residual_n: f64,
    /// Whether that is of recordings that were held out.
    pub residual_is_held_out: bool,
}

impl PredictiveBand {
    /// Of an artifact.
    ///
    /// # Errors
    /// [`EstimatesError`] where its uncertainty is incomplete.
    pub fn of(artifact: &ModelArtifact) -> Result<Self, EstimatesError> {
        let estimates = Estimates::of(artifact)?;
        let model = artifact.force_model();
        let moved = |index: usize| {
            [-1.0, 1.0].map(|sign| {
                let mut shifts = vec![0.0; estimates.len()];
                shifts[index] = sign * estimates.stderr()[index];
                estimates.shifted(&model, &shifts)
            })
        };
        let fit = &artifact.fit;
        let residual = fit.validation.unwrap_or(fit.estimation);
        Ok(Self {
            moved: (0..estimates.len()).map(moved).collect(),
            correlation: estimates.correlation().to_vec(),
            residual_n: residual.rmse_all_n.max(residual.rmse_n),
            residual_is_held_out: fit.validation.is_some(),
        })
    }

    /// Half of the interval at a pressure in Pa, a length in m and a direction of motion, in N; that of the residual alone
    /// where a moved model has no force.
    pub fn half_width_n(&self, pressure_pa: f64, length_m: f64, direction: f64) -> f64 {
        let slope = |[low, high]: &[ForceModel; 2]| {
            let [low_n, high_n] = [low, high].map(|model| model.force_n(pressure_pa, length_m, direction));
            0.5 * (high_n - low_n)
        };
        let gradient: Vec<f64> = self.moved.iter().map(slope).collect();
        let mut variance = 0.0;
        for (row, left) in self.correlation.iter().zip(&gradient) {
            for (correlation, right) in row.iter().zip(&gradient) {
                variance += left * correlation * right;
            }
        }
        let variance = if variance.is_finite() { variance.max(0.0) } else { 0.0 };
        Z * (variance + self.residual_n * self.residual_n).sqrt()
    }
}
