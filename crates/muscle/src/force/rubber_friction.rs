//! Friction between bladder and strands (eq. 9).
//!
//! The bladder presses on the braid with the gauge pressure over the cylinder's surface:
//!
//! ```text
//! F_rubber = f' p π D L
//! ```
//!
//! | symbol | code           | unit | meaning                                      |
//! |--------|----------------|------|----------------------------------------------|
//! | `f'`   | `coefficient`  | 1    | effective fraction of the normal force       |
//! | `D`    | `diameter_m`   | m    | diameter of the muscle at its present length |
//!
//! The normal force is several kN, so `f'` is of the order of 1e-3: the share that does work along the
//! axis, not a coefficient of friction of rubber on nylon (which is near 1).
//!
//! Left out: the pressure that the bladder itself carries before it touches the braid. The magnitude here
//! has no sign; eq. 11 opposes it to the motion.
//!
//! Source: eq. 9 of Appl. Sci. 2023, 13(21), 12038.

use std::f64::consts::PI;

/// Normal force of the bladder on the strands, `p π D L`, in N: friction per unit of `f'`.
pub fn normal_force_n(pressure_pa: f64, diameter_m: f64, length_m: f64) -> f64 {
    pressure_pa * PI * diameter_m * length_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tests::nominal;

    #[test]
    fn validates_against_published_friction() {
        // 15 to 18 N over the contractions of a lift at 0.3 MPa, f' near 1.2e-3 plus a little contact
        // between strands; p π D L alone is 5 to 9 kN over 0.3 to 0.5 MPa.
        let muscle = nominal();
        let normal_n = normal_force_n(3e5, muscle.diameter_m(0.267), 0.267);
        assert!((4.9e3..9.1e3).contains(&normal_n), "{normal_n}");
    }

    #[test]
    fn without_pressure_nothing_rubs() {
        assert!(normal_force_n(0.0, 0.02, 0.267).abs() < f64::EPSILON);
    }
}
