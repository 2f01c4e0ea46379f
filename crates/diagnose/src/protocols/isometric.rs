//! Pressure moves at one length after the other.

use super::path::{PAUSE_S, Path, Take};
use super::reach::Reach;

/// A take at each contraction, from the lowest pressure at which the muscle is taut.
fn at_lengths(reach: &Reach<'_>, contractions: &[f64], act: impl Fn(&mut Path)) -> Vec<Take> {
    contractions
        .iter()
        .filter_map(|&contraction| {
            let length_m = reach.length(contraction);
            let mut path = Path::from(reach.taut_pressure(length_m)?, length_m);
            act(&mut path);
            Some(path.take(PAUSE_S))
        })
        .collect()
}

pub(super) fn ramps(reach: &Reach<'_>) -> Vec<Take> {
    at_lengths(reach, &[0.0, 0.05, 0.10, 0.15, 0.20], |path| {
        let low_pa = path.at.pressure_pa;
        // Slow where the bladder comes to lie on the braid.
        let knee_pa = reach.pressure(120.0).max(low_pa);
        let (slow, fast) = (reach.pressure_rate(10.0), reach.pressure_rate(50.0));
        for _ in 0..2 {
            path.go_to_pressure(knee_pa, slow);
            path.go_to_pressure(reach.pressure_pa.1, fast);
            path.go_to_pressure(knee_pa, fast);
            path.go_to_pressure(low_pa, slow);
        }
        for _ in 0..3 {
            path.go_to_pressure(knee_pa, slow);
            path.go_to_pressure(low_pa, slow);
        }
    })
}

pub(super) fn steps(reach: &Reach<'_>) -> Vec<Take> {
    at_lengths(reach, &[0.02, 0.10, 0.18], |path| {
        let low_pa = path.at.pressure_pa;
        for level_kpa in [100.0, 400.0, 200.0, 500.0, 300.0, 50.0, 350.0] {
            path.go_to_pressure(reach.pressure(level_kpa).max(low_pa), reach.pressure_rate(500.0));
            path.hold(60.0);
        }
    })
}
