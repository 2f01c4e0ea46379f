//! Damping of the muscle, more under pressure and less while extending.
//!
//! ```text
//! F_v = (c₀ + c₁ p) v      contracting
//! F_v = ρ (c₀ + c₁ p) v    extending
//! ```
//!
//! | symbol | code             | unit       | meaning                             |
//! |--------|------------------|------------|-------------------------------------|
//! | `c₀`   | `vented_n_s_per_m` | N s/m    | damping without pressure            |
//! | `c₁`   | `per_pascal`     | N s/(m Pa) | what pressure adds                  |
//! | `ρ`    | `extending`      | 1          | extending over contracting          |
//! | `v`    | `-dL/dt`         | m/s        | speed of shortening                 |
//!
//! Source: Reynolds, Repperger, Phillips and Bandry (2003), Annals of Biomedical Engineering 31(3), where damping
//! depends on pressure and is smaller during relaxation than during contraction.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Resistance in proportion to speed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Viscous {
    vented_n_s_per_m: f64,
    per_pascal: f64,
    extending: f64,
}

impl Viscous {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        // The faster a long muscle is driven, the less of its damping a speed asks for.
        let scale = draw.force_scale() / draw.length_scale();
        Self {
            vented_n_s_per_m: draw.severe("vented_damping", 40.0 * scale, 90.0 * scale, "N s/m"),
            per_pascal: draw.severe("damping_per_pressure", 2e-4 * scale, 5e-4 * scale, "N s/(m Pa)"),
            extending: draw.even("extending_share", 0.6, 0.9, "1"),
        }
    }
}

impl Mechanism for Viscous {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let speed_m_per_s = now.shortening_speed_m_per_s();
        let share = if speed_m_per_s < 0.0 { self.extending } else { 1.0 };
        let damping_n_s_per_m = self.vented_n_s_per_m + self.per_pascal * now.muscle_pressure_pa;
        now.tension.beside_n -= share * damping_n_s_per_m * speed_m_per_s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go, work_j};

    const DAMPER: Viscous = Viscous { vented_n_s_per_m: 60.0, per_pascal: 3e-4, extending: 0.7 };

    #[test]
    fn force_is_proportional_to_speed_and_vanishes_at_rest_and_at_a_held_length() {
        let mut path = vec![(2e5, 0.26)];
        go(&mut path, 2e5, 0.25, 1000);
        go(&mut path, 2e5, 0.25, 10);
        go(&mut path, 4e5, 0.25, 10);
        go(&mut path, 4e5, 0.24, 500);
        let moments = drive(DAMPER, &path);
        // 10 mm/s at 200 kPa, 20 mm/s at 400 kPa.
        assert!((moments[500].tension.beside_n + 1.2).abs() < 1e-9);
        assert!(moments[1001..1021].iter().all(|now| now.tension.beside_n == 0.0));
        assert!((moments[1300].tension.beside_n + 3.6).abs() < 1e-9);
    }

    #[test]
    fn extending_is_damped_less_and_a_cycle_dissipates() {
        let mut path = vec![(2e5, 0.26)];
        go(&mut path, 2e5, 0.25, 1000);
        go(&mut path, 2e5, 0.26, 1000);
        let moments = drive(DAMPER, &path);
        assert!((moments[1500].tension.beside_n - 0.7 * 1.2).abs() < 1e-9);
        assert!(work_j(&moments, |now| now.tension.beside_n) > 0.0);
    }
}
