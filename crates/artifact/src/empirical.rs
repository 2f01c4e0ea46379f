//! Terms without a name in a diagnosis.

use pam_muscle::effects::Sentence;
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::evidence::Evidence;
use super::parameter_entry::ParameterEntry;

/// What models the part of a mismatch that has no name, and what that gains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Empirical {
    /// The terms, in the order in which they were found; the model has them as effects `empirical`.
    pub terms: Vec<EmpiricalTerm>,
    /// Over held-out blocks of the estimation recordings.
    pub blocks: EmpiricalGain,
    /// Over the counted samples of held-out recordings; with the terms it is `rmse_after_n` of `fit.holdout`. None where nothing
    /// was held out.
    pub holdout: Option<EmpiricalGain>,
}

/// What a model leaves without and with the terms, root mean square.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EmpiricalGain {
    /// Base, static map and named effects, in N; along held-out recordings the refitted base alone where no effect is named.
    pub rmse_without_n: f64,
    /// The same and the terms, in N.
    pub rmse_with_n: f64,
}

/// A term without a name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EmpiricalTerm {
    /// What it is, but for its amplitudes.
    pub sentence: Sentence,
    /// The same as an equation.
    pub equation: String,
    /// The same in words.
    pub words: String,
    /// The named effect that it bends: by this, the effect differs from its published form. None where it is another thing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bends: Option<String>,
    /// Its amplitudes, SI.
    pub parameters: Vec<ParameterEntry>,
    /// Why it is believed.
    pub evidence: Evidence,
    /// Its curve, with a band.
    pub curve: EmpiricalCurve,
    /// Whether other draws of blocks would choose it.
    pub stability: Stability,
    /// Effects of the catalogue that come nearest, the best first.
    pub nearest: Vec<NearestEffect>,
}

/// The curve of a term over what was seen.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EmpiricalCurve {
    /// Unit of the argument.
    pub unit: String,
    /// What the curve is evaluated at: the driver after the memory.
    pub argument: Vec<f64>,
    /// Force where the scale is as large as it is typically, in N.
    pub force_n: Vec<f64>,
    /// Lower end of a band of 95 %, by leaving out stretches of recording, in N.
    pub low_n: Vec<f64>,
    /// Upper end.
    pub high_n: Vec<f64>,
    /// Root mean square of the scale where the term acts, over what was fitted, in its unit.
    pub typical_scale: f64,
}

/// How often sentences are chosen where blocks of recording are drawn anew, with repetition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Stability {
    /// Share of the draws that choose this one, in [0, 1].
    pub chosen: f64,
    /// Others that draws choose, the most frequent first.
    pub others: Vec<StabilityRival>,
}

/// Another sentence that draws of blocks choose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StabilityRival {
    /// What it is.
    pub sentence: Sentence,
    /// The same in a few words.
    pub words: String,
    /// Share of the draws that choose it, in [0, 1].
    pub chosen: f64,
}

/// An effect of the catalogue that comes near a term.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct NearestEffect {
    /// Catalogue id.
    pub id: String,
    /// What it leaves of held-out blocks alone, in N.
    pub rmse_with_n: f64,
    /// What speaks against it, in words.
    pub against: String,
}
