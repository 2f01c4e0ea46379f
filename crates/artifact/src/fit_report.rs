//! How a fit went, as a model carries it: statistics, the operating range, the search.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Agreement between model and recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FitReport {
    /// All estimation recordings together.
    pub estimation: FitStatistics,
    /// All validation recordings together, where there are any.
    pub validation: Option<FitStatistics>,
    /// Every recording on its own, in the order of the inputs.
    pub recordings: Vec<RecordingFit>,
    /// What the white noise of all three channels leaves of a perfect model on the estimation recordings, root
    /// mean square, in N.
    pub noise_floor_n: f64,
    /// White noise of the force channel alone, in N.
    pub force_noise_n: f64,
    /// Independent samples that the estimation recordings are worth.
    pub effective_samples: f64,
}

/// One recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RecordingFit {
    /// Path as given.
    pub path: String,
    /// Agreement on it.
    pub statistics: FitStatistics,
}

/// Residual, measured less modelled, over the samples whose direction of motion is certain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FitStatistics {
    /// Root mean square, in N.
    pub rmse_n: f64,
    /// Root mean square with the samples that are left out, in N.
    pub rmse_all_n: f64,
    /// Largest absolute value, in N.
    pub max_n: f64,
    /// `1 - Σ residual² / Σ (force - mean)²`.
    pub r2: f64,
    /// `100 (1 - ‖residual‖ / ‖force - mean‖)`.
    pub fit_percent: f64,
    /// Samples counted.
    pub n_samples: usize,
    /// Samples that are left out: around reversals, where noise hides the direction, and beyond a sensor's range.
    pub n_unsettled: usize,
}

/// What the estimation recordings cover.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Lowest and highest gauge pressure, in Pa.
    pub pressure_pa: [f64; 2],
    /// Shortest and longest length, in m.
    pub length_m: [f64; 2],
    /// Lowest and highest force, in N.
    pub force_n: [f64; 2],
    /// Fastest change of length, in m/s.
    pub length_rate_m_per_s: f64,
    /// Fastest change of pressure, in Pa/s.
    pub pressure_rate_pa_per_s: f64,
}

/// How the search went.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SearchReport {
    /// Every swarm, in order of its start.
    pub starts: Vec<StartReport>,
    /// Whether the best start converged; a pure swarm never claims to.
    pub converged: bool,
    /// Lowest RMSE that the columns allow with free weights, in N.
    pub column_floor_rmse_n: f64,
}

/// One swarm and what followed it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StartReport {
    /// RMSE after the swarm, in N.
    pub swarm_rmse_n: f64,
    /// RMSE after the polish, in N.
    pub polished_rmse_n: Option<f64>,
}

/// Weights of the same columns without signs or ranges.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct UnboundedFit {
    /// RMSE on the estimation recordings, in N.
    pub estimation_rmse_n: f64,
    /// RMSE on the validation recordings, in N.
    pub validation_rmse_n: Option<f64>,
    /// What the weights would mean as parameters.
    pub implied: Vec<ImpliedParameter>,
}

/// A parameter that a free weight stands for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ImpliedParameter {
    /// Name, or a product of names.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// Whether a muscle can have it.
    pub physical: bool,
}
