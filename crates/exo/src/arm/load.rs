//! The load as the elbow feels it (eqs 20–27).
//!
//! A load that rests on the forearm at distance `r` from the elbow is pressed on by the normal force `T` and
//! held by friction `f` along the arm; what it does to the arm is the opposite of both:
//!
//! ```text
//! T = m r q̈ + m g cos q,   f = m g sin q - m r q̇²
//! F = (m r q̈ sin q + m r q̇² cos q, -m r q̈ cos q + m r q̇² sin q - m g)
//! τ = ½ [(r cos q, r sin q) × F - I q̈] = -½ [(m r² + I) q̈ + m g r cos q]   for each of two arms
//! ```
//!
//! | symbol | code               | unit   | meaning                                               |
//! |--------|--------------------|--------|-------------------------------------------------------|
//! | `m`    | `mass_kg`          | kg     | of the load, both arms together                       |
//! | `I`    | `inertia_kg_m2`    | kg m²  | of the load about its own centroid, axis of the elbow |
//! | `r`    | `load_arm_m`       | m      | elbow to the load; not the muscle's moment arm        |
//! | `F`    | [`force_on_arm_n`] | N      | load on both arms, forward and up                     |
//! | `τ`    | [`torque_per_arm_n_m`] | N m | load on one elbow                                     |
//!
//! The paper's eq. 25 has the inertial terms with the wrong sign and eq. 22 leaves the centripetal force out;
//! Table 1's `ZZ` appears in none of its eqs 20–27. As `r` is not given there, it is a matter of
//! configuration: 0.30 m is a hand, 0.21 m the muscle's attachment.
//!
//! Source: Appl. Sci. 2023, 13(21), 12038, corrected.

use super::GRAVITY_M_PER_S2;

/// What is lifted; see the [module](self) for symbols.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    /// `m`, in kg.
    pub mass_kg: f64,
    /// `I`, in kg m².
    pub inertia_kg_m2: f64,
    /// `r`, in m.
    pub load_arm_m: f64,
}

/// `F`: force of the load on both arms, forward and up, in N.
pub fn force_on_arm_n(load: &Load, q_rad: f64, dq_rad_per_s: f64, ddq_rad_per_s2: f64) -> [f64; 2] {
    let (sine, cosine) = q_rad.sin_cos();
    let tangential_n = load.mass_kg * load.load_arm_m * ddq_rad_per_s2;
    let radial_n = load.mass_kg * load.load_arm_m * dq_rad_per_s * dq_rad_per_s;
    [
        tangential_n * sine + radial_n * cosine,
        -tangential_n * cosine + radial_n * sine - load.mass_kg * GRAVITY_M_PER_S2,
    ]
}

/// `τ`: torque of the load on one of two elbows, in N m; negative, it pulls the forearm down.
pub fn torque_per_arm_n_m(load: &Load, q_rad: f64, dq_rad_per_s: f64, ddq_rad_per_s2: f64) -> f64 {
    let [forward_n, up_n] = force_on_arm_n(load, q_rad, dq_rad_per_s, ddq_rad_per_s2);
    let (sine, cosine) = q_rad.sin_cos();
    let cross_n_m = load.load_arm_m * (cosine * up_n - sine * forward_n);
    0.5 * (cross_n_m - load.inertia_kg_m2 * ddq_rad_per_s2)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOAD: Load = Load { mass_kg: 5.0, inertia_kg_m2: 0.05, load_arm_m: 0.21 };

    #[test]
    fn the_cross_product_is_the_closed_form() {
        let (q, dq, ddq) = (0.2_f64, 0.4, -0.7);
        let closed_n_m = -0.5
            * ((LOAD.mass_kg * LOAD.load_arm_m.powi(2) + LOAD.inertia_kg_m2) * ddq
                + LOAD.mass_kg * GRAVITY_M_PER_S2 * LOAD.load_arm_m * q.cos());
        assert!((torque_per_arm_n_m(&LOAD, q, dq, ddq) - closed_n_m).abs() < 1e-12);
    }

    #[test]
    fn validates_against_published_torques() {
        // 5.15 to 4.92 N m per arm at rest with the load at the muscle's attachment.
        assert!((torque_per_arm_n_m(&LOAD, 0.0, 0.0, 0.0) + 5.15).abs() < 5e-3);
        assert!((torque_per_arm_n_m(&LOAD, 0.3, 0.0, 0.0) + 4.92).abs() < 5e-3);
    }
}
