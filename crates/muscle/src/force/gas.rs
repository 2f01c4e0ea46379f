//! Force of the gas on an inextensible braid, with the two empirical coefficients (eq. 1 and the first
//! term of eq. 11).
//!
//! Virtual work of gas in a braid of fixed strand length, `F = -p dV/dL` with
//! `V = L (b_s² - L²) / (4 π n²)`, gives
//!
//! ```text
//! F = p (3 L² - b_s²) / (4 π n²) = π r₀² p [a (1 - ε)² - b],   a = 3 / tan² α₀,   b = 1 / sin² α₀
//! F_gas = k₁ π r₀² p [a (1 - k₂ ε)² - b]
//! ```
//!
//! | symbol    | code                | unit | meaning                                                     |
//! |-----------|---------------------|------|-------------------------------------------------------------|
//! | `p`       | `pressure_pa`       | Pa   | gauge pressure                                              |
//! | `ε`       | `contraction_ratio` | 1    | `(L₀ - L) / L₀`                                             |
//! | `k₁`      | `k1`                | 1    | gain: losses, and whatever the radius was measured wrong by |
//! | `k₂`      | `k2`                | 1    | contraction gain: ends that are no cylinder                 |
//!
//! `k₁` scales this term alone. It cannot be told from `r₀²`, and hardly from the braid angle.
//!
//! Source: the braid-angle form of Chou and Hannaford (1996) in the writing of Tondu and Lopez (2000),
//! "Modeling and control of McKibben artificial muscle robot actuators", IEEE Control Systems 20(2).

use std::f64::consts::PI;

use crate::geometry::Muscle;

/// Constants of the gas term for one muscle.
#[derive(Debug, Clone, Copy)]
pub struct Gas {
    area_m2: f64,
    a: f64,
    b: f64,
}

impl Gas {
    /// The term for `muscle`.
    pub fn new(muscle: &Muscle) -> Self {
        Self {
            area_m2: PI * muscle.rest_radius_m * muscle.rest_radius_m,
            a: 3.0 / muscle.braid_angle_rad.tan().powi(2),
            b: 1.0 / muscle.braid_angle_rad.sin().powi(2),
        }
    }

    /// `F_gas`, in N.
    pub fn force_n(&self, pressure_pa: f64, contraction_ratio: f64, k1: f64, k2: f64) -> f64 {
        let reach = 1.0 - k2 * contraction_ratio;
        k1 * self.area_m2 * pressure_pa * (self.a * reach * reach - self.b)
    }

    /// The columns `π r₀² p`, `π r₀² p ε`, `π r₀² p ε²`, in N.
    pub fn columns_n(&self, pressure_pa: f64, contraction_ratio: f64) -> [f64; 3] {
        let thrust_n = self.area_m2 * pressure_pa;
        [thrust_n, thrust_n * contraction_ratio, thrust_n * contraction_ratio * contraction_ratio]
    }

    /// Weights of the [columns](Self::columns_n).
    pub fn weights(&self, k1: f64, k2: f64) -> [f64; 3] {
        [k1 * (self.a - self.b), -2.0 * self.a * k1 * k2, self.a * k1 * k2 * k2]
    }

    /// Derivatives of the [weights](Self::weights) by `k1` and by `k2`.
    pub fn weight_slopes(&self, k1: f64, k2: f64) -> [[f64; 3]; 2] {
        [[self.a - self.b, -2.0 * self.a * k2, self.a * k2 * k2], [0.0, -2.0 * self.a * k1, 2.0 * self.a * k1 * k2]]
    }

    /// `k₁` and `k₂` that each of three free weights would stand for: `[k₁, k₁ k₂, k₁ k₂²]`, which
    /// agree with one another only where the data obey eq. 1.
    pub fn implied(&self, weights: [f64; 3]) -> [f64; 3] {
        [weights[0] / (self.a - self.b), -weights[1] / (2.0 * self.a), weights[2] / self.a]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tests::nominal;

    #[test]
    fn force_is_minus_pressure_times_slope_of_volume() {
        let muscle = nominal();
        let (strand_m, turns) = (muscle.strand_length_m(), muscle.turns());
        let volume_m3 = |l: f64| l * (strand_m * strand_m - l * l) / (4.0 * PI * turns * turns);
        let gas = Gas::new(&muscle);
        for length_m in [0.267, 0.25, 0.22, 0.18] {
            let step_m = 1e-6;
            let slope_m2 = (volume_m3(length_m + step_m) - volume_m3(length_m - step_m)) / (2.0 * step_m);
            let force_n = gas.force_n(3e5, muscle.contraction_ratio(length_m), 1.0, 1.0);
            assert!((force_n + 3e5 * slope_m2).abs() < 1e-5 * force_n.abs().max(1.0), "L = {length_m}");
        }
    }

    #[test]
    fn force_vanishes_at_maximum_contraction() {
        let muscle = nominal();
        let force_n = Gas::new(&muscle).force_n(5e5, muscle.max_contraction_ratio(), 1.0, 1.0);
        assert!(force_n.abs() < 1e-9, "{force_n}");
    }

    #[test]
    fn validates_against_the_braid_angle_form() {
        // Chou and Hannaford (1996): F = π r₀² p (3 cos² θ - 1) / sin² α₀.
        let muscle = nominal();
        let gas = Gas::new(&muscle);
        for contraction_ratio in [0.0, 0.1, 0.2, 0.3] {
            let cos = (1.0 - contraction_ratio) * muscle.braid_angle_rad.cos();
            let expected_n = PI * 1e-4 * 3e5 * (3.0 * cos * cos - 1.0) / muscle.braid_angle_rad.sin().powi(2);
            assert!((gas.force_n(3e5, contraction_ratio, 1.0, 1.0) - expected_n).abs() < 1e-10 * expected_n);
        }
    }

    #[test]
    fn columns_times_weights_are_the_force() {
        let gas = Gas::new(&nominal());
        let (columns_n, weights) = (gas.columns_n(2.5e5, 0.13), gas.weights(0.9, 1.05));
        let sum_n: f64 = columns_n.iter().zip(weights).map(|(column, weight)| column * weight).sum();
        assert!((sum_n - gas.force_n(2.5e5, 0.13, 0.9, 1.05)).abs() < 1e-9);
    }
}
