//! `pam-diagnosis/1`: where a model and recordings differ, and what explains it.

use std::path::Path;

use pam_muscle::Coordinate;
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use super::empirical::{
    Empirical, EmpiricalCurve, EmpiricalGain, EmpiricalTerm, NearestEffect, Stability, StabilityRival,
};
use super::error::ArtifactError;
pub use super::evidence::Evidence;
use super::origin::{Input, Tool};
use super::parameter_entry::ParameterEntry;

/// Schema name and version.
pub const SCHEMA: &str = "pam-diagnosis/1";

/// A diagnosis with everything that later programs need.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DiagnosisArtifact {
    /// `pam-diagnosis/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Files that went into it.
    pub inputs: Vec<Input>,
    /// Options as resolved.
    pub config: DiagnoseConfig,
    /// Seed of every random draw.
    pub seed: u64,
    /// What is to be believed.
    pub verdict: Verdict,
    /// The verdict in words.
    pub statement: String,
    /// The model as it was given, before it was refitted; none in what older versions wrote.
    #[serde(default)]
    pub as_given: Option<AsGiven>,
    /// Where model and recordings differ, the largest share first; empty where they agree.
    #[serde(rename = "where")]
    pub regions: Vec<Region>,
    /// Effects that were left out, the one with the largest log predictive ratio first.
    pub effects: Vec<NamedEffect>,
    /// Residuals before and after.
    pub fit: DiagnosisFit,
    /// Empirical terms of unmodelled structure; none where nothing was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub empirical: Option<Empirical>,
    /// What the force does at one frequency while no drive does; none where nothing was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub periodic: Option<Periodic>,
    /// Whether the augmented model has a smooth static map over pressure and contraction, or a stretch of the ends, which is one of its
    /// own; every figure of `fit` after the effects includes it.
    #[serde(default)]
    pub static_map: bool,
    /// Share of the excess over the noise floor (mean squares) that the effects leave unexplained, in [0, 1].
    pub unexplained_share: f64,
    /// Where structure is left that no effect explains; empty where none is.
    pub unexplained_where: Vec<Region>,
    /// Base parameters that no such muscle has: effects that the parameters absorb show here alone.
    pub implausible: Vec<Implausible>,
    /// Everything that was weighed, in order of the first look.
    pub candidates: Vec<Candidate>,
    /// What the recordings could tell apart at all.
    pub isolability: Isolability,
    /// What to record next, where that would tell more.
    pub next_experiment: Option<NextExperiment>,
    /// What a person should know before using the diagnosis.
    pub warnings: Vec<String>,
}

/// What is to be believed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Model and recordings agree, but for what noise, the parameters' uncertainty or the limit of what matters allow.
    Consistent,
    /// The named effects explain the mismatch.
    Explained,
    /// They explain part of it: over all samples more is left than half as much again as the sensors leave, or the model as given
    /// or what was held out is missed besides.
    ExplainedInPart,
    /// They do, and so do others that these recordings cannot tell from them.
    Ambiguous,
    /// Structure is left that no effect of the catalogue explains; or only a refit follows the recordings and the model as given
    /// misses them; or what was held out is missed.
    Unexplained,
}

/// Options that a diagnosis was run with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DiagnoseConfig {
    /// Excess over the noise floor, root mean square, below which a mismatch does not matter, in N; none leaves it to
    /// half of the noise floor.
    pub matters_above_n: Option<f64>,
    /// Most effects that may be named.
    pub max_effects: usize,
    /// Catalogue ids that were not considered.
    pub excluded: Vec<String>,
}

/// The model as it was given against the recordings, and how far a refit to them moves it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct AsGiven {
    /// Residual on the estimation recordings.
    pub estimation: Residual,
    /// Residual on what was held out.
    pub holdout: Option<Residual>,
    /// Residual on the estimation recordings of the same model with its free parameters refitted to them.
    pub refitted: Residual,
    /// Free base parameters, the one that moved by most standard errors first.
    pub shifts: Vec<Shift>,
    /// Whether it misses the estimation recordings by clearly more than the refitted model does, where no effect explains that
    /// beside the parameters as given: the recordings are of another muscle, or an instrument reads otherwise.
    pub misses: bool,
    /// Faults of one instrument that would each explain why it misses recordings, in words; none where none does.
    pub instrument: Option<String>,
    /// Held-out recordings that the diagnosed model misses, each with the reason that was found; empty where there are none.
    pub holdout_missed: Vec<String>,
}

/// Size of a residual.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Residual {
    /// Root mean square over samples that count, in N.
    pub rmse_n: f64,
    /// The same over all samples, reversals and what came before the first motion included, in N.
    pub rmse_all_n: f64,
}

/// A force that swings at one frequency in recording after recording while neither pressure nor length does.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Periodic {
    /// Frequency, in Hz, to 0.1 Hz.
    pub frequency_hz: f64,
    /// Amplitude in the recording that has most of it, averaged over that recording, in N.
    pub amplitude_n: f64,
    /// Recordings that have it.
    pub n_recordings: usize,
    /// Recordings that are long enough to have it.
    pub n_looked_at: usize,
}

/// How far a refit moves a free base parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Shift {
    /// Parameter or composite.
    pub parameter: String,
    /// Value in the model as given.
    pub given: f64,
    /// Value in the refitted model.
    pub refitted: f64,
    /// Unit of both, and of the standard error.
    pub unit: String,
    /// Standard error of the difference, that of the given model and that of the refit together; none where neither has one.
    pub stderr: Option<f64>,
    /// Difference over its standard error; none where that is not known.
    pub standard_errors: Option<f64>,
}

/// An interval of one coordinate in which the residual exceeds the noise floor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Coordinate.
    pub coordinate: Coordinate,
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Unit of both.
    pub unit: String,
    /// Share of the excess over the noise floor that lies inside.
    pub share_of_excess: f64,
    /// Probability of such a concentration by chance, corrected for multiple comparisons.
    pub p_value: f64,
    /// Recording that it lies in, where it lies in one; a path.
    pub recording: Option<String>,
}

/// An effect that was left out of the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct NamedEffect {
    /// Catalogue id.
    pub id: String,
    /// Name in words.
    pub name: String,
    /// Equation that was fitted.
    pub equation: String,
    /// Its parameters, SI; of what happened several times those of each time, one after the other.
    pub parameters: Vec<ParameterEntry>,
    /// Why it is believed.
    pub evidence: Evidence,
    /// Catalogue ids that these recordings cannot tell apart from it.
    pub alternatives: Vec<String>,
    /// What would tell them apart, or confirm it where nothing else is in question.
    pub separating_test: String,
}

/// Residuals before and after, root mean square over samples whose direction is settled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct DiagnosisFit {
    /// On the recordings that the effects were fitted to.
    pub estimation: BeforeAfter,
    /// On recordings that nothing was fitted to.
    pub holdout: Option<BeforeAfter>,
}

/// Residuals before and after.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BeforeAfter {
    /// Base model, refitted to the same recordings, in N.
    pub rmse_before_n: f64,
    /// Base model and effects, in N.
    pub rmse_after_n: f64,
    /// The same before over all samples, reversals and what came before the first motion included, in N.
    #[serde(default)]
    pub rmse_all_before_n: f64,
    /// And after.
    #[serde(default)]
    pub rmse_all_after_n: f64,
    /// What the sensors leave of a perfect model, in N.
    pub noise_floor_n: f64,
}

/// A base parameter that no such muscle has.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Implausible {
    /// Parameter or composite.
    pub parameter: String,
    /// Value.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// Lowest and highest plausible value.
    pub plausible: [f64; 2],
    /// Likely cause, in words.
    pub likely_cause: String,
}

/// An effect that was weighed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Candidate {
    /// Catalogue id, or `smooth-static-misfit`, the competitor without a name.
    pub id: String,
    /// Evidence alone, against the base model.
    pub evidence: Evidence,
    /// Share of the mean square over blocks left out of the fit, noise included, that it takes away alone, in [0, 1].
    pub explains: f64,
    /// What became of it, in words.
    pub outcome: String,
}

/// What recordings can tell apart: how much of each effect's residual would be left by every other one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Isolability {
    /// Catalogue ids, in the order of the matrix.
    pub ids: Vec<String>,
    /// Residual that each effect would leave after a refit of the base at a typical size, in N.
    pub visible_n: Vec<f64>,
    /// Cosine between the residuals of each pair: near 1 they cannot be told apart. Square, row by row.
    pub cosine: Vec<Vec<f64>>,
}

/// A recording that would tell more.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct NextExperiment {
    /// Protocol, by the name of the virtual bench.
    pub protocol: String,
    /// What it would decide.
    pub separates: Vec<String>,
    /// How far apart it would drive them, root mean square, in N.
    pub separation_n: f64,
    /// How to do it, in words.
    pub instruction: String,
}

impl DiagnosisArtifact {
    /// Reads an artifact; gives its SHA-256 as well.
    ///
    /// # Errors
    /// [`ArtifactError`] names the file, the place and what to do.
    // No program that a user runs reads it; `inline` builds it only where it is called, and it is a tenth of the time to
    // build this package.
    #[inline]
    pub fn read(path: &Path) -> Result<(Self, String), ArtifactError> {
        super::json::read(path, SCHEMA, "pam-diagnose")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_schema_is_refused_by_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("diagnosis.json");
        let refusal = |schema: &str| {
            std::fs::write(&path, format!("{{\"schema\": \"{schema}\"}}")).expect("a file");
            let refused = DiagnosisArtifact::read(&path).expect_err("a refusal").to_string();
            refused.replace(&format!("{}{}", folder.path().display(), std::path::MAIN_SEPARATOR), "")
        };
        let messages = ["pam-diagnosis/0", "pam-diagnosis/2", "pam-model/1"].map(refusal);
        insta::assert_snapshot!(messages.join("\n"), @r#"
        diagnosis.json: schema is "pam-diagnosis/0", expected "pam-diagnosis/1"; an older version wrote it; write it anew with pam-diagnose
        diagnosis.json: schema is "pam-diagnosis/2", expected "pam-diagnosis/1"; a newer version wrote it; update the programs, or write it anew with pam-diagnose
        diagnosis.json: schema is "pam-model/1", expected "pam-diagnosis/1"; write it with pam-diagnose
        "#);
    }
}
