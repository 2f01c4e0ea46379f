//! Force lost to the stretch of the strands (eq. 2).
//!
//! Hoop and axial equilibrium of the braid both give the tension of one strand, `T = p L b / (2 π n² N)`.
//! It stretches the strand by Hooke's law to `b = b_s + b_s T / (E A)`, that is
//!
//! ```text
//! b = b_s / (1 - y),   y = p L b_s / (k E A),   k = 2 π n² N
//! F_braid = p (b² - b_s²) / (4 π n²) = (p b_s² / (4 π n²)) [(1 - y)⁻² - 1]
//! ```
//!
//! which is what the gas force `p (3 L² - b²) / (4 π n²)` loses when `b` grows. The paper takes
//! `k = π n N` instead, too small by `2 n`, and writes
//!
//! ```text
//! F_braid = N² b_s³ A² E² p² π n L / (π n N E A - p L b_s)³ = (p b_s² / (π n)) y (1 - y)⁻³
//! ```
//!
//! (with its own `y`), which is 13 to 16 times as much to first order. [`Form::AsPrinted`] keeps it.
//!
//! | symbol | code                         | unit | meaning                                              |
//! |--------|------------------------------|------|------------------------------------------------------|
//! | `A`    | –                            | m²   | section of one strand                                |
//! | `1/E`  | `strand_compliance_per_pa`   | 1/Pa | compliance of the strand material                    |
//! | `y`    | `strain()`                   | 1    | strain of the strand, related to its stretched length |
//!
//! Only `N b_s³ / (k² E A)` shows in the force, so that one effective modulus is all a fit can find.
//! Valid up to strains of some 15 %, where nylon breaks; both forms are singular at `y = 1`.
//!
//! The force is smooth in the compliance, and zero without it. For a fit it is written as a sum of
//! [`NODES`] columns, the forces at fixed compliances, with the weights of polynomial interpolation
//! through them and through zero. On the strains below [`MAX_STRAIN`] the sum agrees with the exact
//! form to better than 1e-5 of the force at the largest strain (see the tests).
//!
//! Source: eq. 2 of Appl. Sci. 2023, 13(21), 12038, with its constant derived anew.

use std::f64::consts::PI;

use super::form::Form;
use crate::geometry::Muscle;

/// Columns that stand for the braid term in a fit.
pub const NODES: usize = 5;

/// Largest strain of a strand that a fit considers.
pub const MAX_STRAIN: f64 = 0.15;

/// Constants of the braid term for one muscle.
#[derive(Debug, Clone, Copy)]
pub struct Braid {
    form: Form,
    /// Strain per unit of pressure, length and compliance, in 1/m.
    strain_per_m: f64,
    /// Factor of the force, in m².
    area_m2: f64,
}

impl Braid {
    /// The term for `muscle`, corrected or as printed.
    pub fn new(muscle: &Muscle, form: Form) -> Self {
        let (strand_m, turns) = (muscle.strand_length_m(), muscle.turns());
        let (tension_factor, area_m2) = match form {
            Form::Corrected => (2.0 * PI * turns * turns, strand_m * strand_m / (4.0 * PI * turns * turns)),
            Form::AsPrinted => (PI * turns, strand_m * strand_m / (PI * turns)),
        };
        Self { form, strain_per_m: strand_m / (tension_factor * muscle.braid_section_m2()), area_m2 }
    }

    /// Strain `y` of the strands.
    pub fn strain(&self, pressure_pa: f64, length_m: f64, strand_compliance_per_pa: f64) -> f64 {
        self.strain_per_m * pressure_pa * length_m * strand_compliance_per_pa
    }

    /// Largest compliance, in 1/Pa, that keeps the strain below [`MAX_STRAIN`] where pressure times length
    /// is `largest_n_per_m`.
    pub fn max_compliance_per_pa(&self, largest_n_per_m: f64) -> f64 {
        MAX_STRAIN / (self.strain_per_m * largest_n_per_m)
    }

    /// `F_braid`, in N: the loss, positive; not finite where the strain reaches 1.
    pub fn force_n(&self, pressure_pa: f64, length_m: f64, strand_compliance_per_pa: f64) -> f64 {
        let strain = self.strain(pressure_pa, length_m, strand_compliance_per_pa);
        if strain >= 1.0 {
            return f64::NAN;
        }
        let rest = 1.0 - strain;
        let share = match self.form {
            // (1 - y)⁻² - 1 without cancellation.
            Form::Corrected => strain * (2.0 - strain) / (rest * rest),
            Form::AsPrinted => strain / (rest * rest * rest),
        };
        self.area_m2 * pressure_pa * share
    }
}

/// Interpolation of the braid term over the compliance; see the [module](self).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComplianceNodes {
    /// Compliances of the columns, in 1/Pa; zero is a node without a column.
    nodes_per_pa: [f64; NODES],
    /// One over the distances of a node from all others, multiplied; in Paⁿ, with `n` of [`NODES`].
    scales: [f64; NODES],
}

impl ComplianceNodes {
    /// Chebyshev–Lobatto nodes on `0 ..= max_compliance_per_pa`.
    pub fn new(max_compliance_per_pa: f64) -> Self {
        let mut nodes_per_pa = [0.0; NODES];
        for (index, node) in nodes_per_pa.iter_mut().enumerate() {
            let angle = PI * (index + 1) as f64 / NODES as f64;
            *node = 0.5 * max_compliance_per_pa * (1.0 - angle.cos());
        }
        let scales = nodes_per_pa.map(|here| {
            nodes_per_pa.iter().filter(|&&other| other != here).fold(1.0 / here, |scale, other| scale / (here - other))
        });
        Self { nodes_per_pa, scales }
    }

    /// Compliances of the columns, in 1/Pa.
    pub fn nodes_per_pa(&self) -> &[f64; NODES] {
        &self.nodes_per_pa
    }

    /// Weights of the columns at a compliance.
    pub fn weights(&self, compliance_per_pa: f64) -> [f64; NODES] {
        // Lagrange polynomials as products, so that nothing is divided by a small distance: of the distances in front of
        // a node, then of those after it.
        let mut weights = self.scales;
        let mut product = compliance_per_pa;
        for (weight, node) in weights.iter_mut().zip(&self.nodes_per_pa) {
            *weight *= product;
            product *= compliance_per_pa - node;
        }
        product = 1.0;
        for (weight, node) in weights.iter_mut().zip(&self.nodes_per_pa).rev() {
            *weight *= product;
            product *= compliance_per_pa - node;
        }
        weights
    }

    /// Derivatives of the [weights](Self::weights) by the compliance, in Pa.
    pub fn weight_slopes(&self, compliance_per_pa: f64) -> [f64; NODES] {
        let mut slopes = self.scales;
        for (slope, here) in slopes.iter_mut().zip(&self.nodes_per_pa) {
            // Value and derivative of the product so far.
            let (mut product, mut by_compliance) = (compliance_per_pa, 1.0);
            for other in self.nodes_per_pa.iter().filter(|&other| other != here) {
                by_compliance = by_compliance * (compliance_per_pa - other) + product;
                product *= compliance_per_pa - other;
            }
            *slope *= by_compliance;
        }
        slopes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tests::nominal;

    #[test]
    fn force_is_what_the_gas_loses_on_longer_strands() {
        let muscle = nominal();
        let braid = Braid::new(&muscle, Form::Corrected);
        let (pressure_pa, length_m, compliance) = (4e5, 0.24, 1.0 / 3e9);
        // Strand in equilibrium, by iterating Hooke's law on the tension p L b / (2 π n² N).
        let turns = muscle.turns();
        let stiffness_n = 3e9 * muscle.braid_section_m2();
        let rest_m = muscle.strand_length_m();
        let mut strand_m = rest_m;
        for _ in 0..60 {
            strand_m = rest_m * (1.0 + pressure_pa * length_m * strand_m / (2.0 * PI * turns * turns * stiffness_n));
        }
        // -p dV/dL at that strand length, against the same at rest length.
        let gas_n = |b: f64| pressure_pa * (3.0 * length_m * length_m - b * b) / (4.0 * PI * turns * turns);
        let lost_n = gas_n(rest_m) - gas_n(strand_m);
        let force_n = braid.force_n(pressure_pa, length_m, compliance);
        assert!((force_n - lost_n).abs() < 1e-10 * force_n, "{force_n} {lost_n}");
    }

    #[test]
    fn validates_against_the_published_force_budget() {
        // 31, 29, 28 and 26 N at 0.3 MPa and contractions of 0, 0.05, 0.102 and 0.156, found with the
        // paper's `y (1 - y)⁻³` in place of `[(1 - y)⁻² - 1] / 2`: 3 y / 2 more, and y = 0.027 here.
        let muscle = nominal();
        let braid = Braid::new(&muscle, Form::Corrected);
        for (contraction_ratio, expected_n) in [(0.0, 31.0), (0.05, 29.0), (0.102, 28.0), (0.156, 26.0)] {
            let length_m = muscle.length_m(contraction_ratio);
            let strain = braid.strain(3e5, length_m, 1.0 / 3e9);
            let force_n = braid.force_n(3e5, length_m, 1.0 / 3e9) * (1.0 + 1.5 * strain);
            assert!((force_n - expected_n).abs() < 0.6, "ε = {contraction_ratio}: {force_n}");
        }
    }

    #[test]
    fn the_printed_form_is_its_own_formula() {
        let muscle = nominal();
        let (p, l, e): (f64, f64, f64) = (2e5, 0.25, 3e9);
        let (b0, n, big_n) = (muscle.strand_length_m(), muscle.turns(), muscle.strand_count);
        let a = muscle.braid_section_m2() / big_n;
        let printed_n = big_n.powi(2) * b0.powi(3) * a.powi(2) * e.powi(2) * p.powi(2) * PI * n * l
            / (PI * n * big_n * e * a - p * l * b0).powi(3);
        let force_n = Braid::new(&muscle, Form::AsPrinted).force_n(p, l, 1.0 / e);
        assert!((force_n - printed_n).abs() < 1e-10 * printed_n);
        let ratio = force_n / Braid::new(&muscle, Form::Corrected).force_n(p, l, 1.0 / e);
        assert!(ratio > 13.0, "the printed constant overstates the loss: {ratio}");
    }

    #[test]
    fn columns_interpolate_the_exact_force() {
        for form in [Form::Corrected, Form::AsPrinted] {
            let braid = Braid::new(&nominal(), form);
            let largest = 5e5 * 0.27;
            let top = braid.max_compliance_per_pa(largest);
            let nodes = ComplianceNodes::new(top);
            let scale_n = braid.force_n(5e5, 0.27, top);
            for share in [0.01, 0.1, 0.37, 0.6, 0.93] {
                let weights = nodes.weights(share * top);
                for (pressure_pa, length_m) in [(5e5, 0.27), (5e4, 0.27), (3e5, 0.2)] {
                    let sum_n: f64 = nodes
                        .nodes_per_pa()
                        .iter()
                        .zip(weights)
                        .map(|(&node, weight)| weight * braid.force_n(pressure_pa, length_m, node))
                        .sum();
                    let error = (sum_n - braid.force_n(pressure_pa, length_m, share * top)).abs() / scale_n;
                    assert!(error < 1e-5, "{form:?}, {share} of the largest compliance: {error:e}");
                }
            }
        }
    }

    #[test]
    fn weight_slopes_agree_with_finite_differences() {
        let nodes = ComplianceNodes::new(2e-9);
        let step = 1e-14;
        for compliance in [0.0, 1e-10, 0.7e-9, 1.9e-9] {
            let (up, down) = (nodes.weights(compliance + step), nodes.weights(compliance - step));
            let slopes = nodes.weight_slopes(compliance);
            for index in 0..NODES {
                let expected = (up[index] - down[index]) / (2.0 * step);
                assert!((slopes[index] - expected).abs() < 1e-4 * expected.abs().max(1e8), "{compliance:e}");
            }
        }
    }
}
