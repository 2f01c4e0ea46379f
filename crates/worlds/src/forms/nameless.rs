//! What no catalogue has: faults of rig and sensors without a name there.

use std::f64::consts::TAU;

use super::geometry::softplus;
use super::{Built, Setting, size};
use crate::draw::Dice;
use crate::mechanism::{Mechanism, Moment};
use crate::place::Place;

/// A force that depends on where the muscle is, and perhaps on its direction.
#[derive(Debug)]
struct Spot {
    at: f64,
    width: f64,
    size_n: f64,
    /// 0 in both directions alike, 1 against motion, 2 only when extending.
    direction: u8,
}

impl Mechanism for Spot {
    fn added_n(&mut self, now: &Moment) -> f64 {
        let bump = (-((now.contraction - self.at) / self.width).powi(2)).exp();
        let factor = match self.direction {
            0 => -1.0,
            1 => -(now.speed_m_per_s / 1e-3).tanh(),
            _ => 0.5 * (1.0 - (now.speed_m_per_s / 1e-3).tanh()),
        };
        self.size_n * bump * factor
    }
}

fn spot(dice: &mut Dice, u: f64, setting: &Setting, direction: u8) -> Built {
    let (least, most) = setting.contractions;
    let at = setting.contraction_at(dice.uniform(0.3, 0.7));
    let width = (most - least) * dice.uniform(0.05, 0.12);
    let size_n = size(u, 1.5, 40.0);
    Built::one(Spot { at, width, size_n, direction }).with("size_n", size_n).at(
        "contraction",
        at - 1.5 * width,
        at + 1.5 * width,
    )
}

/// An object that the muscle brushes between two contractions.
pub fn touching_object(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    spot(dice, u, setting, 0)
}

/// One length at which the muscle sticks.
pub fn stick_at_one_length(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    spot(dice, u, setting, 1)
}

/// A catch that the muscle passes only when it extends.
pub fn one_way_catch(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    spot(dice, u, setting, 2)
}

/// A hose that kinks as the muscle contracts: the lag grows beyond a contraction.
#[derive(Debug)]
struct Kink {
    from: f64,
    width: f64,
    closed_s: f64,
    inside_pa: Option<f64>,
}

impl Mechanism for Kink {
    fn begin(&mut self, _recording: usize, rested: bool) {
        if rested {
            self.inside_pa = None;
        }
    }

    fn pressure(&mut self, now: &Moment, pressure_pa: f64) -> f64 {
        let inside_pa = self.inside_pa.unwrap_or(pressure_pa);
        let closing = 1.0 / (1.0 + (-(now.contraction - self.from) / self.width).exp());
        let constant_s = 0.002 + self.closed_s * closing;
        let next_pa = inside_pa + (pressure_pa - inside_pa) * (1.0 - (-now.dt_s / constant_s).exp());
        self.inside_pa = Some(next_pa);
        next_pa
    }
}

/// A hose that kinks.
pub fn kinked_hose(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let from = setting.contraction_at(dice.uniform(0.4, 0.7));
    let closed_s = size(u, 0.1, 4.0);
    Built::one(Kink { from, width: 0.006, closed_s, inside_pa: None }).with("closed_s", closed_s).at(
        "contraction",
        from,
        setting.contractions.1,
    )
}

/// A load cell that reads wrong around one force.
#[derive(Debug)]
struct BadSpot {
    at_n: f64,
    width_n: f64,
    size_n: f64,
}

impl Mechanism for BadSpot {
    fn cell_n(&mut self, _now: &Moment, force_n: f64) -> f64 {
        force_n + self.size_n * (-((force_n - self.at_n) / self.width_n).powi(2)).exp()
    }
}

/// A load cell with a bad spot.
pub fn bad_spot(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (least_n, most_n) = setting.forces_n;
    let at_n = least_n + (most_n - least_n) * dice.uniform(0.25, 0.6);
    let width_n = (most_n - least_n) * dice.uniform(0.03, 0.08);
    let size_n = dice.sign() * size(u, 0.01, 0.5) * width_n;
    Built::one(BadSpot { at_n, width_n, size_n }).with("size_n", size_n).at(
        "force_N",
        at_n - 1.5 * width_n,
        at_n + 1.5 * width_n,
    )
}

/// A clamp that creeps, which the encoder does not see.
#[derive(Debug)]
struct Clamp {
    size_m: f64,
    scale_s: f64,
}

impl Mechanism for Clamp {
    fn length(&mut self, now: &Moment, length_m: f64) -> f64 {
        length_m - self.size_m * (now.time_s / self.scale_s).ln_1p()
    }
}

/// A clamp that creeps.
pub fn creeping_clamp(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let size_m = size(u, 5e-5, 1e-3);
    Built::one(Clamp { size_m, scale_s: setting.total_s() * dice.uniform(0.02, 0.15) }).with("size_mm", 1e3 * size_m)
}

/// An encoder's pulley that runs out of true, and one that slips.
#[derive(Debug)]
struct Encoder {
    eccentricity_m: f64,
    circumference_m: f64,
    phase: f64,
    slip: Option<(usize, f64, f64)>,
    slipped_m: f64,
}

impl Mechanism for Encoder {
    fn shown_length(&mut self, now: &Moment, length_m: f64) -> f64 {
        if let Some((recording, at_s, by_m)) = self.slip
            && now.recording == recording
            && now.recording_time_s >= at_s
        {
            self.slipped_m = by_m;
        }
        length_m + self.slipped_m + self.eccentricity_m * (TAU * length_m / self.circumference_m + self.phase).sin()
    }
}

/// An eccentric pulley of the length sensor.
pub fn eccentric_pulley(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let stroke_m = (setting.contractions.1 - setting.contractions.0) * setting.muscle.rest_length_m;
    let eccentricity_m = size(u, 3e-5, 1.2e-3);
    let circumference_m = stroke_m * dice.uniform(0.25, 0.6);
    Built::one(Encoder { eccentricity_m, circumference_m, phase: dice.uniform(0.0, TAU), slip: None, slipped_m: 0.0 })
        .with("eccentricity_mm", 1e3 * eccentricity_m)
}

/// A length sensor that slips once.
pub fn encoder_slip(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let by_m = dice.sign() * size(u, 5e-5, 2e-3);
    let recording = dice.between(0, setting.estimation - 1);
    let duration_s = setting.durations_s[recording];
    let at_s = duration_s * dice.uniform(0.3, 0.7);
    let slip = Some((recording, at_s, by_m));
    let built = Built::one(Encoder { eccentricity_m: 0.0, circumference_m: 1.0, phase: 0.0, slip, slipped_m: 0.0 });
    let place = Place { recording: Some(format!("e{}", recording + 1)), ..Place::new("time_s", at_s, duration_s) };
    Built { place: Some(place), ..built }.with("slip_mm", 1e3 * by_m)
}

/// A room whose temperature swings, and moves both zeros with it.
#[derive(Debug)]
struct Room {
    force_n: f64,
    pressure_pa: f64,
    period_s: f64,
    phase: f64,
}

impl Mechanism for Room {
    fn cell_n(&mut self, now: &Moment, force_n: f64) -> f64 {
        force_n + self.force_n * (TAU * now.time_s / self.period_s + self.phase).sin()
    }

    fn shown_pressure(&mut self, now: &Moment, pressure_pa: f64) -> f64 {
        pressure_pa + self.pressure_pa * (TAU * now.time_s / self.period_s + self.phase - 0.7).sin()
    }
}

/// A room whose temperature swings.
pub fn room_swing(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let longest_s = setting.durations_s.iter().copied().fold(0.0, f64::max);
    let force_n = size(u, 0.3, 8.0);
    let period_s = longest_s * dice.uniform(0.3, 0.9);
    Built::one(Room { force_n, pressure_pa: 150.0 * force_n, period_s, phase: dice.uniform(0.0, TAU) })
        .with("size_n", force_n)
}

/// A fitting with play: the muscle follows the rig late after each reversal.
#[derive(Debug)]
struct Loose {
    half_m: f64,
    end_m: Option<f64>,
}

impl Mechanism for Loose {
    fn begin(&mut self, _recording: usize, rested: bool) {
        if rested {
            self.end_m = None;
        }
    }

    fn length(&mut self, _now: &Moment, length_m: f64) -> f64 {
        let end_m = self.end_m.unwrap_or(length_m).clamp(length_m - self.half_m, length_m + self.half_m);
        self.end_m = Some(end_m);
        end_m
    }
}

/// A loose fitting.
pub fn loose_fitting(_: &mut Dice, u: f64, _: &Setting) -> Built {
    let half_m = size(u, 3e-5, 1e-3);
    Built::one(Loose { half_m, end_m: None }).with("play_mm", 2e3 * half_m)
}

/// Pressure that is lost behind the gauge: by a leak while the valve holds, or by a supply that sags with the flow.
#[derive(Debug)]
struct Lost {
    leak: bool,
    rate: f64,
    most_pa: f64,
    recovery_s: f64,
    lost_pa: f64,
}

impl Mechanism for Lost {
    fn pressure(&mut self, now: &Moment, pressure_pa: f64) -> f64 {
        if self.leak {
            let holding = (-(now.gauge_rate_pa_per_s / 1500.0).powi(2)).exp();
            let room = 1.0 - self.lost_pa / self.most_pa;
            self.lost_pa += now.dt_s * holding * self.rate * pressure_pa.max(0.0) * room;
            self.lost_pa *= (-now.dt_s * (1.0 - holding) / self.recovery_s).exp();
        } else {
            let target_pa = (self.rate * now.gauge_rate_pa_per_s.max(0.0)).min(self.most_pa);
            let constant_s = if target_pa > self.lost_pa { 0.05 } else { self.recovery_s };
            self.lost_pa += (target_pa - self.lost_pa) * (1.0 - (-now.dt_s / constant_s).exp());
        }
        pressure_pa - self.lost_pa
    }
}

/// A leak behind the gauge that shows while the valve holds.
pub fn leak_while_holding(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let most_pa = size(u, 2e3, 6e4).min(0.3 * setting.muscle.highest_pressure_pa);
    let rate = dice.uniform(0.01, 0.04);
    Built::one(Lost { leak: true, rate, most_pa, recovery_s: 0.5, lost_pa: 0.0 }).with("most_kpa", 1e-3 * most_pa)
}

/// A supply that sags while the muscle fills, and recovers slowly.
pub fn supply_sagging(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let most_pa = size(u, 2e3, 6e4).min(0.3 * setting.muscle.highest_pressure_pa);
    let recovery_s = dice.uniform(0.8, 3.0);
    let rate = dice.uniform(0.2, 0.8);
    Built::one(Lost { leak: false, rate, most_pa, recovery_s, lost_pa: 0.0 }).with("most_kpa", 1e-3 * most_pa)
}

/// A second muscle beside the first, which is taut only when long.
#[derive(Debug)]
struct Second {
    at: f64,
    n_per_contraction: f64,
}

impl Mechanism for Second {
    fn added_n(&mut self, now: &Moment) -> f64 {
        self.n_per_contraction * softplus(self.at - now.contraction, 0.004)
    }
}

/// A second muscle in parallel.
pub fn second_muscle(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let at = setting.contraction_at(dice.uniform(0.35, 0.65));
    let span = at - setting.contractions.0;
    let size_n = size(u, 2.0, 60.0);
    Built::one(Second { at, n_per_contraction: size_n / span }).with("size_n", size_n).at(
        "contraction",
        setting.contractions.0,
        at,
    )
}

/// A gauge that does not move within a band.
#[derive(Debug)]
struct DeadZone {
    from_pa: f64,
    width_pa: f64,
}

impl Mechanism for DeadZone {
    fn shown_pressure(&mut self, _now: &Moment, pressure_pa: f64) -> f64 {
        let beyond_pa = pressure_pa - self.from_pa;
        if beyond_pa <= 0.0 || beyond_pa >= 2.0 * self.width_pa {
            pressure_pa
        } else if beyond_pa < self.width_pa {
            self.from_pa
        } else {
            self.from_pa + 2.0 * (beyond_pa - self.width_pa)
        }
    }
}

/// A gauge with a dead zone.
pub fn dead_zone(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (least_pa, most_pa) = setting.pressures_pa;
    let width_pa = size(u, 1.5e3, 4e4).min(0.2 * (most_pa - least_pa).max(1e4));
    let from_pa = least_pa + (most_pa - least_pa) * dice.uniform(0.25, 0.6);
    Built::one(DeadZone { from_pa, width_pa }).with("width_kpa", 1e-3 * width_pa).at(
        "pressure_kPa",
        1e-3 * from_pa,
        1e-3 * (from_pa + 2.0 * width_pa),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loose_fitting_follows_only_when_its_play_is_taken_up() {
        let mut loose = Loose { half_m: 1e-3, end_m: None };
        let now = Moment::default();
        loose.length(&now, 0.2);
        assert_eq!(loose.length(&now, 0.2005), 0.2);
        assert!((loose.length(&now, 0.203) - 0.202).abs() < 1e-12);
    }

    #[test]
    fn a_dead_zone_is_right_outside_and_flat_inside() {
        let mut zone = DeadZone { from_pa: 1e5, width_pa: 1e4 };
        let now = Moment::default();
        assert_eq!(zone.shown_pressure(&now, 9e4), 9e4);
        assert_eq!(zone.shown_pressure(&now, 1.05e5), 1e5);
        assert_eq!(zone.shown_pressure(&now, 1.3e5), 1.3e5);
    }
}
