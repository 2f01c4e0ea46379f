//! Protocols: where the rig takes pressure and length, within what keeps the muscle taut.

use std::f64::consts::{PI, TAU};

use serde::Serialize;

use crate::draw::Dice;
use crate::region::{Load, Region};
use crate::sealed;

/// Kind of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Triangles of length at several pressures.
    Isobaric,
    /// Ramps of pressure at several lengths, from vent where the muscle stays taut.
    IsometricRamps,
    /// Steps of pressure and holds.
    PressureSteps,
    /// Steps of length and holds.
    LengthSteps,
    /// Sines of rising frequency in length.
    LengthChirp,
    /// Sines of rising frequency in pressure.
    PressureChirp,
    /// Triangles at speeds over two decades.
    RateLadder,
    /// Nested loops about one length.
    MinorLoops,
    /// Many sines in both at once.
    Multisine,
    /// By hand, irregular.
    HandPulled,
    /// Even steps of pressure up and down at held lengths.
    Staircase,
    /// Bursts of sines in length at rising frequencies, with dwells.
    DwelledSines,
    /// Strides of a leg with bursts of pressure.
    GaitCycles,
    /// Random steps in pressure and length, each on its own.
    RandomSteps,
    /// Slow pulls that are let go quickly.
    QuickRelease,
    /// Sines in pressure and length that grow and shrink together.
    GrowingSpiral,
    /// By hand with tremor, and a valve that is turned by hand.
    HandHeld,
    /// A weight in a dashpot, while the pressure goes up and down.
    LoadedHang,
}

/// Kinds of the two halves.
pub const KINDS: [Kind; 10] = [
    Kind::Isobaric,
    Kind::IsometricRamps,
    Kind::PressureSteps,
    Kind::LengthSteps,
    Kind::LengthChirp,
    Kind::PressureChirp,
    Kind::RateLadder,
    Kind::MinorLoops,
    Kind::Multisine,
    Kind::HandPulled,
];

/// Path of the rig, at the fine step.
#[derive(Debug, Clone)]
pub struct Path {
    /// Step, s.
    pub dt_s: f64,
    /// Pressure at the gauge, Pa.
    pub pressure_pa: Vec<f64>,
    /// Length at the encoder, m; where a weight hangs, about where it will be.
    pub length_m: Vec<f64>,
    /// Weight that decides the length.
    pub load: Option<Load>,
}

/// Writes commands step by step, up to a number of them.
pub(crate) struct Writer<'a> {
    pub(crate) region: &'a Region,
    pub(crate) dt_s: f64,
    pub(crate) count: usize,
    pressure_pa: Vec<f64>,
    contraction: Vec<f64>,
}

impl Writer<'_> {
    pub(crate) fn full(&self) -> bool {
        self.pressure_pa.len() >= self.count
    }

    pub(crate) fn push(&mut self, pressure_pa: f64, contraction: f64) {
        if !self.full() {
            self.pressure_pa.push(pressure_pa);
            self.contraction.push(contraction);
        }
    }

    pub(crate) fn here(&self, pressure_pa: f64, contraction: f64) -> (f64, f64) {
        (*self.pressure_pa.last().unwrap_or(&pressure_pa), *self.contraction.last().unwrap_or(&contraction))
    }

    /// Moves evenly to a point.
    pub(crate) fn go(&mut self, pressure_pa: f64, contraction: f64, seconds: f64) {
        let (from_pa, from) = self.here(pressure_pa, contraction);
        let steps = (seconds / self.dt_s).ceil().max(1.0) as usize;
        for step in 1..=steps {
            let share = step as f64 / steps as f64;
            self.push(from_pa + (pressure_pa - from_pa) * share, from + (contraction - from) * share);
        }
    }

    /// Moves evenly at a speed of length, m/s.
    pub(crate) fn slide(&mut self, contraction: f64, speed_m_per_s: f64) {
        let (pressure_pa, from) = self.here(0.0, contraction);
        let way_m = (contraction - from).abs() * self.region.rest_m;
        self.go(pressure_pa, contraction, way_m / speed_m_per_s);
    }

    pub(crate) fn hold(&mut self, seconds: f64) {
        let (pressure_pa, contraction) = self.here(0.0, 0.0);
        self.go(pressure_pa, contraction, seconds);
    }
}

/// Levels over the pressures in use, in random order.
pub(crate) fn pressures(dice: &mut Dice, region: &Region, count: usize) -> Vec<f64> {
    // From where at least a third of the stroke is taut.
    let open_pa = region.least_pressure_pa(region.least + 0.35 * (region.most - region.least));
    let low = dice.uniform(0.15, 0.3).max(open_pa / region.highest_pa).min(0.8);
    let mut levels: Vec<f64> = (0..count)
        .map(|index| {
            let share = if count == 1 { dice.uniform(0.4, 0.8) } else { index as f64 / (count - 1) as f64 };
            region.highest_pa * (low + (1.0 - low) * share)
        })
        .collect();
    dice.shuffle(&mut levels);
    levels
}

pub(crate) fn contractions(dice: &mut Dice, region: &Region, count: usize) -> Vec<f64> {
    let mut levels: Vec<f64> = (0..count)
        .map(|index| {
            let share = if count == 1 { dice.uniform(0.2, 0.6) } else { 0.9 * index as f64 / (count - 1) as f64 };
            region.least + (region.most - region.least) * share
        })
        .collect();
    dice.shuffle(&mut levels);
    levels
}

/// Writes the path of one recording.
pub fn path(kind: Kind, duration_s: f64, dt_s: f64, dice: &mut Dice, region: &Region) -> Path {
    let count = (duration_s / dt_s).round() as usize + 1;
    let mut writer = Writer { region, dt_s, count, pressure_pa: Vec::new(), contraction: Vec::new() };
    let parts = ((duration_s / 12.0) as usize).clamp(2, 5);
    let part_s = duration_s / parts as f64;
    match kind {
        Kind::Isobaric => isobaric(&mut writer, dice, parts, part_s),
        Kind::IsometricRamps => isometric(&mut writer, dice, parts, part_s),
        Kind::PressureSteps => pressure_steps(&mut writer, dice, parts.min(3), duration_s),
        Kind::LengthSteps => length_steps(&mut writer, dice, parts.min(3), duration_s),
        Kind::LengthChirp => length_chirp(&mut writer, dice, parts.min(3), duration_s),
        Kind::PressureChirp => pressure_chirp(&mut writer, dice, parts.min(3), duration_s),
        Kind::RateLadder => rate_ladder(&mut writer, dice, duration_s),
        Kind::MinorLoops => minor_loops(&mut writer, dice),
        Kind::Multisine => multisine(&mut writer, dice),
        Kind::HandPulled => hand_pulled(&mut writer, dice),
        _ => sealed::protocol::write(kind, &mut writer, dice, duration_s),
    }
    while !writer.full() {
        let (pressure_pa, contraction) = writer.here(region.highest_pa * 0.5, region.least);
        writer.push(pressure_pa, contraction);
    }
    let path = follow(&writer);
    Path { load: region.hang.as_ref().filter(|_| kind == Kind::LoadedHang).map(|hang| hang.0), ..path }
}

fn isobaric(writer: &mut Writer, dice: &mut Dice, parts: usize, part_s: f64) {
    let staircase = dice.chance(0.4);
    for pressure_pa in pressures(dice, writer.region, parts) {
        let low = writer.region.least;
        let span = writer.region.most_at(pressure_pa) - low;
        writer.go(pressure_pa, low, 0.1 * part_s);
        let heights: &[f64] = if staircase { &[0.35, 0.65, 1.0] } else { &[1.0, 1.0] };
        if writer.region.cycling {
            let speed_m_per_s = 0.7 * writer.region.fastest_m_per_s;
            let cycles = 0.9 * part_s * speed_m_per_s / (2.0 * span.max(0.01) * writer.region.rest_m);
            for _ in 0..cycles as usize {
                writer.slide(low + span, speed_m_per_s);
                writer.slide(low, speed_m_per_s);
            }
            continue;
        }
        let way: f64 = heights.iter().map(|height| 2.0 * height * span).sum();
        let speed_m_per_s = (way * writer.region.rest_m / (0.9 * part_s)).min(writer.region.fastest_m_per_s);
        for &height in heights {
            writer.slide(low + height * span, speed_m_per_s.max(1e-5));
            writer.slide(low, speed_m_per_s.max(1e-5));
        }
    }
}

fn isometric(writer: &mut Writer, dice: &mut Dice, parts: usize, part_s: f64) {
    for contraction in contractions(dice, writer.region, parts) {
        let from_pa = writer.region.least_pressure_pa(contraction);
        let to_pa = writer.region.highest_pa * dice.uniform(0.85, 1.0);
        writer.go(from_pa.max(writer.here(from_pa, contraction).0.min(to_pa)), contraction, 0.06 * part_s);
        writer.go(from_pa, contraction, 0.06 * part_s);
        for _ in 0..2 {
            writer.go(to_pa, contraction, 0.22 * part_s);
            writer.go(from_pa, contraction, 0.22 * part_s);
        }
    }
}

fn pressure_steps(writer: &mut Writer, dice: &mut Dice, parts: usize, duration_s: f64) {
    let part_s = duration_s / parts as f64;
    let hold_s = (part_s / 6.0).clamp(1.5, 20.0);
    let levels = contractions(dice, writer.region, parts);
    for contraction in levels {
        let least_pa = writer.region.least_pressure_pa(contraction);
        let steps = (part_s / hold_s).ceil() as usize;
        writer.go(dice.uniform(least_pa, writer.region.highest_pa), contraction, 0.8);
        for _ in 0..steps {
            writer.go(dice.uniform(least_pa, writer.region.highest_pa), contraction, 0.15);
            writer.hold(hold_s * dice.uniform(0.7, 1.3));
        }
    }
}

fn length_steps(writer: &mut Writer, dice: &mut Dice, parts: usize, duration_s: f64) {
    let part_s = duration_s / parts as f64;
    let hold_s = (part_s / 6.0).clamp(1.5, 20.0);
    for pressure_pa in pressures(dice, writer.region, parts) {
        let (low, high) = (writer.region.least, writer.region.most_at(pressure_pa));
        writer.go(pressure_pa, dice.uniform(low, high), 0.8);
        let steps = (part_s / hold_s).ceil() as usize;
        for _ in 0..steps {
            let to = dice.uniform(low, high);
            writer.slide(to, writer.region.fastest_m_per_s);
            writer.hold(hold_s * dice.uniform(0.7, 1.3));
        }
    }
}

/// Phase of a sine whose frequency grows exponentially from `from_hz` to `to_hz`.
fn chirp_phase(time_s: f64, duration_s: f64, from_hz: f64, to_hz: f64) -> (f64, f64) {
    let rate = (to_hz / from_hz).ln() / duration_s;
    (TAU * from_hz * ((rate * time_s).exp_m1()) / rate, from_hz * (rate * time_s).exp())
}

fn length_chirp(writer: &mut Writer, dice: &mut Dice, parts: usize, duration_s: f64) {
    let part_s = duration_s / parts as f64;
    let to_hz = writer.region.highest_hz;
    for pressure_pa in pressures(dice, writer.region, parts) {
        let (low, high) = (writer.region.least, writer.region.most_at(pressure_pa));
        let middle = low + (high - low) * dice.uniform(0.4, 0.6);
        let swing = 0.4 * (high - low);
        writer.go(pressure_pa, middle, 1.0);
        let sine_s = part_s - 1.0;
        let steps = (sine_s / writer.dt_s) as usize;
        for step in 0..steps {
            let (phase, hz) = chirp_phase(step as f64 * writer.dt_s, sine_s, 0.08, to_hz);
            let amplitude = swing.min(1.6 * writer.region.fastest_m_per_s / (TAU * hz) / writer.region.rest_m);
            writer.push(pressure_pa, middle + amplitude * phase.sin());
        }
    }
}

fn pressure_chirp(writer: &mut Writer, dice: &mut Dice, parts: usize, duration_s: f64) {
    let part_s = duration_s / parts as f64;
    let to_hz = (0.7 * writer.region.highest_hz).max(1.0);
    for contraction in contractions(dice, writer.region, parts) {
        let least_pa = writer.region.least_pressure_pa(contraction);
        let middle_pa = 0.5 * (least_pa + writer.region.highest_pa);
        let swing_pa = 0.48 * (writer.region.highest_pa - least_pa);
        writer.go(middle_pa, contraction, 1.0);
        let sine_s = part_s - 1.0;
        let steps = (sine_s / writer.dt_s) as usize;
        for step in 0..steps {
            let (phase, hz) = chirp_phase(step as f64 * writer.dt_s, sine_s, 0.06, to_hz);
            let amplitude_pa = swing_pa * (0.4 / hz).powf(0.7).min(1.0);
            writer.push(middle_pa + amplitude_pa * phase.sin(), contraction);
        }
    }
}

fn rate_ladder(writer: &mut Writer, dice: &mut Dice, duration_s: f64) {
    let levels = if duration_s > 40.0 { 2 } else { 1 };
    let rungs = 5;
    let rung_s = duration_s / levels as f64 / f64::from(rungs) - 0.5;
    for pressure_pa in pressures(dice, writer.region, levels) {
        let (low, high) = (writer.region.least, writer.region.most_at(pressure_pa));
        writer.go(pressure_pa, low, 1.5);
        let fastest_m_per_s = 0.8 * writer.region.fastest_m_per_s;
        for rung in 0..rungs {
            let speed_m_per_s = fastest_m_per_s * 100f64.powf(-f64::from(rung) / f64::from(rungs - 1));
            let height = (high - low).min(speed_m_per_s * rung_s / 2.0 / writer.region.rest_m).max(1e-5);
            let middle = low + (high - low - height) * 0.5;
            let cycles = (rung_s * speed_m_per_s / (2.0 * height * writer.region.rest_m)).floor().max(1.0) as usize;
            writer.slide(middle, 0.3 * fastest_m_per_s);
            for _ in 0..cycles {
                if writer.full() {
                    return;
                }
                writer.slide(middle + height, speed_m_per_s);
                writer.slide(middle, speed_m_per_s);
            }
        }
    }
}

fn minor_loops(writer: &mut Writer, dice: &mut Dice) {
    let speed_m_per_s = dice.log_uniform(0.002, 0.012);
    let levels = pressures(dice, writer.region, 3);
    'all: loop {
        for &pressure_pa in &levels {
            let (low, high) = (writer.region.least, writer.region.most_at(pressure_pa));
            let middle = low + (high - low) * dice.uniform(0.4, 0.6);
            writer.go(pressure_pa, middle, 1.5);
            for half_mm in [10.0, 5.0, 2.0, 1.0, 0.5, 2.0, 8.0] {
                let half = (1e-3 * half_mm / writer.region.rest_m).min(0.45 * (high - low));
                writer.slide(middle + half, speed_m_per_s);
                writer.slide(middle - half, speed_m_per_s);
                writer.slide(middle, speed_m_per_s);
                if writer.full() {
                    break 'all;
                }
            }
        }
    }
}

/// Sum of sines between −1 and 1, roughly.
fn sines(dice: &mut Dice, from_hz: f64, to_hz: f64) -> Vec<(f64, f64, f64)> {
    let lines: Vec<(f64, f64, f64)> = (0..8)
        .map(|_| {
            let hz = dice.log_uniform(from_hz, to_hz);
            ((from_hz / hz).powf(0.35), hz, dice.uniform(0.0, TAU))
        })
        .collect();
    let rms = (lines.iter().map(|line| 0.5 * line.0 * line.0).sum::<f64>()).sqrt();
    lines.into_iter().map(|(weight, hz, phase)| (0.5 * weight / rms, hz, phase)).collect()
}

fn multisine(writer: &mut Writer, dice: &mut Dice) {
    let (of_pressure, of_length) = (sines(dice, 0.03, dice.clone().uniform(0.4, 1.0)), sines(dice, 0.03, 0.8));
    let low_pa = writer.region.highest_pa * dice.uniform(0.2, 0.45);
    let high_pa = writer.region.highest_pa;
    let value = |lines: &[(f64, f64, f64)], time_s: f64| -> f64 {
        let sum: f64 = lines.iter().map(|(weight, hz, phase)| weight * (TAU * hz * time_s + phase).sin()).sum();
        0.5 + 0.5 * (1.1 * sum).tanh()
    };
    let (low, high) = (writer.region.least, writer.region.most_at(low_pa));
    for step in 0..writer.count {
        let time_s = step as f64 * writer.dt_s;
        writer.push(
            low_pa + (high_pa - low_pa) * value(&of_pressure, time_s),
            low + (high - low) * value(&of_length, time_s),
        );
    }
}

fn hand_pulled(writer: &mut Writer, dice: &mut Dice) {
    let (mut pressure_pa, mut contraction) = (0.6 * writer.region.highest_pa, writer.region.least);
    let mut until_pressure_s = dice.uniform(3.0, 9.0);
    let mut target_pa = pressure_pa;
    while !writer.full() {
        let to = dice.uniform(writer.region.least, writer.region.most_at(pressure_pa.min(target_pa)));
        let way_m = (to - contraction).abs() * writer.region.rest_m;
        let move_s = dice.log_uniform(0.3, 3.0).max(2.0 * way_m / writer.region.fastest_m_per_s);
        let steps = (move_s / writer.dt_s).ceil() as usize;
        let (from, from_pa) = (contraction, pressure_pa);
        for step in 1..=steps {
            let share = step as f64 / steps as f64;
            // Least jerk (Flash and Hogan 1985).
            let smooth = share.powi(3) * (10.0 - 15.0 * share + 6.0 * share * share);
            pressure_pa = from_pa + (target_pa - from_pa) * smooth;
            writer.push(pressure_pa, from + (to - from) * smooth);
        }
        contraction = to;
        let dwell_s = if dice.chance(0.5) { dice.log_uniform(0.2, 4.0) } else { 0.0 };
        writer.hold(dwell_s);
        until_pressure_s -= move_s + dwell_s;
        if until_pressure_s < 0.0 {
            target_pa = dice.uniform(writer.region.least_pressure_pa(contraction), writer.region.highest_pa);
            until_pressure_s = dice.uniform(3.0, 12.0);
        }
    }
}

/// What the drives make of the commands: taut, and through a critically damped second order each.
fn follow(writer: &Writer) -> Path {
    let region = writer.region;
    let dt_s = writer.dt_s;
    let smooth = |commands: &[f64], bandwidth_hz: f64| -> Vec<f64> {
        let natural = 2.0 * PI * bandwidth_hz;
        let (mut value, mut rate) = (commands[0], 0.0);
        // Exact step of the critically damped second order for a command that is constant within it.
        let decay = (-natural * dt_s).exp();
        commands
            .iter()
            .map(|&command| {
                let error = value - command;
                let slope = rate + natural * error;
                value = command + (error + slope * dt_s) * decay;
                rate = (rate - natural * slope * dt_s) * decay;
                value
            })
            .collect()
    };
    let mut pressure_pa = smooth(&writer.pressure_pa, region.bandwidths_hz.1);
    let taut: Vec<f64> = writer
        .contraction
        .iter()
        .zip(&pressure_pa)
        .map(|(&contraction, &pressure_pa)| contraction.min(region.most_at(pressure_pa)).max(region.least))
        .collect();
    let contraction = smooth(&taut, region.bandwidths_hz.0);
    if let Some(regulator) = region.regulator {
        regulator.disturb(&mut pressure_pa, &contraction, dt_s, 1.01 * region.highest_pa);
    }
    let length_m = contraction.iter().map(|contraction| region.rest_m * (1.0 - contraction)).collect();
    Path { dt_s, pressure_pa, length_m, load: None }
}

#[cfg(test)]
mod tests;
