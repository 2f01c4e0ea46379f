//! Options of a fit, and what it assumed, as a model carries them.

use pam_muscle::direction::Standstill;
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options that a fit was run with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct IdentifyConfig {
    /// Particles of each swarm.
    pub n_particles: usize,
    /// Most moves of each particle.
    pub n_iterations: usize,
    /// Swarms.
    pub n_starts: usize,
    /// Whether Levenberg–Marquardt followed the swarm.
    pub polish: bool,
    /// Loss: `square` or `huber`.
    pub loss: Loss,
    /// Parameters fitted on their own that are otherwise reported as composites.
    pub freed: Vec<String>,
    /// Parameters held at a value given by the user.
    pub fixed: Vec<FixedParameter>,
    /// `C₀₁ / C₁₀` that their sum is split by.
    pub bladder_ratio: f64,
    /// What was assumed of the base; the recordings judged the rest.
    #[serde(default)]
    pub assumed: Assumed,
    /// Whether the user went on where instruments or parameters are implausible; left out where not.
    #[serde(default, skip_serializing_if = "is_false")]
    pub accept_implausible: bool,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands over a reference")]
fn is_false(value: &bool) -> bool {
    !value
}

/// Hypotheses of the base that a user may force.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Assumed {
    /// Law of the bladder.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bladder: Option<BladderLaw>,
    /// Law of the friction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionLaw>,
    /// Friction at standstill.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standstill: Option<Standstill>,
}

/// How the two coefficients of the bladder are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum BladderLaw {
    /// Their sum, shared at a fixed ratio.
    Shared,
    /// Each on its own.
    Free,
}

/// Which friction of eq. 11 is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum FrictionLaw {
    /// That of the bladder (eq. 9).
    Rubber,
    /// That between strands (eq. 10).
    Strands,
    /// Both.
    Both,
}

/// A hypothesis of the base beside another, judged by what the columns of eq. 11 leave.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StandstillFit {
    /// Friction at standstill.
    pub standstill: Standstill,
    /// Root mean square of what is left, in N.
    pub rmse_n: f64,
}

/// A parameter held at a value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct FixedParameter {
    /// Name of the parameter.
    pub name: String,
    /// Value, in the unit that the artifact writes it in.
    pub value: f64,
}

/// What a residual costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Loss {
    /// Its square.
    Square,
    /// Its square up to 1.345 robust standard deviations, and its absolute value beyond (Huber 1964).
    Huber,
}
