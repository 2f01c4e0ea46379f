//! Protocols that look for what a muscle remembers of its past.

use super::Setting;
use crate::path::{Path, Take};

/// Triangles from slight stretch to a contraction and back.
fn triangles(setting: &Setting<'_>, path: &mut Path, contraction_ratio: f64, cycles: u32, speed_m_per_s: f64) {
    let reach = &setting.reach;
    let Some(short_m) = reach.taut_length_m(path.pressure_pa(), contraction_ratio) else { return };
    let long_m = path.length_m();
    for _ in 0..cycles {
        path.go_to_length(short_m, speed_m_per_s);
        path.go_to_length(long_m, speed_m_per_s);
    }
}

/// P1: at 300 kPa, three triangles each to 5, 10, 15 and 20 %, the whole twice, and once more after an hour.
pub(super) fn run_in(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let (cycles, stretch) = setting.pace.cycles(3);
    let staircase = |path: &mut Path| {
        for contraction_ratio in [0.05, 0.10, 0.15, 0.20] {
            triangles(setting, path, contraction_ratio, cycles, reach.distance_m(5.0) / stretch);
        }
    };
    let start = Path::from(reach.pressure_pa(300.0), reach.longest_m());
    let mut fresh = start.clone();
    staircase(&mut fresh);
    staircase(&mut fresh);
    let mut rested = start;
    staircase(&mut rested);
    vec![fresh.take(0.0), rested.take(setting.pace.duration_s(3600.0))]
}

/// P12: twenty blocks of ten cycles between 2 and 18 % at 0.5 Hz, at 150 and 400 kPa in turn; a probe cycle at
/// 200 kPa before, after every five blocks, and at ten, twenty and thirty minutes of rest.
pub(super) fn endurance(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let (blocks, stretch) = setting.pace.cycles(20);
    let long_m = reach.length_m(0.02);
    let probe_pa = reach.pressure_pa(200.0);
    if !reach.is_taut(probe_pa, long_m) {
        return Vec::new();
    }
    let rate_pa_per_s = reach.pressure_pa(50.0);
    let probe = |path: &mut Path| {
        path.go_to_pressure(probe_pa, rate_pa_per_s);
        triangles(setting, path, 0.18, 1, reach.distance_m(5.0));
    };
    let mut path = Path::from(probe_pa, long_m);
    probe(&mut path);
    for block in 1..=blocks {
        let block_pa = reach.pressure_pa(if block % 2 == 1 { 150.0 } else { 400.0 });
        if !reach.is_taut(block_pa, long_m) {
            continue;
        }
        path.go_to_pressure(block_pa, rate_pa_per_s);
        // One second from end to end.
        triangles(setting, &mut path, 0.18, 10, (long_m - reach.length_m(0.18)) / stretch);
        if block % 5 == 0 || block == blocks {
            probe(&mut path);
        }
    }
    let mut takes = vec![path.take(0.0)];
    for _ in 0..3 {
        let mut path = Path::from(probe_pa, long_m);
        probe(&mut path);
        takes.push(path.take(setting.pace.duration_s(600.0)));
    }
    takes
}

/// P14: at 300 kPa and 1 mm/s, waits of 0.1, 1, 10 and 100 s before going on and before turning back.
pub(super) fn dwell(setting: &Setting<'_>) -> Vec<Take> {
    let reach = &setting.reach;
    let (cycles, stretch) = setting.pace.cycles(1);
    let speed_m_per_s = reach.distance_m(1.0) / stretch;
    let pressure_pa = reach.pressure_pa(300.0);
    let (long_m, short_m) = (reach.length_m(0.08), reach.length_m(0.12));
    if !reach.is_taut(pressure_pa, short_m) {
        return Vec::new();
    }
    let mut path = Path::from(pressure_pa, long_m);
    for wait_s in [0.1, 1.0, 10.0, 100.0].map(|wait_s| setting.pace.duration_s(wait_s)).repeat(cycles as usize) {
        for share in [0.5, 1.0] {
            path.go_to_length(long_m + share * (short_m - long_m), speed_m_per_s);
            path.hold(wait_s);
        }
        path.go_to_length(long_m, speed_m_per_s);
        path.hold(wait_s);
    }
    vec![path.take(0.0)]
}
