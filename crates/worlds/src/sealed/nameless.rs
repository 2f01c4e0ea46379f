//! What no catalogue has, and what does not come to one of its effects either.

use std::f64::consts::{PI, TAU};

use crate::draw::Dice;
use crate::forms::{Built, Setting, size};
use crate::mechanism::{Mechanism, Moment};

/// A sleeve that wrinkles between two contractions as long as the pressure is too low to smooth it.
#[derive(Debug)]
struct Wrinkle {
    at: f64,
    width: f64,
    smooth_pa: f64,
    size_n: f64,
}

impl Mechanism for Wrinkle {
    fn added_n(&mut self, now: &Moment) -> f64 {
        let place = (now.contraction - self.at) / self.width;
        if place.abs() >= 1.0 {
            return 0.0;
        }
        let folded = 1.0 / (1.0 + (now.pressure_pa.max(0.0) / self.smooth_pa).powi(4));
        // Folds take force away; the edges of the range are smooth.
        -self.size_n * folded * (0.5 * PI * place).cos().powi(2)
    }
}

/// A sleeve that wrinkles in a range of length and at low pressure.
pub fn sleeve_wrinkle(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (least, most) = setting.contractions;
    let at = setting.contraction_at(dice.uniform(0.25, 0.6));
    let width = (most - least) * dice.uniform(0.12, 0.22);
    let (least_pa, most_pa) = setting.pressures_pa;
    let smooth_pa = least_pa.max(0.0) + (most_pa - least_pa) * dice.uniform(0.4, 0.7);
    let size_n = size(u, 2.0, 40.0);
    Built::one(Wrinkle { at, width, smooth_pa, size_n }).with("size_n", size_n).with("smooth_kpa", 1e-3 * smooth_pa).at(
        "contraction",
        at - width,
        at + width,
    )
}

/// A bundle of fibers that jumps under the end cap at one contraction and back at a lesser one, once per cycle.
#[derive(Debug)]
struct Bundle {
    leaves: f64,
    returns: f64,
    share: f64,
    out: bool,
    /// How far it has jumped, 0…1.
    place: f64,
}

/// Duration of a jump, s.
const JUMP_S: f64 = 0.02;

impl Mechanism for Bundle {
    fn begin(&mut self, _recording: usize, rested: bool) {
        if rested {
            (self.out, self.place) = (false, 0.0);
        }
    }

    fn gas_factor(&mut self, now: &Moment) -> f64 {
        if now.contraction > self.leaves {
            self.out = true;
        } else if now.contraction < self.returns {
            self.out = false;
        }
        let target = f64::from(u8::from(self.out));
        self.place += (target - self.place) * (1.0 - (-now.dt_s / JUMP_S).exp());
        1.0 - self.share * self.place
    }
}

/// A bundle of fibers that jumps under the end cap and then carries nothing: 0.5 to 8 % of the pull.
pub fn bundle_jump(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let leaves = setting.contraction_at(dice.uniform(0.55, 0.75));
    let returns = setting.contraction_at(dice.uniform(0.2, 0.4));
    let share = size(u, 0.005, 0.08);
    Built::one(Bundle { leaves, returns, share, out: false, place: 0.0 })
        .with("share", share)
        .with("leaves_contraction", leaves)
        .with("returns_contraction", returns)
        .at("contraction", returns, leaves)
}

/// Moist air that comes and goes, and a braid of nylon that swells in it.
#[derive(Debug)]
struct Moist {
    size_m: f64,
    period_s: f64,
    share: f64,
    phase_s: f64,
    constant_s: f64,
    swollen: f64,
}

impl Mechanism for Moist {
    fn length(&mut self, now: &Moment, length_m: f64) -> f64 {
        let moist = (now.time_s + self.phase_s).rem_euclid(self.period_s) < self.share * self.period_s;
        let target = f64::from(u8::from(moist));
        self.swollen += (target - self.swollen) * (1.0 - (-now.dt_s / self.constant_s).exp());
        // A muscle that has grown longer is less stretched at the same place of the rig.
        length_m - self.size_m * self.swollen
    }
}

/// A humidifier beside the bench that switches on and off: strands swell by 0.02 to 0.6 % of their length and dry again.
pub fn moist_air(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let longest_s = setting.durations_s.iter().copied().fold(20.0, f64::max);
    let period_s = longest_s * dice.uniform(0.5, 1.2);
    let size_m = size(u, 2e-4, 6e-3) * setting.muscle.rest_length_m;
    let (share, constant_s) = (dice.uniform(0.35, 0.65), period_s * dice.uniform(0.08, 0.25));
    Built::one(Moist { size_m, period_s, share, phase_s: dice.uniform(0.0, period_s), constant_s, swollen: 0.0 })
        .with("size_mm", 1e3 * size_m)
        .with("period_s", period_s)
}

/// Strokes of a membrane pump that reach the muscle; the gauge sits behind a snubber and does not see them.
#[derive(Debug)]
struct Pump {
    size_pa: f64,
    hz: f64,
    on_s: f64,
    off_s: f64,
    phase: f64,
}

impl Mechanism for Pump {
    fn pressure(&mut self, now: &Moment, pressure_pa: f64) -> f64 {
        let within_s = now.time_s.rem_euclid(self.on_s + self.off_s);
        // The motor runs up and down within half a second.
        let runs = (within_s / 0.5).min((self.on_s - within_s) / 0.5).clamp(0.0, 1.0);
        let turn = TAU * self.hz * now.time_s + self.phase;
        let stroke = (turn.sin() + 0.3 * (2.0 * turn).sin()) / 1.2;
        // A vented muscle has no valve open to the pump.
        let open = (pressure_pa / 2e4).clamp(0.0, 1.0);
        pressure_pa + self.size_pa * runs * stroke * open
    }
}

/// A pump without a tank, which runs at times.
pub fn pump_strokes(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let (size_pa, hz) = (size(u, 300.0, 1.2e4), dice.uniform(1.8, 5.0));
    let (on_s, off_s) = (dice.uniform(4.0, 12.0), dice.uniform(4.0, 15.0));
    Built::one(Pump { size_pa, hz, on_s, off_s, phase: dice.uniform(0.0, TAU) })
        .with("size_kpa", 1e-3 * size_pa)
        .with("stroke_hz", hz)
}

/// A swivel that holds the torque of an unbalanced braid until it lets go, and begins anew.
#[derive(Debug)]
struct Swivel {
    /// Rise of pressure in either direction that it holds, Pa.
    holds_pa: f64,
    size_n: f64,
    last_pa: Option<f64>,
    held_pa: f64,
    shown: f64,
}

impl Mechanism for Swivel {
    fn begin(&mut self, _recording: usize, rested: bool) {
        self.last_pa = None;
        if rested {
            (self.held_pa, self.shown) = (0.0, 0.0);
        }
    }

    fn cell_n(&mut self, now: &Moment, force_n: f64) -> f64 {
        self.held_pa += self.last_pa.map_or(0.0, |last_pa| now.pressure_pa - last_pa);
        self.last_pa = Some(now.pressure_pa);
        if self.held_pa.abs() > self.holds_pa {
            self.held_pa = 0.0;
        }
        // Letting go takes some milliseconds.
        self.shown += (self.held_pa / self.holds_pa - self.shown) * (1.0 - (-now.dt_s / 0.01).exp());
        force_n + self.size_n * self.shown
    }
}

/// A swivel that sticks: what the cell reads grows with the torque and falls back each time it lets go.
pub fn sticking_swivel(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (least_pa, most_pa) = setting.pressures_pa;
    let holds_pa = ((most_pa - least_pa) * dice.uniform(0.08, 0.25)).max(8e3);
    let size_n = dice.sign() * size(u, 1.0, 25.0);
    Built::one(Swivel { holds_pa, size_n, last_pa: None, held_pa: 0.0, shown: 0.0 })
        .with("size_n", size_n)
        .with("holds_kpa", 1e-3 * holds_pa)
}

/// An encoder whose counter misses pulses while it runs fast in one direction, until its index mark sets it right.
#[derive(Debug)]
struct Missed {
    above_m_per_s: f64,
    share: f64,
    /// Length of the index mark, m.
    mark_m: f64,
    last_m: Option<f64>,
    error_m: f64,
}

impl Mechanism for Missed {
    fn begin(&mut self, _recording: usize, _rested: bool) {
        (self.last_m, self.error_m) = (None, 0.0);
    }

    fn shown_length(&mut self, now: &Moment, length_m: f64) -> f64 {
        if let Some(last_m) = self.last_m {
            let speed_m_per_s = (last_m - length_m) / now.dt_s;
            if speed_m_per_s > self.above_m_per_s {
                self.error_m += self.share * (last_m - length_m);
            }
            // The mark counts when the muscle extends past it.
            if last_m < self.mark_m && length_m >= self.mark_m {
                self.error_m = 0.0;
            }
        }
        self.last_m = Some(length_m);
        length_m + self.error_m
    }
}

/// An encoder that misses pulses: 0.3 to 8 % of those above a speed.
pub fn missed_pulses(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let share = size(u, 0.003, 0.08);
    let above_m_per_s = dice.log_uniform(2e-3, 1.2e-2);
    let mark_m = setting.muscle.rest_length_m * (1.0 - setting.contraction_at(dice.uniform(0.1, 0.3)));
    Built::one(Missed { above_m_per_s, share, mark_m, last_m: None, error_m: 0.0 })
        .with("share", share)
        .with("above_mm_per_s", 1e3 * above_m_per_s)
        .with("mark_mm", 1e3 * mark_m)
}

#[cfg(test)]
mod tests;
