//! Pressure and length wander together.

use std::f64::consts::TAU;

use super::path::{Path, Take};
use super::reach::Reach;

/// A sum of sines up to `highest_hz` in [0, 1]; phases at steps of an irrational number neither repeat nor heap up.
fn wander(highest_hz: f64, step: f64, duration_s: f64) -> impl Fn(f64) -> f64 {
    const LINES: i32 = 14;
    // Above it lines get weaker, so that speeds stay those of a bench.
    const CORNER_HZ: f64 = 0.2;
    let highest_line = highest_hz * duration_s;
    let lines: Vec<(f64, f64, f64)> = (0..LINES)
        .map(|line| {
            let hertz = highest_line.powf(f64::from(line) / f64::from(LINES - 1)).round() / duration_s;
            let index = f64::from(line);
            (hertz, 1.0 / (1.0 + (hertz / CORNER_HZ).powi(2)).sqrt(), TAU * (index * index * step).fract())
        })
        .collect();
    let sum =
        move |time_s: f64| lines.iter().map(|(hertz, size, phase)| size * (TAU * hertz * time_s + phase).sin()).sum();
    let (low, high) = (0..4000)
        .map(|index| sum(f64::from(index) / 4000.0 * duration_s))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value: f64| (low.min(value), high.max(value)));
    move |time_s| ((sum(time_s) - low) / (high - low)).clamp(0.0, 1.0)
}

pub(super) fn multisine(reach: &Reach<'_>) -> Vec<Take> {
    const DURATION_S: f64 = 240.0;
    const STEP_S: f64 = 0.04;
    const INTERVALS: usize = 64;
    let pressure = wander(1.0, 0.618_034, DURATION_S);
    let length = wander(0.8, 0.414_214, DURATION_S);
    let long_m = reach.length(0.0);
    let Some(short_m) = reach.taut_length(reach.pressure(250.0), 0.21).filter(|short_m| *short_m < long_m) else {
        return Vec::new();
    };
    // The lowest pressure at which the muscle is taut, as a table over length.
    let floors_pa: Vec<f64> = (0..=INTERVALS)
        .map(|index| {
            let length_m = long_m + index as f64 / INTERVALS as f64 * (short_m - long_m);
            reach.taut_pressure(length_m).unwrap_or(reach.pressure_pa.1)
        })
        .collect();
    let at = |time_s: f64| {
        let share = length(time_s);
        let index = ((share * INTERVALS as f64) as usize).min(INTERVALS - 1);
        let floor_pa = floors_pa[index].max(floors_pa[index + 1]);
        (reach.pressure(15.0 + 475.0 * pressure(time_s)).max(floor_pa), long_m + share * (short_m - long_m))
    };
    let (pressure_pa, length_m) = at(0.0);
    let mut path = Path::from(pressure_pa, length_m);
    for index in 1..=(DURATION_S / STEP_S) as usize {
        let (pressure_pa, length_m) = at(index as f64 * STEP_S);
        path.go(pressure_pa, length_m, STEP_S);
    }
    vec![path.take(0.0)]
}
