//! Elastic force of the rubber bladder (eqs 3–8).
//!
//! Virtual work of a muscle that stores the energy `V_r W` in its rubber: `-F dL = p dV - V_r dW`, so the
//! bladder adds
//!
//! ```text
//! F_bladder = V_r dW/dL,   W = C₁₀ (I₁ - 3) + C₀₁ (I₂ - 3)
//! λ₁ = L / L₀,   λ₂ = (D - t) / (D₀ - t₀),   λ₃ = t / t₀,   V_r = π L₀ t₀ (D₀ - t₀)
//! ```
//!
//! with the wall `t` from the volume of the rubber, which does not change, and the bladder lying on the
//! braid: `L (D - t) t = V_r / π`, so
//!
//! ```text
//! t = ½ [D - √(D² - 4 V_r / (π L))],   t' = -t [(D - t) + L D'] / (L (D - 2 t))
//! ```
//!
//! The force is negative under contraction: rubber resists being inflated. The paper defines it with this
//! sign and then subtracts it, which would let rubber help the contraction; that form stays available as
//! [`Form::AsPrinted`](super::Form::AsPrinted).
//!
//! | symbol | code                   | unit | meaning                                 |
//! |--------|------------------------|------|-----------------------------------------|
//! | `C₁₀`  | `c10_pa`               | Pa   | Mooney–Rivlin coefficient of `I₁`        |
//! | `C₀₁`  | `c01_pa`               | Pa   | Mooney–Rivlin coefficient of `I₂`        |
//! | `V_r`  | `rubber_volume_m3`     | m³   | volume of the rubber, not of the cavity |
//!
//! Valid once the bladder touches the braid. The two coefficients act almost alike (the cosine between
//! their forces is 0.989 for contractions of 0 to 0.21), so that a fit finds their sum.
//!
//! Source: Mooney (1940) and Rivlin (1948) for the energy; eqs 3–8 of Appl. Sci. 2023, 13(21), 12038.

use std::f64::consts::PI;

use crate::geometry::{Kinematics, Muscle};

/// Constants of the bladder for one muscle.
#[derive(Debug, Clone, Copy)]
pub struct Bladder {
    rubber_volume_m3: f64,
    /// `4 V_r / π`.
    wall_term_m3: f64,
    /// `1 / L₀`, `1 / (D₀ - t₀)` and `1 / t₀`, as a division costs ten products.
    per_rest_m: [f64; 3],
    kinematics: Kinematics,
}

impl Bladder {
    /// The term for `muscle`.
    pub fn new(muscle: &Muscle) -> Self {
        let rest_mid_wall_m = 2.0 * muscle.rest_radius_m - muscle.wall_thickness_m;
        let rubber_volume_m3 = PI * muscle.rest_length_m * muscle.wall_thickness_m * rest_mid_wall_m;
        Self {
            rubber_volume_m3,
            wall_term_m3: 4.0 * rubber_volume_m3 / PI,
            per_rest_m: [1.0 / muscle.rest_length_m, 1.0 / rest_mid_wall_m, 1.0 / muscle.wall_thickness_m],
            kinematics: Kinematics::of(muscle),
        }
    }

    /// `V_r`, in m³.
    pub fn rubber_volume_m3(&self) -> f64 {
        self.rubber_volume_m3
    }

    /// Inner diameter `D - 2 t`, in m, at a length with its diameter.
    fn inner_diameter_m(&self, length_m: f64, diameter_m: f64) -> f64 {
        (diameter_m * diameter_m - self.wall_term_m3 / length_m).sqrt()
    }

    /// Stretches `λ₁`, `λ₂`, `λ₃` at a length.
    pub fn stretches(&self, length_m: f64) -> [f64; 3] {
        let diameter_m = self.kinematics.diameter_m(length_m);
        let wall_m = 0.5 * (diameter_m - self.inner_diameter_m(length_m, diameter_m));
        let [d1, per_mid_wall_m, per_wall_m] = self.per_rest_m;
        [length_m * d1, (diameter_m - wall_m) * per_mid_wall_m, wall_m * per_wall_m]
    }

    /// Forces per unit of `C₁₀` and of `C₀₁`, in N/Pa: `V_r dI₁/dL` and `V_r dI₂/dL`.
    pub fn columns_n_per_pa(&self, length_m: f64) -> [f64; 2] {
        self.columns_at(length_m, self.kinematics.diameter_m(length_m))
    }

    /// [`columns_n_per_pa`](Self::columns_n_per_pa) where the diameter is known already.
    pub(super) fn columns_at(&self, length_m: f64, diameter_m: f64) -> [f64; 2] {
        let inner_m = self.inner_diameter_m(length_m, diameter_m);
        let wall_m = 0.5 * (diameter_m - inner_m);
        let diameter_slope = self.kinematics.diameter_slope(length_m, diameter_m);
        let wall_slope = -wall_m * ((diameter_m - wall_m) + length_m * diameter_slope) / (length_m * inner_m);
        let [d1, per_mid_wall_m, per_wall_m] = self.per_rest_m;
        let l1 = length_m * d1;
        let l2 = (diameter_m - wall_m) * per_mid_wall_m;
        let l3 = wall_m * per_wall_m;
        let d2 = (diameter_slope - wall_slope) * per_mid_wall_m;
        let d3 = wall_slope * per_wall_m;
        let (q1, q2, q3) = (l1 * l1, l2 * l2, l3 * l3);
        [
            2.0 * self.rubber_volume_m3 * (l1 * d1 + l2 * d2 + l3 * d3),
            2.0 * self.rubber_volume_m3 * (l1 * (q2 + q3) * d1 + l2 * (q1 + q3) * d2 + l3 * (q1 + q2) * d3),
        ]
    }

    /// `V_r dW/dL`, in N.
    pub fn force_n(&self, length_m: f64, c10_pa: f64, c01_pa: f64) -> f64 {
        let [first, second] = self.columns_n_per_pa(length_m);
        c10_pa * first + c01_pa * second
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tests::nominal;

    fn energy_j(bladder: &Bladder, length_m: f64, c10_pa: f64, c01_pa: f64) -> f64 {
        let squares = bladder.stretches(length_m).map(|stretch| stretch * stretch);
        let first: f64 = squares.iter().sum();
        let second = squares[0] * squares[1] + squares[1] * squares[2] + squares[0] * squares[2];
        bladder.rubber_volume_m3() * (c10_pa * (first - 3.0) + c01_pa * (second - 3.0))
    }

    #[test]
    fn force_is_the_slope_of_the_energy() {
        let bladder = Bladder::new(&nominal());
        for length_m in [0.268, 0.26, 0.24, 0.21, 0.18] {
            let step_m = 1e-6;
            let slope_n = (energy_j(&bladder, length_m + step_m, 118.4e3, 105.7e3)
                - energy_j(&bladder, length_m - step_m, 118.4e3, 105.7e3))
                / (2.0 * step_m);
            let force_n = bladder.force_n(length_m, 118.4e3, 105.7e3);
            assert!((force_n - slope_n).abs() < 1e-5 * force_n.abs().max(1.0), "L = {length_m}: {force_n} {slope_n}");
        }
    }

    #[test]
    fn columns_are_the_equations_as_written() {
        let muscle = nominal();
        let bladder = Bladder::new(&muscle);
        let volume_m3 = bladder.rubber_volume_m3();
        for step in 0..60 {
            let length_m = 0.18 + 0.0015 * f64::from(step);
            let diameter_m = muscle.diameter_m(length_m);
            let slope = muscle.diameter_slope(length_m);
            let wall_m = 0.5 * (diameter_m - (diameter_m * diameter_m - 4.0 * volume_m3 / (PI * length_m)).sqrt());
            let wall_slope =
                -wall_m * (diameter_m - wall_m + length_m * slope) / (length_m * (diameter_m - 2.0 * wall_m));
            let (rest_m, rest_wall_m) = (muscle.rest_length_m, muscle.wall_thickness_m);
            let rest_mid_m = 2.0 * muscle.rest_radius_m - rest_wall_m;
            let [l1, l2, l3] = [length_m / rest_m, (diameter_m - wall_m) / rest_mid_m, wall_m / rest_wall_m];
            let [d1, d2, d3] = [1.0 / rest_m, (slope - wall_slope) / rest_mid_m, wall_slope / rest_wall_m];
            let first = 2.0 * volume_m3 * (l1 * d1 + l2 * d2 + l3 * d3);
            let (q1, q2, q3) = (l1 * l1, l2 * l2, l3 * l3);
            let second = 2.0 * volume_m3 * (l1 * (q2 + q3) * d1 + l2 * (q1 + q3) * d2 + l3 * (q1 + q2) * d3);
            // Both vanish at the rest length; what counts is their size along the stroke, 3e-4 N/Pa.
            let [by_c10, by_c01] = bladder.columns_n_per_pa(length_m);
            assert!((by_c10 - first).abs() < 1e-12 * 3e-4, "L = {length_m}: {by_c10} {first}");
            assert!((by_c01 - second).abs() < 1e-12 * 3e-4, "L = {length_m}: {by_c01} {second}");
        }
    }

    #[test]
    fn rubber_keeps_its_volume_and_rests_at_the_rest_length() {
        let muscle = nominal();
        let bladder = Bladder::new(&muscle);
        for length_m in [0.267, 0.24, 0.2] {
            let [l1, l2, l3] = bladder.stretches(length_m);
            assert!((l1 * l2 * l3 - 1.0).abs() < 1e-12, "L = {length_m}");
        }
        assert!(bladder.force_n(muscle.rest_length_m, 118.4e3, 105.7e3).abs() < 1e-6);
    }

    #[test]
    fn validates_against_the_published_force_budget() {
        // At contractions of 0.05, 0.102 and 0.156: -56, -67 and -67 N for latex of 118.4 and 105.7 kPa.
        let muscle = nominal();
        let bladder = Bladder::new(&muscle);
        for (contraction_ratio, expected_n) in [(0.05, -56.0), (0.102, -67.0), (0.156, -67.0)] {
            let force_n = bladder.force_n(muscle.length_m(contraction_ratio), 118.4e3, 105.7e3);
            assert!((force_n - expected_n).abs() < 1.0, "ε = {contraction_ratio}: {force_n}");
        }
    }
}
