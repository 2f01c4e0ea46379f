//! Wear: the gas force fades with the way that the braid has gone.
//!
//! ```text
//! F_gas → F_gas [1 - d (N / N_ref)^γ],   N = ∫ |dx| / (2 x_stroke)
//! ```
//!
//! | symbol     | code       | unit | meaning                                                 |
//! |------------|------------|------|---------------------------------------------------------|
//! | `N`        | `cycles`   | 1    | travel of the braid, counted in full strokes and back   |
//! | `x_stroke` | `stroke_m` | m    | full stroke of the protocols                            |
//! | `d`        | `loss`     | 1    | share of the force lost after `N_ref` = 100 cycles      |
//! | `γ`        | `exponent` | 1    | below one: much at first, then less                     |
//!
//! A rest brings nothing back.
//!
//! Source: Durante (2021) on fatigue of pneumatic muscles, for a loss that goes on with cycles; the power law is
//! the usual one of wear.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Cycles after which the loss is stated.
const REFERENCE_CYCLES: f64 = 100.0;

/// Largest loss.
const MOST: f64 = 0.9;

/// Loss of gas force with travel.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wear {
    loss: f64,
    exponent: f64,
    stroke_m: f64,
    travel_m: f64,
}

impl Wear {
    pub(crate) fn new(loss: f64, exponent: f64, stroke_m: f64) -> Self {
        Self { loss, exponent, stroke_m, travel_m: 0.0 }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let stroke_m = draw.reached_contraction() * draw.muscle.muscle().rest_length_m;
        let loss = draw.severe("loss_after_100_cycles", 0.02, 0.04, "1");
        let exponent = draw.even("exponent", 0.45, 0.9, "1");
        Self::new(loss, exponent, stroke_m)
    }
}

impl Mechanism for Wear {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        self.travel_m += now.braid_travel_m.abs();
        let cycles = self.travel_m / (2.0 * self.stroke_m);
        let lost = self.loss * (cycles / REFERENCE_CYCLES).powf(self.exponent);
        now.tension.gas_n *= 1.0 - lost.min(MOST);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go};

    fn loss(now: &Moment) -> f64 {
        1.0 - now.tension.gas_n
            / TrueMuscle::nominal().passive_tension(now.muscle_pressure_pa, now.muscle_length_m).gas_n
    }

    #[test]
    fn a_power_of_the_cycles_is_lost_for_good_and_in_proportion_to_the_gas_force() {
        let mut path = vec![(3e5, 0.25)];
        for _ in 0..100 {
            go(&mut path, 3e5, 0.23, 10);
            go(&mut path, 3e5, 0.25, 10);
        }
        go(&mut path, 3e5, 0.25, 1000);
        let moments = drive(Wear::new(0.05, 0.5, 0.02), &path);
        assert!((loss(&moments[2000]) - 0.05).abs() < 1e-9);
        assert!((loss(&moments[500]) - 0.025).abs() < 1e-9);
        assert!((loss(&moments[3000]) - 0.05).abs() < 1e-9);
    }
}
