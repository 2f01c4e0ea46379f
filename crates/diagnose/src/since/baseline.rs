//! What the model of then knew of its parameters.

use nalgebra::{DMatrix, SymmetricEigen};
use pam_artifact::ModelArtifact;
use pam_identification::search_space::Free;
use pam_muscle::effects::{CATALOGUE, Kind, effect};
use pam_muscle::force::Parameter;
use pam_muscle::force::columns::ForceColumns;

use super::quantity::Quantity;
use crate::base;

/// Times its standard error that a base parameter may differ without having changed: it is an error of the noise in its
/// recordings, and other paths through the same range move a parameter by more.
const INFLATED: f64 = 2.0;

/// Quantities of the model of then, and what is known of them.
#[derive(Debug)]
pub(crate) struct Baseline {
    /// Base parameters that were free.
    pub free: Vec<Free>,
    /// Directions of the base parameters (those of `free`, SI) that vary independently, each as long as its standard error.
    pub directions: Vec<Vec<f64>>,
    /// Amplitudes and shapes with their standard errors.
    pub of_terms: Vec<(Quantity, f64)>,
    /// How much the model of then missed its own recordings by beyond their noise, in N.
    pub missed_n: f64,
}

impl Baseline {
    /// Of `model`; terms are counted without events.
    pub(crate) fn of(model: &ModelArtifact, columns: &ForceColumns) -> Self {
        let free = base::search_space(model, columns).free;
        let stderr: Vec<f64> = free.iter().map(|&free| INFLATED * stderr(model, free).unwrap_or(0.0)).collect();
        let covariance = DMatrix::from_fn(free.len(), free.len(), |row, column| {
            stderr[row] * stderr[column] * correlation(model, free[row], free[column])
        });
        // Of order one, whatever the units.
        let scaled = DMatrix::from_fn(free.len(), free.len(), |row, column| {
            let size = stderr[row] * stderr[column];
            if size > 0.0 { covariance[(row, column)] / size } else { 0.0 }
        });
        let eigen = SymmetricEigen::new(scaled);
        let directions = (0..free.len())
            .filter(|&index| eigen.eigenvalues[index] > 1e-9)
            .map(|index| {
                let length = eigen.eigenvalues[index].sqrt();
                (0..free.len()).map(|row| length * stderr[row] * eigen.eigenvectors[(row, index)]).collect()
            })
            .collect();
        let then = &model.fit.estimation;
        Self {
            free,
            directions,
            of_terms: of_terms(model),
            missed_n: (then.rmse_n.powi(2) - model.fit.noise_floor_n.powi(2)).max(0.0).sqrt(),
        }
    }
}

/// Standard error of a base parameter, SI; of a modulus that of its inverse.
fn stderr(model: &ModelArtifact, free: Free) -> Option<f64> {
    let stderr = match free {
        Free::BladderSum => model.composites.iter().find(|entry| entry.name == free.name())?.stderr,
        Free::One(parameter) => {
            let entry = model.parameters.iter().find(|entry| entry.name == parameter.artifact_name())?;
            // δ(1/E) = δE / E².
            let scale = if parameter == Parameter::StrandCompliance { entry.value.powi(-2) } else { 1.0 };
            entry.stderr.map(|stderr| scale * stderr)
        }
    };
    stderr.filter(|stderr| stderr.is_finite() && *stderr > 0.0)
}

fn correlation(model: &ModelArtifact, left: Free, right: Free) -> f64 {
    let at = |free: Free| model.correlation.names.iter().position(|name| name == free.name());
    let known = || model.correlation.matrix.get(at(left)?)?.get(at(right)?).copied();
    match known() {
        _ if left == right => 1.0,
        Some(value) if value.is_finite() => value.clamp(-1.0, 1.0),
        _ => 0.0,
    }
}

/// Amplitudes and shapes of named effects that have a standard error.
fn of_terms(model: &ModelArtifact) -> Vec<(Quantity, f64)> {
    let lasting =
        model.effects.iter().filter(|entry| effect(&entry.id).is_none_or(|effect| effect.kind() != Kind::Event));
    let mut known = Vec::new();
    for (term, entry) in lasting.enumerate() {
        let Some(effect) = CATALOGUE.iter().find(|effect| effect.page().id == entry.id) else { continue };
        let stderr = |name: &str| {
            let found = entry.parameters.iter().find(|parameter| parameter.name == name)?;
            found.stderr.filter(|stderr| stderr.is_finite() && *stderr > 0.0)
        };
        for (index, amplitude) in effect.amplitudes().iter().enumerate() {
            known.extend(stderr(amplitude.name).map(|stderr| (Quantity::Amplitude { term, index }, stderr)));
        }
        for (index, shape) in effect.shape().iter().enumerate() {
            known.extend(stderr(shape.name).map(|stderr| (Quantity::Shape { term, index }, stderr)));
        }
    }
    known
}
