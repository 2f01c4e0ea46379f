//! The bladder must be blown up before it reaches the braid.
//!
//! ```text
//! p_b(L) = 2 (t₀ / R_b) (C₁₀ + C₀₁) (1 - λ⁻⁴),   λ = D(L) / (2 R_b)
//! p_contact = mean over u in [1 - w, 1 + w] of max(0, p - u p_b)
//! ```
//!
//! | symbol      | code                 | unit | meaning                                                     |
//! |-------------|----------------------|------|-------------------------------------------------------------|
//! | `p_b`       | `inflation_pa()`     | Pa   | pressure that blows the bare bladder up to the braid        |
//! | `R_b`       | `bladder_radius_m`   | m    | radius of the bladder at ease, less than that of the braid  |
//! | `λ`         | `hoop`               | 1    | stretch of the bladder around                               |
//! | `w`         | `spread`             | 1    | the bladder is not equally far from the braid all around    |
//! | `p_contact` | `muscle_pressure_pa` | Pa   | what is left for the braid, and what its friction feels     |
//!
//! The mean over the spread is exact: nothing, then a parabola, then a shift.
//!
//! Source: inflation of a thin neo-Hookean tube (Green and Zerna, 1954, "Theoretical Elasticity"), with `G = 2 (C₁₀
//! + C₀₁)`.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Pressure lost between gas and braid.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Threshold {
    stiffness_pa: f64,
    bladder_radius_m: f64,
    spread: f64,
}

impl Threshold {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let dimensions = draw.muscle.muscle().clone();
        let fit = draw.even("bladder_over_braid_radius", 0.75, 0.88, "1");
        let spread = draw.even("spread", 0.15, 0.5, "1");
        let bladder_radius_m = fit * dimensions.rest_radius_m;
        let parameters = draw.muscle.parameters();
        let rubber_pa = parameters.c10_pa + parameters.c01_pa;
        let stiffness_pa = draw.severity * 2.0 * dimensions.wall_thickness_m / bladder_radius_m * rubber_pa;
        let threshold = Self { stiffness_pa, bladder_radius_m, spread };
        let at_m = dimensions.length_m(0.5 * draw.reached_contraction());
        let inflation_pa = threshold.inflation_pa(draw.muscle, at_m);
        draw.parameters.push(crate::draw::DrawnParameter {
            name: "inflation_pressure_at_half_stroke",
            value: inflation_pa,
            unit: "Pa",
        });
        draw.at("pressure", 0.0, (1.0 + spread) * inflation_pa, "Pa");
        threshold
    }

    fn inflation_pa(&self, muscle: &TrueMuscle, length_m: f64) -> f64 {
        let hoop = muscle.muscle().diameter_m(length_m) / (2.0 * self.bladder_radius_m);
        self.stiffness_pa * (1.0 - hoop.powi(-4)).max(0.0)
    }
}

/// Mean of `max(0, p - u p_b)` over `u` in `[1 - spread, 1 + spread]`.
fn contact_pa(pressure_pa: f64, inflation_pa: f64, spread: f64) -> f64 {
    let (first_pa, last_pa) = ((1.0 - spread) * inflation_pa, (1.0 + spread) * inflation_pa);
    if pressure_pa >= last_pa {
        pressure_pa - inflation_pa
    } else if pressure_pa <= first_pa {
        0.0
    } else {
        (pressure_pa - first_pa).powi(2) / (2.0 * (last_pa - first_pa))
    }
}

impl Mechanism for Threshold {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        let inflation_pa = self.inflation_pa(muscle, now.muscle_length_m);
        now.muscle_pressure_pa = contact_pa(now.muscle_pressure_pa, inflation_pa, self.spread);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::run;

    #[test]
    fn nothing_below_a_shift_above_and_a_smooth_way_between() {
        assert_eq!(contact_pa(10e3, 30e3, 0.3), 0.0);
        assert!((contact_pa(100e3, 30e3, 0.3) - 70e3).abs() < 1e-9);
        // The mean is that of the samples.
        let sampled: f64 = (0..10_000)
            .map(|index| (35e3 - (0.7 + 0.6 * (f64::from(index) + 0.5) / 10_000.0) * 30e3).max(0.0) / 10_000.0)
            .sum();
        assert!((contact_pa(35e3, 30e3, 0.3) - sampled).abs() < 0.1);
        let below = contact_pa(39e3 - 1e-3, 30e3, 0.3);
        assert!((contact_pa(39e3, 30e3, 0.3) - below).abs() < 2e-3);
    }

    #[test]
    fn a_wider_braid_asks_for_more_pressure() {
        let threshold = Threshold { stiffness_pa: 50e3, bladder_radius_m: 8e-3, spread: 0.3 };
        let at = |length_m: f64| 4e5 - run(vec![Box::new(threshold.clone())], &[(4e5, length_m)])[0].muscle_pressure_pa;
        assert!(at(0.22) > at(0.267) && at(0.267) > 0.0 && at(0.22) < 50e3);
    }
}
