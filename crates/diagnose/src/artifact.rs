//! A diagnosis as artifacts: what was found, and the model with it.

use pam_artifact::diagnosis::{BeforeAfter, DiagnosisArtifact, DiagnosisFit, SCHEMA, Verdict};
use pam_artifact::model::{
    self, CompositeEntry, Correlation, Domain, FitReport, FitStatistics, ModelArtifact, ParameterEntry,
    ParameterStatus, RecordingFit, SearchReport,
};
use pam_artifact::{Input, Tool};
use pam_identification::evaluate::{Evaluation, evaluate, evaluate_augmented, noise_floor_n};
use pam_identification::prepare::{Prepared, begun_at_rest};
use pam_identification::search_space::Free;
use pam_muscle::effects::Kind;
use pam_muscle::force::Parameter;

use crate::diagnose::Diagnosis;
use crate::error::DiagnoseError;
use crate::trial::ends_as_meant;

/// How an artifact begins.
#[derive(Debug, Clone, PartialEq)]
pub struct Head {
    /// Program that writes it.
    pub tool: Tool,
    /// Files that went into it.
    pub inputs: Vec<Input>,
    /// Seed of every random draw.
    pub seed: u64,
}

/// Base model and augmented model against every recording, over all samples at the rate of the recording.
///
/// Events happened once, in an estimation recording: held-out recordings are judged without them.
#[derive(Debug, Clone)]
pub struct Agreement {
    /// Base model, refitted, on the estimation recordings.
    pub base_estimation: Evaluation,
    /// Base model, refitted to the estimation recordings, on what was held out.
    pub base_holdout: Evaluation,
    /// Base model and effects on the estimation recordings.
    pub estimation: Evaluation,
    /// Base model and effects on what was held out.
    pub holdout: Evaluation,
    /// The same without empirical terms; none where there are none.
    pub holdout_without_terms: Option<FitStatistics>,
    /// The same with what is kept to the estimation recordings; none where nothing is.
    pub holdout_everywhere: Option<FitStatistics>,
    /// What the noise of all channels leaves of a perfect model on the estimation recordings, in N.
    pub noise_floor_n: f64,
    /// Independent samples that the estimation recordings are worth.
    pub effective_samples: f64,
}

impl Agreement {
    /// Of `diagnosis`.
    ///
    /// # Errors
    /// [`DiagnoseError::Recording`] where samples cannot be read back.
    pub fn of(diagnosis: &Diagnosis) -> Result<Self, DiagnoseError> {
        let Diagnosis { estimation, holdout, base, augmented, model, .. } = diagnosis;
        // Each model as it takes friction at rest: no gain comes from a state that suits one of them alone.
        let as_base = |recordings| begun_at_rest(recordings, base, model.direction.standstill);
        let base_holdout = evaluate(&as_base(holdout)?, base)?;
        let holdout_without_terms = match (&diagnosis.without_terms, &diagnosis.empirical) {
            (Some(without), _) => evaluate_augmented(holdout, &without.elsewhere(), model.direction)?.together,
            (None, Some(_)) => base_holdout.together,
            (None, None) => None,
        };
        Ok(Self {
            base_estimation: diagnosis.base_fitted.clone(),
            base_holdout,
            holdout_without_terms,
            holdout_everywhere: match &diagnosis.kept_to_fitted {
                Some(kept) => evaluate_augmented(holdout, &kept.everywhere.elsewhere(), model.direction)?.together,
                None => None,
            },
            estimation: diagnosis.fitted.evaluation.clone(),
            holdout: diagnosis.held.evaluation.clone(),
            noise_floor_n: noise_floor_n(estimation, augmented.base())?,
            effective_samples: effective_samples(&diagnosis.fitted.residuals_n()),
        })
    }
}

/// Samples of `residuals` over the number of them that share one: `1 + 2 Σ ρ`, summed until the correlation dies away. Where there
/// are very many, thinned ones are counted.
fn effective_samples(residuals: &[Vec<f64>]) -> f64 {
    const MOST_LAGS: usize = 400;
    // Mean product of residuals that are so many samples apart.
    let covariance = |lag: usize| {
        let (mut products, mut count) = (0.0, 0.0);
        for residuals_n in residuals.iter().filter(|residuals_n| lag < residuals_n.len()) {
            for (left, right) in residuals_n.iter().zip(&residuals_n[lag..]) {
                products += left * right;
            }
            count += (residuals_n.len() - lag) as f64;
        }
        products / f64::max(count, 1.0)
    };
    let n_samples = residuals.iter().map(Vec::len).sum::<usize>() as f64;
    let variance = covariance(0).max(f64::MIN_POSITIVE);
    let correlations = (1..MOST_LAGS).map(|lag| covariance(lag) / variance);
    let together = 1.0 + correlations.take_while(|correlation| *correlation >= 0.05).map(|one| 2.0 * one).sum::<f64>();
    n_samples / together
}

impl Diagnosis {
    /// The diagnosis for other programs and for people.
    ///
    /// # Panics
    /// Where `agreement` is of another diagnosis.
    pub fn artifact(&self, head: Head, agreement: &Agreement) -> DiagnosisArtifact {
        let noise_floor_n = agreement.noise_floor_n;
        let pair = |before: &FitStatistics, after: &FitStatistics| BeforeAfter {
            rmse_before_n: before.rmse_n,
            rmse_after_n: after.rmse_n,
            rmse_all_before_n: before.rmse_all_n,
            rmse_all_after_n: after.rmse_all_n,
            noise_floor_n,
        };
        let held = agreement.base_holdout.together.zip(agreement.holdout.together);
        DiagnosisArtifact {
            schema: SCHEMA.to_owned(),
            tool: head.tool,
            inputs: head.inputs,
            config: self.config.clone(),
            seed: head.seed,
            verdict: self.verdict,
            statement: self.statement.clone(),
            as_given: Some(self.given.artifact()),
            regions: self.regions.clone(),
            effects: self.effects.clone(),
            empirical: self.empirical.clone(),
            periodic: self.periodic,
            static_map: self.has_map(),
            fit: DiagnosisFit {
                estimation: pair(&together(&agreement.base_estimation), &together(&agreement.estimation)),
                holdout: held.map(|(before, after)| pair(&before, &after)),
            },
            unexplained_share: self.unexplained_share,
            unexplained_where: self.unexplained.clone(),
            implausible: self.implausible.clone(),
            candidates: self.candidates.clone(),
            isolability: self.isolability.clone(),
            next_experiment: self.next_experiment.as_ref().map(|(next, _)| next.clone()),
            warnings: self.warnings(agreement),
        }
    }

    /// The model with what was found, for every program that takes a model.
    ///
    /// # Panics
    /// Where `agreement` is of another diagnosis.
    pub fn model_artifact(&self, head: Head, agreement: &Agreement) -> ModelArtifact {
        let prepared = || self.estimation.iter().chain(&self.holdout);
        let statistics = agreement.estimation.each.iter().chain(&agreement.holdout.each);
        let estimation = together(&agreement.estimation);
        let matrix = self.uncertainty.correlation.row_iter().map(|row| row.iter().copied().collect()).collect();
        ModelArtifact {
            schema: model::SCHEMA.to_owned(),
            tool: head.tool,
            inputs: head.inputs,
            config: self.model.config.clone(),
            seed: head.seed,
            muscle_name: self.model.muscle_name.clone(),
            geometry: self.model.geometry.clone(),
            strand_modulus_pa: self.model.strand_modulus_pa,
            form: self.model.form,
            parameters: self.parameters(),
            composites: self.composites(),
            effects: self.entries.clone(),
            correlation: Correlation { names: self.free.iter().map(|&name| name.to_owned()).collect(), matrix },
            fit: FitReport {
                estimation,
                validation: agreement.holdout.together,
                recordings: prepared()
                    .zip(statistics)
                    .map(|(prepared, &statistics)| RecordingFit { path: prepared.recording.path.clone(), statistics })
                    .collect(),
                noise_floor_n: agreement.noise_floor_n,
                force_noise_n: force_noise_n(&self.estimation),
                effective_samples: agreement.effective_samples,
            },
            domain: domain(&self.estimation),
            direction: self.model.direction,
            standstill_laws: self.model.standstill_laws.clone(),
            quality: prepared().map(|prepared| prepared.quality.clone()).collect(),
            search: SearchReport {
                // No swarm: the joint fit descends from the model in question.
                starts: Vec::new(),
                converged: true,
                column_floor_rmse_n: estimation.rmse_n,
            },
            unbounded: None,
            warnings: self.warnings(agreement),
        }
    }

    /// Value of a free parameter or composite in the unit of artifacts, its standard error, and whether it presses against
    /// its range; none where it was held.
    fn found(&self, free: Free) -> Option<(f64, Option<f64>, bool)> {
        let index = self.free.iter().position(|name| *name == free.name())?;
        let parameters = self.augmented.base().parameters();
        let at_bound = self.at_bound[index];
        let stderr = self.uncertainty.base.get(index).copied().filter(|stderr| !at_bound && stderr.is_finite());
        Some(match free {
            Free::BladderSum => (parameters.of(Parameter::C10) + parameters.of(Parameter::C01), stderr, at_bound),
            Free::One(parameter) => {
                let value = parameter.from_artifact(parameters.of(parameter));
                // The modulus is the inverse of what was fitted: δE = E² δ(1/E).
                let scale = if parameter == Parameter::StrandCompliance { value * value } else { 1.0 };
                (value, stderr.map(|stderr| scale * stderr), at_bound)
            }
        })
    }

    /// Parameters of eq. 11 as refitted beside the effects; fitted dimensions stay what they were.
    fn parameters(&self) -> Vec<ParameterEntry> {
        let refitted = self.augmented.base().parameters();
        self.model
            .parameters
            .iter()
            .map(|entry| {
                let Some(parameter) = Parameter::ALL.into_iter().find(|known| known.artifact_name() == entry.name)
                else {
                    return ParameterEntry { stderr: None, status: ParameterStatus::Fixed, ..entry.clone() };
                };
                let value = parameter.from_artifact(refitted.of(parameter));
                let shared = matches!(parameter, Parameter::C10 | Parameter::C01);
                let sum = self.found(Free::BladderSum).filter(|_| shared);
                let (stderr, status) = match (self.found(Free::One(parameter)), sum) {
                    (Some((_, _, true)), _) | (None, Some((_, _, true))) => (None, ParameterStatus::AtBound),
                    (Some((_, stderr, false)), _) => (
                        stderr,
                        if entry.status == ParameterStatus::Composite {
                            ParameterStatus::Composite
                        } else {
                            ParameterStatus::Fitted
                        },
                    ),
                    (None, Some((sum, stderr, false))) => {
                        let share = if sum > 0.0 { value / sum } else { 0.5 };
                        (stderr.map(|stderr| share * stderr), ParameterStatus::Composite)
                    }
                    (None, None) => (None, ParameterStatus::Fixed),
                };
                ParameterEntry { value, stderr, status, ..entry.clone() }
            })
            .collect()
    }

    /// Combinations with the values that they have now.
    fn composites(&self) -> Vec<CompositeEntry> {
        self.model
            .composites
            .iter()
            .map(|entry| {
                let radius_m = self.model.geometry.rest_radius_m;
                let (free, scale) = match entry.name.as_str() {
                    "c10 + c01" => (Free::BladderSum, 1.0),
                    "k1 rest_radius^2" => (Free::One(Parameter::K1), radius_m * radius_m),
                    _ => (Free::One(Parameter::RubberFriction), 1.0),
                };
                match self.found(free) {
                    Some((value, stderr, _)) => CompositeEntry {
                        value: value * scale,
                        stderr: stderr.map(|stderr| stderr * scale),
                        ..entry.clone()
                    },
                    None => entry.clone(),
                }
            })
            .collect()
    }

    /// What a person should know before using diagnosis or model.
    fn warnings(&self, agreement: &Agreement) -> Vec<String> {
        let mut warnings = Vec::new();
        if !self.model.effects.is_empty() {
            let ids: Vec<&str> = self.model.effects.iter().map(|entry| entry.id.as_str()).collect();
            warnings.push(format!(
                "the model in question had {} beyond eq. 11, which was left aside and weighed anew with the rest",
                ids.join(", ")
            ));
        }
        if self.verdict == Verdict::Unexplained {
            warnings.push(
                "part of the mismatch has no name: trust the model no further than the held-out error".to_owned(),
            );
        }
        for effect in self.effects.iter().filter(|effect| !effect.alternatives.is_empty()) {
            warnings.push(format!(
                "these recordings cannot distinguish {} from {}",
                effect.id,
                effect.alternatives.join(" or ")
            ));
        }
        let at_bound = |entry: &&ParameterEntry| entry.status == ParameterStatus::AtBound;
        for effect in &self.entries {
            let says_how = |entry: &&ParameterEntry| ends_as_meant(&effect.id, &entry.name, entry.value);
            for parameter in effect.parameters.iter().filter(at_bound).filter(|entry| !says_how(entry)) {
                let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) };
                warnings.push(format!(
                    "{} of {} is at the end of its range, {:.4}{unit}: the effect may stand in for something else",
                    parameter.name, effect.id, parameter.value
                ));
            }
        }
        let implausible = |name: &str| self.implausible.iter().any(|entry| entry.parameter == name);
        let pressed = self.free.iter().zip(&self.at_bound).filter(|(name, at_bound)| **at_bound && !implausible(name));
        for (name, _) in pressed {
            warnings
                .push(format!("{name} is at the end of its range: eq. 11 still lacks something that it stands in for"));
        }
        for entry in &self.implausible {
            let [low, high] = entry.plausible;
            warnings.push(format!(
                "{} = {} is outside what braided muscles have ({} to {}); a likely cause is {}",
                entry.parameter,
                plain(entry.value, &entry.unit),
                plain(low, &entry.unit),
                plain(high, &entry.unit),
                entry.likely_cause
            ));
        }
        let terms = self.augmented.terms().iter();
        let mut events: Vec<&str> =
            terms.filter(|term| term.effect.kind() == Kind::Event).map(|term| term.effect.page().id).collect();
        let times = events.len();
        events.dedup();
        if times > 0 {
            let when =
                if times > events.len() { "in estimation recordings" } else { "once, in an estimation recording" };
            warnings.push(format!(
                "{} happened {when}: other recordings are judged and predicted without it",
                events.join(", ")
            ));
        }
        if let Some((before, after)) = agreement.base_holdout.together.zip(agreement.holdout.together)
            && after.rmse_n > before.rmse_n
            && !self.entries.is_empty()
            && self.raised(agreement).is_none()
        {
            warnings.push(format!(
                "on what was held out the residual rises from {:.2} N to {:.2} N: the recordings differ in something else",
                before.rmse_n, after.rmse_n
            ));
        }
        warnings.extend(self.noticed.iter().chain(&self.too_short).cloned());
        if self.holdout.is_empty() {
            warnings.push(
                "no recording was held out: name one with --holdout to see what the effects are worth".to_owned(),
            );
        }
        warnings
    }
}

/// All recordings together; a diagnosis has at least one.
pub(crate) fn together(evaluation: &Evaluation) -> FitStatistics {
    evaluation.together.unwrap_or_else(|| evaluation.each[0])
}

/// A value with the prefix that base parameters are usually written with.
fn plain(value: f64, unit: &str) -> String {
    let (value, unit) = match unit {
        "Pa" if value.abs() >= 1e8 => (1e-9 * value, " GPa"),
        "Pa" => (1e-3 * value, " kPa"),
        "1" => (value, ""),
        _ => return format!("{} {unit}", three_digits(value)),
    };
    format!("{}{unit}", three_digits(value))
}

/// Three significant digits, without zeros at the end of decimals.
fn three_digits(value: f64) -> String {
    let place = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    let text = format!("{value:.*}", (2 - place).clamp(0, 8) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// White noise of the force over all recordings.
fn force_noise_n(recordings: &[Prepared]) -> f64 {
    let (mut squares, mut rows) = (0.0, 0.0);
    for prepared in recordings {
        if let Some(force) = prepared.quality.channel("force") {
            let n = prepared.quality.n_rows as f64;
            squares += n * force.noise * force.noise;
            rows += n;
        }
    }
    (squares / f64::max(rows, 1.0)).sqrt()
}

/// What `recordings` cover.
fn domain(recordings: &[Prepared]) -> Domain {
    let range = |name: &str| {
        let channels = || recordings.iter().filter_map(|prepared| prepared.quality.channel(name));
        [
            channels().map(|channel| channel.lowest).fold(f64::INFINITY, f64::min),
            channels().map(|channel| channel.highest).fold(f64::NEG_INFINITY, f64::max),
        ]
    };
    let fastest = |rate: fn(&Prepared) -> f64| recordings.iter().map(rate).fold(0.0, f64::max);
    Domain {
        pressure_pa: range("pressure"),
        length_m: range("length"),
        force_n: range("force"),
        length_rate_m_per_s: fastest(|prepared| prepared.quality.length_rate_m_per_s),
        pressure_rate_pa_per_s: fastest(|prepared| prepared.quality.pressure_rate_pa_per_s),
    }
}
