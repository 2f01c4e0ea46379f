//! The base model as a diagnosis refits it: the same parameters free as when it was identified.

use pam_artifact::ModelArtifact;
use pam_artifact::model::ParameterStatus;
use pam_identification::search_space::{Free, SearchSpace};
use pam_muscle::force::Parameter;
use pam_muscle::force::columns::ForceColumns;

/// What `model` leaves free, within the ranges of an identification; everything else is held at its value.
pub fn search_space(model: &ModelArtifact, columns: &ForceColumns) -> SearchSpace {
    let status = |parameter: Parameter| {
        model
            .parameters
            .iter()
            .find(|entry| entry.name == parameter.artifact_name())
            .map_or(ParameterStatus::Fixed, |entry| entry.status)
    };
    let sum = model.composites.iter().any(|composite| composite.name == Free::BladderSum.name());
    let mut free = Vec::new();
    for parameter in Parameter::ALL {
        if sum && matches!(parameter, Parameter::C10 | Parameter::C01) {
            if parameter == Parameter::C10 {
                free.push(Free::BladderSum);
            }
        } else if status(parameter) != ParameterStatus::Fixed {
            free.push(Free::One(parameter));
        }
    }
    let ranges = free
        .iter()
        .map(|free| {
            let (low, high) = free.ranges(model.strand_modulus_pa).search;
            if *free == Free::One(Parameter::StrandCompliance) {
                (low, high.min(columns.max_compliance_per_pa()))
            } else {
                (low, high)
            }
        })
        .collect();
    SearchSpace { free, ranges, held: *model.force_model().parameters(), bladder_ratio: model.config.bladder_ratio }
}

/// The point of the unit box of `space` that stands for the values of `model`.
pub fn coordinates(model: &ModelArtifact, space: &SearchSpace) -> Vec<f64> {
    let theta = *model.force_model().parameters();
    space
        .free
        .iter()
        .zip(&space.ranges)
        .map(|(free, (low, high))| {
            let value = match free {
                Free::One(parameter) => theta.of(*parameter),
                Free::BladderSum => theta.of(Parameter::C10) + theta.of(Parameter::C01),
            };
            ((value - low) / (high - low)).clamp(0.0, 1.0)
        })
        .collect()
}
