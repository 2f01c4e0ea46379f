//! Energies stored in a muscle held at length `L` and pressure `p`.
//!
//! The gas does work on its surroundings when the volume grows, the strands stretch under the load that
//! the gas puts on them, the rubber of the bladder is deformed. A muscle that is held pulls with the
//! derivative of what is stored by its length:
//!
//! ```text
//! V(L, b)  = L (b² - L²) / (4 π n²)                                 volume inside a braid of strand length b
//! Π(L; p)  = min over b of  N E A (b - b_s)² / (2 b_s) - p V(L, b)  gas and stretched strands
//! b        = b_s / (1 - y),   y = p L b_s / (2 π n² N E A)          where the minimum is: ∂Π/∂b = 0
//! Π₀(L; p) = -p V(L, b_s)                                           gas alone, strands of fixed length
//! U(L)     = V_r W(λ₁, λ₂, λ₃)                                      rubber of the bladder
//! W        = C₁₀ (λ₁² + λ₂² + λ₃² - 3) + C₀₁ (λ₁⁻² + λ₂⁻² + λ₃⁻² - 3)
//! λ₁ = L / L₀,   λ₂ = (D - t) / (D₀ - t₀),   λ₃ = t / t₀
//! D(L) = √(b_s² - L²) / (π n)                                       the bladder fills the braid
//! t(L) = ½ [D - √(D² - 4 V_r / (π L))]                              the wall keeps its volume
//! ```
//!
//! | symbol     | code                | unit | meaning                                          |
//! |------------|---------------------|------|--------------------------------------------------|
//! | `L`        | `length`            | m    | active length                                    |
//! | `p`        | `pressure_pa`       | Pa   | gauge pressure                                   |
//! | `b`, `b_s` | `strand`, `strand_m`| m    | length of a strand: stretched, as made           |
//! | `N E A`    | `stiffness_n`       | N    | strands together: number, modulus, cross-section |
//! | `V_r`      | `rubber_m3`         | m³   | volume of rubber, `π L₀ t₀ (D₀ - t₀)`            |
//! | `C₁₀, C₀₁` | `c10_pa`, `c01_pa`  | Pa   | Mooney–Rivlin constants                          |
//!
//! Valid while the muscle is a cylinder, the bladder touches the braid and `y < 1/2`.
//!
//! Sources: Chou and Hannaford (1996), IEEE Trans. Robotics and Automation 12(1), for the virtual work of the gas;
//! Mooney (1940), J. Applied Physics 11, and Rivlin (1948), Phil. Trans. A 241, for the rubber.

use std::f64::consts::PI;

use pam_muscle::Muscle;

use crate::dual::Dual;

/// What the energies need of a muscle, computed once.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Energies {
    rest_length_m: f64,
    wall_m: f64,
    mean_diameter_m: f64,
    strand_m: f64,
    turns: f64,
    section_m2: f64,
    rubber_m3: f64,
}

impl Energies {
    /// Energies of `muscle`.
    pub(crate) fn of(muscle: &Muscle) -> Self {
        let mean_diameter_m = 2.0 * muscle.rest_radius_m - muscle.wall_thickness_m;
        Self {
            rest_length_m: muscle.rest_length_m,
            wall_m: muscle.wall_thickness_m,
            mean_diameter_m,
            strand_m: muscle.strand_length_m(),
            turns: muscle.turns(),
            section_m2: muscle.braid_section_m2(),
            rubber_m3: PI * muscle.rest_length_m * muscle.wall_thickness_m * mean_diameter_m,
        }
    }

    /// `V(L, b)`, in m³.
    fn volume_m3(&self, length: Dual, strand: Dual) -> Dual {
        1.0 / (4.0 * PI * self.turns * self.turns) * (length * (strand.squared() - length.squared()))
    }

    /// `Π₀(L; p)`, in J.
    pub(crate) fn gas_j(&self, pressure_pa: f64, length: Dual) -> Dual {
        -(pressure_pa * self.volume_m3(length, Dual::constant(self.strand_m)))
    }

    /// The function of `b` that [`Self::gas_and_strands_j`] minimizes, in J.
    fn gas_and_strands_at_j(&self, pressure_pa: f64, modulus_pa: f64, length: Dual, strand: Dual) -> Dual {
        let stiffness_n = modulus_pa * self.section_m2;
        let stretch = strand - Dual::constant(self.strand_m);
        stiffness_n / (2.0 * self.strand_m) * stretch.squared() - pressure_pa * self.volume_m3(length, strand)
    }

    /// `b / b_s - 1`: share by which the strands stretch.
    pub(crate) fn strand_strain(&self, pressure_pa: f64, modulus_pa: f64, length_m: f64) -> f64 {
        self.stretched_strand(pressure_pa, modulus_pa, Dual::constant(length_m)).value / self.strand_m - 1.0
    }

    /// The strand length `b` that minimizes the energy.
    fn stretched_strand(&self, pressure_pa: f64, modulus_pa: f64, length: Dual) -> Dual {
        let stiffness_n = modulus_pa * self.section_m2;
        let y = pressure_pa * self.strand_m / (2.0 * PI * self.turns * self.turns * stiffness_n) * length;
        Dual::constant(self.strand_m) / (Dual::constant(1.0) - y)
    }

    /// `Π(L; p)`, in J.
    pub(crate) fn gas_and_strands_j(&self, pressure_pa: f64, modulus_pa: f64, length: Dual) -> Dual {
        let strand = self.stretched_strand(pressure_pa, modulus_pa, length);
        self.gas_and_strands_at_j(pressure_pa, modulus_pa, length, strand)
    }

    /// `U(L)`, in J.
    pub(crate) fn bladder_j(&self, c10_pa: f64, c01_pa: f64, length: Dual) -> Dual {
        let strand_squared = Dual::constant(self.strand_m * self.strand_m);
        let diameter = 1.0 / (PI * self.turns) * (strand_squared - length.squared()).sqrt();
        let bore = (diameter.squared() - Dual::constant(4.0 * self.rubber_m3 / PI) / length).sqrt();
        let wall = 0.5 * (diameter - bore);
        let axial = (1.0 / self.rest_length_m * length).squared();
        let hoop = (1.0 / self.mean_diameter_m * (diameter - wall)).squared();
        let radial = (1.0 / self.wall_m * wall).squared();
        let one = Dual::constant(1.0);
        let three = Dual::constant(3.0);
        let stretched = axial + hoop + radial - three;
        let compressed = one / axial + one / hoop + one / radial - three;
        self.rubber_m3 * (c10_pa * stretched + c01_pa * compressed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::derivative;
    use crate::true_muscle::tests::nominal_muscle;

    const NYLON_PA: f64 = 3e9;

    /// Derivative by a seven-point central difference; its error is of the order of `h⁶`.
    fn difference(function: impl Fn(f64) -> f64, at: f64, step: f64) -> f64 {
        let pair = |steps: f64| function(at + steps * step) - function(at - steps * step);
        (45.0 * pair(1.0) - 9.0 * pair(2.0) + pair(3.0)) / (60.0 * step)
    }

    #[test]
    fn every_derivative_agrees_with_high_order_differences() {
        let energies = Energies::of(&nominal_muscle());
        for contraction_ratio in [-0.01, 0.0, 0.1, 0.2, 0.3] {
            let length_m = 0.267 * (1.0 - contraction_ratio);
            let each: [&dyn Fn(Dual) -> Dual; 3] = [
                &|length| energies.gas_j(3e5, length),
                &|length| energies.gas_and_strands_j(3e5, NYLON_PA, length),
                &|length| energies.bladder_j(118.4e3, 105.7e3, length),
            ];
            for (index, energy) in each.into_iter().enumerate() {
                let exact = derivative(energy, length_m);
                let numeric = difference(|length_m| energy(Dual::constant(length_m)).value, length_m, 3e-4);
                // The bladder is at ease at ε = 0, so its error is compared with its force elsewhere.
                let error = (exact - numeric).abs() / exact.abs().max(50.0);
                assert!(error < 1e-9, "energy {index}, ε = {contraction_ratio}: {exact} {numeric} {error:e}");
            }
        }
    }

    #[test]
    fn the_closed_form_of_the_strand_is_the_minimum_that_a_search_finds() {
        let energies = Energies::of(&nominal_muscle());
        let length = Dual::constant(0.24);
        let energy_j =
            |strand_m: f64| energies.gas_and_strands_at_j(5e5, NYLON_PA, length, Dual::constant(strand_m)).value;
        let (mut low_m, mut high_m) = (energies.strand_m, 1.2 * energies.strand_m);
        while high_m - low_m > 1e-9 {
            let third_m = (high_m - low_m) / 3.0;
            if energy_j(low_m + third_m) < energy_j(high_m - third_m) {
                high_m -= third_m;
            } else {
                low_m += third_m;
            }
        }
        let strand_m = energies.stretched_strand(5e5, NYLON_PA, length).value;
        // A minimum is flat: a search finds it to the root of the rounding only.
        assert!((strand_m - low_m).abs() < 1e-7, "{strand_m} {low_m}");
        assert!(strand_m > energies.strand_m);
    }

    #[test]
    fn gas_energy_derives_to_the_closed_form_of_the_ideal_braid() {
        let muscle = nominal_muscle();
        let energies = Energies::of(&muscle);
        let a = 3.0 / muscle.braid_angle_rad.tan().powi(2);
        let b = 1.0 / muscle.braid_angle_rad.sin().powi(2);
        for contraction_ratio in [0.0, 0.1, 0.2, 0.3] {
            let length_m = muscle.length_m(contraction_ratio);
            let tension_n = derivative(|length| energies.gas_j(3e5, length), length_m);
            let closed_n = PI * muscle.rest_radius_m.powi(2) * 3e5 * (a * (1.0 - contraction_ratio).powi(2) - b);
            assert!((tension_n - closed_n).abs() < 1e-9 * 773.0);
        }
    }

    #[test]
    fn stretched_strands_pull_as_a_braid_of_that_strand_length_would() {
        // Envelope theorem: the strand's own change does no work at the minimum.
        let energies = Energies::of(&nominal_muscle());
        let (pressure_pa, length_m) = (5e5, 0.25);
        let tension_n = derivative(|length| energies.gas_and_strands_j(pressure_pa, NYLON_PA, length), length_m);
        let strand_m = energies.stretched_strand(pressure_pa, NYLON_PA, Dual::constant(length_m)).value;
        let closed_n = pressure_pa * (3.0 * length_m * length_m - strand_m * strand_m)
            / (4.0 * PI * energies.turns * energies.turns);
        assert!((tension_n - closed_n).abs() < 1e-9 * closed_n);
    }

    #[test]
    fn a_bladder_at_rest_stores_nothing_and_pulls_nothing() {
        let energies = Energies::of(&nominal_muscle());
        let at_rest = energies.bladder_j(118.4e3, 105.7e3, Dual::variable(0.267));
        assert!(at_rest.value.abs() < 1e-12 && at_rest.slope.abs() < 1e-9, "{at_rest:?}");
    }

    #[test]
    fn stiff_strands_leave_the_gas_alone() {
        let energies = Energies::of(&nominal_muscle());
        let soft_n = derivative(|length| energies.gas_and_strands_j(3e5, 1e18, length), 0.25);
        let rigid_n = derivative(|length| energies.gas_j(3e5, length), 0.25);
        assert!((soft_n - rigid_n).abs() < 1e-6);
    }
}
