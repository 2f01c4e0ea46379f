//! `pam-prediction/1`: how well a model follows a recording.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::model::Domain;
use super::origin::{Input, Tool};

/// Schema name and version.
pub const SCHEMA: &str = "pam-prediction/1";

/// A model against one recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PredictionArtifact {
    /// `pam-prediction/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Files that went into it.
    pub inputs: Vec<Input>,
    /// Options as resolved.
    pub config: PredictConfig,
    /// Seed as given; nothing is drawn at random.
    pub seed: u64,
    /// Rows of the recording.
    pub n_rows: usize,
    /// Samples that count: not around reversals, where noise hides the direction of friction, nor beyond a sensor's range.
    /// None where no force was recorded.
    pub counted: Option<PredictionErrors>,
    /// All samples. None where no force was recorded.
    pub all: Option<PredictionErrors>,
    /// What the white noise of all three channels leaves of a perfect model on this recording, root mean square, in N; none
    /// where no force was recorded.
    pub noise_floor_n: Option<f64>,
    /// How the interval around the prediction came about.
    pub band: Band,
    /// Where the recording leaves the operating range that the model was identified on.
    pub extrapolation: Extrapolation,
    /// Whether every limit that was set is met.
    pub accepted: bool,
}

/// Options of a prediction.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PredictConfig {
    /// Limit of the RMSE over samples that count, in N.
    pub max_rmse_n: Option<f64>,
    /// Limit of the RMSE over all samples, in N.
    pub max_rmse_all_n: Option<f64>,
    /// Whether the user went on where an instrument or the muscle is implausible.
    pub accept_implausible: bool,
}

/// Residual, measured less modelled, over a set of samples.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct PredictionErrors {
    /// Root mean square, in N.
    pub rmse_n: f64,
    /// Mean, in N.
    pub mean_n: f64,
    /// Largest absolute value, in N.
    pub max_n: f64,
    /// `1 - Σ residual² / Σ (force - mean)²`.
    pub r2: f64,
    /// `100 (1 - ‖residual‖ / ‖force - mean‖)`.
    pub fit_percent: f64,
    /// Share of samples inside the band, in [0, 1]; `level` is what it should be.
    pub inside_band: f64,
    /// Samples.
    pub n_samples: usize,
}

/// Interval around the prediction: `z √(gᵀ C g + r²)` to either side, with the gradient `g` of the force by the base
/// parameters, their covariance `C` and the residual `r` of the model on recordings of its own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Band {
    /// Share of samples that it is meant to hold.
    pub level: f64,
    /// Residual `r`: RMSE of the model over all samples, of held-out recordings where there were any, in N.
    pub residual_n: f64,
    /// Whether that is of held-out recordings.
    pub residual_is_held_out: bool,
    /// Half width, root mean square over the recording, in N.
    pub half_width_n: f64,
}

/// Where a recording leaves what its model was identified on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Extrapolation {
    /// What the model was identified on.
    pub domain: Domain,
    /// Share of samples beyond its pressures, in [0, 1].
    pub pressure_share: f64,
    /// Share of samples beyond its lengths.
    pub length_share: f64,
    /// Share of samples beyond either.
    pub share: f64,
}
