//! Sweeps: one channel swings ever faster while the other is held.

use std::f64::consts::TAU;

use super::Setting;
use crate::path::{Path, Take};

/// Knots per period of the fastest swing.
const KNOTS_PER_PERIOD: f64 = 50.0;

/// A swing whose frequency rises by equal factors in equal times.
struct Chirp {
    from_hz: f64,
    to_hz: f64,
    duration_s: f64,
}

impl Chirp {
    fn frequency_hz(&self, time_s: f64) -> f64 {
        self.from_hz * (self.to_hz / self.from_hz).powf(time_s / self.duration_s)
    }

    /// Sine of the phase, which is the integral of the frequency.
    fn sine(&self, time_s: f64) -> f64 {
        let e_foldings_per_s = (self.to_hz / self.from_hz).ln() / self.duration_s;
        (TAU * (self.frequency_hz(time_s) - self.from_hz) / e_foldings_per_s).sin()
    }

    fn knot_step_s(&self) -> f64 {
        1.0 / (KNOTS_PER_PERIOD * self.to_hz)
    }
}

/// P8: at three contractions, 250 ± 150 kPa from 0.05 to 10 Hz; above 1 Hz the swing gets smaller, as it does
/// behind a valve.
pub(super) fn pressure_chirp(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let chirp = Chirp { from_hz: 0.05, to_hz: 10.0, duration_s: setting.pace.duration_s(120.0) };
    let high_pa = reach.pressure_pa(400.0);
    let mut takes = Vec::new();
    for contraction_ratio in [0.02, 0.10, 0.18] {
        let length_m = reach.length_m(contraction_ratio);
        let Some(taut_pa) = reach.taut_pressure_pa(length_m).filter(|taut_pa| *taut_pa < high_pa) else { continue };
        let low_pa = reach.pressure_pa(100.0).max(taut_pa);
        let (center_pa, amplitude_pa) = (0.5 * (low_pa + high_pa), 0.5 * (high_pa - low_pa));
        let mut path = Path::from(center_pa, length_m);
        path.follow(chirp.duration_s, chirp.knot_step_s(), |time_s| {
            let amplitude_pa = amplitude_pa / chirp.frequency_hz(time_s).max(1.0);
            (center_pa + amplitude_pa * chirp.sine(time_s), length_m)
        });
        takes.push(path.take(5.0));
    }
    takes
}

/// P9: at three pressures, 10 ± 4 % shrinking to ± 0.3 % from 0.05 to 8 Hz.
pub(super) fn length_chirp(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let chirp = Chirp { from_hz: 0.05, to_hz: 8.0, duration_s: setting.pace.duration_s(120.0) };
    let amplitude_m = reach.length_m(0.0) - reach.length_m(0.04);
    let smallest = 0.003 / 0.04;
    let mut path = None;
    for level_kpa in [100.0, 300.0, 450.0] {
        let pressure_pa = reach.pressure_pa(level_kpa);
        let Some(short_m) = reach.taut_length_m(pressure_pa, 0.14) else { continue };
        let center_m = short_m + amplitude_m;
        if center_m + amplitude_m > reach.longest_m() {
            continue;
        }
        let path = path.get_or_insert_with(|| Path::from(pressure_pa, center_m));
        path.go_to_pressure(pressure_pa, reach.pressure_pa(50.0));
        path.go_to_length(center_m, reach.distance_m(5.0));
        path.follow(chirp.duration_s, chirp.knot_step_s(), |time_s| {
            let amplitude_m = amplitude_m * f64::powf(smallest, time_s / chirp.duration_s);
            (pressure_pa, center_m - amplitude_m * chirp.sine(time_s))
        });
        path.go_to_length(center_m, reach.distance_m(5.0));
    }
    path.map(|path| path.take(0.0)).into_iter().collect()
}
