//! Protocols at constant pressure: the drive moves, the valve holds.

use super::Setting;
use crate::path::{Path, Take};

/// Rate at which pressure is changed between levels, in kPa/s on the reference muscle, however short the
/// protocol: no level is nearer than a second to the next, so that a fit can tell that the length stood
/// still meanwhile.
const LEVEL_RATE_KPA_PER_S: f64 = 60.0;

/// P0: vented at rest length (shortened, if slack is allowed), then three slow stretches by 2 %.
pub(super) fn null(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let rest_m = if reach.is_taut(0.0, reach.length_m(0.02)) { reach.length_m(0.02) } else { reach.length_m(0.0) };
    let (cycles, stretch) = setting.pace.cycles(3);
    let mut path = Path::from(0.0, rest_m);
    path.hold(setting.pace.duration_s(30.0));
    for _ in 0..cycles {
        path.go_to_length(reach.length_m(-0.02), reach.distance_m(1.0) / stretch);
        path.go_to_length(rest_m, reach.distance_m(1.0) / stretch);
    }
    vec![path.take(0.0)]
}

/// P2: triangles from slight stretch to 21 % at seven pressures in mixed order, with dwells in the last cycle.
pub(super) fn triangles(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let (cycles, stretch) = setting.pace.cycles(3);
    let speed_m_per_s = reach.distance_m(5.0) / stretch;
    let long_m = reach.longest_m();
    let mut path = None;
    for level_kpa in [300.0, 60.0, 500.0, 100.0, 400.0, 200.0, 30.0] {
        let pressure_pa = reach.pressure_pa(level_kpa);
        let Some(short_m) = reach.taut_length_m(pressure_pa, 0.21) else { continue };
        let path = path.get_or_insert_with(|| Path::from(pressure_pa, long_m));
        path.go_to_pressure(pressure_pa, reach.pressure_pa(LEVEL_RATE_KPA_PER_S));
        for cycle in 1..=cycles {
            let dwell_s = if cycle == cycles { setting.pace.duration_s(10.0) } else { 0.0 };
            path.go_to_length(short_m, speed_m_per_s);
            path.hold(dwell_s);
            path.go_to_length(long_m, speed_m_per_s);
            path.hold(dwell_s);
        }
    }
    path.map(|path| path.take(0.0)).into_iter().collect()
}

/// P3: triangles between 5 and 15 % at 0.5 to 50 mm/s, at three pressures.
pub(super) fn rate_ladder(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let (cycles, stretch) = setting.pace.cycles(3);
    let long_m = reach.length_m(0.05);
    let mut path = None;
    for level_kpa in [100.0, 300.0, 450.0] {
        let pressure_pa = reach.pressure_pa(level_kpa);
        let Some(short_m) = reach.taut_length_m(pressure_pa, 0.15).filter(|short_m| *short_m < long_m) else {
            continue;
        };
        let path = path.get_or_insert_with(|| Path::from(pressure_pa, long_m));
        path.go_to_pressure(pressure_pa, reach.pressure_pa(LEVEL_RATE_KPA_PER_S));
        for speed_mm_per_s in [0.5, 1.5, 5.0, 15.0, 50.0] {
            for _ in 0..cycles {
                path.go_to_length(short_m, reach.distance_m(speed_mm_per_s) / stretch);
                path.go_to_length(long_m, reach.distance_m(speed_mm_per_s) / stretch);
            }
        }
    }
    path.map(|path| path.take(0.0)).into_iter().collect()
}

/// P4: closed loops of ±10 to ±0.5 mm and back up about 10 % at two speeds, then reversal curves from
/// five contractions.
pub(super) fn minor_loops(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let pressure_pa = reach.pressure_pa(300.0);
    let center_m = reach.length_m(0.10);
    let Some(short_m) = reach.taut_length_m(pressure_pa, 0.15) else { return Vec::new() };
    let room_m = center_m - short_m;
    let long_m = reach.length_m(0.05);
    let (cycles, stretch) = setting.pace.cycles(1);
    let mut path = Path::from(pressure_pa, long_m);
    for _ in 0..cycles {
        for speed_mm_per_s in [2.0, 10.0] {
            let speed_m_per_s = reach.distance_m(speed_mm_per_s) / stretch;
            for amplitude_mm in [10.0, 5.0, 2.0, 1.0, 0.5, 1.0, 2.0, 5.0, 10.0] {
                let amplitude_m = reach.distance_m(amplitude_mm).min(room_m);
                path.go_to_length(center_m - amplitude_m, speed_m_per_s);
                path.go_to_length(center_m + amplitude_m, speed_m_per_s);
                path.go_to_length(center_m, speed_m_per_s);
            }
        }
        let speed_m_per_s = reach.distance_m(5.0) / stretch;
        path.go_to_length(long_m, speed_m_per_s);
        for share in [1.0, 0.8, 0.6, 0.4, 0.2] {
            path.go_to_length(long_m + share * (short_m - long_m), speed_m_per_s);
            path.go_to_length(long_m, speed_m_per_s);
        }
    }
    vec![path.take(0.0)]
}

/// P6: fast steps between seven contractions with holds of a minute, at three pressures.
pub(super) fn length_steps(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let mut path = None;
    for level_kpa in [100.0, 300.0, 450.0] {
        let pressure_pa = reach.pressure_pa(level_kpa);
        let path = path.get_or_insert_with(|| Path::from(pressure_pa, reach.longest_m()));
        for (index, contraction_ratio) in [0.0, 0.12, 0.05, 0.20, 0.10, 0.02, 0.15, 0.0].into_iter().enumerate() {
            let Some(length_m) = reach.taut_length_m(pressure_pa, contraction_ratio) else { continue };
            path.go_to_length(length_m, reach.distance_m(100.0));
            if index == 0 {
                path.go_to_pressure(pressure_pa, reach.pressure_pa(LEVEL_RATE_KPA_PER_S));
            }
            path.hold(setting.pace.duration_s(60.0));
        }
    }
    path.map(|path| path.take(0.0)).into_iter().collect()
}
