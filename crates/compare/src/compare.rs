//! Two models along the same recordings.

use pam_artifact::comparison::{ComparedParameter, ComparedRecording, Comparison, Outcome};
use pam_artifact::{InputRole, ModelArtifact};
use pam_identification::error::IdentifyError;
use pam_identification::evaluate::{NoForceAt, without_force};
use pam_identification::faults;
use pam_identification::predict::{prepare, prepare_plausible, walk_augmented};
use pam_muscle::effects::AugmentedModel;
use pam_recording::Recording;

use crate::blocks::{Errors, Resampling, difference};

/// What was found.
#[derive(Debug, Clone)]
pub struct Compared {
    /// Which model is better.
    pub outcome: Outcome,
    /// All recordings together.
    pub together: Comparison,
    /// Each recording.
    pub recordings: Vec<ComparedRecording>,
}

/// Chance below which a difference is none of chance.
pub const SIGNIFICANT: f64 = 0.05;

/// Residuals of one recording, and which samples count.
struct Walked {
    residuals_n: Vec<f64>,
    counted: Vec<bool>,
    period_s: f64,
}

/// Walks both models along `recordings`, all of which have a force. Recordings of another muscle are refused unless
/// `accept_implausible`.
///
/// # Errors
/// As [`prepare_plausible`], [`IdentifyError::HeldOutTwice`] where recordings share samples, which would count twice, and
/// [`IdentifyError::WithoutForce`] where a model has no force for a sample.
pub fn compare(
    models: [&ModelArtifact; 2],
    recordings: &[Recording],
    accept_implausible: bool,
    resampling: Resampling,
) -> Result<Compared, IdentifyError> {
    faults::twice::check(&[], recordings)?;
    let (mut counted, mut all, mut compared) = (Vec::new(), Vec::new(), Vec::new());
    for recording in recordings {
        let [a, b] = models.map(|model| walked(model, recording.clone(), accept_implausible));
        let (a, b) = (a?, b?);
        let both = || a.counted.iter().zip(&b.counted).map(|(a, b)| *a && *b);
        let picked = |walked: &Walked| -> Vec<f64> {
            walked
                .residuals_n
                .iter()
                .zip(both())
                .filter(|(_, counts)| *counts)
                .map(|(residual_n, _)| *residual_n)
                .collect()
        };
        let of_counted = Errors { a_n: picked(&a), b_n: picked(&b), period_s: a.period_s };
        let of_all = Errors { a_n: a.residuals_n, b_n: b.residuals_n, period_s: a.period_s };
        if of_counted.a_n.is_empty() {
            let n_rows = recording.samples.n_rows();
            return Err(IdentifyError::NothingCounted { path: recording.path.clone(), n_rows });
        }
        let [fitted_by_a, fitted_by_b] = models.map(|model| was_fitted_to(model, recording));
        let errors = comparison(std::slice::from_ref(&of_counted), std::slice::from_ref(&of_all), resampling);
        compared.push(ComparedRecording { path: recording.path.clone(), fitted_by_a, fitted_by_b, errors });
        counted.push(of_counted);
        all.push(of_all);
    }
    let together = comparison(&counted, &all, resampling);
    let outcome = match together.counted.p_value {
        Some(p) if p < SIGNIFICANT && together.counted.difference_n > 0.0 => Outcome::A,
        Some(p) if p < SIGNIFICANT && together.counted.difference_n < 0.0 => Outcome::B,
        _ => Outcome::NoDifference,
    };
    Ok(Compared { outcome, together, recordings: compared })
}

fn comparison(counted: &[Errors], all: &[Errors], resampling: Resampling) -> Comparison {
    Comparison { counted: difference(counted, resampling), all: difference(all, resampling) }
}

/// Whether `model` was fitted to a recording of the same bytes.
fn was_fitted_to(model: &ModelArtifact, recording: &Recording) -> bool {
    model.inputs.iter().any(|input| input.role == InputRole::Estimation && input.sha256 == recording.sha256)
}

fn walked(artifact: &ModelArtifact, recording: Recording, accept_implausible: bool) -> Result<Walked, IdentifyError> {
    let n_rows = recording.samples.n_rows();
    let mut prepared =
        if accept_implausible { prepare(recording, artifact)? } else { prepare_plausible(recording, artifact)? };
    // Events belong to the recordings that they were found in.
    let model: AugmentedModel = artifact.augmented_model().elsewhere();
    prepared.begin_with(&model, artifact.direction, 0)?;
    let mut walked = Walked {
        residuals_n: Vec::with_capacity(n_rows),
        counted: Vec::with_capacity(n_rows),
        period_s: prepared.quality.period_s,
    };
    let (mut n_without, mut first) = (0, None);
    walk_augmented(&prepared, &model, artifact.direction, 0, &mut |instant, model_n| {
        let residual_n = instant.force_n - model_n;
        if !(residual_n * residual_n).is_finite() {
            n_without += 1;
            let moment = &instant.moment;
            first.get_or_insert(NoForceAt {
                time_s: moment.time_s,
                pressure_pa: moment.pressure_pa,
                length_m: moment.length_m,
            });
        }
        walked.residuals_n.push(residual_n);
        walked.counted.push(instant.settled);
    })
    .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
    match first {
        Some(at) => Err(without_force(prepared.recording.path.clone(), n_without, n_rows, at, model.base())),
        None => Ok(walked),
    }
}

/// Parameters of both models, those of a first.
pub fn parameters([a, b]: [&ModelArtifact; 2]) -> Vec<ComparedParameter> {
    let mut names: Vec<(&str, &str)> = Vec::new();
    for entry in a.parameters.iter().chain(&b.parameters) {
        if !names.iter().any(|(name, _)| *name == entry.name) {
            names.push((&entry.name, &entry.unit));
        }
    }
    let found = |model: &ModelArtifact, name: &str| {
        let entry = model.parameters.iter().find(|entry| entry.name == name);
        (entry.map(|entry| entry.value), entry.and_then(|entry| entry.stderr))
    };
    let compared = |(name, unit): (&str, &str)| {
        let ((in_a, stderr_a), (in_b, stderr_b)) = (found(a, name), found(b, name));
        let standard_errors = match (in_a, in_b, stderr_a, stderr_b) {
            (Some(in_a), Some(in_b), Some(stderr_a), Some(stderr_b)) if stderr_a.hypot(stderr_b) > 0.0 => {
                Some((in_b - in_a) / stderr_a.hypot(stderr_b))
            }
            _ => None,
        };
        ComparedParameter {
            name: name.to_owned(),
            unit: unit.to_owned(),
            a: in_a,
            stderr_a,
            b: in_b,
            stderr_b,
            standard_errors,
        }
    };
    names.into_iter().map(compared).collect()
}
