//! What an identified model says of its own uncertainty: standard errors, correlation, and a model with its parameters
//! moved.
//!
//! A composite is one number: its members keep their ratio. A parameter without a standard error, because it ended at its
//! bound, is held at its value.

use pam_muscle::Dimension;
use pam_muscle::force::{ForceModel, Parameter};

use super::model::ModelArtifact;

/// Estimates of a model that have a standard error, in the order of its correlation matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimates {
    targets: Vec<Target>,
    stderr: Vec<f64>,
    correlation: Vec<Vec<f64>>,
    held: Vec<String>,
}

/// What an estimate moves.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Target {
    /// A parameter of eq. 11, by the value in the artifact.
    Parameter(Parameter),
    /// `C₁₀ + C₀₁`.
    Bladder,
    /// A dimension of the muscle.
    Dimension(Dimension),
}

/// Why an artifact says nothing of its uncertainty.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum EstimatesError {
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
        "correlation names \"{name}\", which is no parameter of the model; write the model \
         anew with pam-identify"
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
}

impl Estimates {
    /// Those of an artifact.
    ///
    /// # Errors
    /// [`EstimatesError`] says what is missing there.
    pub fn of(artifact: &ModelArtifact) -> Result<Self, EstimatesError> {
        let (names, matrix) = (&artifact.correlation.names, &artifact.correlation.matrix);
        if matrix.len() != names.len() || matrix.iter().any(|row| row.len() != names.len()) {
            return Err(EstimatesError::Shape { names: names.len(), rows: matrix.len() });
        }
        let (mut rows, mut targets, mut errors, mut held) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (row, name) in names.iter().enumerate() {
            let of_parameter = artifact.parameters.iter().find(|entry| entry.name == *name).map(|entry| entry.stderr);
            let of_composite = artifact.composites.iter().find(|entry| entry.name == *name).map(|entry| entry.stderr);
            let known = target(name).zip(of_parameter.or(of_composite));
            let Some((target, stderr)) = known else { return Err(EstimatesError::Unknown { name: name.clone() }) };
            match stderr {
                Some(stderr) if stderr >= 0.0 => {
                    rows.push(row);
                    targets.push(target);
                    errors.push(stderr);
                }
                Some(stderr) => {
                    return Err(EstimatesError::Negative { name: name.clone(), stderr: stderr.to_string() });
                }
                None => held.push(name.clone()),
            }
        }
        let both = |row: usize, column: usize| 0.5 * (matrix[row][column] + matrix[column][row]);
        let correlation = rows.iter().map(|&row| rows.iter().map(|&column| both(row, column)).collect()).collect();
        Ok(Self { targets, stderr: errors, correlation, held })
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.targets.len()
    }

    /// Whether none has a standard error.
    pub fn is_empty(&self) -> bool {
        self.targets.is_empty()
    }

    /// Standard errors, in the units of the artifact.
    pub fn stderr(&self) -> &[f64] {
        &self.stderr
    }

    /// Their correlation, symmetric, `n × n`, row by row.
    pub fn correlation(&self) -> &[Vec<f64>] {
        &self.correlation
    }

    /// Names of the parameters that are held at their values, for want of a standard error.
    pub fn held(&self) -> &[String] {
        &self.held
    }

    /// `model` with each estimate moved by its entry of `shifts`, in the units of the artifact, as far as physics allows.
    ///
    /// # Panics
    /// Where there are fewer shifts than estimates.
    pub fn shifted(&self, model: &ForceModel, shifts: &[f64]) -> ForceModel {
        let mut parameters = *model.parameters();
        let mut muscle = model.muscle().clone();
        for (index, target) in self.targets.iter().enumerate() {
            let shift = shifts[index];
            match *target {
                Target::Parameter(parameter) => {
                    let value = &mut parameters.theta[parameter.index()];
                    *value = within_physics(parameter, *value, shift);
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

/// Smallest share of a modulus or a dimension that a shift leaves: a tail of the normal distribution that reaches beyond is
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
