//! The muscle as measured with ruler, caliper and photograph, and the kinematics of its braid.
//!
//! Strands of fixed length wind `n` times around a cylinder, so length, diameter and braid angle are
//! one degree of freedom:
//!
//! ```text
//! L = b_s cos θ,   D = b_s sin θ / (π n)   =>   D(L)² = (b_s² - L²) / (π² n²),   dD/dL = -L / (π² n² D)
//! V(L) = π D² L / 4 = L (b_s² - L²) / (4 π n²)
//! ```
//!
//! | symbol | code                  | unit | meaning                                            |
//! |--------|-----------------------|------|----------------------------------------------------|
//! | `L₀`   | `rest_length_m`       | m    | active length, vented and just taut                |
//! | `r₀`   | `rest_radius_m`       | m    | outer radius of the bladder at rest                |
//! | `α₀`   | `braid_angle_rad`     | rad  | strand to axis, at rest                            |
//! | `t₀`   | `wall_thickness_m`    | m    | bladder wall at rest                               |
//! | `N`    | `strand_count`        | 1    | strands in the braid                               |
//! | `d_s`  | `strand_diameter_m`   | m    | diameter of one strand                             |
//! | `b_s`  | `strand_length_m()`   | m    | length of one strand, `L₀ / cos α₀`                |
//! | `n`    | `turns()`             | 1    | turns of one strand, `b_s sin α₀ / (2 π r₀)`       |
//! | `ε`    | `contraction_ratio()` | 1    | `(L₀ - L) / L₀`, positive when shortened           |
//!
//! Valid while the muscle is a cylinder; end caps, wall thickness of the braid and sag are left out.
//!
//! Source: Chou and Hannaford (1996), "Measurement and modeling of McKibben pneumatic artificial
//! muscles", IEEE Trans. Robotics and Automation 12(1).

use std::f64::consts::PI;

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Dimensions of a muscle, in SI; see the [module](self) for symbols.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Muscle {
    /// `L₀`, in m.
    pub rest_length_m: f64,
    /// `r₀`, in m.
    pub rest_radius_m: f64,
    /// `α₀`, in rad.
    pub braid_angle_rad: f64,
    /// `t₀`, in m.
    pub wall_thickness_m: f64,
    /// `N`.
    pub strand_count: f64,
    /// `d_s`, in m.
    pub strand_diameter_m: f64,
}

impl Muscle {
    /// The self-made McKibben muscle of `configs/muscle-nominal.toml`, the example of the whole toolchain: 267 mm long, 10 mm of
    /// radius, a braid at 25°, 1 mm of latex, 240 nylon strands of 0.25 mm.
    pub fn nominal() -> Self {
        Self {
            rest_length_m: 0.267,
            rest_radius_m: 0.010,
            braid_angle_rad: 25.0_f64.to_radians(),
            wall_thickness_m: 0.001,
            strand_count: 240.0,
            strand_diameter_m: 0.25e-3,
        }
    }

    /// `b_s`, in m.
    pub fn strand_length_m(&self) -> f64 {
        self.rest_length_m / self.braid_angle_rad.cos()
    }

    /// `n`: turns of one strand from end to end.
    pub fn turns(&self) -> f64 {
        self.strand_length_m() * self.braid_angle_rad.sin() / (2.0 * PI * self.rest_radius_m)
    }

    /// `ε = (L₀ - L) / L₀`.
    pub fn contraction_ratio(&self, length_m: f64) -> f64 {
        (self.rest_length_m - length_m) / self.rest_length_m
    }

    /// `L = L₀ (1 - ε)`, in m.
    pub fn length_m(&self, contraction_ratio: f64) -> f64 {
        self.rest_length_m * (1.0 - contraction_ratio)
    }

    /// Contraction at which an ideal braid pulls no more, `1 - 1 / (√3 cos α₀)`.
    pub fn max_contraction_ratio(&self) -> f64 {
        1.0 - 1.0 / (3.0_f64.sqrt() * self.braid_angle_rad.cos())
    }

    /// `D(L)`, in m; see [`Kinematics::diameter_m`].
    pub fn diameter_m(&self, length_m: f64) -> f64 {
        Kinematics::of(self).diameter_m(length_m)
    }

    /// `dD/dL`, dimensionless and negative.
    pub fn diameter_slope(&self, length_m: f64) -> f64 {
        let kinematics = Kinematics::of(self);
        kinematics.diameter_slope(length_m, kinematics.diameter_m(length_m))
    }

    /// Cross-section of all strands together, `N π d_s² / 4`, in m².
    pub fn braid_section_m2(&self) -> f64 {
        self.strand_count * PI * self.strand_diameter_m * self.strand_diameter_m / 4.0
    }
}

/// Kinematics of the braid with its constants worked out, for walks over many samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Kinematics {
    rest_length_m: f64,
    strand_length_square_m2: f64,
    /// `1 / (π n)` and its square: a division costs ten products.
    per_pi_turns: f64,
    per_pi_turns_square: f64,
}

impl Kinematics {
    /// Those of `muscle`.
    pub fn of(muscle: &Muscle) -> Self {
        let per_pi_turns = 1.0 / (PI * muscle.turns());
        Self {
            rest_length_m: muscle.rest_length_m,
            strand_length_square_m2: muscle.strand_length_m().powi(2),
            per_pi_turns,
            per_pi_turns_square: per_pi_turns * per_pi_turns,
        }
    }

    /// `ε = (L₀ - L) / L₀`.
    pub fn contraction_ratio(&self, length_m: f64) -> f64 {
        (self.rest_length_m - length_m) / self.rest_length_m
    }

    /// `D(L)`, in m; NaN where the strands are straight, that is at `L ≥ b_s`.
    pub fn diameter_m(&self, length_m: f64) -> f64 {
        (self.strand_length_square_m2 - length_m * length_m).sqrt() * self.per_pi_turns
    }

    /// `dD/dL` at a length with its diameter, dimensionless and negative.
    pub fn diameter_slope(&self, length_m: f64, diameter_m: f64) -> f64 {
        -length_m * self.per_pi_turns_square / diameter_m
    }
}

/// Dimensions that a fit may free. The strands are missing on purpose: their number, diameter and
/// modulus act together, so that a fit of the modulus covers them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Dimension {
    /// Rest length; shifts the datum of the length sensor.
    RestLength,
    /// Rest radius; acts like `k1` on the gas term and on its own on the bladder.
    RestRadius,
    /// Braid angle at rest.
    BraidAngle,
    /// Wall thickness of the bladder.
    WallThickness,
}

impl Dimension {
    /// Every dimension, in the order in which a fit lists them.
    pub const ALL: [Self; 4] = [Self::RestLength, Self::RestRadius, Self::BraidAngle, Self::WallThickness];

    /// Name in the muscle file, which carries the unit of that file.
    pub fn key(self) -> &'static str {
        match self {
            Self::RestLength => "rest_length_mm",
            Self::RestRadius => "rest_radius_mm",
            Self::BraidAngle => "braid_angle_deg",
            Self::WallThickness => "wall_thickness_mm",
        }
    }

    /// The value in `muscle`, in SI.
    pub fn of(self, muscle: &Muscle) -> f64 {
        match self {
            Self::RestLength => muscle.rest_length_m,
            Self::RestRadius => muscle.rest_radius_m,
            Self::BraidAngle => muscle.braid_angle_rad,
            Self::WallThickness => muscle.wall_thickness_m,
        }
    }

    /// `muscle` with this dimension set to `value`, in SI.
    pub fn set(self, muscle: &Muscle, value: f64) -> Muscle {
        let mut changed = muscle.clone();
        match self {
            Self::RestLength => changed.rest_length_m = value,
            Self::RestRadius => changed.rest_radius_m = value,
            Self::BraidAngle => changed.braid_angle_rad = value,
            Self::WallThickness => changed.wall_thickness_m = value,
        }
        changed
    }

    /// SI unit as an artifact writes it.
    pub fn unit(self) -> &'static str {
        if self == Self::BraidAngle { "rad" } else { "m" }
    }

    /// Name of the parameter in an artifact.
    pub fn parameter_name(self) -> &'static str {
        match self {
            Self::RestLength => "rest_length",
            Self::RestRadius => "rest_radius",
            Self::BraidAngle => "braid_angle",
            Self::WallThickness => "wall_thickness",
        }
    }

    /// Range within which a fit may move the dimension, in SI: what a ruler, a caliper or a photograph
    /// of a braid can get wrong.
    pub fn fit_range(self, muscle: &Muscle) -> (f64, f64) {
        let value = self.of(muscle);
        match self {
            Self::RestLength => (value - 0.005, value + 0.005),
            Self::RestRadius => (0.8 * value, 1.2 * value),
            Self::BraidAngle => (value - 8.0_f64.to_radians(), value + 8.0_f64.to_radians()),
            Self::WallThickness => (0.5 * value, 1.5 * value),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// The muscle that every physics test here uses.
    pub(crate) fn nominal() -> Muscle {
        Muscle::nominal()
    }

    #[test]
    fn diameter_at_rest_is_twice_the_radius() {
        let muscle = nominal();
        assert!((muscle.diameter_m(muscle.rest_length_m) - 0.020).abs() < 1e-15);
    }

    #[test]
    fn diameter_slope_agrees_with_finite_differences() {
        let muscle = nominal();
        for length_m in [0.27, 0.25, 0.22, 0.19] {
            let step_m = 1e-6;
            let slope = (muscle.diameter_m(length_m + step_m) - muscle.diameter_m(length_m - step_m)) / (2.0 * step_m);
            assert!((slope - muscle.diameter_slope(length_m)).abs() < 1e-7, "L = {length_m}");
        }
    }

    #[test]
    fn validates_against_published_strand_length_and_turns() {
        // 0.267 m at 25° on a 10 mm radius: b_s = 0.2946 m, n = 1.98.
        let muscle = nominal();
        assert!((muscle.strand_length_m() - 0.2946).abs() < 1e-4);
        assert!((muscle.turns() - 1.98).abs() < 5e-3);
    }
}
