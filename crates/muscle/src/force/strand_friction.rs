//! Friction between the strands where they cross (eq. 10).
//!
//! The paper names the contact area but lost its formula. Crossed cylinders after Hertz: the braid has
//! `N_c = n N² / 2` crossings that share the pressure on the surface,
//!
//! ```text
//! F_c = p π D L / N_c,   a = [3 F_c (d_s / 2) (1 - ν²) / (2 E)]^{1/3},   S = N_c π a²
//! F_strand = (f_ss / S_scale) S p        so   F_strand ∝ p^{5/3} (D L)^{2/3}
//! ```
//!
//! | symbol         | code               | unit | meaning                                       |
//! |----------------|--------------------|------|-----------------------------------------------|
//! | `f_ss/S_scale` | coefficient        | 1    | only the quotient can be found                |
//! | `E`            | `strand_modulus_pa`| Pa   | modulus of the strand material, not of the fit |
//! | `ν`            | [`POISSON_RATIO`]  | 1    | of nylon                                      |
//! | `S`            | `contact_area_m2`  | m²   | all contacts together                         |
//!
//! Over the range of a bench this is nearly the friction of the bladder (cosine 0.98), so that a fit
//! finds one of the two and reports it for both.
//!
//! Source: Davis and Caldwell (2006), "Braid effects on contractile range and friction modeling in pneumatic
//! muscle actuators", Int. J. Robotics Research 25(4), for the idea; Hertz (1882) for the contact.

use std::f64::consts::PI;

use crate::geometry::Muscle;

/// Poisson's ratio of nylon.
pub const POISSON_RATIO: f64 = 0.4;

/// Constants of the contact between strands for one muscle.
#[derive(Debug, Clone, Copy)]
pub struct StrandContact {
    crossings: f64,
    /// `3 (d_s / 2) (1 - ν²) / (2 E)`, in m/Pa.
    hertz_m_per_pa: f64,
}

impl StrandContact {
    /// The term for `muscle` with strands of a given modulus.
    pub fn new(muscle: &Muscle, strand_modulus_pa: f64) -> Self {
        let radius_m = 0.5 * muscle.strand_diameter_m;
        Self {
            crossings: 0.5 * muscle.turns() * muscle.strand_count * muscle.strand_count,
            hertz_m_per_pa: 1.5 * radius_m * (1.0 - POISSON_RATIO * POISSON_RATIO) / strand_modulus_pa,
        }
    }

    /// `S`, in m², where the bladder presses on the braid with `normal_force_n`; zero without pressure.
    pub fn contact_area_m2(&self, normal_force_n: f64) -> f64 {
        let force_n = normal_force_n.max(0.0) / self.crossings;
        let radius_m = (self.hertz_m_per_pa * force_n).cbrt();
        self.crossings * PI * radius_m * radius_m
    }

    /// Friction per unit of `f_ss / S_scale`, `S p`, in N.
    pub fn force_n(&self, pressure_pa: f64, normal_force_n: f64) -> f64 {
        self.contact_area_m2(normal_force_n) * pressure_pa
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::force::rubber_friction::normal_force_n;
    use crate::geometry::tests::nominal;

    fn friction_n(pressure_pa: f64, length_m: f64) -> f64 {
        let muscle = Muscle { strand_count: 120.0, ..nominal() };
        let normal_n = normal_force_n(pressure_pa, muscle.diameter_m(length_m), length_m);
        StrandContact::new(&muscle, 3e9).force_n(pressure_pa, normal_n)
    }

    #[test]
    fn validates_against_published_magnitudes() {
        // 0.5 N at 0.05 MPa and 10 N at 0.3 MPa for a quotient of 1 and a braid of 120 strands.
        assert!((friction_n(0.05e6, 0.24) - 0.5).abs() < 0.15, "{}", friction_n(0.05e6, 0.24));
        assert!((friction_n(0.3e6, 0.24) - 10.0).abs() < 1.5, "{}", friction_n(0.3e6, 0.24));
    }

    #[test]
    fn grows_with_pressure_to_five_thirds() {
        let ratio = friction_n(4e5, 0.24) / friction_n(1e5, 0.24);
        assert!((ratio - 4.0_f64.powf(5.0 / 3.0)).abs() < 1e-9, "{ratio}");
    }

    #[test]
    fn suction_presses_no_strands_together() {
        assert!(friction_n(-1e3, 0.24).abs() < f64::EPSILON);
    }
}
