//! Relaxation of the bladder: its rubber pulls more right after a stretch than after a while.
//!
//! ```text
//! F_v = Σ g_i (F_bl - q_i),   g_i ∝ τ_i^{-α},   Σ g_i = G
//! ```
//!
//! | symbol | code        | unit | meaning                                        |
//! |--------|-------------|------|------------------------------------------------|
//! | `F_bl` | `bladder_n` | N    | elastic force of the bladder                   |
//! | `G`    | `share`     | 1    | share of a sudden force that relaxes           |
//! | `α`    | `order`     | 1    | order of the fractional element                |
//! | `τ_i`  |             | s    | 0.03 to 3000 s, three for each decade          |
//!
//! Relaxation of a fractional solid goes as `t^{-α}`; the ladder of times is its spectrum. Driven by the length
//! alone: a pressure step at a held length leaves it.
//!
//! Source: Bagley and Torvik (1983), J. Rheology 27(3), for fractional solids.

use crate::draw::Draw;
use crate::mechanism::spectrum::Spectrum;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Overstress of the bladder.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Viscoelastic {
    overstress: Spectrum,
}

impl Viscoelastic {
    pub(crate) fn new(share: f64, order: f64) -> Self {
        let spectrum = Spectrum::new(0.03, 3000.0, |time_s| time_s.powf(-order));
        Self { overstress: spectrum.with_sum(share) }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let share = draw.severe("relaxing_share", 0.25, 0.45, "1");
        let order = draw.even("order", 0.05, 0.2, "1");
        draw.at("time_since_last_move", 0.0, 60.0, "s");
        Self::new(share, order)
    }
}

impl Mechanism for Viscoelastic {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        now.tension.beside_n += self.overstress.follow(now.tension.bladder_n, now.step_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go, work_j};

    #[test]
    fn a_step_of_length_relaxes_in_the_hold_and_keeps_its_sign() {
        let mut path = vec![(3e5, 0.267)];
        go(&mut path, 3e5, 0.24, 200);
        go(&mut path, 3e5, 0.24, 10_000);
        let moments = drive(Viscoelastic::new(0.3, 0.1), &path);
        let at = |index: usize| moments[index].tension.beside_n;
        // The bladder resists the contraction, at first more than later.
        assert!(at(200) < at(1000) && at(1000) < at(10_000) && at(10_000) < 0.0);
        // Still a third is left after ten seconds: no single time constant.
        assert!(at(10_000) / at(200) > 0.3);
    }

    #[test]
    fn a_step_of_pressure_leaves_it() {
        let mut path = vec![(1e5, 0.25)];
        go(&mut path, 4e5, 0.25, 100);
        assert!(drive(Viscoelastic::new(0.3, 0.1), &path).iter().all(|now| now.tension.beside_n == 0.0));
    }

    #[test]
    fn a_cycle_dissipates() {
        let mut path = vec![(3e5, 0.255)];
        for _ in 0..4 {
            go(&mut path, 3e5, 0.245, 500);
            go(&mut path, 3e5, 0.255, 500);
        }
        let moments = drive(Viscoelastic::new(0.3, 0.1), &path);
        assert!(work_j(&moments[3000..], |now| now.tension.beside_n) > 0.0);
    }
}
