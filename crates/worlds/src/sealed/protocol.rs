//! Protocols of the third part.

use std::f64::consts::{PI, TAU};

use crate::draw::Dice;
use crate::protocol::{Kind, Writer, contractions, pressures};

/// Kinds of the third part.
pub const KINDS: [Kind; 8] = [
    Kind::Staircase,
    Kind::DwelledSines,
    Kind::GaitCycles,
    Kind::RandomSteps,
    Kind::QuickRelease,
    Kind::GrowingSpiral,
    Kind::HandHeld,
    Kind::LoadedHang,
];

/// Writes a recording of one of [`KINDS`].
pub(crate) fn write(kind: Kind, writer: &mut Writer, dice: &mut Dice, duration_s: f64) {
    let parts = ((duration_s / 15.0) as usize).clamp(1, 4);
    match kind {
        Kind::Staircase => staircase(writer, dice, parts, duration_s),
        Kind::DwelledSines => dwelled_sines(writer, dice, parts.min(3), duration_s),
        Kind::GaitCycles => gait_cycles(writer, dice),
        Kind::RandomSteps => random_steps(writer, dice),
        Kind::QuickRelease => quick_release(writer, dice, parts, duration_s),
        Kind::GrowingSpiral => growing_spiral(writer, dice, duration_s),
        Kind::LoadedHang => loaded_hang(writer, dice, duration_s),
        _ => hand_held(writer, dice),
    }
}

/// Pressure in even steps up and down at held lengths.
fn staircase(writer: &mut Writer, dice: &mut Dice, parts: usize, duration_s: f64) {
    let part_s = duration_s / parts as f64;
    for contraction in contractions(dice, writer.region, parts) {
        let from_pa = writer.region.least_pressure_pa(contraction);
        let to_pa = (writer.region.highest_pa * dice.uniform(0.85, 1.0)).max(from_pa);
        let steps = dice.between(4, 7);
        let dwell_s = (0.94 * part_s / (2 * steps) as f64 - 0.25).max(0.4);
        let here_pa = writer.here(from_pa, contraction).0;
        writer.go(from_pa.max(here_pa.min(to_pa)), contraction, 0.03 * part_s);
        writer.go(from_pa, contraction, 0.03 * part_s);
        for step in (1..=steps).chain((0..steps).rev()) {
            writer.go(from_pa + (to_pa - from_pa) * step as f64 / steps as f64, contraction, 0.25);
            writer.hold(dwell_s);
        }
    }
}

/// Bursts of a sine in length, each at another frequency, with a dwell after each.
fn dwelled_sines(writer: &mut Writer, dice: &mut Dice, parts: usize, duration_s: f64) {
    let bursts = 5;
    let burst_s = duration_s / parts as f64 / f64::from(bursts);
    for pressure_pa in pressures(dice, writer.region, parts) {
        let (low, high) = (writer.region.least, writer.region.most_at(pressure_pa));
        let middle = low + (high - low) * dice.uniform(0.42, 0.58);
        writer.go(pressure_pa, middle, 0.8);
        for burst in 0..bursts {
            let most_hz = 0.6 * writer.region.highest_hz;
            let hz = (0.12 * (most_hz / 0.12).powf(f64::from(burst) / f64::from(bursts - 1))).max(1.0 / burst_s);
            let fastest = 1.5 * writer.region.fastest_m_per_s / (TAU * hz) / writer.region.rest_m;
            let amplitude = (0.42 * (high - low)).min(fastest) * dice.uniform(0.6, 1.0);
            let moving_s = ((0.75 * burst_s * hz).floor().max(1.0) / hz).min(burst_s);
            for step in 0..(moving_s / writer.dt_s) as usize {
                let time_s = step as f64 * writer.dt_s;
                // A quarter of a cycle to swing in and out.
                let edge = (4.0 * hz * time_s.min(moving_s - time_s)).clamp(0.0, 1.0);
                writer.push(pressure_pa, middle + amplitude * edge * (TAU * hz * time_s).sin());
            }
            writer.hold((burst_s - moving_s).max(0.3));
        }
    }
}

/// Strides of a leg: length by two harmonics, pressure in a burst while the foot pushes off, bouts with pauses.
fn gait_cycles(writer: &mut Writer, dice: &mut Dice) {
    let region = writer.region;
    let rest_pa = region.highest_pa * dice.uniform(0.2, 0.35);
    let burst_pa = region.highest_pa * dice.uniform(0.75, 0.98) - rest_pa;
    let (low, high) = (region.least, region.most_at(rest_pa));
    let (second, phase) = (dice.uniform(0.15, 0.4), dice.uniform(0.0, TAU));
    let (middle_of_burst, width) = (dice.uniform(0.4, 0.6), dice.uniform(0.10, 0.18));
    let usual_s = dice.uniform(0.9, 2.2);
    writer.go(rest_pa, 0.5 * (low + high), 1.0);
    while !writer.full() {
        for _ in 0..dice.between(6, 16) {
            let stride_s = usual_s * (1.0 + 0.04 * dice.normal()).clamp(0.85, 1.15);
            let fastest = 1.5 * region.fastest_m_per_s * stride_s / (TAU * (1.0 + 2.0 * second)) / region.rest_m;
            let swing =
                (0.42 * (high - low) / (1.0 + second)).min(fastest) * (1.0 + 0.05 * dice.normal()).clamp(0.8, 1.15);
            let push_pa = burst_pa * (1.0 + 0.04 * dice.normal()).clamp(0.85, 1.03);
            let steps = (stride_s / writer.dt_s) as usize;
            for step in 0..steps {
                let share = step as f64 / steps as f64;
                let angle = (TAU * share).sin() + second * ((2.0 * TAU * share + phase).sin() - phase.sin());
                let burst = (-((share - middle_of_burst) / width).powi(2)).exp();
                writer.push(rest_pa + push_pa * burst, 0.5 * (low + high) + swing * angle);
            }
        }
        writer.hold(dice.uniform(0.8, 4.0));
    }
}

/// Both pressure and length step at random, each on its own (an amplitude-modulated random sequence).
fn random_steps(writer: &mut Writer, dice: &mut Dice) {
    let region = writer.region;
    let mean_s = dice.log_uniform(1.2, 5.0);
    let low_pa = region.highest_pa * dice.uniform(0.2, 0.4);
    let (mut pressure_pa, mut to_pa) = (region.highest_pa * 0.6, region.highest_pa * 0.6);
    let (mut contraction, mut to) = (region.least, region.least);
    // Until the next step: minus the logarithm of a uniform draw.
    let wait = |dice: &mut Dice| 0.25 - mean_s * dice.uniform(0.02, 1.0).ln();
    let (mut until_pressure_s, mut until_length_s) = (wait(dice), wait(dice));
    let rate_pa_per_s = region.highest_pa * dice.uniform(0.8, 4.0);
    let rate_per_s = region.fastest_m_per_s * dice.uniform(0.6, 1.0) / region.rest_m;
    while !writer.full() {
        until_pressure_s -= writer.dt_s;
        until_length_s -= writer.dt_s;
        if until_pressure_s <= 0.0 {
            to_pa = dice.uniform(low_pa, region.highest_pa);
            until_pressure_s = wait(dice);
        }
        if until_length_s <= 0.0 {
            to = dice.uniform(region.least, region.most_at(to_pa));
            until_length_s = wait(dice);
        }
        let (most_pa, most) = (rate_pa_per_s * writer.dt_s, rate_per_s * writer.dt_s);
        pressure_pa += (to_pa - pressure_pa).clamp(-most_pa, most_pa);
        let taut = to.min(region.most_at(pressure_pa));
        contraction += (taut - contraction).clamp(-most, most);
        writer.push(pressure_pa, contraction);
    }
}

/// Slow pulls to growing heights, each let go quickly, with a hold at the bottom.
fn quick_release(writer: &mut Writer, dice: &mut Dice, parts: usize, duration_s: f64) {
    let part_s = duration_s / parts as f64;
    let fastest_m_per_s = writer.region.fastest_m_per_s;
    for pressure_pa in pressures(dice, writer.region, parts) {
        let low = writer.region.least;
        let span = writer.region.most_at(pressure_pa) - low;
        writer.go(pressure_pa, low, 0.05 * part_s);
        let pulls: &[f64] = if dice.chance(0.5) { &[0.4, 0.7, 1.0] } else { &[1.0, 0.6, 1.0, 0.3] };
        let way_m: f64 = pulls.iter().map(|height| height * span * writer.region.rest_m).sum();
        let share = if writer.region.cycling { 0.15 } else { 1.0 };
        let quick_s = way_m / (0.9 * fastest_m_per_s);
        let hold_s = share * 0.12 * part_s / pulls.len() as f64;
        let slow_m_per_s =
            (way_m / (share * 0.8 * part_s - quick_s).max(0.05 * part_s)).clamp(5e-5, 0.6 * fastest_m_per_s);
        let contracts_slowly = dice.chance(0.6);
        let rounds = if writer.region.cycling { 6 } else { 1 };
        for _ in 0..rounds {
            for &height in pulls {
                let (there, back) = (slow_m_per_s, 0.9 * fastest_m_per_s);
                let (there, back) = if contracts_slowly { (there, back) } else { (back, there) };
                writer.slide(low + height * span, there);
                writer.slide(low, back);
                writer.hold(hold_s);
            }
        }
    }
}

/// Sines in both that grow and shrink together, at frequencies with no common period.
fn growing_spiral(writer: &mut Writer, dice: &mut Dice, duration_s: f64) {
    let region = writer.region;
    let low_pa = region.highest_pa * dice.uniform(0.2, 0.4);
    let (middle_pa, half_pa) = (0.5 * (low_pa + region.highest_pa), 0.5 * (region.highest_pa - low_pa));
    let (low, high) = (region.least, region.most_at(low_pa));
    let of_pressure_hz = dice.log_uniform(0.05, 0.25);
    let fastest_hz = 1.5 * region.fastest_m_per_s / (PI * (high - low).max(0.01) * region.rest_m);
    let of_length_hz = (of_pressure_hz * dice.uniform(0.35, 2.9)).clamp(0.04, fastest_hz.max(0.05));
    let rounds = (duration_s / dice.uniform(25.0, 60.0)).round().max(1.0);
    for step in 0..writer.count {
        let time_s = step as f64 * writer.dt_s;
        // Grows over three quarters of a round and shrinks over the last.
        let place = (rounds * time_s / duration_s).fract();
        let size = if place < 0.75 { 0.08 + 0.92 * place / 0.75 } else { 0.08 + 0.92 * (1.0 - place) / 0.25 };
        let pressure_pa = middle_pa + half_pa * size * (TAU * of_pressure_hz * time_s).sin();
        let contraction = 0.5 * (low + high) - 0.5 * (high - low) * size * (TAU * of_length_hz * time_s).cos();
        writer.push(pressure_pa, contraction);
    }
}

/// Pressure up and down in ramps with stops on the way, while a weight hangs; the length written is about where it will be.
fn loaded_hang(writer: &mut Writer, dice: &mut Dice, duration_s: f64) {
    let region = writer.region;
    let steps = 60;
    // From where the weight leaves its stop.
    let from_pa = (1..steps)
        .map(|step| region.highest_pa * f64::from(step) / f64::from(steps))
        .find(|&pressure_pa| region.lifted_at(pressure_pa) > region.least + 0.005)
        .unwrap_or(0.6 * region.highest_pa);
    let rounds = (duration_s / dice.uniform(15.0, 30.0)).round().max(1.0);
    let stops = dice.between(1, 4);
    let move_s = duration_s / rounds / (2 * stops) as f64;
    let still = dice.uniform(0.1, 0.5);
    let (mut last_pa, mut to) = (from_pa, region.lifted_at(from_pa));
    writer.push(last_pa, to);
    while !writer.full() {
        let top_pa = from_pa + (region.highest_pa - from_pa) * dice.uniform(0.6, 1.0);
        for stop in (1..=stops).chain((0..stops).rev()) {
            let next_pa = from_pa + (top_pa - from_pa) * stop as f64 / stops as f64;
            // In parts, since the muscle shortens less and less.
            for part in 1..=10 {
                let pressure_pa = last_pa + (next_pa - last_pa) * f64::from(part) / 10.0;
                to = region.lifted_at(pressure_pa);
                writer.go(pressure_pa, to, 0.1 * (1.0 - still) * move_s);
            }
            writer.go(next_pa, to, still * move_s);
            last_pa = next_pa;
        }
    }
}

/// By hand, with a valve that is turned by hand: uneven moves, and a tremor of 7 to 11 Hz.
fn hand_held(writer: &mut Writer, dice: &mut Dice) {
    let region = writer.region;
    let (tremor, tremor_hz) = (dice.log_uniform(5e-6, 6e-5) / region.rest_m, dice.uniform(7.0, 11.0));
    let (mut pressure_pa, mut to_pa) = (0.5 * region.highest_pa, 0.5 * region.highest_pa);
    let mut from = region.least;
    let mut phase = 0.0;
    while !writer.full() {
        if dice.chance(0.35) {
            to_pa = dice.uniform(region.least_pressure_pa(from), region.highest_pa);
        }
        let to = dice.uniform(region.least, region.most_at(pressure_pa.min(to_pa)));
        let way_m = (to - from).abs() * region.rest_m;
        let move_s = dice.log_uniform(0.6, 5.0).max(2.2 * way_m / region.fastest_m_per_s);
        let rest_s = if dice.chance(0.4) { dice.log_uniform(0.3, 5.0) } else { 0.0 };
        // Where in the move the hand is fastest: not in the middle.
        let skew = dice.uniform(0.7, 1.5);
        for step in 1..=((move_s + rest_s) / writer.dt_s).ceil() as usize {
            let share = (step as f64 * writer.dt_s / move_s).min(1.0).powf(skew);
            let smooth = share * share * (3.0 - 2.0 * share);
            phase += TAU * tremor_hz * (1.0 + 0.1 * dice.normal()) * writer.dt_s;
            pressure_pa += (to_pa - pressure_pa) * (1.0 - (-writer.dt_s / 0.9).exp());
            writer.push(pressure_pa, from + (to - from) * smooth + tremor * phase.sin());
        }
        from = to;
    }
}
