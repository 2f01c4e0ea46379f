//! Friction with memory of the braid, after LuGre.
//!
//! ```text
//! F_f = F_c(p, L) (z + τ ż),   ż = v / δ - |v| z / δ
//! ```
//!
//! | symbol | code              | unit | meaning                                             |
//! |--------|-------------------|------|-----------------------------------------------------|
//! | `F_c`  | `friction_n()`    | N    | friction while sliding                              |
//! | `z`    | `deflection`      | 1    | deflection of the bristles over that while sliding  |
//! | `δ`    | `presliding_m`    | m    | that deflection: distance over which friction turns |
//! | `τ`    | `damping_s`       | s    | damping of the bristles over their stiffness        |
//! | `v`    | travel over step  | m/s  | speed of the braid, positive contracting            |
//!
//! Bristles bend before they slide. After a reversal the friction turns within a few `δ` instead of at once; while
//! nothing moves it stays. The rate equation is stepped exactly for constant `v`. It forgets a small loop instead
//! of closing it, which sums of stick-slip elements do not.
//!
//! Source: Canudas de Wit, Olsson, Åström and Lischinsky (1995), "A new model for control of systems with
//! friction", IEEE Trans. Automatic Control 40(3).

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Friction that gives way before it slides, in place of the sign of the motion.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LuGre {
    presliding_m: f64,
    damping_s: f64,
    deflection: f64,
}

impl LuGre {
    pub(crate) fn new(presliding_m: f64, damping_s: f64) -> Self {
        // The muscle comes from being inflated.
        Self { presliding_m, damping_s, deflection: 1.0 }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let scale = draw.length_scale();
        let presliding_m = draw.severe("presliding_distance", 0.6e-3 * scale, 1.6e-3 * scale, "m");
        let damping_s = draw.severe("bristle_damping_time", 0.5e-3, 2e-3, "s");
        draw.at("travel_since_reversal", 0.0, 3.0 * presliding_m, "m");
        Self::new(presliding_m, damping_s)
    }
}

impl Mechanism for LuGre {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        let before = self.deflection;
        if now.braid_travel_m != 0.0 {
            let sliding = now.braid_travel_m.signum();
            let kept = (-now.braid_travel_m.abs() / self.presliding_m).exp();
            self.deflection = sliding + (before - sliding) * kept;
        }
        let rate_per_s = if now.step_s > 0.0 { (self.deflection - before) / now.step_s } else { 0.0 };
        let friction_n = muscle.friction_n(now.muscle_pressure_pa, now.muscle_length_m);
        now.tension.friction_n += friction_n * (self.deflection + self.damping_s * rate_per_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{go, run, work_j};
    use crate::mechanism::{BraidMotion, PassiveTension};

    const PRESLIDING_M: f64 = 1e-3;

    fn friction(path: &[(f64, f64)], presliding_m: f64) -> Vec<Moment> {
        let friction = LuGre::new(presliding_m, 0.0);
        run(vec![Box::new(BraidMotion::new()), Box::new(PassiveTension), Box::new(friction)], path)
    }

    fn out_and_back(steps: usize) -> Vec<(f64, f64)> {
        let mut path = vec![(3e5, 0.255)];
        go(&mut path, 3e5, 0.245, steps);
        go(&mut path, 3e5, 0.255, steps);
        path
    }

    #[test]
    fn friction_turns_within_a_few_presliding_distances_of_a_reversal() {
        let moments = friction(&out_and_back(1000), PRESLIDING_M);
        let share = |index: usize| {
            let now = &moments[index];
            now.tension.friction_n / TrueMuscle::nominal().friction_n(now.muscle_pressure_pa, now.muscle_length_m)
        };
        assert!((share(1000) - 1.0).abs() < 1e-4);
        // One distance after the reversal: 1 → -1 by 1 - 1/e.
        assert!((share(1100) - (2.0 * (-1.0_f64).exp() - 1.0)).abs() < 1e-4, "{}", share(1100));
        assert!((share(2000) + 1.0).abs() < 1e-3);
    }

    #[test]
    fn the_path_counts_and_not_its_rate() {
        let (slow, fast) = (friction(&out_and_back(4000), PRESLIDING_M), friction(&out_and_back(100), PRESLIDING_M));
        for index in 0..200 {
            let difference_n = slow[index * 40].tension.friction_n - fast[index].tension.friction_n;
            assert!(difference_n.abs() < 1e-9);
        }
    }

    #[test]
    fn no_distance_leaves_the_sign_of_the_motion() {
        for now in &friction(&out_and_back(100), 0.0)[1..] {
            let friction_n = now.direction * TrueMuscle::nominal().friction_n(3e5, now.muscle_length_m);
            assert!((now.tension.friction_n - friction_n).abs() < 1e-12);
        }
    }

    #[test]
    fn a_closed_cycle_dissipates_and_a_hold_keeps() {
        let mut path = out_and_back(1000);
        let cycle = path.len();
        go(&mut path, 3e5, 0.255, 500);
        let moments = friction(&path, PRESLIDING_M);
        let held_n = moments[cycle - 1].tension.friction_n;
        assert!(moments[cycle..].iter().all(|now| now.tension.friction_n == held_n));
        assert!(work_j(&moments, |now| -now.tension.friction_n) > 0.0);
    }
}
