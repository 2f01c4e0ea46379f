//! Sweeps of the frequency.

use std::f64::consts::TAU;

use super::isobaric::at_levels;
use super::path::{PAUSE_S, Path, Take};
use super::reach::Reach;

/// Follows `curve` (phase in rad, frequency in Hz and share of the time in) while the frequency rises by equal factors in
/// equal times; so many knots in every period.
fn chirp(path: &mut Path, from_hz: f64, to_hz: f64, duration_s: f64, curve: impl Fn(f64, f64, f64) -> (f64, f64)) {
    const KNOTS_PER_PERIOD: f64 = 20.0;
    let e_folds_per_s = (to_hz / from_hz).ln() / duration_s;
    let mut time_s = 0.0;
    while time_s < duration_s {
        let frequency_hz = from_hz * (e_folds_per_s * time_s).exp();
        let step_s = 1.0 / (KNOTS_PER_PERIOD * frequency_hz);
        time_s += step_s;
        let frequency_hz = from_hz * (e_folds_per_s * time_s).exp();
        let (pressure_pa, length_m) =
            curve(TAU * (frequency_hz - from_hz) / e_folds_per_s, frequency_hz, time_s / duration_s);
        path.go(pressure_pa, length_m, step_s);
    }
}

pub(super) fn pressure_chirp(reach: &Reach<'_>) -> Vec<Take> {
    let high_pa = reach.pressure(400.0);
    [0.02, 0.10, 0.18]
        .iter()
        .filter_map(|&contraction| {
            let length_m = reach.length(contraction);
            let low_pa = reach.taut_pressure(length_m).filter(|low_pa| *low_pa < high_pa)?.max(reach.pressure(100.0));
            let (center_pa, amplitude_pa) = (0.5 * (low_pa + high_pa), 0.5 * (high_pa - low_pa));
            let mut path = Path::from(center_pa, length_m);
            // Above 1 Hz the swing gets smaller, as it does behind a valve.
            chirp(&mut path, 0.05, 10.0, 120.0, |phase, hertz, _| {
                (center_pa + amplitude_pa / hertz.max(1.0) * phase.sin(), length_m)
            });
            Some(path.take(PAUSE_S))
        })
        .collect()
}

pub(super) fn length_chirp(reach: &Reach<'_>) -> Vec<Take> {
    at_levels(reach, &[100.0, 300.0, 450.0], 0.14, reach.length(0.06), |path, short_m| {
        let (pressure_pa, long_m) = (path.at.pressure_pa, path.at.length_m);
        let (center_m, amplitude_m) = (0.5 * (short_m + long_m), 0.5 * (long_m - short_m));
        path.go_to_length(center_m, reach.distance(5.0));
        chirp(path, 0.05, 8.0, 120.0, |phase, _, share| {
            (pressure_pa, center_m - amplitude_m * 0.075_f64.powf(share) * phase.sin())
        });
    })
}
