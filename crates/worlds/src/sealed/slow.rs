//! Slow change of the muscle: heat and wear.

use crate::draw::Dice;
use crate::forms::{Built, Setting, size};
use crate::mechanism::{Mechanism, Moment};

/// Heat of friction in the braid and of losses in the wall: two nodes with a resistance between them.
#[derive(Debug)]
struct TwoNodes {
    braid_j_per_k: f64,
    wall_j_per_k: f64,
    between_k_per_w: f64,
    outside_k_per_w: f64,
    wall_per_k: f64,
    friction_per_k: f64,
    braid_k: f64,
    wall_k: f64,
}

/// Share of the bladder's work that turns to heat.
const RUBBER_LOSS: f64 = 0.15;

impl Mechanism for TwoNodes {
    fn bladder_factor(&mut self, now: &Moment) -> f64 {
        let speed = now.speed_m_per_s.abs();
        let across_w = (self.braid_k - self.wall_k) / self.between_k_per_w;
        let braid_w = now.sliding_n.abs() * speed - across_w - self.braid_k / self.outside_k_per_w;
        let wall_w = RUBBER_LOSS * now.bladder_n.abs() * speed + across_w;
        self.braid_k += braid_w * now.dt_s / self.braid_j_per_k;
        self.wall_k += wall_w * now.dt_s / self.wall_j_per_k;
        1.0 + self.wall_per_k * self.wall_k
    }

    fn friction_factor(&mut self, _now: &Moment) -> f64 {
        (1.0 + self.friction_per_k * self.braid_k).max(0.3)
    }
}

/// Self-heating of braid and wall apart, which softens the rubber by 0.2 to 0.8 % per kelvin.
pub fn thermal_two_nodes(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let (capacity_j_per_k, outside_k_per_w) = (size(1.0 - u, 12.0, 80.0), size(u, 5.0, 20.0));
    let share = dice.uniform(0.3, 0.6);
    let wall_per_k = -size(u, 0.002, 0.008);
    Built::one(TwoNodes {
        braid_j_per_k: share * capacity_j_per_k,
        wall_j_per_k: (1.0 - share) * capacity_j_per_k,
        between_k_per_w: dice.uniform(0.3, 2.0),
        outside_k_per_w,
        wall_per_k,
        friction_per_k: -dice.uniform(0.005, 0.010),
        braid_k: 0.0,
        wall_k: 0.0,
    })
    .with("capacity_j_per_k", capacity_j_per_k)
    .with("bladder_per_k", wall_per_k)
}

/// A muscle that is still warm from what it did before, and cools.
#[derive(Debug)]
struct Cooling {
    warmer_k: f64,
    constant_s: f64,
    bladder_per_k: f64,
    friction_per_k: f64,
    logged: bool,
    now_k: f64,
}

impl Mechanism for Cooling {
    fn bladder_factor(&mut self, now: &Moment) -> f64 {
        self.now_k = self.warmer_k * (-now.time_s / self.constant_s).exp();
        1.0 + self.bladder_per_k * self.now_k
    }

    fn friction_factor(&mut self, _now: &Moment) -> f64 {
        1.0 + self.friction_per_k * self.now_k
    }

    fn temperature_c(&self) -> Option<f64> {
        self.logged.then_some(22.0 + self.now_k)
    }
}

/// Cooling after a warm-up of 2 to 15 K (Newton's law), with the temperature logged or not.
pub fn thermal_cooling(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let warmer_k = size(u, 2.0, 15.0);
    let constant_s = (setting.total_s() * dice.uniform(0.25, 0.8)).clamp(100.0, 900.0);
    let bladder_per_k = -dice.uniform(0.003, 0.008);
    let friction_per_k = -dice.uniform(0.005, 0.010);
    let logged = dice.chance(0.4);
    Built::one(Cooling { warmer_k, constant_s, bladder_per_k, friction_per_k, logged, now_k: warmer_k })
        .with("warmer_k", warmer_k)
        .with("time_s", constant_s)
        .with("bladder_per_k", bladder_per_k)
}

/// A braid whose friction falls as it is run in.
#[derive(Debug)]
struct RunIn {
    loss: f64,
    scale_m: f64,
    travelled_m: f64,
}

impl Mechanism for RunIn {
    fn friction_factor(&mut self, now: &Moment) -> f64 {
        self.travelled_m += now.speed_m_per_s.abs() * now.dt_s;
        1.0 + self.loss * (-self.travelled_m / self.scale_m).exp_m1()
    }
}

/// Wear of the friction while a new braid is run in: down by 5 to 35 %.
pub fn wear_run_in(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (loss, scale_m) = (size(u, 0.05, 0.35), setting.travel_m.max(0.01) * dice.uniform(0.2, 0.5));
    Built::one(RunIn { loss, scale_m, travelled_m: 0.0 }).with("friction_loss", loss).with("travel_m", scale_m)
}

/// Damage of the pull that adds up over half cycles of force, each by a power of its range.
#[derive(Debug)]
struct Miner {
    loss: f64,
    exponent: f64,
    range_n: f64,
    /// Half cycles of the whole range that make up the damage.
    half_cycles: f64,
    turn_n: Option<f64>,
    last_turn_n: f64,
    rising: bool,
    damage: f64,
}

/// Share of the range by which a force must turn back to end a half cycle.
const TURN: f64 = 0.05;

impl Mechanism for Miner {
    fn gas_factor(&mut self, now: &Moment) -> f64 {
        let force_n = now.force_n;
        let turn_n = self.turn_n.get_or_insert(force_n);
        let further = if self.rising { force_n > *turn_n } else { force_n < *turn_n };
        if further {
            *turn_n = force_n;
        } else if (force_n - *turn_n).abs() > TURN * self.range_n {
            let half_cycle = (*turn_n - self.last_turn_n).abs() / self.range_n;
            self.damage += half_cycle.powf(self.exponent) / self.half_cycles;
            (self.last_turn_n, self.rising) = (*turn_n, !self.rising);
            *turn_n = force_n;
        }
        1.0 - self.loss * self.damage.min(3.0)
    }
}

/// Wear of the pull by half cycles of force (Basquin 1910; Palmgren 1924 and Miner 1945), 1 to 5 % over the plan.
pub fn wear_miner(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let loss = size(u, 0.01, 0.05);
    let exponent = dice.uniform(1.5, 4.0);
    let range_n = (setting.forces_n.1 - setting.forces_n.0).max(20.0);
    let stroke_m = (setting.contractions.1 - setting.contractions.0) * setting.muscle.rest_length_m;
    let half_cycles = (0.4 * setting.travel_m / stroke_m.max(1e-3)).max(4.0);
    let miner =
        Miner { loss, exponent, range_n, half_cycles, turn_n: None, last_turn_n: 0.0, rising: true, damage: 0.0 };
    Built::one(miner).with("loss", loss).with("exponent", exponent).with("half_cycles", half_cycles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heat_of_two_nodes_is_kept_until_it_leaves() {
        let mut nodes = TwoNodes {
            braid_j_per_k: 10.0,
            wall_j_per_k: 20.0,
            between_k_per_w: 1.0,
            outside_k_per_w: 1e9,
            wall_per_k: -0.005,
            friction_per_k: -0.008,
            braid_k: 0.0,
            wall_k: 0.0,
        };
        let now = Moment { sliding_n: 20.0, speed_m_per_s: 0.05, dt_s: 1e-2, ..Moment::default() };
        for _ in 0..10_000 {
            nodes.bladder_factor(&now);
        }
        let stored_j = nodes.braid_k * 10.0 + nodes.wall_k * 20.0;
        assert!((stored_j - 100.0).abs() < 1e-6, "{stored_j}");
        assert!(nodes.braid_k > nodes.wall_k);
    }

    #[test]
    fn what_cools_ends_as_it_would_be_cold() {
        let mut muscle = Cooling {
            warmer_k: 10.0,
            constant_s: 100.0,
            bladder_per_k: -0.005,
            friction_per_k: -0.01,
            logged: true,
            now_k: 10.0,
        };
        assert!((muscle.bladder_factor(&Moment::default()) - 0.95).abs() < 1e-9);
        assert!((muscle.bladder_factor(&Moment { time_s: 2000.0, ..Moment::default() }) - 1.0).abs() < 1e-6);
        assert!((muscle.temperature_c().unwrap_or(0.0) - 22.0).abs() < 1e-3);
    }

    #[test]
    fn large_half_cycles_do_more_damage_than_small_ones() {
        let damage = |swing_n: f64, cycles: usize| {
            let mut miner = Miner {
                loss: 0.05,
                exponent: 3.0,
                range_n: 100.0,
                half_cycles: 20.0,
                turn_n: None,
                last_turn_n: 0.0,
                rising: true,
                damage: 0.0,
            };
            for _ in 0..cycles {
                for force_n in [0.0, 0.5 * swing_n, swing_n, 0.5 * swing_n] {
                    miner.gas_factor(&Moment { force_n, ..Moment::default() });
                }
            }
            miner.damage
        };
        assert!((damage(100.0, 10) - 1.0).abs() < 0.06, "{}", damage(100.0, 10));
        assert!(damage(50.0, 20) < 0.3);
    }
}
