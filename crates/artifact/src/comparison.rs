//! `pam-comparison/1`: two models beside one another on the same recordings.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::origin::{Input, Tool};

/// Schema name and version.
pub const SCHEMA: &str = "pam-comparison/1";

/// Two models, a and b, on the same recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ComparisonArtifact {
    /// `pam-comparison/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Files that went into it: model a, model b, and the recordings.
    pub inputs: Vec<Input>,
    /// Options as resolved.
    pub config: CompareConfig,
    /// Seed of the bootstrap.
    pub seed: u64,
    /// What the recordings say, counted samples of all of them together.
    pub outcome: Outcome,
    /// All recordings together.
    pub together: Comparison,
    /// Each recording.
    pub recordings: Vec<ComparedRecording>,
    /// Parameters of both models.
    pub parameters: Vec<ComparedParameter>,
    /// Effects of model a, by id.
    pub effects_a: Vec<String>,
    /// Effects of model b, by id.
    pub effects_b: Vec<String>,
}

/// Options of a comparison.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CompareConfig {
    /// Resamples of the bootstrap.
    pub n_resamples: usize,
    /// Level of the intervals.
    pub level: f64,
    /// Whether the user went on where an instrument or the muscle is implausible.
    pub accept_implausible: bool,
}

/// Which model follows the recordings better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Model a, beyond chance.
    A,
    /// Model b, beyond chance.
    B,
    /// The recordings do not tell.
    NoDifference,
}

/// Two models over the same samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Comparison {
    /// Samples that count under both models.
    pub counted: Difference,
    /// All samples.
    pub all: Difference,
}

/// Errors of two models over a set of samples, and their difference with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Difference {
    /// Samples.
    pub n_samples: usize,
    /// RMSE of model a, in N.
    pub rmse_a_n: f64,
    /// RMSE of model b, in N.
    pub rmse_b_n: f64,
    /// RMSE of b less that of a, in N.
    pub difference_n: f64,
    /// Interval of the difference at the level of the configuration, in N; none where too few blocks are independent.
    pub interval_n: Option<[f64; 2]>,
    /// Chance of a difference of squared errors so large where there is none, two-sided; none likewise.
    pub p_value: Option<f64>,
    /// Blocks of the length that was resampled, each longer than the autocorrelation of the difference of squared errors.
    pub n_blocks: usize,
    /// Length of a block, in s: the longest of the recordings.
    pub block_s: f64,
}

/// Two models on one recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ComparedRecording {
    /// Path as given.
    pub path: String,
    /// Whether model a was fitted to it.
    pub fitted_by_a: bool,
    /// Whether model b was fitted to it.
    pub fitted_by_b: bool,
    /// Errors.
    pub errors: Comparison,
}

/// A parameter of two models.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ComparedParameter {
    /// Name.
    pub name: String,
    /// Unit; `1` where it has none.
    pub unit: String,
    /// Value in model a.
    pub a: Option<f64>,
    /// Standard error in model a.
    pub stderr_a: Option<f64>,
    /// Value in model b.
    pub b: Option<f64>,
    /// Standard error in model b.
    pub stderr_b: Option<f64>,
    /// Value in b less that in a over the standard error of that difference, the two estimates taken as independent.
    pub standard_errors: Option<f64>,
}
