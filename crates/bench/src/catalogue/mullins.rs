//! Softening of rubber that has been deformed before, after Ogden and Roxburgh.
//!
//! ```text
//! F_bl → η F_bl,   η = 1 - (1/r) erf[(W_m - W) / (m + β W_m)]
//! ```
//!
//! | symbol | code                 | unit | meaning                                              |
//! |--------|----------------------|------|------------------------------------------------------|
//! | `W`    | `bladder_energy_j()` | J    | energy stored in the bladder                         |
//! | `W_m`  | `highest_j`          | J    | the highest that it has been                         |
//! | `1/r`  | `loss`               | 1    | share of the force that can be lost                  |
//! | `m`    | `scale_j`            | J    | energy over which the softening sets in              |
//! | `β`    | `growth`             | 1    | how that grows with `W_m`                            |
//!
//! The bladder is virgin at the start of a recording: on its first way up it pulls in full, on every way within
//! what it has seen it pulls less, and no rest brings it back.
//!
//! Source: Ogden and Roxburgh (1999), "A pseudo-elastic model for the Mullins effect in filled rubber", Proc. Royal
//! Society A 455.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Largest share of the bladder's force that can be lost.
const MOST: f64 = 0.95;

/// Softening below the highest energy so far.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Mullins {
    loss: f64,
    scale_j: f64,
    growth: f64,
    highest_j: f64,
}

impl Mullins {
    pub(crate) fn new(loss: f64, scale_j: f64, growth: f64) -> Self {
        Self { loss: loss.min(MOST), scale_j, growth, highest_j: 0.0 }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let shortest_m = draw.muscle.muscle().length_m(draw.reached_contraction());
        let reached_j = draw.muscle.bladder_energy_j(shortest_m);
        let loss = draw.severe("softening", 0.2, 0.4, "1");
        let scale_j = draw.ratio("onset_energy", 0.05 * reached_j, 0.2 * reached_j, "J");
        let growth = draw.even("growth", 0.05, 0.3, "1");
        Self::new(loss, scale_j, growth)
    }
}

impl Mechanism for Mullins {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        let energy_j = muscle.bladder_energy_j(now.muscle_length_m);
        self.highest_j = self.highest_j.max(energy_j);
        let below = (self.highest_j - energy_j) / (self.scale_j + self.growth * self.highest_j);
        now.tension.bladder_n *= 1.0 - self.loss * libm::erf(below);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go, work_j};

    fn staircase() -> Vec<(f64, f64)> {
        let mut path = vec![(3e5, 0.267)];
        for short_m in [0.25, 0.25, 0.23, 0.23] {
            go(&mut path, 3e5, short_m, 100);
            go(&mut path, 3e5, 0.267, 100);
        }
        path
    }

    fn eta(now: &Moment) -> f64 {
        now.tension.bladder_n / TrueMuscle::nominal().passive_tension(0.0, now.muscle_length_m).bladder_n
    }

    #[test]
    fn virgin_rubber_is_stiffer_and_a_larger_stroke_finds_it_again() {
        let moments = drive(Mullins::new(0.3, 0.1, 0.1), &staircase());
        // First way, second way at the same length, then beyond the first two strokes.
        assert_eq!(eta(&moments[50]), 1.0);
        assert!(eta(&moments[250]) < 0.95);
        assert_eq!(eta(&moments[490]), 1.0);
        assert!(eta(&moments[690]) < 1.0);
    }

    #[test]
    fn the_softened_path_is_the_same_again_and_again() {
        let moments = drive(Mullins::new(0.3, 0.1, 0.1), &staircase());
        assert!((eta(&moments[150]) - eta(&moments[250])).abs() < 1e-9);
        assert!((eta(&moments[250]) - eta(&moments[350])).abs() < 1e-9);
    }

    #[test]
    fn the_first_cycle_dissipates_and_the_second_does_not() {
        let moments = drive(Mullins::new(0.3, 0.1, 0.1), &staircase());
        assert!(work_j(&moments[..=200], |now| now.tension.bladder_n) > 1e-3);
        assert!(work_j(&moments[200..=400], |now| now.tension.bladder_n).abs() < 1e-9);
    }
}
