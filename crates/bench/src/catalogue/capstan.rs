//! A cable around a guide between muscle and load cell: friction that grows with the load.
//!
//! ```text
//! F_cell = F e^{-μΘ s}
//! ```
//!
//! | symbol | code        | unit | meaning                                         |
//! |--------|-------------|------|-------------------------------------------------|
//! | `μΘ`   | `wrap`      | 1    | friction of the cable times the angle it wraps  |
//! | `s`    | `direction` | 1    | +1 contracting, -1 extending                    |
//!
//! A slack cable rubs on nothing.
//!
//! Sources: Euler (1769), "Remarques sur l'effet du frottement dans l'équilibre"; Kaneko, Yamashita and Tanie
//! (1991), Proc. ICAR, for tendons in sheaths.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Friction in proportion to the tension.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Capstan {
    wrap: f64,
}

impl Capstan {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        Self { wrap: draw.severe("friction_times_angle", 0.025, 0.05, "1") }
    }
}

impl Mechanism for Capstan {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let tension_n = now.tension.total_n();
        if tension_n > 0.0 {
            now.tension.beside_n += tension_n * (-self.wrap * now.direction).exp_m1();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go};

    #[test]
    fn the_ratio_of_the_branches_is_the_same_at_any_tension() {
        for pressure_pa in [1e5, 4e5] {
            let mut path = vec![(pressure_pa, 0.26)];
            go(&mut path, pressure_pa, 0.24, 100);
            go(&mut path, pressure_pa, 0.26, 100);
            let moments = drive(Capstan { wrap: 0.04 }, &path);
            let muscle = TrueMuscle::nominal();
            let ratio = |index: usize, direction: f64| {
                moments[index].tension.total_n()
                    / muscle.force_n(pressure_pa, moments[index].muscle_length_m, direction)
            };
            assert!((ratio(150, -1.0) / ratio(50, 1.0) - 0.08_f64.exp()).abs() < 1e-9);
        }
    }

    #[test]
    fn a_slack_cable_rubs_on_nothing() {
        let moments = drive(Capstan { wrap: 0.04 }, &[(0.0, 0.24), (0.0, 0.239)]);
        assert!(moments[1].tension.total_n() < 0.0 && moments[1].tension.beside_n == 0.0);
    }
}
