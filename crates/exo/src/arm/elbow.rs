//! One elbow: what the general formulas reduce to.
//!
//! The mass matrix of a revolute joint does not depend on its angle, nothing couples the elbows, and gravity is
//! a sinusoid; so three numbers from [`rigid_body`](super::rigid_body) stand for an arm with its share of the
//! load:
//!
//! ```text
//! M q̈ + G(q) = τ,   G(q) = g_x cos q - g_y sin q
//! ```
//!
//! The load and its inertia about its own centroid are shared equally by the two arms, as a body of half the
//! mass on each (option "load in `T` and `U`" of two; as a passive torque on top it would count twice).

use nalgebra::{Matrix3, Vector2, Vector3};

use super::load::Load;
use super::rigid_body::{Body, gravity_n_m, mass_matrix};

/// Dynamics of one elbow with half the load; see the [module](self).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elbow {
    /// `M`, in kg m².
    pub inertia_kg_m2: f64,
    level_n_m: f64,
    upright_n_m: f64,
}

/// What moves with the elbow besides the load: forearm, hand and the exoskeleton's shell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forearm {
    /// In kg.
    pub mass_kg: f64,
    /// Elbow to its center of mass, in m.
    pub center_m: f64,
    /// About its center of mass, in kg m².
    pub inertia_kg_m2: f64,
}

impl Elbow {
    /// One arm with half of `load`.
    pub fn new(load: &Load, forearm: &Forearm) -> Self {
        let body = |mass_kg: f64, center_m: f64, inertia_kg_m2: f64| Body {
            joint: 0,
            mass_kg,
            inertia_kg_m2: Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, inertia_kg_m2)),
            center_m: Vector3::new(center_m, 0.0, 0.0),
        };
        let half = body(0.5 * load.mass_kg, load.load_arm_m, 0.5 * load.inertia_kg_m2);
        Self::of_bodies(&[half, body(forearm.mass_kg, forearm.center_m, forearm.inertia_kg_m2)])
    }

    /// The left elbow with whatever bodies hang on it.
    pub fn of_bodies(bodies: &[Body]) -> Self {
        let quarter_turn = std::f64::consts::FRAC_PI_2;
        Self {
            inertia_kg_m2: mass_matrix(bodies, &Vector2::zeros())[(0, 0)],
            level_n_m: gravity_n_m(bodies, &Vector2::zeros())[0],
            upright_n_m: -gravity_n_m(bodies, &Vector2::new(quarter_turn, quarter_turn))[0],
        }
    }

    /// `G`, in N m, where `q` has this sine and cosine.
    pub fn gravity_n_m(&self, sine: f64, cosine: f64) -> f64 {
        self.level_n_m * cosine - self.upright_n_m * sine
    }

    /// Kinetic and potential energy, in J.
    pub fn energy_j(&self, q_rad: f64, dq_rad_per_s: f64) -> f64 {
        let (sine, cosine) = q_rad.sin_cos();
        0.5 * self.inertia_kg_m2 * dq_rad_per_s * dq_rad_per_s + self.level_n_m * sine + self.upright_n_m * cosine
    }
}

#[cfg(test)]
mod tests {
    use super::super::load::torque_per_arm_n_m;
    use super::*;

    const LOAD: Load = Load { mass_kg: 5.0, inertia_kg_m2: 0.05, load_arm_m: 0.3 };
    const NO_FOREARM: Forearm = Forearm { mass_kg: 0.0, center_m: 0.12, inertia_kg_m2: 0.0 };

    #[test]
    fn the_load_as_a_body_and_as_a_passive_torque_are_one() {
        // M q̈ + G = τ with the load in M and G, against 0 = τ + τ_load.
        let elbow = Elbow::new(&LOAD, &NO_FOREARM);
        for (q, dq, ddq) in [(0.0_f64, 0.0, 0.0), (0.2, 0.3, 0.8), (-0.3, -1.0, -2.0)] {
            let (sine, cosine) = q.sin_cos();
            let torque_n_m = elbow.inertia_kg_m2 * ddq + elbow.gravity_n_m(sine, cosine);
            assert!((torque_n_m + torque_per_arm_n_m(&LOAD, q, dq, ddq)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_forearm_adds_its_own_weight_to_each_arm() {
        let forearm = Forearm { mass_kg: 2.0, center_m: 0.15, inertia_kg_m2: 0.01 };
        let (with, without) = (Elbow::new(&LOAD, &forearm), Elbow::new(&LOAD, &NO_FOREARM));
        assert!((with.inertia_kg_m2 - without.inertia_kg_m2 - 0.01 - 2.0 * 0.15 * 0.15).abs() < 1e-12);
        let more_n_m = with.gravity_n_m(0.0, 1.0) - without.gravity_n_m(0.0, 1.0);
        assert!((more_n_m - 2.0 * 0.15 * super::super::GRAVITY_M_PER_S2).abs() < 1e-12);
    }
}
