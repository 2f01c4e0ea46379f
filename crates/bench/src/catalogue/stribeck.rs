//! Breakaway and falling friction at low speed, after Stribeck.
//!
//! ```text
//! F_f = F_c h,   dh/dx = (g(v) - h) / δ,   g(v) = 1 + (μ - 1) exp(-(v / v_s)²)
//! h  ←  h + (μ - h) (1 - exp(-t / t_a))    at the end of a rest of t
//! ```
//!
//! | symbol | code        | unit | meaning                                             |
//! |--------|-------------|------|-----------------------------------------------------|
//! | `F_c`  | `friction_n`| N    | friction of the braid as found                      |
//! | `h`    | `level`     | 1    | level of friction over that at high speed           |
//! | `μ`    | `1 + excess`| 1    | friction at rest over friction at high speed        |
//! | `v_s`  | `speed_m_per_s` | m/s | speed at which the excess has fallen to `1/e`    |
//! | `δ`    | `renewal_m` | m    | travel over which contacts are renewed              |
//! | `t_a`  | `aging_s`   | s    | time in which contacts at rest grow                 |
//!
//! The level follows the speed with the travel that renews the contacts, stays while nothing moves, and begins anew
//! from what a rest has made of it: a breakaway that grows with the rest before it.
//!
//! Sources: Stribeck (1902), Zeitschrift VDI 46; Tondu and Lopez (2000), IEEE Control Systems Magazine 20(2), for
//! the braid; Armstrong-Hélouvry, Dupont and Canudas de Wit (1994), Automatica 30(7), for frictional memory and
//! rising static friction.

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Speed below which the braid is at rest.
const REST_M_PER_S: f64 = 1e-6;

/// Friction that falls as the braid gets faster.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stribeck {
    excess: f64,
    speed_m_per_s: f64,
    renewal_m: f64,
    aging_s: f64,
    level: f64,
    rest_s: f64,
}

impl Stribeck {
    pub(crate) fn new(excess: f64, speed_m_per_s: f64, renewal_m: f64, aging_s: f64) -> Self {
        Self { excess, speed_m_per_s, renewal_m, aging_s, level: 1.0 + excess, rest_s: 0.0 }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let length = draw.length_scale();
        let excess = draw.severe("static_excess", 0.3, 0.55, "1");
        let speed_m_per_s = draw.ratio("stribeck_speed", 2e-3 * length, 10e-3 * length, "m/s");
        let renewal_m = draw.ratio("renewal_distance", 0.05e-3 * length, 0.15e-3 * length, "m");
        let aging_s = draw.ratio("aging_time", 1.0, 10.0, "s");
        draw.at("speed", 0.0, 1.5 * speed_m_per_s, "m/s");
        Self::new(excess, speed_m_per_s, renewal_m, aging_s)
    }
}

impl Mechanism for Stribeck {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let speed_m_per_s = now.braid_speed_m_per_s();
        if speed_m_per_s < REST_M_PER_S {
            self.rest_s += now.step_s;
        } else {
            if self.rest_s > 0.0 {
                let grown = -(-self.rest_s / self.aging_s).exp_m1();
                self.level += (1.0 + self.excess - self.level) * grown;
                self.rest_s = 0.0;
            }
            let settled = 1.0 + self.excess * (-(speed_m_per_s / self.speed_m_per_s).powi(2)).exp();
            let renewed = -(-now.braid_travel_m.abs() / self.renewal_m).exp_m1();
            self.level += (settled - self.level) * renewed;
        }
        now.tension.friction_n *= self.level;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::moment::rig::{drive, go};

    fn factor(now: &Moment) -> f64 {
        let plain_n = TrueMuscle::nominal().friction_n(now.muscle_pressure_pa, now.muscle_length_m);
        now.tension.friction_n.abs() / plain_n
    }

    /// Level after ten millimeters at a speed.
    fn level_at(speed_mm_per_s: f64) -> f64 {
        let mut path = vec![(3e5, 0.26)];
        go(&mut path, 3e5, 0.25, (10.0 / speed_mm_per_s * 1e3) as usize);
        factor(drive(Stribeck::new(0.5, 5e-3, 1e-4, 3.0), &path).last().unwrap())
    }

    #[test]
    fn friction_falls_with_speed_from_static_to_kinetic() {
        assert!((level_at(0.1) - 1.5).abs() < 1e-3);
        assert!((level_at(5.0) - (1.0 + 0.5 * (-1.0_f64).exp())).abs() < 1e-6);
        assert!((level_at(50.0) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn a_longer_rest_makes_a_higher_breakaway_and_the_rest_itself_changes_nothing() {
        let breakaway = |rest: usize| {
            let mut path = vec![(3e5, 0.26)];
            go(&mut path, 3e5, 0.25, 200);
            go(&mut path, 3e5, 0.25, rest);
            go(&mut path, 3e5, 0.249, 200);
            let moments = drive(Stribeck::new(0.5, 5e-3, 1e-4, 3.0), &path);
            assert_eq!(moments[201].tension.friction_n, moments[200 + rest].tension.friction_n);
            factor(&moments[200 + rest + 1])
        };
        assert!(breakaway(10_000) > breakaway(1_000) && breakaway(1_000) > breakaway(10));
    }

    #[test]
    fn without_excess_friction_is_as_it_was() {
        let mut path = vec![(3e5, 0.26)];
        go(&mut path, 3e5, 0.25, 100);
        assert!(drive(Stribeck::new(0.0, 5e-3, 1e-4, 3.0), &path).iter().all(|now| factor(now) == 1.0));
    }
}
