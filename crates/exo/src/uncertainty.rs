//! How wrong an identified model may be: parameters drawn from their own covariance.
//!
//! ```text
//! θ = θ̂ + S C ξ,   C Cᵀ = correlation,   S = diag(standard errors),   ξ ~ N(0, 1)
//! ```
//!
//! A composite is drawn as one number: its members keep their ratio. A parameter without a standard error, because it ended
//! at its bound, has no distribution to draw from and is held at its value.

use nalgebra::{DMatrix, DVector};
use pam_artifact::estimates::EstimatesError;
use pam_artifact::{Estimates, ModelArtifact};
use pam_muscle::force::ForceModel;
use rand::RngExt as _;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

/// Distribution of a model's parameters.
#[derive(Debug, Clone)]
pub struct Uncertainty {
    estimates: Estimates,
    /// `S C`: one row for each estimate.
    factor: DMatrix<f64>,
}

/// Why a model's uncertainty cannot be drawn from.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UncertaintyError {
    /// The artifact says nothing of it.
    #[error(transparent)]
    Estimates(#[from] EstimatesError),
    /// The matrix is no correlation matrix.
    #[error("correlation is not positive definite; set trials.model_parameters = false, or identify the model anew")]
    Indefinite,
}

impl Uncertainty {
    /// The distribution in an artifact.
    ///
    /// # Errors
    /// [`UncertaintyError`] says what is missing there.
    pub fn new(artifact: &ModelArtifact) -> Result<Self, UncertaintyError> {
        let estimates = Estimates::of(artifact)?;
        let n = estimates.len();
        // A perfect correlation is singular by rounding; a billionth on the diagonal moves nothing.
        let correlation = DMatrix::from_fn(n, n, |row, column| {
            estimates.correlation()[row][column] + if row == column { 1e-9 } else { 0.0 }
        });
        let cholesky = correlation.cholesky().ok_or(UncertaintyError::Indefinite)?;
        let factor = DMatrix::from_diagonal(&DVector::from_row_slice(estimates.stderr())) * cholesky.l();
        Ok(Self { estimates, factor })
    }

    /// Names of the parameters that are held at their values, for want of a standard error.
    pub fn held(&self) -> &[String] {
        self.estimates.held()
    }

    /// A model with parameters drawn around those of `model`.
    pub fn draw(&self, model: &ForceModel, rng: &mut Pcg64) -> ForceModel {
        let normal = DVector::from_fn(self.estimates.len(), |_, _| rng.sample::<f64, _>(StandardNormal));
        self.estimates.shifted(model, (&self.factor * normal).as_slice())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use pam_muscle::force::Parameter;
    use rand_pcg::Pcg64;

    use super::*;

    fn artifact() -> ModelArtifact {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../bin/exo-track/tests/data/model.json");
        ModelArtifact::read(&path).expect("the shipped model").0
    }

    #[test]
    fn a_parameter_at_its_bound_is_held_and_the_others_are_drawn_as_before() {
        let free = artifact();
        let mut bound = free.clone();
        let index = bound.correlation.names.iter().position(|name| name == "k3").expect("k3 is fitted");
        for other in 0..bound.correlation.names.len() {
            let entry = if other == index { 1.0 } else { 0.0 };
            bound.correlation.matrix[index][other] = entry;
            bound.correlation.matrix[other][index] = entry;
        }
        let k3 = bound.parameters.iter_mut().find(|entry| entry.name == "k3").expect("every model has k3");
        k3.stderr = None;
        let uncertainty = Uncertainty::new(&bound).expect("what is left can be drawn from");
        assert_eq!(uncertainty.held(), ["k3"]);
        let model = bound.force_model();
        let mut rng = Pcg64::new(1, 1);
        for _ in 0..20 {
            let drawn = uncertainty.draw(&model, &mut rng);
            let of = |model: &ForceModel, parameter: Parameter| model.parameters().theta[parameter.index()];
            assert_eq!(of(&drawn, Parameter::K3).to_bits(), of(&model, Parameter::K3).to_bits());
            assert!((of(&drawn, Parameter::K1) - of(&model, Parameter::K1)).abs() > 0.0);
        }
    }

    #[test]
    fn a_model_without_any_standard_error_is_drawn_as_it_is() {
        let mut fixed = artifact();
        fixed.parameters.iter_mut().for_each(|entry| entry.stderr = None);
        fixed.composites.iter_mut().for_each(|entry| entry.stderr = None);
        let uncertainty = Uncertainty::new(&fixed).expect("nothing is left to draw");
        assert_eq!(uncertainty.held().len(), fixed.correlation.names.len());
        let drawn = uncertainty.draw(&fixed.force_model(), &mut Pcg64::new(1, 1));
        assert_eq!(drawn.parameters(), fixed.force_model().parameters());
    }

    #[test]
    fn a_name_that_is_no_parameter_is_refused() {
        let mut odd = artifact();
        odd.correlation.names[0] = "k9".to_owned();
        assert_eq!(Uncertainty::new(&odd).err(), Some(EstimatesError::Unknown { name: "k9".to_owned() }.into()));
    }
}
