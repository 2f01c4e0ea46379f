//! How wrong an identified model may be: parameters drawn from their own covariance.
//!
//! ```text
//! θ = θ̂ + S C ξ,   C Cᵀ = correlation,   S = diag(standard errors),   ξ ~ N(0, 1)
//! ```
//!
//! A composite is drawn as one number: its members keep their ratio. A parameter without a standard error, because it ended
//! at its bound, has no distribution to draw from and is held at its value.

use nalgebra::{DMatrix, DVector};
use pam_core::artifact::ModelArtifact;
use pam_core::force::{ForceModel, Parameter};
use pam_core::muscle::Dimension;
use rand::RngExt as _;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

/// Distribution of a model's parameters.
#[derive(Debug, Clone)]
pub struct Uncertainty {
    /// What each row of `factor` moves.
    targets: Vec<Target>,
    /// `S C`: one row for each target.
    factor: DMatrix<f64>,
    /// Names of what has no standard error.
    held: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Target {
    /// A parameter of eq. 11, by the value in the artifact.
    Parameter(Parameter),
    /// `C₁₀ + C₀₁`.
    Bladder,
    /// A dimension of the muscle.
    Dimension(Dimension),
}

/// Why a model's uncertainty cannot be drawn from.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UncertaintyError {
    /// The matrix is not square, or does not belong to the names.
    #[error("correlation has {names} names and a matrix of {rows} rows; write the model anew with pam-identify")]
    Shape {
        /// Names.
        names: usize,
        /// Rows.
        rows: usize,
    },
    /// A name that stands for no parameter.
    #[error(
        "correlation names \"{name}\", which is no parameter of the model; set trials.model_parameters = false, or write \
         the model anew with pam-identify"
    )]
    Unknown {
        /// Name found.
        name: String,
    },
    /// A standard error that is none.
    #[error("the standard error of {name} is {stderr}; write the model anew with pam-identify")]
    Negative {
        /// Name of the parameter.
        name: String,
        /// What it says.
        stderr: String,
    },
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
        let (names, matrix) = (&artifact.correlation.names, &artifact.correlation.matrix);
        if matrix.len() != names.len() || matrix.iter().any(|row| row.len() != names.len()) {
            return Err(UncertaintyError::Shape { names: names.len(), rows: matrix.len() });
        }
        let (mut rows, mut targets, mut errors, mut held) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (row, name) in names.iter().enumerate() {
            let of_parameter = artifact.parameters.iter().find(|entry| entry.name == *name).map(|entry| entry.stderr);
            let of_composite = artifact.composites.iter().find(|entry| entry.name == *name).map(|entry| entry.stderr);
            let known = target(name).zip(of_parameter.or(of_composite));
            let Some((target, stderr)) = known else { return Err(UncertaintyError::Unknown { name: name.clone() }) };
            match stderr {
                Some(stderr) if stderr >= 0.0 => {
                    rows.push(row);
                    targets.push(target);
                    errors.push(stderr);
                }
                Some(stderr) => {
                    return Err(UncertaintyError::Negative { name: name.clone(), stderr: stderr.to_string() });
                }
                None => held.push(name.clone()),
            }
        }
        let n = rows.len();
        // A perfect correlation is singular by rounding; a billionth on the diagonal moves nothing.
        let correlation = DMatrix::from_fn(n, n, |row, column| {
            let both = matrix[rows[row]][rows[column]] + matrix[rows[column]][rows[row]];
            0.5 * both + if row == column { 1e-9 } else { 0.0 }
        });
        let cholesky = correlation.cholesky().ok_or(UncertaintyError::Indefinite)?;
        Ok(Self { targets, factor: DMatrix::from_diagonal(&DVector::from_vec(errors)) * cholesky.l(), held })
    }

    /// Names of the parameters that are held at their values, for want of a standard error.
    pub fn held(&self) -> &[String] {
        &self.held
    }

    /// A model with parameters drawn around those of `model`.
    pub fn draw(&self, model: &ForceModel, rng: &mut Pcg64) -> ForceModel {
        let normal = DVector::from_fn(self.targets.len(), |_, _| rng.sample::<f64, _>(StandardNormal));
        let shifts = &self.factor * normal;
        let mut parameters = *model.parameters();
        let mut muscle = model.muscle().clone();
        for (target, shift) in self.targets.iter().zip(shifts.iter()) {
            match *target {
                Target::Parameter(parameter) => {
                    let value = &mut parameters.theta[parameter.index()];
                    *value = within_physics(parameter, *value, *shift);
                }
                Target::Bladder => {
                    let (c10, c01) = (Parameter::C10.index(), Parameter::C01.index());
                    let sum_pa = parameters.theta[c10] + parameters.theta[c01];
                    let scale = if sum_pa > 0.0 { (1.0 + shift / sum_pa).max(0.0) } else { 1.0 };
                    parameters.theta[c10] *= scale;
                    parameters.theta[c01] *= scale;
                }
                Target::Dimension(dimension) => {
                    let value = dimension.of(&muscle);
                    muscle = dimension.set(&muscle, (value + shift).max(LEAST_SHARE * value));
                }
            }
        }
        ForceModel::new(&muscle, model.strand_modulus_pa(), model.form(), parameters)
    }
}

/// Smallest share of a modulus or a dimension that a draw leaves: a tail of the normal distribution that reaches beyond is
/// no muscle.
const LEAST_SHARE: f64 = 0.01;

/// The parameter `value` after a `shift` of what the artifact writes; friction that drives and strands that lengthen when
/// they are let go are no muscle's.
fn within_physics(parameter: Parameter, value: f64, shift: f64) -> f64 {
    let written = parameter.from_artifact(value);
    let least = match parameter {
        Parameter::StrandCompliance => LEAST_SHARE * written,
        Parameter::RubberFriction | Parameter::StrandFriction => written.min(0.0),
        _ => f64::NEG_INFINITY,
    };
    parameter.from_artifact((written + shift).max(least))
}

fn target(name: &str) -> Option<Target> {
    if name == "c10 + c01" {
        return Some(Target::Bladder);
    }
    let parameter = Parameter::ALL.into_iter().find(|parameter| parameter.artifact_name() == name);
    let dimension = Dimension::ALL.into_iter().find(|dimension| dimension.parameter_name() == name);
    parameter.map(Target::Parameter).or(dimension.map(Target::Dimension))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

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
        assert_eq!(Uncertainty::new(&odd).err(), Some(UncertaintyError::Unknown { name: "k9".to_owned() }));
    }
}
