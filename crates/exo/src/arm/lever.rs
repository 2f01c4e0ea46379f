//! The muscle as the third side of a triangle over the elbow (eqs 28–29).
//!
//! The muscle joins a point on the upper arm, `a` from the elbow, to a point on the forearm, `b` from it. The
//! angle between the two is `π/2 - q`, so by the law of cosines and virtual work
//!
//! ```text
//! l(q) = √(a² + b² - 2 a b sin q) - l(0) + L(0),   r(q) = -dl/dq = a b cos q / √(a² + b² - 2 a b sin q)
//! ```
//!
//! | symbol | code               | unit | meaning                                          |
//! |--------|--------------------|------|--------------------------------------------------|
//! | `q`    | `q_rad`            | rad  | forearm above the horizontal, upper arm upright  |
//! | `a`    | `upper_m`          | m    | elbow to the muscle's end on the upper arm       |
//! | `b`    | `lower_m`          | m    | elbow to the muscle's end on the forearm         |
//! | `L(0)` | `mounted_length_m` | m    | active length of the muscle as mounted, at q = 0 |
//! | `l`    | `length_m()`       | m    | active length of the muscle                      |
//! | `r`    | `moment_arm_m`     | m    | torque per unit of tension                       |
//!
//! Fittings and cable take up the difference between the triangle's side and the muscle's active length; the
//! paper's muscle has none (0.267 m on a side of 0.26707 m). Valid for `|q| < π/2` and a muscle that lies
//! against nothing.
//!
//! Source: eqs 28 and 29 of Appl. Sci. 2023, 13(21), 12038, with the muscle's length in the denominator.

/// Geometry of a muscle on the elbow; see the [module](self) for symbols.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lever {
    product_m2: f64,
    squares_m2: f64,
    offset_m: f64,
}

/// Where the muscle is at one angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeverAt {
    /// Active length, in m.
    pub length_m: f64,
    /// Torque per unit of tension, in m.
    pub moment_arm_m: f64,
}

/// How the muscle moves at one angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeverMotion {
    /// Rate of the length, in m/s.
    pub length_rate_m_per_s: f64,
    /// Its acceleration, in m/s².
    pub length_acceleration_m_per_s2: f64,
}

impl Lever {
    /// A muscle of active length `mounted_length_m` at `q = 0`.
    pub fn new(upper_m: f64, lower_m: f64, mounted_length_m: f64) -> Self {
        let squares_m2 = upper_m * upper_m + lower_m * lower_m;
        Self { product_m2: upper_m * lower_m, squares_m2, offset_m: mounted_length_m - squares_m2.sqrt() }
    }

    /// Length and moment arm where `q` has this sine and cosine.
    pub fn at(&self, sine: f64, cosine: f64) -> LeverAt {
        let side_m = (self.squares_m2 - 2.0 * self.product_m2 * sine).sqrt();
        LeverAt { length_m: side_m + self.offset_m, moment_arm_m: self.product_m2 * cosine / side_m }
    }

    /// How the length follows the joint: `l̇ = -r q̇`, `l̈ = -r q̈ - r' q̇²` with `r' = (r² - a b sin q) / side`.
    pub fn motion(&self, q_rad: f64, dq_rad_per_s: f64, ddq_rad_per_s2: f64) -> LeverMotion {
        let (sine, cosine) = q_rad.sin_cos();
        let at = self.at(sine, cosine);
        let (side_m, arm_m) = (at.length_m - self.offset_m, at.moment_arm_m);
        let slope_m = (arm_m * arm_m - self.product_m2 * sine) / side_m;
        LeverMotion {
            length_rate_m_per_s: -arm_m * dq_rad_per_s,
            length_acceleration_m_per_s2: -arm_m * ddq_rad_per_s2 - slope_m * dq_rad_per_s * dq_rad_per_s,
        }
    }

    /// Length and moment arm at an angle.
    pub fn at_angle(&self, q_rad: f64) -> LeverAt {
        let (sine, cosine) = q_rad.sin_cos();
        self.at(sine, cosine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: (f64, f64) = (0.165, 0.21);

    #[test]
    fn validates_against_published_lengths_and_moment_arms() {
        // 0.26707 to 0.22549 m and 0.1297 to 0.1468 m over the lift.
        let lever = Lever::new(PAPER.0, PAPER.1, 0.267_067);
        let (start, end) = (lever.at_angle(0.0), lever.at_angle(0.3));
        assert!((start.length_m - 0.26707).abs() < 5e-6 && (end.length_m - 0.22549).abs() < 5e-6, "{end:?}");
        assert!((start.moment_arm_m - 0.1297).abs() < 5e-5 && (end.moment_arm_m - 0.1468).abs() < 5e-5);
    }

    #[test]
    fn moment_arm_is_minus_the_slope_of_the_length() {
        let lever = Lever::new(PAPER.0, PAPER.1, 0.25);
        for q_rad in [-0.4, 0.0, 0.1, 0.3, 0.9] {
            let step_rad = 1e-6;
            let slope_m = (lever.at_angle(q_rad + step_rad).length_m - lever.at_angle(q_rad - step_rad).length_m)
                / (2.0 * step_rad);
            assert!((lever.at_angle(q_rad).moment_arm_m + slope_m).abs() < 1e-9, "q = {q_rad}");
        }
    }

    #[test]
    fn the_length_moves_as_its_finite_differences() {
        let lever = Lever::new(PAPER.0, PAPER.1, 0.25);
        let (q, dq, ddq, step_s) = (0.2, 0.7, -1.3, 1e-4);
        let length_m = |time_s: f64| lever.at_angle(q + dq * time_s + 0.5 * ddq * time_s * time_s).length_m;
        let motion = lever.motion(q, dq, ddq);
        let rate = (length_m(step_s) - length_m(-step_s)) / (2.0 * step_s);
        let acceleration = (length_m(step_s) - 2.0 * length_m(0.0) + length_m(-step_s)) / (step_s * step_s);
        assert!((motion.length_rate_m_per_s - rate).abs() < 1e-8);
        assert!((motion.length_acceleration_m_per_s2 - acceleration).abs() < 1e-6);
    }

    #[test]
    fn a_muscle_with_fittings_is_as_long_as_it_was_mounted() {
        assert!((Lever::new(PAPER.0, PAPER.1, 0.2).at_angle(0.0).length_m - 0.2).abs() < 1e-15);
    }
}
