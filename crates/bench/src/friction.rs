//! Friction of the braid, on the bladder and on itself.
//!
//! ```text
//! F_f = f' p π D L + (f_ss / S_scale) S p
//! S   = N_c π a²,   N_c = n N² / 2,   a = [3 F_c (d_s / 2) (1 - ν²) / (2 E)]^{1/3},   F_c = p π D L / N_c
//! ```
//!
//! | symbol         | code              | unit | meaning                                          |
//! |----------------|-------------------|------|--------------------------------------------------|
//! | `F_f`          | `force_n()`       | N    | friction while moving, opposed to the motion     |
//! | `f'`           | `rubber_friction` | 1    | effective share of the normal force `p π D L`    |
//! | `f_ss/S_scale` | `strand_friction` | 1    | strand on strand; only the quotient acts         |
//! | `S`            | `area_m2`         | m²   | contact of all crossings together                |
//! | `N_c`          | `crossings`       | 1    | crossings of strands                             |
//! | `F_c`          | `crossing_n`      | N    | load on one crossing                             |
//! | `a`            | `radius_m`        | m    | radius of one contact                            |
//! | `E`, `ν`       | `modulus_pa`, [`POISSON_RATIO`] | Pa, 1 | strand material                   |
//!
//! It opposes the motion of the braid, whose direction is that of [`BraidMotion`](crate::mechanism::BraidMotion):
//! held at standstill, so that the tension jumps by `2 F_f` at a reversal.
//!
//! Source: Hertz (1882), "Über die Berührung fester elastischer Körper", for crossed cylinders.

use std::f64::consts::PI;

use pam_muscle::Muscle;

use crate::mechanism::{Mechanism, Moment};
use crate::parameters::Parameters;
use crate::true_muscle::TrueMuscle;

/// Poisson's ratio of nylon.
pub const POISSON_RATIO: f64 = 0.4;

/// How much friction there is, for one muscle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FrictionLaw {
    rubber_friction: f64,
    strand_friction: f64,
    crossings: f64,
    strand_radius_m: f64,
    modulus_pa: f64,
}

impl FrictionLaw {
    pub(crate) fn new(muscle: &Muscle, modulus_pa: f64, parameters: &Parameters) -> Self {
        Self {
            rubber_friction: parameters.rubber_friction,
            strand_friction: parameters.strand_friction,
            crossings: muscle.turns() * muscle.strand_count * muscle.strand_count / 2.0,
            strand_radius_m: muscle.strand_diameter_m / 2.0,
            modulus_pa,
        }
    }

    /// `F_f`, in N; none without pressure.
    pub(crate) fn force_n(&self, pressure_pa: f64, length_m: f64, diameter_m: f64) -> f64 {
        if pressure_pa <= 0.0 {
            return 0.0;
        }
        let normal_n = pressure_pa * PI * diameter_m * length_m;
        let on_bladder_n = self.rubber_friction * normal_n;
        if self.strand_friction == 0.0 {
            return on_bladder_n;
        }
        let crossing_n = normal_n / self.crossings;
        let flattening = 1.0 - POISSON_RATIO * POISSON_RATIO;
        let radius_m = (3.0 * crossing_n * self.strand_radius_m * flattening / (2.0 * self.modulus_pa)).cbrt();
        let area_m2 = self.crossings * PI * radius_m * radius_m;
        on_bladder_n + self.strand_friction * area_m2 * pressure_pa
    }
}

/// Friction that follows the sign of the true motion, step by step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BraidFriction;

impl Mechanism for BraidFriction {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        now.tension.friction_n += now.direction * muscle.friction_n(now.muscle_pressure_pa, now.muscle_length_m);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::NYLON_MODULUS_PA;
    use crate::true_muscle::tests::nominal_muscle;

    fn friction_at(pressure_pa: f64, contraction_ratio: f64, strand_friction: f64) -> f64 {
        let parameters = Parameters { strand_friction, ..Parameters::nominal() };
        let muscle = TrueMuscle::new(nominal_muscle(), NYLON_MODULUS_PA, parameters);
        muscle.friction_n(pressure_pa, muscle.muscle().length_m(contraction_ratio))
    }

    /// Published for 0.3 MPa and ε = 0, 0.05, 0.102, 0.156: 15, 17, 18, 18 N, which is `f' = 1.2e-3`
    /// together with `f_ss / S_scale = 0.6`; the friction on the bladder alone is 6 to 8 N.
    #[test]
    fn validates_against_published_friction_with_both_kinds() {
        for (contraction_ratio, published_n) in [(0.0, 15.0), (0.05, 17.0), (0.102, 18.0), (0.156, 18.0)] {
            let friction_n = friction_at(3e5, contraction_ratio, 0.6);
            assert!((friction_n - published_n).abs() < 0.6, "ε = {contraction_ratio}: {friction_n} N");
            assert!((6.0..8.0).contains(&friction_at(3e5, contraction_ratio, 0.0)));
        }
    }

    #[test]
    fn contact_of_the_strands_grows_with_pressure_to_the_five_thirds() {
        let strands_n = |pressure_pa| friction_at(pressure_pa, 0.1, 0.6) - friction_at(pressure_pa, 0.1, 0.0);
        let ratio: f64 = strands_n(4e5) / strands_n(1e5);
        assert!((ratio - 4.0_f64.powf(5.0 / 3.0)).abs() < 1e-12 * ratio);
    }

    #[test]
    fn contracting_lowers_the_tension_and_extending_raises_it() {
        let muscle = TrueMuscle::nominal();
        assert!(muscle.force_n(3e5, 0.25, 1.0) < muscle.force_n(3e5, 0.25, 0.0));
        assert!(muscle.force_n(3e5, 0.25, -1.0) > muscle.force_n(3e5, 0.25, 0.0));
    }
}
