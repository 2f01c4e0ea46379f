//! `pam-change/1`: what has changed in a muscle or its rig since a diagnosis.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::evidence::Evidence;
use super::origin::{Input, Tool};

/// Schema name and version.
pub const SCHEMA: &str = "pam-change/1";

/// Later recordings of a muscle beside its model of then.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ChangeArtifact {
    /// `pam-change/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Files that went into it: the model of then, and the later recordings.
    pub inputs: Vec<Input>,
    /// Options as resolved.
    pub config: ChangeConfig,
    /// Seed of every random draw.
    pub seed: u64,
    /// What is to be believed.
    pub verdict: ChangeVerdict,
    /// The verdict in words.
    pub statement: String,
    /// What has changed, the largest log predictive ratio first.
    pub changes: Vec<Change>,
    /// Everything else that was compared, each alone beside what has changed: how far it may differ.
    pub unchanged: Vec<Compared>,
    /// Residuals.
    pub fit: ChangeFit,
    /// Everything that was weighed alone, the best first.
    pub candidates: Vec<ChangeCandidate>,
    /// What a person should know before using it.
    pub warnings: Vec<String>,
}

/// Options of a comparison with then.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ChangeConfig {
    /// Most changes that may be named.
    pub max_changes: usize,
    /// Ids that were not considered.
    pub excluded: Vec<String>,
    /// Whether the user went on where an instrument or the muscle is implausible.
    pub accept_implausible: bool,
}

/// What is to be believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ChangeVerdict {
    /// The model of then follows the later recordings as it did its own, within its standard errors.
    Unchanged,
    /// What is named has changed.
    Changed,
    /// Something has, and these recordings cannot tell what is named from something else.
    Ambiguous,
    /// Something has that is not named, or what is named leaves much of it.
    Unexplained,
}

/// What kind of thing has changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ChangeKind {
    /// Zero or gain of a channel.
    Channel,
    /// A base parameter.
    Parameter,
    /// Size or shape of an effect that was there.
    Effect,
    /// An effect that was there and is no longer.
    EffectGone,
    /// An effect that was not there.
    NewEffect,
}

/// A change.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// `force-zero`, `force-gain`, `pressure-zero`, `pressure-gain` or `length-zero`; a base parameter or composite; a
    /// catalogue id.
    pub id: String,
    /// What it is.
    pub kind: ChangeKind,
    /// Name in words.
    pub name: String,
    /// Its numbers.
    pub differences: Vec<Compared>,
    /// Why it is believed.
    pub evidence: Evidence,
    /// Ids of what these recordings cannot tell apart from it.
    pub alternatives: Vec<String>,
}

/// A number then and now.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Compared {
    /// Name: of a channel, a base parameter, or a parameter of an effect, as in `stribeck.stribeck_force_n`.
    pub name: String,
    /// Unit; `1` where it has none.
    pub unit: String,
    /// Value then; none of an effect that was not there.
    pub then: Option<f64>,
    /// Value now.
    pub now: f64,
    /// Standard error of the difference, of then and now together; none where the recordings do not tell.
    pub stderr: Option<f64>,
    /// Difference over its standard error; of a new effect its value over that.
    pub standard_errors: Option<f64>,
}

/// Residuals on the later recordings, root mean square over samples that count, channels smoothed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ChangeFit {
    /// What the model of then left of its own recordings, as recorded, in N.
    pub then_n: f64,
    /// What it leaves of the later ones, in N.
    pub as_then_n: f64,
    /// The same within its standard errors, the recordings' tares and what it did not know, in N.
    pub within_errors_n: f64,
    /// The same with what has changed, in N.
    pub now_n: f64,
    /// What the sensors leave of a perfect model of the later recordings, as recorded, in N.
    pub noise_floor_n: f64,
    /// Share of the samples that lie within the pressures and lengths of then; the others are not compared.
    pub share_compared: f64,
}

/// A candidate, alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ChangeCandidate {
    /// Id.
    pub id: String,
    /// Log predictive ratio, less what its freedom and its plausibility cost.
    pub log_ratio: f64,
    /// RMSE of blocks left out of the fit, in N.
    pub rmse_n: f64,
}
