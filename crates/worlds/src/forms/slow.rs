//! Forms of slow change: heat, wear, drift of the load cell, and a jump of it.

use std::f64::consts::TAU;

use super::{Built, Setting, size};
use crate::draw::Dice;
use crate::mechanism::{Mechanism, Moment};
use crate::place::Place;

/// Temperature over ambient: `C Ṫ = P − ΔT/R`, with `P` of friction and of the rubber's losses, or of the room.
#[derive(Debug)]
struct Heat {
    capacity_j_per_k: f64,
    resistance_k_per_w: f64,
    bladder_per_k: f64,
    friction_per_k: f64,
    rise_k: f64,
    /// Rise of the room over the whole plan, and the plan's duration; none for self-heating.
    room: Option<(f64, f64)>,
}

/// Share of the bladder's work that turns to heat.
const RUBBER_LOSS: f64 = 0.15;

impl Mechanism for Heat {
    fn bladder_factor(&mut self, now: &Moment) -> f64 {
        if let Some((room_k, total_s)) = self.room {
            let target_k = room_k * now.time_s / total_s;
            self.rise_k += (target_k - self.rise_k) * (1.0 - (-now.dt_s / 30.0).exp());
        } else {
            let power_w = (now.sliding_n.abs() + RUBBER_LOSS * now.bladder_n.abs()) * now.speed_m_per_s.abs();
            let constant_s = self.capacity_j_per_k * self.resistance_k_per_w;
            let target_k = power_w * self.resistance_k_per_w;
            self.rise_k += (target_k - self.rise_k) * (1.0 - (-now.dt_s / constant_s).exp());
        }
        1.0 + self.bladder_per_k * self.rise_k
    }

    fn friction_factor(&mut self, _now: &Moment) -> f64 {
        (1.0 + self.friction_per_k * self.rise_k).max(0.3)
    }

    fn temperature_c(&self) -> Option<f64> {
        self.room.map(|_| 21.0 + self.rise_k)
    }
}

fn self_heating(dice: &mut Dice, u: f64, bladder_per_k: f64) -> Built {
    let (capacity_j_per_k, resistance_k_per_w) = (size(1.0 - u, 12.0, 80.0), size(u, 5.0, 20.0));
    let friction_per_k = -dice.uniform(0.005, 0.010);
    let heat = Heat { capacity_j_per_k, resistance_k_per_w, bladder_per_k, friction_per_k, rise_k: 0.0, room: None };
    Built::one(heat).with("capacity_j_per_k", capacity_j_per_k).with("bladder_per_k", bladder_per_k)
}

/// Self-heating that softens the rubber.
pub fn thermal_softening(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let per_k = -size(u, 0.002, 0.008);
    self_heating(dice, u, per_k)
}

/// Self-heating of rubber with entropic elasticity, which stiffens by a three-hundredth per kelvin.
pub fn thermal_entropic(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    self_heating(dice, u, 0.0034)
}

/// A room that grows warmer or colder, with the temperature logged.
pub fn thermal_room(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let room_k = dice.sign() * size(u, 2.0, 15.0);
    let bladder_per_k = -dice.uniform(0.002, 0.008);
    let friction_per_k = -dice.uniform(0.005, 0.010);
    let total_s = setting.total_s();
    let room = Some((room_k, total_s));
    Built::one(Heat {
        capacity_j_per_k: 50.0,
        resistance_k_per_w: 10.0,
        bladder_per_k,
        friction_per_k,
        rise_k: 0.0,
        room,
    })
    .with("room_k", room_k)
    .with("bladder_per_k", bladder_per_k)
}

/// Wear with travelled distance, over that of the estimation recordings.
#[derive(Debug)]
struct Wear {
    loss: f64,
    set_m: f64,
    exponent: f64,
    nominal_m: f64,
    travelled_m: f64,
}

impl Mechanism for Wear {
    fn length(&mut self, now: &Moment, length_m: f64) -> f64 {
        self.travelled_m += now.speed_m_per_s.abs() * now.dt_s;
        length_m - self.set_m * (1.0 - (-3.0 * self.travelled_m / self.nominal_m).exp())
    }

    fn gas_factor(&mut self, _now: &Moment) -> f64 {
        1.0 - self.loss * (self.travelled_m / self.nominal_m).powf(self.exponent)
    }
}

fn wear(loss: f64, set_m: f64, exponent: f64, setting: &Setting) -> Built {
    Built::one(Wear { loss, set_m, exponent, nominal_m: setting.travel_m.max(0.01), travelled_m: 0.0 })
        .with("loss", loss)
        .with("set_mm", 1e3 * set_m)
}

/// Wear of the pull, linear in travelled distance.
pub fn wear_linear(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    wear(size(u, 0.01, 0.05), 0.0, 1.0, setting)
}

/// Wear of the pull, a power of travelled distance.
pub fn wear_power(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    wear(size(u, 0.01, 0.05), 0.0, dice.uniform(0.4, 0.75), setting)
}

/// A rest length that sets.
pub fn wear_set(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    wear(0.0, size(u, 2e-4, 2e-3), 1.0, setting)
}

/// Drift of the load cell's zero; over the estimation recordings it stays within the span of a
/// load cell's zero, from −5 to 5 N.
#[derive(Debug)]
struct Drift {
    kind: u8,
    size_n: f64,
    scale_s: f64,
    waves: [(f64, f64, f64); 4],
}

impl Mechanism for Drift {
    fn cell_n(&mut self, now: &Moment, force_n: f64) -> f64 {
        let time = now.time_s / self.scale_s;
        force_n
            + self.size_n
                * match self.kind {
                    0 => time,
                    1 => 1.0 - (-time).exp(),
                    _ => {
                        self.waves.iter().map(|(weight, rate, phase)| weight * (TAU * rate * time + phase).sin()).sum()
                    }
                }
    }
}

fn drift(kind: u8, dice: &mut Dice, u: f64, scale_s: f64) -> Built {
    let size_n = dice.sign() * size(u, 0.5, 9.0);
    let waves = [0.5, 1.1, 2.1, 3.7]
        .map(|rate: f64| (0.6 / rate.sqrt(), rate * dice.uniform(0.8, 1.2), dice.uniform(0.0, TAU)));
    Built::one(Drift { kind, size_n, scale_s, waves }).with("size_n", size_n)
}

/// Drift, linear in time.
pub fn drift_linear(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    drift(0, dice, u, setting.total_s())
}

/// Drift of an amplifier that warms up.
pub fn drift_saturating(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let scale_s = setting.total_s() * dice.uniform(0.2, 0.6);
    drift(1, dice, u, scale_s)
}

/// Drift that wanders.
pub fn drift_wandering(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    drift(2, dice, u, setting.total_s())
}

/// A jump of the load cell at one instant of one recording.
#[derive(Debug)]
struct Jump {
    recording: usize,
    at_s: f64,
    size_n: f64,
    /// Share that stays, and how fast the rest goes.
    stays: f64,
    settling_s: f64,
    since_s: Option<f64>,
    tared: bool,
}

impl Mechanism for Jump {
    fn begin(&mut self, recording: usize, rested: bool) {
        self.tared |= rested && recording > self.recording;
    }

    fn cell_n(&mut self, now: &Moment, force_n: f64) -> f64 {
        if now.recording == self.recording && now.recording_time_s >= self.at_s && self.since_s.is_none() {
            self.since_s = Some(now.time_s);
        }
        match self.since_s {
            Some(since_s) if !self.tared => {
                let left = (-(now.time_s - since_s) / self.settling_s).exp();
                force_n + self.size_n * (self.stays + (1.0 - self.stays) * left)
            }
            _ => force_n,
        }
    }
}

fn jump(dice: &mut Dice, u: f64, setting: &Setting, stays: f64) -> Built {
    let size_n = dice.sign() * size(u, 1.0, 10.0);
    let recording = dice.between(0, setting.estimation - 1);
    let duration_s = setting.durations_s[recording];
    let at_s = dice.uniform(0.25, 0.75) * duration_s;
    let settling_s = dice.uniform(0.5, 4.0);
    let place = Place { recording: Some(format!("e{}", recording + 1)), ..Place::new("time_s", at_s, duration_s) };
    let built = Built::one(Jump { recording, at_s, size_n, stays, settling_s, since_s: None, tared: false });
    Built { place: Some(place), ..built }.with("size_n", size_n).with("at_s", at_s)
}

/// One jump that stays.
pub fn step_jump(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    jump(dice, u, setting, 1.0)
}

/// A jump of which a part settles.
pub fn step_settling(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let stays = dice.uniform(0.4, 0.7);
    jump(dice, u, setting, stays)
}
