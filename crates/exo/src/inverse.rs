//! Which pressure gives a force at a length: the muscle's model turned around.
//!
//! The loop asks through one trait, so that a trained network, the exact inverse or anything else can answer.
//! The direction is a number between -1 and 1, because friction that has not broken away yet is somewhere
//! between the branches of contraction and extension.

use pam_muscle::effects::AugmentedModel;

/// An answer of an inverse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inverted {
    /// Gauge pressure, in Pa.
    pub pressure_pa: f64,
    /// Whether the question lies outside what the inverse knows; the pressure is then its nearest answer.
    pub outside: bool,
}

/// The inverse of a force model.
pub trait Inverse: Sync {
    /// Pressure that gives `force_n` at `length_m`; `direction` from -1 (extending) to 1 (contracting).
    fn pressure_pa(&self, force_n: f64, length_m: f64, direction: f64) -> Inverted;
}

/// The inverse by bracketed root finding on the settled force of a model.
#[derive(Debug, Clone)]
pub struct ExactInverse {
    model: AugmentedModel,
    lowest_pa: f64,
    highest_pa: f64,
}

/// Accuracy of the exact inverse, in Pa.
const TOLERANCE_PA: f64 = 1e-3;

impl ExactInverse {
    /// The inverse of `model` between two gauge pressures.
    pub fn new(model: impl Into<AugmentedModel>, lowest_pa: f64, highest_pa: f64) -> Self {
        Self { model: model.into(), lowest_pa, highest_pa }
    }
}

impl Inverse for ExactInverse {
    /// Regula falsi in the form of Illinois: the force is nearly linear in the pressure.
    fn pressure_pa(&self, force_n: f64, length_m: f64, direction: f64) -> Inverted {
        let excess_n = |pressure_pa: f64| self.model.settled_force_n(pressure_pa, length_m, direction) - force_n;
        let (mut low_pa, mut high_pa) = (self.lowest_pa, self.highest_pa);
        let (mut low_n, mut high_n) = (excess_n(low_pa), excess_n(high_pa));
        if !(low_n <= 0.0 && high_n >= 0.0) {
            // Also where the force is no number: as much as can be done is to say so.
            let pressure_pa = if low_n > 0.0 { low_pa } else { high_pa };
            return Inverted { pressure_pa, outside: true };
        }
        let mut kept_low = None;
        for _ in 0..100 {
            if high_pa - low_pa < TOLERANCE_PA || high_n - low_n <= 0.0 {
                break;
            }
            let middle_pa = high_pa - high_n * (high_pa - low_pa) / (high_n - low_n);
            let middle_n = excess_n(middle_pa);
            if middle_n.abs() < 1e-9 {
                return Inverted { pressure_pa: middle_pa, outside: false };
            }
            if middle_n < 0.0 {
                (low_pa, low_n) = (middle_pa, middle_n);
                high_n *= if kept_low == Some(false) { 0.5 } else { 1.0 };
                kept_low = Some(false);
            } else {
                (high_pa, high_n) = (middle_pa, middle_n);
                low_n *= if kept_low == Some(true) { 0.5 } else { 1.0 };
                kept_low = Some(true);
            }
        }
        Inverted { pressure_pa: 0.5 * (low_pa + high_pa), outside: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::nominal_model;

    #[test]
    fn force_of_the_inverse_is_the_force_asked_for() {
        let (model, inverse) = (nominal_model(), ExactInverse::new(nominal_model(), 0.0, 5e5));
        for (force_n, length_m, direction) in [(56.7, 0.267, 1.0), (48.0, 0.2255, 0.3), (200.0, 0.24, -1.0)] {
            let found = inverse.pressure_pa(force_n, length_m, direction);
            assert!(!found.outside);
            assert!((model.force_n(found.pressure_pa, length_m, direction) - force_n).abs() < 1e-5, "{found:?}");
        }
    }

    #[test]
    fn a_force_out_of_reach_gives_the_nearest_pressure_and_says_so() {
        let inverse = ExactInverse::new(nominal_model(), 0.0, 5e5);
        assert_eq!(inverse.pressure_pa(5e3, 0.26, 1.0), Inverted { pressure_pa: 5e5, outside: true });
        assert_eq!(inverse.pressure_pa(-500.0, 0.26, 1.0), Inverted { pressure_pa: 0.0, outside: true });
    }

    #[test]
    fn validates_against_published_pressures_of_the_lift() {
        // 24 to 105 kPa for a load arm of 0.30 m: 56.7 N at 0.267 m, 47.9 N at 0.2255 m, printed with the
        // paper's larger loss in the braid.
        let inverse = ExactInverse::new(nominal_model(), 0.0, 5e5);
        for (force_n, length_m, expected_kpa) in [(56.7, 0.267, 24.0), (47.9, 0.2255, 105.0)] {
            let found_kpa = 1e-3 * inverse.pressure_pa(force_n, length_m, 1.0).pressure_pa;
            assert!((found_kpa - expected_kpa).abs() < 3.0, "{found_kpa}");
        }
    }
}
