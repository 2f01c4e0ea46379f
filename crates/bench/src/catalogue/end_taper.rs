//! Conical ends: near its fittings a muscle is no cylinder.
//!
//! ```text
//! F_e = p dV_lost/dL,   V_lost = 2 π L_c [D²/4 - (D² + D D₀ + D₀²) / 12],   L_c = (D - D₀) / (2 tan β)
//! ```
//!
//! | symbol   | code            | unit | meaning                                    |
//! |----------|-----------------|------|--------------------------------------------|
//! | `V_lost` | `lost_m3()`     | m³   | what two cones have less than the cylinder |
//! | `D, D₀`  | `diameter_m()`  | m    | diameter of the braid, and of the fittings |
//! | `β`      | `1 / slope`     | 1    | half the opening of the cones, as `tan β`  |
//!
//! Volume that is missing does no work: the derivative is taken as a symmetric difference over the volume itself.
//!
//! Source: Tondu and Lopez (2000), IEEE Control Systems Magazine 20(2), and Doumit, Fahim and Munro (2009), IEEE
//! Trans. Robotics 25(6), for conical ends.

use std::f64::consts::PI;

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Step of the difference over the length of the muscle.
const STEP: f64 = 1e-4;

/// Volume lost to the ends.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EndTaper {
    cotangent: f64,
}

impl EndTaper {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        Self { cotangent: draw.severe("cotangent_of_cone", 1.2, 2.4, "1") }
    }

    fn lost_m3(&self, muscle: &TrueMuscle, length_m: f64) -> f64 {
        let (d, d0) = (muscle.muscle().diameter_m(length_m), 2.0 * muscle.muscle().rest_radius_m);
        let cone_m = 0.5 * self.cotangent * (d - d0);
        2.0 * PI * cone_m * (0.25 * d * d - (d * d + d * d0 + d0 * d0) / 12.0)
    }
}

impl Mechanism for EndTaper {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        let step_m = STEP * muscle.muscle().rest_length_m;
        let volume_m3 = |offset_m: f64| self.lost_m3(muscle, now.muscle_length_m + offset_m);
        let slope_m2 = (volume_m3(step_m) - volume_m3(-step_m)) / (2.0 * step_m);
        now.tension.beside_n += now.muscle_pressure_pa * slope_m2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::drive;

    fn force_n(pressure_pa: f64, length_m: f64) -> f64 {
        drive(EndTaper { cotangent: 1.5 }, &[(pressure_pa, length_m)])[0].tension.beside_n
    }

    #[test]
    fn ends_take_force_from_a_shortened_muscle_and_none_at_rest() {
        assert!(force_n(3e5, 0.267).abs() < 0.1);
        assert!(force_n(3e5, 0.24) < -1.0);
        assert!(force_n(3e5, 0.21) < force_n(3e5, 0.24));
    }

    #[test]
    fn force_is_in_proportion_to_pressure_and_none_without() {
        assert!((force_n(4e5, 0.24) - 2.0 * force_n(2e5, 0.24)).abs() < 1e-9);
        assert_eq!(force_n(0.0, 0.24), 0.0);
    }

    #[test]
    fn the_work_of_the_ends_is_pressure_times_the_volume_they_take() {
        let muscle = TrueMuscle::nominal();
        let taper = EndTaper { cotangent: 1.5 };
        let steps = 1000;
        let step_m = 0.03 / f64::from(steps);
        let work_j: f64 = (0..steps).map(|index| force_n(3e5, 0.23 + (f64::from(index) + 0.5) * step_m) * step_m).sum();
        let volume_m3 = taper.lost_m3(&muscle, 0.26) - taper.lost_m3(&muscle, 0.23);
        assert!((work_j / (3e5 * volume_m3) - 1.0).abs() < 1e-5);
    }
}
