//! Air in the bladder: pressure, volume and flow.
//!
//! ```text
//! ṗ = κ [R T ṁ - (p + p_atm) V̇] / V,   V(L) = L (b_s² - L²) / (4 π n²) - V_r + V_d
//! ṁ = C ρ₀ p_up ψ(p_down / p_up),   ψ(x) = 1 for x ≤ b, √(1 - ((x - b) / (1 - b))²) beyond
//! ```
//!
//! | symbol  | code                         | unit        | meaning                                     |
//! |---------|------------------------------|-------------|---------------------------------------------|
//! | `p`     | `pressure_pa`                | Pa          | gauge pressure in the muscle                |
//! | `V`     | `volume_m3`                  | m³          | air in bladder and tube                     |
//! | `V_d`   | `dead_volume_m3`             | m³          | fittings and tube                           |
//! | `ṁ`     | `flow_kg_per_s`              | kg/s        | into the muscle                             |
//! | `C`     | `conductance_m3_per_s_pa`    | m³/(s Pa)   | sonic conductance of the open valve         |
//! | `κ`     | [`POLYTROPIC`]               | 1           | between isothermal (1) and adiabatic (1.4)  |
//!
//! Valid for air of one temperature.
//!
//! Source: ISO 6358-1:2013 for the flow; the rest is the balance of mass and energy of an ideal gas.

use std::f64::consts::PI;

use pam_muscle::Muscle;

/// Exponent of the change of state: seconds are between slow and fast.
pub const POLYTROPIC: f64 = 1.2;
/// Atmosphere, in Pa.
pub const ATMOSPHERE_PA: f64 = 101_325.0;
/// Gas constant of air times 293 K, in J/kg.
const RT_J_PER_KG: f64 = 287.05 * 293.15;
/// Density of air at the reference conditions of ISO 8778, in kg/m³.
const RHO_0_KG_PER_M3: f64 = 1.185;
/// Critical pressure ratio of a small seat valve; ISO 6358 allows 0.2 to 0.5.
const CRITICAL_RATIO: f64 = 0.3;

/// Volume and compressibility of the air in one muscle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BladderGas {
    strand_square_m2: f64,
    /// `1 / (4 π n²)`.
    per_turns_square: f64,
    solid_m3: f64,
}

impl BladderGas {
    /// Air in `muscle` and a tube of `dead_volume_m3`.
    pub fn new(muscle: &Muscle, dead_volume_m3: f64) -> Self {
        let rubber_m3 = PI
            * muscle.rest_length_m
            * muscle.wall_thickness_m
            * (2.0 * muscle.rest_radius_m - muscle.wall_thickness_m);
        Self {
            strand_square_m2: muscle.strand_length_m().powi(2),
            per_turns_square: 1.0 / (4.0 * PI * muscle.turns().powi(2)),
            solid_m3: rubber_m3 - dead_volume_m3,
        }
    }

    /// `V`, in m³.
    pub fn volume_m3(&self, length_m: f64) -> f64 {
        length_m * (self.strand_square_m2 - length_m * length_m) * self.per_turns_square - self.solid_m3
    }

    /// `dV/dL`, in m²; negative: a shorter muscle is thicker.
    pub fn volume_slope_m2(&self, length_m: f64) -> f64 {
        (self.strand_square_m2 - 3.0 * length_m * length_m) * self.per_turns_square
    }

    /// Pressure after the volume has grown by a share `ΔV / V`, without flow, in Pa gauge.
    pub fn after_expansion_pa(pressure_pa: f64, share: f64) -> f64 {
        pressure_pa - POLYTROPIC * (pressure_pa + ATMOSPHERE_PA) * share
    }

    /// Change of pressure per mass of air that flows in, `κ R T / V`, in Pa/kg.
    pub fn stiffness_pa_per_kg(per_m3: f64) -> f64 {
        POLYTROPIC * RT_J_PER_KG * per_m3
    }
}

/// Flow from one gauge pressure to a lower one through an open valve, in kg/s; zero against the gradient.
///
/// Computed as `p_up ψ = √(p_up² - ((p_down - b p_up) / (1 - b))²)`, which divides by nothing.
pub fn flow_kg_per_s(conductance_m3_per_s_pa: f64, upstream_pa: f64, downstream_pa: f64) -> f64 {
    let (up_pa, down_pa) = (upstream_pa + ATMOSPHERE_PA, downstream_pa + ATMOSPHERE_PA);
    let kg_per_s_pa = conductance_m3_per_s_pa * RHO_0_KG_PER_M3;
    let beyond_pa = (down_pa - CRITICAL_RATIO * up_pa) * (1.0 / (1.0 - CRITICAL_RATIO));
    if beyond_pa <= 0.0 {
        return kg_per_s_pa * up_pa;
    }
    kg_per_s_pa * (up_pa * up_pa - beyond_pa * beyond_pa).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::nominal_muscle;

    #[test]
    fn validates_against_published_volumes() {
        // 68 to 162 cm³ over contractions of 0 to 0.2.
        let (muscle, gas) = (nominal_muscle(), BladderGas::new(&nominal_muscle(), 0.0));
        for (contraction_ratio, expected_cm3) in [(0.0, 68.0), (0.2, 162.0)] {
            let volume_cm3 = 1e6 * gas.volume_m3(muscle.length_m(contraction_ratio));
            assert!((volume_cm3 - expected_cm3).abs() < 1.0, "{volume_cm3}");
        }
    }

    #[test]
    fn volume_slope_agrees_with_finite_differences() {
        let gas = BladderGas::new(&nominal_muscle(), 2e-5);
        let slope_m2 = (gas.volume_m3(0.24 + 1e-6) - gas.volume_m3(0.24 - 1e-6)) / 2e-6;
        assert!((slope_m2 - gas.volume_slope_m2(0.24)).abs() < 1e-9);
    }

    #[test]
    fn flow_is_choked_below_the_critical_ratio_and_vanishes_at_equal_pressures() {
        let choked = flow_kg_per_s(1e-9, 6e5, 0.0);
        assert!((choked - 1e-9 * RHO_0_KG_PER_M3 * (6e5 + ATMOSPHERE_PA)).abs() < 1e-15);
        assert!(flow_kg_per_s(1e-9, 6e5, 5e5) < choked);
        // Half of what is choked at ψ = 1/2, that is at b + (1 - b) √3/2 = 0.9062.
        let down_pa = (CRITICAL_RATIO + 0.7 * 0.75_f64.sqrt()) * (6e5 + ATMOSPHERE_PA) - ATMOSPHERE_PA;
        assert!((flow_kg_per_s(1e-9, 6e5, down_pa) / choked - 0.5).abs() < 1e-12);
        assert!(flow_kg_per_s(1e-9, 3e5, 3e5) < 1e-18 && flow_kg_per_s(1e-9, 1e5, 3e5) < 1e-18);
    }
}
