//! Cycles and waits, for what a muscle remembers.

use super::path::{Path, Take};
use super::reach::Reach;

pub(super) fn run_in(reach: &Reach<'_>) -> Vec<Take> {
    let staircase = |path: &mut Path| {
        for contraction in [0.05, 0.10, 0.15, 0.20] {
            if let Some(short_m) = reach.taut_length(path.at.pressure_pa, contraction) {
                path.triangles(short_m, 3, reach.distance(5.0));
            }
        }
    };
    let mut fresh = Path::from(reach.pressure(300.0), reach.length_m.1);
    let mut rested = fresh.clone();
    staircase(&mut fresh);
    staircase(&mut fresh);
    staircase(&mut rested);
    vec![fresh.take(0.0), rested.take(3600.0)]
}

pub(super) fn endurance(reach: &Reach<'_>) -> Vec<Take> {
    let long_m = reach.length(0.02);
    let probe_pa = reach.pressure(200.0);
    let Some(probe_m) = reach.taut_length(probe_pa, 0.18).filter(|short_m| *short_m < long_m) else {
        return Vec::new();
    };
    let rate_pa_per_s = reach.pressure_rate(50.0);
    let probe = |path: &mut Path| {
        path.go_to_pressure(probe_pa, rate_pa_per_s);
        path.triangles(probe_m, 1, reach.distance(5.0));
    };
    let mut path = Path::from(probe_pa, long_m);
    probe(&mut path);
    for block in 1..=20 {
        let block_pa = reach.pressure(if block % 2 == 1 { 150.0 } else { 400.0 });
        let Some(short_m) = reach.taut_length(block_pa, 0.18).filter(|short_m| *short_m < long_m) else { continue };
        path.go_to_pressure(block_pa, rate_pa_per_s);
        // One second from end to end.
        path.triangles(short_m, 10, long_m - short_m);
        if block % 5 == 0 {
            probe(&mut path);
        }
    }
    let mut takes = vec![path.take(0.0)];
    for _ in 0..3 {
        let mut path = Path::from(probe_pa, long_m);
        probe(&mut path);
        takes.push(path.take(600.0));
    }
    takes
}

pub(super) fn dwell(reach: &Reach<'_>) -> Vec<Take> {
    let pressure_pa = reach.pressure(300.0);
    let (long_m, short_m) = (reach.length(0.08), reach.length(0.12));
    if !reach.is_taut(pressure_pa, short_m) {
        return Vec::new();
    }
    let mut path = Path::from(pressure_pa, long_m);
    for wait_s in [0.1, 1.0, 10.0, 100.0] {
        for share in [0.5, 1.0] {
            path.go_to_length(long_m + share * (short_m - long_m), reach.distance(1.0));
            path.hold(wait_s);
        }
        path.go_to_length(long_m, reach.distance(1.0));
        path.hold(wait_s);
    }
    vec![path.take(0.0)]
}
