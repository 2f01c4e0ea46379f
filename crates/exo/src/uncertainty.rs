//! How wrong an identified model may be: parameters drawn from their own covariance.
//!
//! ```text
//! θ = θ̂ + S C ξ,   C Cᵀ = correlation,   S = diag(standard errors),   ξ ~ N(0, 1)
//! ```
//!
//! What the identification reports as a composite is drawn as one: the members keep their ratio.

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
    /// A name that stands for no parameter, or one without a standard error.
    #[error(
        "correlation names \"{name}\", which has no standard error or is unknown; set trials.model_parameters = false, \
         or write the model anew with pam-identify"
    )]
    Unknown {
        /// Name found.
        name: String,
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
        let mut targets = Vec::new();
        let mut errors = Vec::new();
        for name in names {
            let unknown = || UncertaintyError::Unknown { name: name.clone() };
            let of_parameter = artifact.parameters.iter().find(|entry| entry.name == *name).map(|entry| entry.stderr);
            let of_composite = artifact.composites.iter().find(|entry| entry.name == *name).map(|entry| entry.stderr);
            let stderr = of_parameter.or(of_composite).flatten().filter(|stderr| *stderr >= 0.0);
            errors.push(stderr.ok_or_else(unknown)?);
            targets.push(target(name).ok_or_else(unknown)?);
        }
        let n = names.len();
        // A perfect correlation is singular by rounding; a billionth on the diagonal moves nothing.
        let correlation = DMatrix::from_fn(n, n, |row, column| {
            0.5 * (matrix[row][column] + matrix[column][row]) + if row == column { 1e-9 } else { 0.0 }
        });
        let cholesky = correlation.cholesky().ok_or(UncertaintyError::Indefinite)?;
        Ok(Self { targets, factor: DMatrix::from_diagonal(&DVector::from_vec(errors)) * cholesky.l() })
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
                    *value = parameter.from_artifact(parameter.from_artifact(*value) + shift);
                }
                Target::Bladder => {
                    let (c10, c01) = (Parameter::C10.index(), Parameter::C01.index());
                    let sum_pa = parameters.theta[c10] + parameters.theta[c01];
                    let scale = if sum_pa > 0.0 { 1.0 + shift / sum_pa } else { 1.0 };
                    parameters.theta[c10] *= scale;
                    parameters.theta[c01] *= scale;
                }
                Target::Dimension(dimension) => muscle = dimension.set(&muscle, dimension.of(&muscle) + shift),
            }
        }
        ForceModel::new(&muscle, model.strand_modulus_pa(), model.form(), parameters)
    }
}

fn target(name: &str) -> Option<Target> {
    if name == "c10 + c01" {
        return Some(Target::Bladder);
    }
    let parameter = Parameter::ALL.into_iter().find(|parameter| parameter.artifact_name() == name);
    let dimension = Dimension::ALL.into_iter().find(|dimension| dimension.parameter_name() == name);
    parameter.map(Target::Parameter).or(dimension.map(Target::Dimension))
}
