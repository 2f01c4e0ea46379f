//! Protocols at constant length: the drive is locked, the valve moves.
//!
//! One length is one take: the logger is off while the rig goes to the next.

use super::Setting;
use crate::path::{Path, Take};

/// Time that the rig takes from one length to the next.
const PAUSE_S: f64 = 5.0;

/// P5: at five contractions, two ramps from vent (or from where the muscle is taut) to full pressure and
/// back, then three small ones; slow below 120 kPa.
pub(super) fn ramps(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let (cycles, stretch) = setting.pace.cycles(2);
    let (small_cycles, small_stretch) = setting.pace.cycles(3);
    let mut takes = Vec::new();
    for contraction_ratio in [0.0, 0.05, 0.10, 0.15, 0.20] {
        let length_m = reach.length_m(contraction_ratio);
        let Some(lowest_pa) = reach.taut_pressure_pa(length_m) else { continue };
        let mut path = Path::from(lowest_pa, length_m);
        for _ in 0..cycles {
            ramp(setting, &mut path, reach.highest_pressure_pa(), stretch);
            ramp(setting, &mut path, lowest_pa, stretch);
        }
        if reach.pressure_pa(150.0) > lowest_pa {
            for _ in 0..small_cycles {
                ramp(setting, &mut path, reach.pressure_pa(150.0), small_stretch);
                ramp(setting, &mut path, lowest_pa, small_stretch);
            }
        }
        takes.push(path.take(PAUSE_S));
    }
    takes
}

/// Ramps to a pressure: 10 kPa/s below 120 kPa, 50 kPa/s above.
fn ramp(setting: &Setting<'_>, path: &mut Path, pressure_pa: f64, stretch: f64) {
    let reach = &setting.reach;
    let knee_pa = reach.pressure_pa(120.0);
    let rate_pa_per_s = |low: bool| reach.pressure_pa(if low { 10.0 } else { 50.0 }) / stretch;
    let from_pa = path.pressure_pa();
    if (from_pa < knee_pa) != (pressure_pa < knee_pa) {
        path.go_to_pressure(knee_pa, rate_pa_per_s(from_pa < knee_pa));
    }
    path.go_to_pressure(
        pressure_pa,
        rate_pa_per_s(pressure_pa < knee_pa || from_pa < knee_pa && pressure_pa == knee_pa),
    );
}

/// P7: at three contractions, fast steps between seven pressures with holds of a minute.
pub(super) fn steps(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let mut takes = Vec::new();
    for contraction_ratio in [0.02, 0.10, 0.18] {
        let length_m = reach.length_m(contraction_ratio);
        let Some(lowest_pa) = reach.taut_pressure_pa(length_m) else { continue };
        let mut path = Path::from(lowest_pa, length_m);
        for level_kpa in [100.0, 400.0, 200.0, 500.0, 300.0, 50.0, 350.0] {
            path.go_to_pressure(reach.pressure_pa(level_kpa).max(lowest_pa), reach.pressure_pa(500.0));
            path.hold(setting.pace.duration_s(60.0));
        }
        takes.push(path.take(PAUSE_S));
    }
    takes
}
