//! The base force model, eq. 11, term by term.
//!
//! ```text
//! F = F_gas(p, ε; k₁, k₂) + k₃ + V_r dW/dL - F_braid(p, L) - s (f' p π D L + (f_ss / S_scale) S p)
//! ```
//!
//! with the gauge pressure `p` and the direction of motion `s` (+1 contracting, -1 extending; see
//! [`direction`](crate::direction)). One term is one file: [`gas`], [`bladder`], [`braid`],
//! [`rubber_friction`], [`strand_friction`]. [`Form::AsPrinted`] is the same sum as the paper prints it.
//! [`columns`] writes either as a sum of columns with weights, which is what a fit sees.

pub mod bladder;
pub mod braid;
pub mod columns;
mod form;
pub mod gas;
pub mod rubber_friction;
pub mod strand_friction;

pub use form::Form;

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::geometry::{Kinematics, Muscle};

/// A parameter of eq. 11 that a fit may find.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Parameter {
    /// `k₁`: gain of the gas term.
    K1,
    /// `k₂`: contraction gain of the gas term.
    K2,
    /// `k₃`: constant force, in N.
    K3,
    /// `C₁₀`, in Pa.
    C10,
    /// `C₀₁`, in Pa.
    C01,
    /// `1/E`, in 1/Pa; a fit sees the compliance, in which the force is nearly linear.
    StrandCompliance,
    /// `f'`.
    RubberFriction,
    /// `f_ss / S_scale`.
    StrandFriction,
}

impl Parameter {
    /// Every parameter, in the order of the vector `theta`.
    pub const ALL: [Self; 8] = [
        Self::K1,
        Self::K2,
        Self::K3,
        Self::C10,
        Self::C01,
        Self::StrandCompliance,
        Self::RubberFriction,
        Self::StrandFriction,
    ];

    /// Position in the vector `theta`.
    pub fn index(self) -> usize {
        self as usize
    }

    /// Name in artifacts and on the command line.
    pub fn artifact_name(self) -> &'static str {
        match self {
            Self::K1 => "k1",
            Self::K2 => "k2",
            Self::K3 => "k3",
            Self::C10 => "c10",
            Self::C01 => "c01",
            Self::StrandCompliance => "strand_modulus",
            Self::RubberFriction => "rubber_friction",
            Self::StrandFriction => "strand_friction",
        }
    }

    /// Unit in artifacts; `1` where it has none.
    pub fn unit(self) -> &'static str {
        match self {
            Self::K1 | Self::K2 | Self::RubberFriction | Self::StrandFriction => "1",
            Self::K3 => "N",
            Self::C10 | Self::C01 | Self::StrandCompliance => "Pa",
        }
    }

    /// Value in `theta` for a value in an artifact: people read the modulus of a strand, a fit sees its
    /// compliance. The map is its own inverse.
    pub fn from_artifact(self, value: f64) -> f64 {
        if self == Self::StrandCompliance { 1.0 / value } else { value }
    }
}

/// Values of the eight parameters, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseParameters {
    /// Values in the order of [`Parameter::ALL`].
    pub theta: [f64; 8],
}

impl BaseParameters {
    /// The value of one parameter.
    pub fn of(&self, parameter: Parameter) -> f64 {
        self.theta[parameter.index()]
    }
}

/// The terms of eq. 11 at one instant, in N; their sum is [`Terms::force_n`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Terms {
    /// Gas on the braid.
    pub gas_n: f64,
    /// `k₃`.
    pub offset_n: f64,
    /// Bladder, with the sign of the form.
    pub bladder_n: f64,
    /// Stretch of the strands; a loss, negative.
    pub braid_n: f64,
    /// Friction, opposed to the direction of motion.
    pub friction_n: f64,
}

impl Terms {
    /// Force of the muscle.
    pub fn force_n(&self) -> f64 {
        self.gas_n + self.offset_n + self.bladder_n + self.braid_n + self.friction_n
    }
}

/// Eq. 11 for one muscle with values for its parameters.
#[derive(Debug, Clone)]
pub struct ForceModel {
    form: Form,
    parameters: BaseParameters,
    muscle: Muscle,
    strand_modulus_pa: f64,
    /// Strain of the strands per pressure and length, in 1/(Pa m).
    stretch: f64,
    kinematics: Kinematics,
    gas: gas::Gas,
    bladder: bladder::Bladder,
    braid: braid::Braid,
    contact: strand_friction::StrandContact,
}

impl ForceModel {
    /// The model of `muscle`; `strand_modulus_pa` serves the contact between strands, and how far they slide under pressure.
    pub fn new(muscle: &Muscle, strand_modulus_pa: f64, form: Form, parameters: BaseParameters) -> Self {
        Self {
            form,
            parameters,
            muscle: muscle.clone(),
            strand_modulus_pa,
            stretch: braid::Braid::new(muscle, Form::Corrected).strain(1.0, 1.0, 1.0 / strand_modulus_pa),
            kinematics: Kinematics::of(muscle),
            gas: gas::Gas::new(muscle),
            bladder: bladder::Bladder::new(muscle),
            braid: braid::Braid::new(muscle, form),
            contact: strand_friction::StrandContact::new(muscle, strand_modulus_pa),
        }
    }

    /// Muscle that the model describes.
    pub fn muscle(&self) -> &Muscle {
        &self.muscle
    }

    /// How far the strands slide over one another per pascal while the muscle is held at a length, in m/Pa: their stretch
    /// (eq. 2) changes the angle of the braid as much as a shortening by `L Δy` does. The indentation of the bladder, which
    /// adds to it, is left out.
    pub fn slide_m_per_pa(&self, length_m: f64) -> f64 {
        self.stretch * length_m * length_m
    }

    /// Modulus that the contact between strands is computed with, in Pa.
    pub fn strand_modulus_pa(&self) -> f64 {
        self.strand_modulus_pa
    }

    /// How eq. 11 is written.
    pub fn form(&self) -> Form {
        self.form
    }

    /// Kinematics of the braid.
    pub fn kinematics(&self) -> &Kinematics {
        &self.kinematics
    }

    /// Bladder term, without its parameters.
    pub fn bladder(&self) -> &bladder::Bladder {
        &self.bladder
    }

    /// Values of the parameters.
    pub fn parameters(&self) -> &BaseParameters {
        &self.parameters
    }

    /// The terms at gauge pressure, length and direction (+1 contracting, -1 extending, 0 neither).
    pub fn terms(&self, pressure_pa: f64, length_m: f64, direction: f64) -> Terms {
        let [k1, k2, k3, c10_pa, c01_pa, compliance_per_pa, rubber, strand] = self.parameters.theta;
        let diameter_m = self.kinematics.diameter_m(length_m);
        let [by_c10, by_c01] = self.bladder.columns_at(length_m, diameter_m);
        let normal_n = rubber_friction::normal_force_n(pressure_pa, diameter_m, length_m);
        // A cube root, which most models have no use for, and none where friction pulls neither way.
        let rubs = strand != 0.0 && direction != 0.0;
        let contact_n = if rubs { strand * self.contact.force_n(pressure_pa, normal_n) } else { 0.0 };
        let friction_n = rubber * normal_n + contact_n;
        Terms {
            gas_n: self.gas.force_n(pressure_pa, self.kinematics.contraction_ratio(length_m), k1, k2),
            offset_n: k3,
            bladder_n: self.form.bladder_sign() * (c10_pa * by_c10 + c01_pa * by_c01),
            braid_n: -self.braid.force_n(pressure_pa, length_m, compliance_per_pa),
            friction_n: -direction * friction_n,
        }
    }

    /// Force of the muscle, in N; see [`terms`](Self::terms).
    pub fn force_n(&self, pressure_pa: f64, length_m: f64, direction: f64) -> f64 {
        self.terms(pressure_pa, length_m, direction).force_n()
    }
}

#[cfg(test)]
mod tests;
