//! What a sentence is in proportion to.
//!
//! | scale                 | factor                                                                  | unit |
//! |-----------------------|-------------------------------------------------------------------------|------|
//! | `one`                 | 1                                                                       | 1    |
//! | `pressure`            | gauge pressure                                                          | Pa   |
//! | `gas-force`           | gas on the braid, of eq. 11                                             | N    |
//! | `bladder-force`       | bladder of latex ([`LATEX_PA`](crate::effects::moment::LATEX_PA)), negative where it resists | N |
//! | `friction`            | `s p π D L`, the friction of eq. 11 over its coefficient                 | N    |
//! | `direction`           | `s`: +1 contracting, -1 extending                                       | 1    |
//! | `contracting`         | `(1 + s) / 2`                                                           | 1    |
//! | `extending`           | `(1 - s) / 2`                                                           | 1    |
//! | `slope-over-pressure` | `∂F/∂p` of eq. 11: the curve is an error of the pressure, in Pa          | N/Pa |
//! | `slope-over-length`   | `∂F/∂L` of eq. 11: the curve is an error of the length, in m            | N/m  |

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::effects::{Base, Moment};

/// What a sentence is in proportion to; see the [module](self) for the factors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Scale {
    /// Nothing.
    One,
    /// Gauge pressure.
    Pressure,
    /// Force of the gas on the braid.
    GasForce,
    /// Force of the bladder.
    BladderForce,
    /// Friction of eq. 11 over its coefficient.
    Friction,
    /// Direction of motion.
    Direction,
    /// 1 while the muscle contracts, 0 while it extends.
    Contracting,
    /// 1 while it extends, 0 while it contracts.
    Extending,
    /// Slope of the force over the pressure.
    SlopeOverPressure,
    /// Slope of the force over the length.
    SlopeOverLength,
}

impl Scale {
    /// Every one.
    pub const ALL: [Self; 10] = [
        Self::One,
        Self::Pressure,
        Self::GasForce,
        Self::BladderForce,
        Self::Friction,
        Self::Direction,
        Self::Contracting,
        Self::Extending,
        Self::SlopeOverPressure,
        Self::SlopeOverLength,
    ];

    /// The factor.
    pub fn factor(self, now: &Moment, base: &Base) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Pressure => now.pressure_pa,
            Self::GasForce => base.gas_n,
            Self::BladderForce => base.latex_n(),
            Self::Friction => now.direction * base.normal_n,
            Self::Direction => now.direction,
            Self::Contracting => 0.5 * (1.0 + now.direction),
            Self::Extending => 0.5 * (1.0 - now.direction),
            Self::SlopeOverPressure => base.slope_n_per_pa,
            Self::SlopeOverLength => base.slope_n_per_m,
        }
    }

    /// Unit of a curve that the factor makes a force of.
    pub fn unit_of_curve(self) -> &'static str {
        match self {
            Self::One | Self::Direction | Self::Contracting | Self::Extending => "N",
            Self::Pressure => "N/Pa",
            Self::GasForce | Self::BladderForce | Self::Friction => "1",
            Self::SlopeOverPressure => "Pa",
            Self::SlopeOverLength => "m",
        }
    }

    /// Largest size of a curve that any muscle may want, in its unit: beyond every force that one has.
    pub(super) fn largest(self) -> f64 {
        match self {
            Self::One | Self::Direction | Self::Contracting | Self::Extending => 1e4,
            Self::Pressure => 0.1,
            Self::GasForce | Self::BladderForce => 100.0,
            Self::Friction => 10.0,
            Self::SlopeOverPressure => 1e6,
            Self::SlopeOverLength => 0.1,
        }
    }

    /// Whether it needs the slopes of [`Base`].
    pub fn uses_slopes(self) -> bool {
        matches!(self, Self::SlopeOverPressure | Self::SlopeOverLength)
    }

    /// Whether it changes with the direction of motion.
    pub fn has_direction(self) -> bool {
        matches!(self, Self::Friction | Self::Direction | Self::Contracting | Self::Extending)
    }
}
