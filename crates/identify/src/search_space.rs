//! Fitted parameters, their ranges, and the values that are plausible for a muscle.
//!
//! Two ranges stand beside each parameter. The *search* range holds every sign and size that physics
//! allows for any muscle, commercial ones with molded ends included; the *plausible* range is that of
//! braided muscles of latex or silicone with nylon or PET strands. An estimate outside the plausible range
//! warns, with the cause that is likely then: tare, gain and datum errors are absorbed by the parameters and
//! show nowhere else.

use pam_muscle::force::{BaseParameters, Parameter};

/// `C₀₁ / C₁₀` of latex, 105.7 / 118.4 (Klute and Hannaford, 2000): how the sum is shared unless told
/// otherwise.
pub const LATEX_RATIO: f64 = 105.7 / 118.4;

/// Compliance of a strand that no force model can tell from a rigid one: a modulus of 1000 GPa.
const RIGID_PER_PA: f64 = 1e-12;

/// A parameter, or a composite of two, that the search moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Free {
    /// One parameter on its own.
    One(Parameter),
    /// `C₁₀ + C₀₁` at a fixed ratio.
    BladderSum,
}

/// Ranges of a parameter, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranges {
    /// Where the search looks.
    pub search: (f64, f64),
    /// Plausible range of a braided muscle.
    pub plausible: (f64, f64),
    /// Held there where an excitation cannot identify it.
    pub nominal: f64,
}

impl Free {
    /// Name in artifacts, notes and the correlation matrix.
    pub fn name(self) -> &'static str {
        match self {
            Self::One(parameter) => parameter.artifact_name(),
            Self::BladderSum => "c10 + c01",
        }
    }

    /// Ranges; `strand_modulus_pa` is the modulus that the muscle file states.
    pub fn ranges(self, strand_modulus_pa: f64) -> Ranges {
        let ranges = |search, plausible, nominal| Ranges { search, plausible, nominal };
        match self {
            Self::One(Parameter::K1) => ranges((0.2, 2.0), (0.75, 1.05), 0.9),
            Self::One(Parameter::K2) => ranges((0.5, 3.0), (0.95, 1.3), 1.05),
            Self::One(Parameter::K3) => ranges((-50.0, 50.0), (-5.0, 5.0), 0.0),
            Self::One(Parameter::C10 | Parameter::C01) => ranges((0.0, 1.0e6), (0.0, 500e3), 110e3),
            Self::BladderSum => ranges((0.0, 2.0e6), (100e3, 500e3), 224.1e3),
            Self::One(Parameter::StrandCompliance) => {
                ranges((RIGID_PER_PA, 1.0 / 0.2e9), (1.0 / 12e9, 1.0 / 0.5e9), 1.0 / strand_modulus_pa)
            }
            Self::One(Parameter::RubberFriction) => ranges((0.0, 0.03), (0.5e-3, 6e-3), 1.2e-3),
            Self::One(Parameter::StrandFriction) => ranges((0.0, 20.0), (0.0, 3.0), 0.0),
        }
    }

    /// The usual cause of an estimate below (or above) the plausible range.
    pub fn likely_cause(self, above: bool) -> &'static str {
        match (self, above) {
            (Self::One(Parameter::K1), _) => {
                "a gain of the force or pressure channel, rest_radius_mm (k1 acts as its square) or braid_angle_deg"
            }
            (Self::One(Parameter::K2), true) => {
                "ends that are no cylinder, an inactive length at the fittings, or braid_angle_deg too small"
            }
            (Self::One(Parameter::K2), false) => "the datum of the length sensor, or braid_angle_deg too large",
            (Self::One(Parameter::K3), _) => "the tare of the load cell, or the zero of the pressure transducer",
            (Self::One(Parameter::C10 | Parameter::C01) | Self::BladderSum, true) => {
                "wall_thickness_mm too small, or a pressure that inflates the bladder before it pulls"
            }
            (Self::One(Parameter::C10 | Parameter::C01) | Self::BladderSum, false) => {
                "the datum of the length sensor, the zero of the pressure transducer, or wall_thickness_mm too large"
            }
            (Self::One(Parameter::StrandCompliance), true) => {
                "compliance between the clamps and the length sensor, or strands softer than the muscle file says"
            }
            (Self::One(Parameter::StrandCompliance), false) => "a gain that hides the stretch of the strands",
            (Self::One(Parameter::RubberFriction | Parameter::StrandFriction), true) => {
                "a delay or damping that looks like friction, or friction outside the muscle"
            }
            (Self::One(Parameter::RubberFriction | Parameter::StrandFriction), false) => {
                "a channel that lags the others, or a recording without reversals"
            }
        }
    }
}

/// The parameters that a fit moves, with everything else held.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchSpace {
    /// Free parameters, in the order of the unit box.
    pub free: Vec<Free>,
    /// Lowest and highest value of each, in SI.
    pub ranges: Vec<(f64, f64)>,
    /// Values of what is held.
    pub held: BaseParameters,
    /// `C₀₁ / C₁₀`.
    pub bladder_ratio: f64,
}

impl SearchSpace {
    /// Values of all parameters at a point of the unit box.
    pub fn parameters(&self, x: &[f64]) -> BaseParameters {
        let mut parameters = self.held;
        for (index, (&free, &(low, high))) in self.free.iter().zip(&self.ranges).enumerate() {
            let value = low + x[index] * (high - low);
            match free {
                Free::One(parameter) => parameters.theta[parameter.index()] = value,
                Free::BladderSum => {
                    parameters.theta[Parameter::C10.index()] = value / (1.0 + self.bladder_ratio);
                    parameters.theta[Parameter::C01.index()] = value * self.bladder_ratio / (1.0 + self.bladder_ratio);
                }
            }
        }
        parameters
    }

    /// Value of a free parameter at a coordinate of the unit box, in SI.
    pub fn value(&self, index: usize, coordinate: f64) -> f64 {
        let (low, high) = self.ranges[index];
        low + coordinate * (high - low)
    }

    /// Derivative by coordinate `index` of anything whose derivatives by the eight parameters are
    /// `slopes`.
    pub fn pull_back<const N: usize>(&self, index: usize, slopes: &[[f64; N]; 8]) -> [f64; N] {
        let (low, high) = self.ranges[index];
        let span = high - low;
        match self.free[index] {
            Free::One(parameter) => slopes[parameter.index()].map(|slope| span * slope),
            Free::BladderSum => {
                let (first, second) = (&slopes[Parameter::C10.index()], &slopes[Parameter::C01.index()]);
                let share = 1.0 / (1.0 + self.bladder_ratio);
                std::array::from_fn(|column| span * share * (first[column] + self.bladder_ratio * second[column]))
            }
        }
    }

    /// Coordinate in the unit box of the nominal value of a free parameter.
    pub fn nominal_coordinate(&self, index: usize, strand_modulus_pa: f64) -> f64 {
        let (low, high) = self.ranges[index];
        ((self.free[index].ranges(strand_modulus_pa).nominal - low) / (high - low)).clamp(0.0, 1.0)
    }
}
