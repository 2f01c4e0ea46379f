//! Hysteresis of the rubber, after Bouc and Wen.
//!
//! ```text
//! F_h = W z,   dz/dx = [1 - |z|ⁿ (γ + β sgn(z dx))] / δ,   β + γ = 1
//! ```
//!
//! | symbol | code         | unit | meaning                                                |
//! |--------|--------------|------|--------------------------------------------------------|
//! | `W`    | `width_n`    | N    | half the width of a large loop, whatever the pressure  |
//! | `z`    | `memory`     | 1    | between -1 and 1                                       |
//! | `x`    | `-L`         | m    | shortening                                             |
//! | `δ`    | `distance_m` | m    | distance over which `z` turns                          |
//! | `n`    | `sharpness`  | 1    | sharpness of the knee                                  |
//! | `β`    | `1 - gamma`  | 1    | share of the softening that depends on direction       |
//!
//! The rubber of a bladder rubs inside itself; its loop depends on the path and not on the rate. It resists: less
//! tension while contracting. Driven by the length alone, so that a pressure at a held length leaves it.
//!
//! Sources: Bouc (1967), Proc. 4th Conf. on Nonlinear Oscillations; Wen (1976), J. Engineering Mechanics Division
//! 102(2).

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Largest share of `δ` that is stepped at once.
const STEP: f64 = 0.05;

/// Distance, in `δ`, after which everything earlier is forgotten.
const FORGOTTEN: f64 = 60.0;

/// Rate-independent hysteresis on the length.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BoucWen {
    width_n: f64,
    distance_m: f64,
    sharpness: f64,
    gamma: f64,
    memory: f64,
}

impl BoucWen {
    pub(crate) fn new(width_n: f64, distance_m: f64, sharpness: f64, gamma: f64) -> Self {
        Self { width_n, distance_m, sharpness, gamma, memory: 0.0 }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let (force, length) = (draw.force_scale(), draw.length_scale());
        let width_n = draw.severe("half_width", 4.0 * force, 7.0 * force, "N");
        let distance_m = draw.ratio("turning_distance", 1e-3 * length, 4e-3 * length, "m");
        let sharpness = draw.even("sharpness", 1.0, 1.8, "1");
        let gamma = draw.even("gamma", 0.2, 0.45, "1");
        Self::new(width_n, distance_m, sharpness, gamma)
    }

    /// Slope of the memory, per `δ` of travel in direction `sign`.
    fn slope(&self, memory: f64, sign: f64) -> f64 {
        let softening = self.gamma + (1.0 - self.gamma) * (memory * sign).signum();
        sign * (1.0 - memory.abs().powf(self.sharpness) * softening)
    }

    /// Moves on by a shortening, in midpoint steps.
    fn follow(&mut self, shortening_m: f64) {
        let travel = shortening_m.abs() / self.distance_m;
        let sign = shortening_m.signum();
        if travel > FORGOTTEN {
            self.memory = sign;
            return;
        }
        let steps = (travel / STEP).ceil();
        let step = travel / steps;
        for _ in 0..steps as usize {
            let middle = self.memory + 0.5 * step * self.slope(self.memory, sign);
            self.memory = (self.memory + step * self.slope(middle, sign)).clamp(-1.0, 1.0);
        }
    }
}

impl Mechanism for BoucWen {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        if now.shortening_m != 0.0 {
            self.follow(now.shortening_m);
        }
        now.tension.beside_n -= self.width_n * self.memory;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go, work_j};

    fn rubber() -> BoucWen {
        BoucWen::new(5.0, 2e-3, 1.4, 0.3)
    }

    fn loops(pressure_pa: f64) -> Vec<(f64, f64)> {
        let mut path = vec![(pressure_pa, 0.25)];
        for _ in 0..2 {
            go(&mut path, pressure_pa, 0.23, 2000);
            go(&mut path, pressure_pa, 0.25, 2000);
        }
        path
    }

    #[test]
    fn a_large_loop_is_as_wide_as_stated_at_any_pressure_and_dissipates() {
        for pressure_pa in [0.0, 4e5] {
            let moments = drive(rubber(), &loops(pressure_pa));
            assert!((moments[2000].tension.beside_n + 5.0).abs() < 0.05);
            assert!((moments[4000].tension.beside_n - 5.0).abs() < 0.05);
            assert!(work_j(&moments[4000..], |now| now.tension.beside_n) > 0.0);
        }
    }

    #[test]
    fn the_second_loop_retraces_the_first() {
        let moments = drive(rubber(), &loops(2e5));
        assert!((moments[8000].tension.beside_n - moments[4000].tension.beside_n).abs() < 1e-3);
    }

    #[test]
    fn pressure_at_a_held_length_leaves_it_and_so_does_a_hold() {
        let mut path = vec![(1e5, 0.25)];
        go(&mut path, 1e5, 0.245, 100);
        go(&mut path, 4e5, 0.245, 100);
        let moments = drive(rubber(), &path);
        assert_eq!(moments[100].tension.beside_n, moments[200].tension.beside_n);
    }

    #[test]
    fn a_turn_is_the_same_in_one_step_and_in_many() {
        let (mut one, mut many) = (rubber(), rubber());
        one.follow(3e-3);
        (0..100).for_each(|_| many.follow(3e-5));
        assert!((one.memory - many.memory).abs() < 1e-3, "{} {}", one.memory, many.memory);
    }
}
