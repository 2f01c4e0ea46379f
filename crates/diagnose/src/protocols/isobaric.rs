//! Length moves at one pressure after the other.

use super::path::{Path, Take};
use super::reach::Reach;

/// Rate at which the pressure goes from level to level, in kPa/s: slow enough that the direction follows.
const LEVEL_KPA_PER_S: f64 = 60.0;

pub(super) fn null(reach: &Reach<'_>) -> Vec<Take> {
    let rest_m = reach.length(0.015);
    let low_pa = reach.taut_pressure(rest_m).unwrap_or(reach.pressure_pa.0);
    let mut path = Path::from(low_pa, rest_m);
    path.hold(30.0);
    for _ in 0..3 {
        path.go_to_length(reach.length_m.1, reach.distance(1.0));
        path.go_to_length(rest_m, reach.distance(1.0));
    }
    path.hold(30.0);
    vec![path.take(0.0)]
}

/// At each level that leaves room, what `act` does with the length that the level allows.
pub(super) fn at_levels(
    reach: &Reach<'_>,
    levels_kpa: &[f64],
    deepest: f64,
    long_m: f64,
    act: impl Fn(&mut Path, f64),
) -> Vec<Take> {
    let mut path: Option<Path> = None;
    for &level_kpa in levels_kpa {
        let pressure_pa = reach.pressure(level_kpa);
        let Some(short_m) = reach.taut_length(pressure_pa, deepest).filter(|short_m| *short_m < long_m) else {
            continue;
        };
        let path = path.get_or_insert_with(|| Path::from(pressure_pa, long_m));
        path.go_to_length(long_m, reach.distance(5.0));
        path.go_to_pressure(pressure_pa, reach.pressure_rate(LEVEL_KPA_PER_S));
        act(path, short_m);
    }
    path.map(|path| path.take(0.0)).into_iter().collect()
}

pub(super) fn triangles(reach: &Reach<'_>) -> Vec<Take> {
    let levels_kpa = [300.0, 60.0, 500.0, 100.0, 400.0, 200.0, 30.0];
    at_levels(reach, &levels_kpa, 0.21, reach.length_m.1, |path, short_m| {
        let long_m = path.at.length_m;
        path.triangles(short_m, 2, reach.distance(5.0));
        path.go_to_length(short_m, reach.distance(5.0));
        path.hold(10.0);
        path.go_to_length(long_m, reach.distance(5.0));
        path.hold(10.0);
    })
}

pub(super) fn rate_ladder(reach: &Reach<'_>) -> Vec<Take> {
    at_levels(reach, &[100.0, 300.0, 450.0], 0.15, reach.length(0.05), |path, short_m| {
        for speed_mm_per_s in [0.5, 1.5, 5.0, 15.0, 50.0] {
            path.triangles(short_m, 3, reach.distance(speed_mm_per_s));
        }
    })
}

pub(super) fn minor_loops(reach: &Reach<'_>) -> Vec<Take> {
    let pressure_pa = reach.pressure(300.0);
    let (center_m, long_m) = (reach.length(0.10), reach.length(0.05));
    let Some(short_m) = reach.taut_length(pressure_pa, 0.15).filter(|short_m| *short_m < center_m) else {
        return Vec::new();
    };
    let room_m = (center_m - short_m).min(reach.length_m.1 - center_m);
    let mut path = Path::from(pressure_pa, long_m);
    for speed_mm_per_s in [2.0, 10.0] {
        let speed_m_per_s = reach.distance(speed_mm_per_s);
        for amplitude_mm in [10.0, 5.0, 2.0, 1.0, 0.5, 1.0, 2.0, 5.0, 10.0] {
            let amplitude_m = reach.distance(amplitude_mm).min(room_m);
            path.go_to_length(center_m - amplitude_m, speed_m_per_s);
            path.go_to_length(center_m + amplitude_m, speed_m_per_s);
            path.go_to_length(center_m, speed_m_per_s);
        }
    }
    path.go_to_length(long_m, reach.distance(5.0));
    for share in [1.0, 0.8, 0.6, 0.4, 0.2] {
        path.triangles(long_m + share * (short_m - long_m), 1, reach.distance(5.0));
    }
    vec![path.take(0.0)]
}

pub(super) fn length_steps(reach: &Reach<'_>) -> Vec<Take> {
    at_levels(reach, &[100.0, 300.0, 450.0], 0.20, reach.length_m.1, |path, _| {
        for contraction in [0.0, 0.12, 0.05, 0.20, 0.10, 0.02, 0.15, 0.0] {
            if let Some(length_m) = reach.taut_length(path.at.pressure_pa, contraction) {
                path.go_to_length(length_m, reach.distance(100.0));
                path.hold(60.0);
            }
        }
    })
}
