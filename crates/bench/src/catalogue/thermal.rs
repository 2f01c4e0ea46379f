//! The bladder warms by what is lost in it and gets softer.
//!
//! ```text
//! C dT/dt = F_f |v_b| + ψ |F_bl v| - T / R,   F_bl → F_bl (1 - s T)
//! ```
//!
//! | symbol | code              | unit | meaning                                               |
//! |--------|-------------------|------|-------------------------------------------------------|
//! | `T`    | `warming_k`       | K    | temperature above that of the room                    |
//! | `C`    | `capacity_j_per_k`| J/K  | heat that a kelvin takes                              |
//! | `R`    | `resistance_k_per_w` | K/W | temperature that a watt keeps up                    |
//! | `F_f`  | `friction_n`      | N    | friction of the braid, `v_b` the speed of its travel  |
//! | `ψ`    | `loss`            | 1    | share of the rubber's power that turns into heat      |
//! | `s`    | `per_kelvin`      | 1/K  | softening                                             |
//!
//! Source: lumped heat balance; the signs and orders are those reported for pneumatic muscles in long operation.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Softening largest at all.
const MOST: f64 = 0.9;

/// Warming by losses.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Thermal {
    capacity_j_per_k: f64,
    resistance_k_per_w: f64,
    loss: f64,
    per_kelvin: f64,
    warming_k: f64,
}

impl Thermal {
    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        // Heat capacity goes with the amount of rubber, as force times length does.
        let scale = draw.force_scale() * draw.length_scale();
        Self {
            capacity_j_per_k: draw.ratio("heat_capacity", 25.0 * scale, 45.0 * scale, "J/K"),
            resistance_k_per_w: draw.ratio("thermal_resistance", 8.0 / scale, 16.0 / scale, "K/W"),
            loss: draw.even("loss_of_rubber", 0.2, 0.4, "1"),
            per_kelvin: draw.severe("softening_per_kelvin", 0.01, 0.018, "1/K"),
            warming_k: 0.0,
        }
    }
}

impl Mechanism for Thermal {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        if now.step_s > 0.0 {
            let friction_w = now.tension.friction_n.abs() * now.braid_speed_m_per_s();
            let rubber_w = self.loss * (now.tension.bladder_n * now.shortening_speed_m_per_s()).abs();
            let settled_k = (friction_w + rubber_w) * self.resistance_k_per_w;
            let time_s = self.capacity_j_per_k * self.resistance_k_per_w;
            self.warming_k += (settled_k - self.warming_k) * -(-now.step_s / time_s).exp_m1();
        }
        now.tension.bladder_n *= 1.0 - (self.per_kelvin * self.warming_k).min(MOST);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go};

    const BLADDER: Thermal =
        Thermal { capacity_j_per_k: 2.0, resistance_k_per_w: 10.0, loss: 0.3, per_kelvin: 0.01, warming_k: 0.0 };

    fn softening(now: &Moment) -> f64 {
        1.0 - now.tension.bladder_n / TrueMuscle::nominal().passive_tension(0.0, now.muscle_length_m).bladder_n
    }

    #[test]
    fn cycles_warm_it_and_a_rest_cools_it_with_its_time_constant() {
        let mut path = vec![(4e5, 0.25)];
        for _ in 0..20 {
            go(&mut path, 4e5, 0.23, 500);
            go(&mut path, 4e5, 0.25, 500);
        }
        let cycled = path.len() - 1;
        go(&mut path, 4e5, 0.25, 20_000);
        let moments = drive(BLADDER, &path);
        assert!(softening(&moments[cycled]) > softening(&moments[cycled / 4]) && softening(&moments[cycled / 4]) > 0.0);
        let left = softening(&moments[cycled + 20_000]) / softening(&moments[cycled]);
        assert!((left - (-1.0_f64).exp()).abs() < 1e-3, "{left}");
    }

    #[test]
    fn what_stands_still_stays_cold() {
        let moments = drive(BLADDER, &[(4e5, 0.23); 100]);
        assert!(softening(&moments[99]).abs() < 1e-12);
    }
}
