//! What was found, and its artifact.

use pam_artifact::model::{
    Correlation, Domain, FitReport, IdentifyConfig, ModelArtifact, RecordingFit, SCHEMA, SearchReport, StandstillFit,
    StartReport, UnboundedFit,
};
use pam_artifact::{Input, Tool};
use pam_muscle::direction::Thresholds;
use pam_muscle::force::ForceModel;
use pam_muscle::{Dimension, Muscle};

use crate::error::IdentifyError;
use crate::evaluate::Evaluation;
use crate::fit::Fit;
use crate::prepare::Prepared;
use crate::report;
use crate::search_space::{Free, SearchSpace};
use crate::trace::{Trace, trace};
use crate::uncertainty::Uncertainty;

/// What was found.
#[derive(Debug)]
pub struct Identified {
    /// The muscle, fitted dimensions as fitted.
    pub muscle: Muscle,
    /// Eq. 11 with the values found.
    pub model: ForceModel,
    /// What was moved.
    pub space: SearchSpace,
    /// Dimensions that were moved, in the order of the coordinates after those of `space`.
    pub freed: Vec<Dimension>,
    /// The search.
    pub fit: Fit,
    /// How well the result is known.
    pub uncertainty: Uncertainty,
    /// Parameters that the recordings cannot identify, held at their nominal values.
    pub unidentifiable: Vec<Free>,
    /// Thresholds of the direction.
    pub thresholds: Thresholds,
    /// Laws of friction at standstill that were compared, the one taken first.
    pub laws: Vec<StandstillFit>,
    /// Whether only what was held out tells them apart.
    pub told_by_validation: bool,
    /// Estimation recordings.
    pub estimation: Vec<Prepared>,
    /// Validation recordings.
    pub validation: Vec<Prepared>,
    /// Agreement on the estimation recordings.
    pub estimation_fit: Evaluation,
    /// Agreement on the validation recordings.
    pub validation_fit: Evaluation,
    /// Weights without bounds, where asked for.
    pub unbounded: Option<UnboundedFit>,
    /// White noise of the force channel, in N.
    pub force_noise_n: f64,
    /// What the noise of all channels leaves of a perfect model, in N.
    pub noise_floor_n: f64,
    /// Lowest RMSE that the columns allow, in N.
    pub column_floor_rmse_n: f64,
    /// Cosines between the forces of `C₁₀` and `C₀₁`, and of the two frictions.
    pub twin_cosines: [f64; 2],
    /// What a person should know.
    pub warnings: Vec<String>,
}

impl Identified {
    /// Samples of every recording beside the model, estimation first.
    ///
    /// # Errors
    /// [`IdentifyError::Samples`] where samples cannot be read back.
    pub fn traces(&self) -> Result<Vec<Trace>, IdentifyError> {
        self.estimation.iter().chain(&self.validation).map(|prepared| trace(prepared, &self.model)).collect()
    }

    /// Best RMSE after each iteration of each swarm, in N.
    pub fn convergence_n(&self) -> Vec<Vec<f64>> {
        self.fit.starts.iter().map(|start| start.swarm.history.iter().map(|cost| cost.sqrt()).collect()).collect()
    }

    /// The artifact.
    pub fn artifact(&self, tool: Tool, inputs: Vec<Input>, config: IdentifyConfig, seed: u64) -> ModelArtifact {
        let prepared = || self.estimation.iter().chain(&self.validation);
        let statistics = self.estimation_fit.each.iter().chain(&self.validation_fit.each);
        let range = |name: &str| {
            let channels = || self.estimation.iter().filter_map(|prepared| prepared.quality.channel(name));
            [
                channels().map(|channel| channel.lowest).fold(f64::INFINITY, f64::min),
                channels().map(|channel| channel.highest).fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        let fastest = |rate: fn(&Prepared) -> f64| self.estimation.iter().map(rate).fold(0.0, f64::max);
        ModelArtifact {
            schema: SCHEMA.to_owned(),
            tool,
            inputs,
            config,
            seed,
            muscle_name: None,
            geometry: self.muscle.clone(),
            strand_modulus_pa: self.model.strand_modulus_pa(),
            form: self.model.form(),
            parameters: report::parameters(self),
            composites: report::composites(self),
            effects: Vec::new(),
            correlation: Correlation {
                names: report::coordinate_names(self),
                matrix: self.uncertainty.correlation.row_iter().map(|row| row.iter().copied().collect()).collect(),
            },
            fit: FitReport {
                estimation: self.estimation_fit.each.first().map_or_else(
                    || unreachable!("a fit has recordings"),
                    |first| self.estimation_fit.together.unwrap_or(*first),
                ),
                validation: self.validation_fit.together,
                recordings: prepared()
                    .zip(statistics)
                    .map(|(prepared, &statistics)| RecordingFit { path: prepared.recording.path.clone(), statistics })
                    .collect(),
                noise_floor_n: self.noise_floor_n,
                force_noise_n: self.force_noise_n,
                effective_samples: self.uncertainty.effective_samples,
            },
            domain: Domain {
                pressure_pa: range("pressure"),
                length_m: range("length"),
                force_n: range("force"),
                length_rate_m_per_s: fastest(|prepared| prepared.quality.length_rate_m_per_s),
                pressure_rate_pa_per_s: fastest(|prepared| prepared.quality.pressure_rate_pa_per_s),
            },
            direction: self.thresholds,
            standstill_laws: if self.laws.len() > 1 { self.laws.clone() } else { Vec::new() },
            quality: prepared().map(|prepared| prepared.quality.clone()).collect(),
            search: SearchReport {
                starts: self
                    .fit
                    .starts
                    .iter()
                    .map(|start| StartReport {
                        swarm_rmse_n: start.swarm.best_cost.sqrt(),
                        polished_rmse_n: start.polished.as_ref().map(|polished| (2.0 * polished.cost).sqrt()),
                    })
                    .collect(),
                converged: self.fit.converged,
                column_floor_rmse_n: self.column_floor_rmse_n,
            },
            unbounded: self.unbounded.clone(),
            warnings: self.warnings.clone(),
        }
    }
}
