//! `pam-group/1`: several muscles of one rig, diagnosed together.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::diagnosis::{DiagnoseConfig, NamedEffect, Verdict};
use super::origin::{Input, Tool};
use super::parameter_entry::ParameterEntry;

/// Schema name and version.
pub const SCHEMA: &str = "pam-group/1";

/// What the rig does to all of its muscles, and what is left for each of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct GroupArtifact {
    /// `pam-group/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Files that went into it: the group, and the model and recordings of every muscle.
    pub inputs: Vec<Input>,
    /// Options as resolved.
    pub config: DiagnoseConfig,
    /// Seed of every random draw.
    pub seed: u64,
    /// What was found, in words.
    pub statement: String,
    /// Effects of the rig, in the order in which they were found.
    pub rig: Vec<RigEffect>,
    /// The muscles, in the order of the group.
    pub muscles: Vec<GroupMuscle>,
    /// Every effect of the rig that was weighed in all muscles together, the largest log predictive ratio first.
    pub candidates: Vec<RigCandidate>,
    /// Catalogue ids of effects of the rig that would explain what was fitted, and that what was held out denies.
    pub denied: Vec<String>,
    /// Catalogue ids of effects of a rig that several muscles show, each with a value of its own: not of one rig.
    pub apart: Vec<String>,
    /// What a person should know before using it.
    pub warnings: Vec<String>,
}

/// An effect of the rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RigEffect {
    /// Catalogue id.
    pub id: String,
    /// Name in words.
    pub name: String,
    /// Equation that was fitted.
    pub equation: String,
    /// The values that all muscles share, SI, with the standard errors of all of them together.
    pub parameters: Vec<ParameterEntry>,
    /// Log predictive ratio of all muscles together, beyond what explains each of them without it.
    pub log_ratio: f64,
    /// With how much of its fitted size held-out recordings of all muscles show it; none where they cannot.
    pub held_out: Option<HeldOutShare>,
    /// What each muscle says of it.
    pub muscles: Vec<InMuscle>,
    /// Ids of effects of the rig that the muscles together cannot tell apart from it.
    pub alternatives: Vec<String>,
    /// What would tell them apart, or confirm it where nothing else is in question.
    pub separating_test: String,
}

/// An effect of the rig in one muscle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct InMuscle {
    /// Name of the muscle.
    pub muscle: String,
    /// What its recordings say.
    pub says: Says,
    /// Log predictive ratio of the shared values in this muscle.
    pub log_ratio: f64,
    /// With how much of its fitted size its held-out recordings show it; none where they cannot.
    pub held_out: Option<HeldOutShare>,
    /// The values that it has by itself where it differs, and its own amplitudes beside the shared shape otherwise, SI.
    pub own: Vec<ParameterEntry>,
    /// Whether the muscle is followed with it: not where its recordings speak against it, nor where it leaves more of what was
    /// fitted than nothing does, as the noise of a channel can make it.
    pub in_model: bool,
}

/// Share of its fitted size with which held-out recordings show an effect: 1 confirms it, 0 denies it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct HeldOutShare {
    /// The share.
    pub share: f64,
    /// Its standard error.
    pub stderr: f64,
}

/// What recordings of one muscle say of an effect of the rig.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Says {
    /// They show it.
    Shows,
    /// They speak neither for it nor against it.
    CannotShow,
    /// They show it with another value.
    Differs,
    /// They speak against it.
    Denies,
}

/// A muscle of the group.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct GroupMuscle {
    /// Name.
    pub name: String,
    /// What is to be believed of it beside what the rig does.
    pub verdict: Verdict,
    /// The verdict in words.
    pub statement: String,
    /// Effects of its own, the one with the largest log predictive ratio first.
    pub effects: Vec<NamedEffect>,
    /// Catalogue ids that a diagnosis of this muscle alone names.
    pub alone: Vec<String>,
    /// Residuals on the recordings that were fitted.
    pub estimation: GroupResidual,
    /// The same on what was held out.
    pub holdout: Option<GroupResidual>,
}

/// Root mean square residual, in N; `all` over excluded samples as well.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct GroupResidual {
    /// Of eq. 11, refitted.
    pub base_n: f64,
    /// The same over all samples.
    pub base_all_n: f64,
    /// Of what a diagnosis of this muscle alone names.
    pub alone_n: f64,
    /// The same over all samples.
    pub alone_all_n: f64,
    /// Of what the rig does and the muscle's own effects.
    pub together_n: f64,
    /// The same over all samples.
    pub together_all_n: f64,
    /// What the sensors leave of a perfect model.
    pub noise_floor_n: f64,
}

/// An effect of the rig that was weighed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RigCandidate {
    /// Catalogue id.
    pub id: String,
    /// Log predictive ratio of all muscles together.
    pub log_ratio: f64,
    /// The same in each muscle, in the order of the group.
    pub each: Vec<f64>,
}
