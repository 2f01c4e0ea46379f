//! A muscle as built, and its static force by one of two benches.

use std::f64::consts::PI;

use crate::draw::Dice;
use crate::lumped::LumpedMuscle;
use crate::rubber::Rubber;
use crate::slices::SlicedMuscle;

/// Dimensions and materials of a muscle.
#[derive(Debug, Clone)]
pub struct Muscle {
    /// Length between the fittings at rest, m.
    pub rest_length_m: f64,
    /// Outer radius of the bladder at rest, m.
    pub rest_radius_m: f64,
    /// Braid to axis at rest, rad.
    pub braid_angle_rad: f64,
    /// Wall of the bladder at rest, m.
    pub wall_m: f64,
    /// Strands in the braid.
    pub strand_count: f64,
    /// Diameter of a strand, m.
    pub strand_diameter_m: f64,
    /// Modulus of the strand material, Pa.
    pub strand_modulus_pa: f64,
    /// Rubber of the bladder.
    pub rubber: Rubber,
    /// Shear modulus of the rubber, Pa.
    pub shear_modulus_pa: f64,
    /// Whether the stress is followed through the wall.
    pub thick_wall: bool,
    /// Highest pressure used, Pa.
    pub highest_pressure_pa: f64,
    /// Shortest and longest length that the static force is prepared for, m.
    pub span_m: (f64, f64),
}

impl Muscle {
    /// Draws a muscle. Its fibers reach a force below 1500 N at its highest pressure.
    pub fn draw(dice: &mut Dice) -> Self {
        loop {
            let rest_length_m = dice.uniform(0.150, 0.350);
            let rest_radius_m = dice.uniform(0.005, 0.012);
            let braid_angle_rad = dice.uniform(20.0, 30.0).to_radians();
            let wall_m = (dice.uniform(0.001, 0.002)).min(0.2 * rest_radius_m);
            let highest_pressure_pa = dice.uniform(2.5e5, 5.5e5);
            let area_m2 = PI * rest_radius_m * rest_radius_m;
            let lead = 3.0 / braid_angle_rad.tan().powi(2) - 1.0 / braid_angle_rad.sin().powi(2);
            let shear_modulus_pa = dice.log_uniform(2.2e5, 7e5);
            let rubber = Rubber::draw(dice, shear_modulus_pa);
            let thick_wall = dice.chance(0.4);
            let strand_count = 12.0 * dice.between(9, 24) as f64;
            let strand_diameter_m = dice.uniform(0.20e-3, 0.35e-3);
            let strand_modulus_pa = if dice.chance(0.7) { dice.uniform(2e9, 4e9) } else { dice.uniform(8e9, 12e9) };
            if !(100.0..1350.0).contains(&(area_m2 * highest_pressure_pa * lead)) {
                continue;
            }
            let geometric_limit = 1.0 - 1.0 / (3f64.sqrt() * braid_angle_rad.cos());
            let most = (geometric_limit - 0.02).min(0.29);
            return Self {
                rest_length_m,
                rest_radius_m,
                braid_angle_rad,
                wall_m,
                strand_count,
                strand_diameter_m,
                strand_modulus_pa,
                rubber,
                shear_modulus_pa,
                thick_wall,
                highest_pressure_pa,
                span_m: (rest_length_m * (1.0 - most), rest_length_m * 1.016),
            };
        }
    }

    /// Length of a strand at rest, m.
    pub fn strand_m(&self) -> f64 {
        self.rest_length_m / self.braid_angle_rad.cos()
    }

    /// Turns of a strand about the axis.
    pub fn turns(&self) -> f64 {
        self.strand_m() * self.braid_angle_rad.sin() / (2.0 * PI * self.rest_radius_m)
    }

    /// Contraction ratio of a length.
    pub fn contraction(&self, length_m: f64) -> f64 {
        1.0 - length_m / self.rest_length_m
    }

    /// Radius of an ideal cylinder of inextensible strands, m.
    pub fn cylinder_radius_m(&self, length_m: f64) -> f64 {
        let strand_m = self.strand_m();
        (strand_m * strand_m - length_m * length_m).max(0.0).sqrt() / (2.0 * PI * self.turns())
    }

    /// Stiffness of all strands together along themselves, N.
    pub fn strand_stiffness_n(&self) -> f64 {
        self.strand_modulus_pa * self.strand_count * 0.25 * PI * self.strand_diameter_m * self.strand_diameter_m
    }
}

/// Static force, in parts that mechanisms act on.
#[derive(Debug, Clone, Copy, Default)]
pub struct Parts {
    /// Force of gas and braid, N.
    pub gas_n: f64,
    /// Force of the bladder, N; negative when contracted.
    pub bladder_n: f64,
    /// Radius at half length, m.
    pub radius_m: f64,
}

impl Parts {
    /// Sum, N.
    pub fn total_n(&self) -> f64 {
        self.gas_n + self.bladder_n
    }
}

/// Static force by one of two benches.
#[derive(Debug, Clone)]
pub enum StaticForce {
    /// One cylinder, by virtual work.
    Lumped(LumpedMuscle),
    /// Slices in equilibrium.
    Slices(SlicedMuscle),
}

impl StaticForce {
    /// Parts of the force at a pressure and a length.
    pub fn parts(&self, pressure_pa: f64, length_m: f64) -> Parts {
        match self {
            Self::Lumped(muscle) => muscle.parts(pressure_pa, length_m),
            Self::Slices(muscle) => muscle.parts(pressure_pa, length_m),
        }
    }

    /// Slope with pressure in N/Pa and with length in N/m.
    pub fn slopes(&self, pressure_pa: f64, length_m: f64) -> (f64, f64) {
        let force_n = |pressure_pa, length_m| self.parts(pressure_pa, length_m).total_n();
        let (dp, dl) = (200.0, 5e-5);
        (
            (force_n(pressure_pa + dp, length_m) - force_n(pressure_pa - dp, length_m)) / (2.0 * dp),
            (force_n(pressure_pa, length_m + dl) - force_n(pressure_pa, length_m - dl)) / (2.0 * dl),
        )
    }
}
