//! The words that sentences are made of here: drivers, and memories with numbers that suit the recordings.

use pam_muscle::effects::Moment;
use pam_muscle::effects::sentence::{Driver, Recall};

use crate::coordinates::moving_limits;
use crate::state::{Setting, State};

/// Time constants of lags, in s.
const LAGS_S: [f64; 8] = [0.02, 0.05, 0.12, 0.3, 0.8, 2.0, 6.0, 20.0];
/// Time constants of two lags that are alike, in s.
const TWO_LAGS_S: [f64; 3] = [0.03, 0.12, 0.5];
/// Halves of a play, and distances of friction, in units of the range of the driver.
const PLAYS: [f64; 4] = [0.004, 0.012, 0.035, 0.1];
/// See [`PLAYS`].
const DISTANCES: [f64; 4] = [0.01, 0.03, 0.1, 0.3];

/// Every driver with every memory that is worth a look on these recordings.
pub(super) fn lexicon(setting: &Setting<'_>, state: &State) -> Vec<(Driver, Recall)> {
    let track = setting.track;
    let counted = || (0..track.n()).filter(|&at| track.counted[at]);
    let range = |value: &dyn Fn(usize) -> f64| {
        let (low, high) = counted()
            .map(value)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        (high - low).max(0.0)
    };
    let moments: Vec<&Moment> = counted().map(|at| &state.sheet.seen[at]).collect();
    let [above_m_per_s, above_pa_per_s] = moving_limits(moments.into_iter());
    let pressure_pa = range(&|at| state.sheet.seen[at].pressure_pa);
    let contraction = range(&|at| state.sheet.seen[at].contraction_ratio);
    let force_n = range(&|at| state.sheet.base[at].static_force_n);
    let mut words = Vec::new();
    let mut add =
        |driver: Driver, memories: Vec<Recall>| words.extend(memories.into_iter().map(|memory| (driver, memory)));
    if pressure_pa > 1e3 {
        add(Driver::Pressure, [once(), lags(), two_lags(), sliding(pressure_pa), grown()].concat());
    }
    if contraction > 2e-3 {
        add(
            Driver::Contraction,
            [once(), lags(), two_lags(), sliding(contraction), grown(), vec![Recall::Work]].concat(),
        );
        add(Driver::Speed, once());
        add(Driver::TravelSinceReversal, once());
    }
    if force_n > 1.0 {
        add(Driver::Force, [once(), lags(), sliding(force_n), grown()].concat());
    }
    add(Driver::Time, once());
    add(Driver::TimeSinceLastMove { above_m_per_s, above_pa_per_s }, once());
    add(Driver::TimeSincePressureMoved { above_pa_per_s }, once());
    add(Driver::Cycle, once());
    words
}

fn once() -> Vec<Recall> {
    vec![Recall::None]
}

fn lags() -> Vec<Recall> {
    LAGS_S.iter().map(|&time_constant_s| Recall::Lag { time_constant_s }).collect()
}

fn two_lags() -> Vec<Recall> {
    TWO_LAGS_S.iter().map(|&constant_s| Recall::TwoLags { time_constants_s: [constant_s; 2] }).collect()
}

fn sliding(range: f64) -> Vec<Recall> {
    let plays = PLAYS.iter().map(|share| Recall::Play { half_width: share * range });
    plays.chain(DISTANCES.iter().map(|share| Recall::Dahl { distance: share * range })).collect()
}

fn grown() -> Vec<Recall> {
    vec![Recall::Largest, Recall::Travelled]
}

/// `memory` with its numbers `factor` times as large, within what can be told apart from nothing.
pub(super) fn stretched(memory: Recall, factor: f64) -> Recall {
    match memory {
        Recall::Lag { time_constant_s } => Recall::Lag { time_constant_s: time_constant_s * factor },
        Recall::TwoLags { time_constants_s } => {
            Recall::TwoLags { time_constants_s: time_constants_s.map(|constant_s| constant_s * factor) }
        }
        Recall::Play { half_width } => Recall::Play { half_width: half_width * factor },
        Recall::Dahl { distance } => Recall::Dahl { distance: distance * factor },
        Recall::None | Recall::Largest | Recall::Travelled | Recall::Work => memory,
    }
}

/// `n` knots over rising values, half by distance and half by number; fewer where they repeat, none where nothing varies.
pub(super) fn knots(sorted: &[f64], n: usize) -> Vec<f64> {
    let (Some(&first), Some(&end)) = (sorted.first(), sorted.last()) else { return Vec::new() };
    let last = sorted.len() - 1;
    let (low, high) = (sorted[last / 500], sorted[last - last / 500]);
    if !(end > first && high > low) {
        return Vec::new();
    }
    let mut knots: Vec<f64> = (0..n)
        .map(|index| {
            let share = index as f64 / (n - 1) as f64;
            let inside = last / 500 + (share * (last - 2 * (last / 500)) as f64) as usize;
            0.6 * (low + share * (high - low)) + 0.4 * sorted[inside]
        })
        .collect();
    knots.dedup_by(|next, before| *next - *before <= 2e-3 * (high - low));
    knots
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knots_rise_and_nothing_that_rests_has_any() {
        let sorted: Vec<f64> = (0..1000).map(|index| (f64::from(index) / 1000.0).powi(3)).collect();
        let found = knots(&sorted, 8);
        assert!(found.len() == 8 && found.windows(2).all(|pair| pair[0] < pair[1]), "{found:?}");
        assert!(knots(&[2.0; 100], 8).is_empty() && knots(&[], 8).is_empty());
    }

    #[test]
    fn only_what_has_numbers_is_stretched() {
        assert_eq!(stretched(Recall::Lag { time_constant_s: 0.3 }, 2.0), Recall::Lag { time_constant_s: 0.6 });
        assert_eq!(stretched(Recall::Largest, 2.0), Recall::Largest);
    }
}
