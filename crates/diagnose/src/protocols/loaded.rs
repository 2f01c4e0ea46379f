//! Pressure moves under a constant load.

use super::path::{PAUSE_S, Path, Take};
use super::reach::Reach;

/// The length follows from the balance of forces, friction left out: the load cylinder of the real bench decides.
pub(super) fn isotonic(reach: &Reach<'_>) -> Vec<Take> {
    let (short_m, long_m) = (reach.length(0.21), reach.length(0.0));
    let highest_n = reach.model.force_n(reach.pressure_pa.1, long_m, 0.0);
    let mut takes = Vec::new();
    // 20, 60, 120 and 250 N of the reference muscle, which pulls 900 N.
    for load_n in [0.022, 0.067, 0.13, 0.28].map(|share| share * highest_n) {
        let length_at = |pressure_pa: f64| {
            let surplus_n = |length_m| reach.model.force_n(pressure_pa, length_m, 0.0) - load_n;
            let (mut slack, mut taut) = (short_m, long_m);
            if surplus_n(short_m) >= 0.0 {
                return short_m;
            }
            while taut - slack > 1e-6 {
                let middle = 0.5 * (slack + taut);
                if surplus_n(middle) >= 0.0 { taut = middle } else { slack = middle }
            }
            taut
        };
        let loaded = Reach { lowest_tension_n: load_n, ..*reach };
        let Some(low_pa) = loaded.taut_pressure(long_m) else { continue };
        let high_pa = loaded.taut_pressure(short_m).unwrap_or(reach.pressure_pa.1);
        if high_pa - low_pa < 0.02 * reach.pressure_pa.1 {
            continue;
        }
        let mut path = Path::from(low_pa, length_at(low_pa));
        const STEPS: usize = 60;
        for way in 0..4 {
            for index in 1..=STEPS {
                let share = index as f64 / STEPS as f64;
                let share = if way % 2 == 0 { share } else { 1.0 - share };
                let pressure_pa = low_pa + share * (high_pa - low_pa);
                let duration_s = (high_pa - low_pa) / STEPS as f64 / reach.pressure_rate(25.0);
                path.go(pressure_pa, length_at(pressure_pa), duration_s);
            }
        }
        takes.push(path.take(PAUSE_S));
    }
    takes
}
