//! The lumped bench: one cylinder whose force follows from virtual work.
//!
//! ```text
//! F = −p ∂V/∂L + dE/dL
//! V = L (b² − L²) / (4 π n²),   b = b₀ / (1 − y),   y = T_b L b₀ / …   (strands that stretch a little)
//! E = ∫ W(λz, λθ) 2π R L₀ dR    (thick: five rings; thin: one, in the middle of the wall)
//! ```
//!
//! | symbol | meaning                                   | unit  |
//! |--------|-------------------------------------------|-------|
//! | `p`    | gauge pressure                            | Pa    |
//! | `L`    | length between the fittings               | m     |
//! | `b`    | length of a strand, `b₀` unloaded         | m     |
//! | `n`    | turns of a strand                         | 1     |
//! | `y`    | strand tension over its stiffness         | 1     |
//! | `W`    | strain energy density of the rubber       | J/m³  |
//!
//! The wall keeps its volume: a ring at reference radius `R` goes to `r² = r_o² − (R_o² − R²) L₀/L`, with the outside `r_o`
//! on the braid. Tension of all strands together, by axial balance of a closed cylinder: `T = p L b / (2 π n²)`.
//!
//! Source: Chou and Hannaford (1996), "Measurement and modeling of McKibben pneumatic artificial muscles", for virtual work.

use std::f64::consts::PI;

use crate::curve::Curve;
use crate::muscle::{Muscle, Parts};

/// Prepared force of a cylinder.
#[derive(Debug, Clone)]
pub struct LumpedMuscle {
    strand_m: f64,
    turns: f64,
    strand_stiffness_n: f64,
    bladder_n: Curve,
    radius_m: Curve,
}

/// Energy of the bladder at a length, J.
fn bladder_energy_j(muscle: &Muscle, length_m: f64) -> f64 {
    let outer_m = muscle.cylinder_radius_m(length_m);
    let (rest_outer_m, rest_inner_m) = (muscle.rest_radius_m, muscle.rest_radius_m - muscle.wall_m);
    let axial = length_m / muscle.rest_length_m;
    let rings = if muscle.thick_wall { 5 } else { 1 };
    let breadth_m = muscle.wall_m / rings as f64;
    (0..rings)
        .map(|ring| {
            let reference_m = rest_inner_m + (ring as f64 + 0.5) * breadth_m;
            let square = outer_m * outer_m - (rest_outer_m.powi(2) - reference_m.powi(2)) / axial;
            let hoop = square.max(1e-12).sqrt() / reference_m;
            let volume_m3 = 2.0 * PI * reference_m * breadth_m * muscle.rest_length_m;
            muscle.rubber.energy_j_per_m3(axial, hoop) * volume_m3
        })
        .sum()
}

impl LumpedMuscle {
    /// Prepares the force of a muscle.
    pub fn new(muscle: &Muscle) -> Self {
        let (from, to) = muscle.span_m;
        let step_m = 1e-5 * muscle.rest_length_m;
        let slope = |length_m: f64| {
            (bladder_energy_j(muscle, length_m + step_m) - bladder_energy_j(muscle, length_m - step_m)) / (2.0 * step_m)
        };
        Self {
            strand_m: muscle.strand_m(),
            turns: muscle.turns(),
            strand_stiffness_n: muscle.strand_stiffness_n(),
            bladder_n: Curve::new(from, to, 18, slope),
            radius_m: Curve::new(from, to, 18, |length_m| muscle.cylinder_radius_m(length_m)),
        }
    }

    /// Parts of the force.
    pub fn parts(&self, pressure_pa: f64, length_m: f64) -> Parts {
        let turns_squared = self.turns * self.turns;
        let tension_n = pressure_pa * length_m * self.strand_m / (2.0 * PI * turns_squared);
        let strand_m = self.strand_m / (1.0 - (tension_n / self.strand_stiffness_n).clamp(-0.05, 0.2));
        let gas_n = pressure_pa * (3.0 * length_m * length_m - strand_m * strand_m) / (4.0 * PI * turns_squared);
        Parts { gas_n, bladder_n: self.bladder_n.at(length_m), radius_m: self.radius_m.at(length_m) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::Dice;

    #[test]
    fn work_of_gas_over_a_stroke_is_pressure_times_volume() {
        let mut muscle = Muscle::draw(&mut Dice::new(2, 2));
        muscle.strand_modulus_pa = 1e15;
        let lumped = LumpedMuscle::new(&muscle);
        let volume = |length_m: f64| PI * muscle.cylinder_radius_m(length_m).powi(2) * length_m;
        let (long_m, short_m) = (muscle.rest_length_m, 0.85 * muscle.rest_length_m);
        let steps = 2000;
        let step_m = (long_m - short_m) / f64::from(steps);
        let work_j: f64 =
            (0..steps).map(|i| lumped.parts(2e5, short_m + (f64::from(i) + 0.5) * step_m).gas_n * step_m).sum();
        let expected_j = 2e5 * (volume(short_m) - volume(long_m));
        assert!((work_j / expected_j - 1.0).abs() < 1e-4, "{work_j} {expected_j}");
    }

    #[test]
    fn a_bladder_pulls_back_when_contracted_and_rests_at_rest() {
        let mut dice = Dice::new(7, 7);
        for _ in 0..20 {
            let muscle = Muscle::draw(&mut dice);
            let lumped = LumpedMuscle::new(&muscle);
            assert!(lumped.parts(0.0, muscle.rest_length_m).bladder_n.abs() < 1.0);
            assert!(lumped.parts(0.0, 0.88 * muscle.rest_length_m).bladder_n < -3.0);
            assert!(lumped.parts(0.0, 1.005 * muscle.rest_length_m).bladder_n > 0.0);
        }
    }
}
