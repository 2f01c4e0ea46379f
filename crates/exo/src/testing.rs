//! Starting points of several tests.

use pam_muscle::Muscle;
use pam_muscle::effects::{AugmentedModel, Term, effect};
use pam_muscle::force::{BaseParameters, ForceModel, Form};

/// The nominal self-made McKibben muscle of 267 mm.
pub(crate) fn nominal_muscle() -> Muscle {
    Muscle::nominal()
}

/// Its force model.
pub(crate) fn nominal_model() -> ForceModel {
    let parameters = BaseParameters { theta: [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.0] };
    ForceModel::new(&nominal_muscle(), 3e9, Form::Corrected, parameters)
}

/// It with an effect of the catalogue.
pub(crate) fn with_effect(id: &str, shape: &[f64], amplitudes: &[f64]) -> AugmentedModel {
    let effect = effect(id).unwrap_or_else(|| panic!("no effect {id}"));
    AugmentedModel::new(nominal_model(), vec![Term::new(effect, shape.to_vec(), amplitudes.to_vec())])
}
