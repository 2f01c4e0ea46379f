//! What is kept of a campaign: a few numbers and sentences, however large its artifacts are.

use std::path::Path;

use pam_artifact::diagnosis::Verdict;
use pam_artifact::model::{FitStatistics, ModelArtifact, ParameterStatus};
use pam_artifact::{ArtifactError, DiagnosisArtifact};

use crate::plan::Campaign;
use crate::step::{Outcome, Step};

/// A number that control charts follow.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// Name of a parameter or a composite, or one of [`RESIDUALS`].
    pub name: String,
    /// Unit; `1` where it has none.
    pub unit: String,
    /// Value.
    pub value: f64,
    /// Standard error; none where that is not known.
    pub stderr: Option<f64>,
}

/// Quantities that are no parameters: residuals over what the sensors leave, on estimation and held-out recordings.
pub const RESIDUALS: [&str; 2] = ["residual / noise", "held-out residual / noise"];

/// Share of the samples that are few: physics that is missing shows in more of them.
const FEW: f64 = 0.01;

/// An effect that was named, and what it is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedEffect {
    /// Catalogue id.
    pub id: String,
    /// Held-out force that it explains, root mean square, in N.
    pub worth_n: f64,
    /// Ids that the recordings cannot tell apart from it.
    pub alternatives: Vec<String>,
}

/// What is kept of a diagnosis.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosed {
    /// The verdict.
    pub verdict: Verdict,
    /// The same in words.
    pub statement: String,
    /// Effects in order of evidence.
    pub effects: Vec<NamedEffect>,
    /// Residual after them, in N.
    pub rmse_after_n: f64,
    /// Base parameters that no such muscle has, each with the likely cause.
    pub implausible: Vec<String>,
}

/// What is kept of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Identified {
    /// Parameters and composites that were fitted inside their ranges, and residuals.
    pub quantities: Vec<Quantity>,
    /// Residual on the estimation recordings, in N.
    pub rmse_n: f64,
    /// Residual on the held-out recordings, in N.
    pub holdout_rmse_n: Option<f64>,
    /// Noise floor, in N.
    pub noise_n: f64,
    /// Those of [`RESIDUALS`] that a few samples leave.
    pub isolated: Vec<&'static str>,
}

/// A campaign and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// What was recorded of which muscle, on which rig, when.
    pub campaign: Campaign,
    /// How each step ended, in the order of [`Step::ALL`].
    pub outcomes: [Outcome; 4],
    /// The model, where there is one.
    pub identified: Option<Identified>,
    /// The diagnosis, where there is one.
    pub diagnosed: Option<Diagnosed>,
    /// Whether there is a page of the diagnosis.
    pub has_report: bool,
}

impl Record {
    /// Reads what `results` holds of a campaign. An artifact that cannot be read costs its campaign the step that wrote it.
    pub fn read(results: &Path, campaign: Campaign) -> Self {
        let folder = results.join(&campaign.id);
        let mut outcomes = Step::ALL.map(|step| Outcome::read(&folder, step));
        let finished = |outcome: &Outcome| matches!(outcome, Outcome::Accepted | Outcome::Rejected(_));
        let mut kept = |step: Step, reason: ArtifactError| {
            outcomes[step as usize] = Outcome::Missing(reason.to_string());
        };
        let there = |step: Step| finished(&Outcome::read(&folder, step));
        let identified = there(Step::Identify)
            .then(|| ModelArtifact::read(&folder.join("model.json")))
            .and_then(|read| read.map_err(|reason| kept(Step::Identify, reason)).ok())
            .map(|(model, _)| identified(&model));
        let diagnosed = there(Step::Diagnose)
            .then(|| DiagnosisArtifact::read(&folder.join("diagnosis.json")))
            .and_then(|read| read.map_err(|reason| kept(Step::Diagnose, reason)).ok())
            .map(|(diagnosis, _)| diagnosed(diagnosis));
        let has_report = diagnosed.is_some() && folder.join("report.html").is_file();
        Self { campaign, outcomes, identified, diagnosed, has_report }
    }

    /// Steps that were refused or left nothing, each with its reason.
    pub fn refusals(&self) -> impl Iterator<Item = (Step, &str)> {
        Step::ALL.into_iter().zip(&self.outcomes).filter_map(|(step, outcome)| match outcome {
            Outcome::Refused(reason) | Outcome::Missing(reason) => Some((step, reason.as_str())),
            Outcome::Accepted | Outcome::Rejected(_) | Outcome::Skipped => None,
        })
    }

    /// Steps whose result was rejected, each with its reason. A diagnosis is none of them: what it finds is its result.
    pub fn rejections(&self) -> impl Iterator<Item = (Step, &str)> {
        Step::ALL.into_iter().zip(&self.outcomes).filter_map(|(step, outcome)| match outcome {
            Outcome::Rejected(reason) if step != Step::Diagnose => Some((step, reason.as_str())),
            _ => None,
        })
    }
}

fn identified(model: &ModelArtifact) -> Identified {
    let parameters = model.parameters.iter().filter(|entry| entry.status == ParameterStatus::Fitted);
    let mut quantities: Vec<Quantity> = parameters
        .map(|entry| (&entry.name, &entry.unit, entry.value, entry.stderr))
        .chain(model.composites.iter().map(|entry| (&entry.name, &entry.unit, entry.value, entry.stderr)))
        .map(|(name, unit, value, stderr)| Quantity { name: name.clone(), unit: unit.clone(), value, stderr })
        .collect();
    let noise_n = model.fit.noise_floor_n;
    let rmse_n = model.fit.estimation.rmse_n;
    let holdout_rmse_n = model.fit.validation.map(|statistics| statistics.rmse_n);
    let mut isolated = Vec::new();
    for (name, statistics) in RESIDUALS.into_iter().zip([Some(model.fit.estimation), model.fit.validation]) {
        let Some(statistics) = statistics else { continue };
        let value = statistics.rmse_n / noise_n;
        if value.is_finite() {
            quantities.push(Quantity { name: name.to_owned(), unit: "1".to_owned(), value, stderr: None });
        }
        if is_isolated(&statistics, noise_n) {
            isolated.push(name);
        }
    }
    Identified { quantities, rmse_n, holdout_rmse_n, noise_n, isolated }
}

/// Whether what a residual has beyond the noise is no more than [`FEW`] samples leave that are as far off as the farthest.
///
/// A turn that noise dates late leaves up to twice the friction over some tenths of a second: one of them is most of the mean square
/// of a healthy muscle. Normal residuals reach to four standard deviations; from 1.2 times the noise on they are not isolated.
fn is_isolated(residual: &FitStatistics, noise_n: f64) -> bool {
    residual.rmse_n * residual.rmse_n - noise_n * noise_n < FEW * residual.max_n * residual.max_n
}

fn diagnosed(diagnosis: DiagnosisArtifact) -> Diagnosed {
    let worth_n = |without_n: f64, with_n: f64| (without_n * without_n - with_n * with_n).max(0.0).sqrt();
    let effects = diagnosis.effects.into_iter().map(|effect| NamedEffect {
        worth_n: worth_n(effect.evidence.rmse_without_n, effect.evidence.rmse_with_n),
        id: effect.id,
        alternatives: effect.alternatives,
    });
    let implausible = diagnosis
        .implausible
        .into_iter()
        .map(|entry| format!("{} is implausible: {}", entry.parameter, entry.likely_cause));
    Diagnosed {
        verdict: diagnosis.verdict,
        statement: diagnosis.statement,
        effects: effects.collect(),
        rmse_after_n: diagnosis.fit.estimation.rmse_after_n,
        implausible: implausible.collect(),
    }
}

/// A verdict as the artifact spells it.
pub fn verdict_word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Consistent => "consistent",
        Verdict::Explained => "explained",
        Verdict::ExplainedInPart => "explained-in-part",
        Verdict::Ambiguous => "ambiguous",
        Verdict::Unexplained => "unexplained",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn residual(rmse_n: f64, max_n: f64) -> FitStatistics {
        FitStatistics {
            rmse_n,
            rmse_all_n: rmse_n,
            max_n,
            r2: 0.99,
            fit_percent: 90.0,
            n_samples: 5434,
            n_unsettled: 566,
        }
    }

    #[test]
    fn one_turn_that_is_dated_late_is_isolated_and_physics_is_not() {
        // Thirty samples of 22 N among five thousand of 0.65 N, as friction of 11 N leaves at 100 Hz.
        assert!(is_isolated(&residual(1.67, 23.8), 0.58));
        // The same root mean square by a residual that is normal, and by one that one sample in ten has.
        assert!(!is_isolated(&residual(1.67, 4.0 * 1.67), 0.58));
        assert!(!is_isolated(&residual(1.67, 5.0), 0.58));
    }
}
