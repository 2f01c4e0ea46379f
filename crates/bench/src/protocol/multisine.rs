//! Pressure and length that wander together without repeating.

use std::f64::consts::TAU;

use rand::RngExt;

use super::Setting;
use crate::path::{Path, Take};
use crate::sensors::Stream;

/// Time between knots; the fastest line has a hundred in a period.
const KNOT_STEP_S: f64 = 0.01;

/// Frequency above which lines get weaker, so that speeds stay those of a bench.
const CORNER_HZ: f64 = 0.2;

/// A sum of sines at multiples of one over the duration.
struct Multisine {
    /// Frequency, in Hz, amplitude and phase, in rad.
    lines: Vec<(f64, f64, f64)>,
    lowest: f64,
    highest: f64,
}

impl Multisine {
    /// Up to twenty lines, spread evenly over the octaves up to `highest_hz`.
    fn new(duration_s: f64, highest_hz: f64, random: &mut impl RngExt) -> Self {
        let highest_line = (highest_hz * duration_s).floor().max(1.0);
        let mut multiples: Vec<u64> =
            (0..20).map(|index| highest_line.powf(f64::from(index) / 19.0).round() as u64).collect();
        multiples.dedup();
        let lines: Vec<_> = multiples
            .into_iter()
            .map(|multiple| {
                let frequency_hz = multiple as f64 / duration_s;
                (frequency_hz, 1.0 / (1.0 + (frequency_hz / CORNER_HZ).powi(2)).sqrt(), TAU * random.random::<f64>())
            })
            .collect();
        let mut multisine = Self { lines, lowest: f64::INFINITY, highest: f64::NEG_INFINITY };
        for index in 0..=(duration_s / KNOT_STEP_S) as usize {
            let sum = multisine.sum(index as f64 * KNOT_STEP_S);
            multisine.lowest = multisine.lowest.min(sum);
            multisine.highest = multisine.highest.max(sum);
        }
        multisine
    }

    fn sum(&self, time_s: f64) -> f64 {
        self.lines
            .iter()
            .map(|(frequency_hz, amplitude, phase)| amplitude * (TAU * frequency_hz * time_s + phase).sin())
            .sum()
    }

    /// Between 0 and 1, both of which it reaches.
    fn share(&self, time_s: f64) -> f64 {
        ((self.sum(time_s) - self.lowest) / (self.highest - self.lowest)).clamp(0.0, 1.0)
    }
}

/// P10: pressure between 15 and 490 kPa at up to 1 Hz, contraction between 0 and 21 % at up to 0.8 Hz;
/// where the muscle would go slack, the pressure is kept up.
pub(super) fn multisine(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let duration_s = setting.pace.duration_s(240.0);
    let mut random = Stream::Protocol.random(setting.seed);
    let pressure = Multisine::new(duration_s, 1.0, &mut random);
    let length = Multisine::new(duration_s, 0.8, &mut random);
    let (low_pa, high_pa) = (reach.pressure_pa(15.0), reach.pressure_pa(490.0));
    let long_m = reach.length_m(0.0);
    let Some(short_m) = reach.taut_length_m(0.5 * high_pa, 0.21) else { return Vec::new() };
    let floor = Floor::new(setting, short_m, long_m);
    let at = |time_s: f64| {
        let length_m = long_m + length.share(time_s) * (short_m - long_m);
        let pressure_pa = low_pa + pressure.share(time_s) * (high_pa - low_pa);
        (pressure_pa.max(floor.pressure_pa(length_m)), length_m)
    };
    let (pressure_pa, length_m) = at(0.0);
    let mut path = Path::from(pressure_pa, length_m);
    path.follow(duration_s, KNOT_STEP_S, at);
    vec![path.take(0.0)]
}

/// The lowest pressure at which the muscle is taut, as a table over length.
struct Floor {
    short_m: f64,
    long_m: f64,
    pressures_pa: Vec<f64>,
}

impl Floor {
    const INTERVALS: usize = 64;

    fn new(setting: &Setting<'_>, short_m: f64, long_m: f64) -> Self {
        let pressures_pa = (0..=Self::INTERVALS)
            .map(|index| {
                let length_m = short_m + (long_m - short_m) * index as f64 / Self::INTERVALS as f64;
                setting.reach.taut_pressure_pa(length_m).unwrap_or(setting.reach.highest_pressure_pa())
            })
            .collect();
        Self { short_m, long_m, pressures_pa }
    }

    fn pressure_pa(&self, length_m: f64) -> f64 {
        let position = (length_m - self.short_m) / (self.long_m - self.short_m) * Self::INTERVALS as f64;
        let index = (position.max(0.0) as usize).min(Self::INTERVALS - 1);
        let share = (position - index as f64).clamp(0.0, 1.0);
        self.pressures_pa[index] + share * (self.pressures_pa[index + 1] - self.pressures_pa[index])
    }
}
