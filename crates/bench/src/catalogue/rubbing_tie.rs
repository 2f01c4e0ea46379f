//! A tie around the muscle rubs over part of the stroke.
//!
//! ```text
//! F_t = W(ε) (F_r z + k (ε - ε_a) L₀),   dz/dx = (s - z) / δ
//! W   = smoothstep from 0 to 1 over the edges of [ε_a, ε_b], 0 outside
//! ```
//!
//! | symbol     | code           | unit | meaning                                        |
//! |------------|----------------|------|------------------------------------------------|
//! | `ε_a, ε_b` | `from`, `to`   | 1    | contraction over which it rubs                 |
//! | `F_r`      | `friction_n`   | N    | its friction, whatever the pressure            |
//! | `z`        | `deflection`   | 1    | the tie gives way before it slides, over `δ`   |
//! | `k`        | `stiffness_n_per_m` | N/m | it is also pulled along a little           |
//!
//! Source: none; dry friction of a strap.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Width of an edge over that of the window.
const EDGE: f64 = 0.15;

/// Dry friction inside a window of contraction.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RubbingTie {
    from: f64,
    to: f64,
    friction_n: f64,
    give_m: f64,
    stiffness_n_per_m: f64,
    deflection: f64,
}

impl RubbingTie {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let (force, length, reached) = (draw.force_scale(), draw.length_scale(), draw.reached_contraction());
        let width = draw.even("width", 0.22 * reached, 0.35 * reached, "1");
        let from = draw.even("from_contraction", 0.15 * reached, 0.8 * reached - width, "1");
        draw.at("contraction", from, from + width, "1");
        Self {
            from,
            to: from + width,
            friction_n: draw.severe("friction", 5.0 * force, 9.0 * force, "N"),
            give_m: draw.ratio("give", 0.2e-3 * length, 0.6e-3 * length, "m"),
            stiffness_n_per_m: draw.severe("stiffness", 60.0 * force / length, 150.0 * force / length, "N/m"),
            deflection: 0.0,
        }
    }

    fn window(&self, contraction_ratio: f64) -> f64 {
        let edge = EDGE * (self.to - self.from);
        let inside = (contraction_ratio - self.from).min(self.to - contraction_ratio) / edge;
        let share = inside.clamp(0.0, 1.0);
        share * share * (3.0 - 2.0 * share)
    }
}

impl Mechanism for RubbingTie {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        if now.shortening_m != 0.0 {
            let sliding = now.shortening_m.signum();
            self.deflection = sliding + (self.deflection - sliding) * (-now.shortening_m.abs() / self.give_m).exp();
        }
        let contraction_ratio = muscle.muscle().contraction_ratio(now.muscle_length_m);
        let window = self.window(contraction_ratio);
        let pulled_m = (contraction_ratio - self.from) * muscle.muscle().rest_length_m;
        now.tension.beside_n -= window * (self.friction_n * self.deflection + self.stiffness_n_per_m * pulled_m);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go, work_j};

    fn tie() -> RubbingTie {
        RubbingTie { from: 0.06, to: 0.12, friction_n: 6.0, give_m: 0.3e-3, stiffness_n_per_m: 100.0, deflection: 0.0 }
    }

    fn stroke(pressure_pa: f64) -> Vec<Moment> {
        let mut path = vec![(pressure_pa, 0.267)];
        for _ in 0..2 {
            go(&mut path, pressure_pa, 0.217, 1000);
            go(&mut path, pressure_pa, 0.267, 1000);
        }
        drive(tie(), &path)
    }

    #[test]
    fn it_rubs_inside_its_window_only_and_alike_at_any_pressure() {
        let (low, high) = (stroke(0.0), stroke(4e5));
        for (low, high) in low.iter().zip(&high) {
            assert!((low.tension.beside_n - high.tension.beside_n).abs() < 1e-12);
            let contraction_ratio = 1.0 - low.muscle_length_m / 0.267;
            if !(0.06..0.12).contains(&contraction_ratio) {
                assert!(low.tension.beside_n.abs() < 1e-9);
            }
        }
        // Middle of the window on the way in and on the way out.
        let difference_n = high[1000 + 519].tension.beside_n - high[481].tension.beside_n;
        assert!((difference_n - 12.0).abs() < 0.05, "{difference_n}");
    }

    #[test]
    fn a_stroke_dissipates_friction_times_way() {
        let moments = stroke(3e5);
        let work_j = work_j(&moments[2000..], |now| now.tension.beside_n);
        // Twice 6 N over 16 mm, less the edges.
        assert!((0.12..0.2).contains(&work_j), "{work_j}");
    }
}
