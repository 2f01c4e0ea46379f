//! Later recordings may go where the model of then was never asked: nothing is compared there.

use pam_artifact::model::Domain;

use crate::track::Track;

/// Share of a channel's range that a recording may go beyond it.
const BEYOND: f64 = 0.03;

/// Leaves out of `track` what lies outside of `domain`; the share of what counted that is left.
pub(crate) fn keep_within(track: &mut Track, domain: &Domain) -> f64 {
    let before = track.n_counted();
    let within = |[low, high]: [f64; 2], value: f64| {
        let slack = BEYOND * (high - low);
        (low - slack..=high + slack).contains(&value)
    };
    for (instant, counted) in track.instants.iter().zip(&mut track.counted) {
        let moment = &instant.moment;
        *counted =
            *counted && within(domain.pressure_pa, moment.pressure_pa) && within(domain.length_m, moment.length_m);
    }
    track.sample();
    track.n_counted() as f64 / before.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::{Given, domain};

    #[test]
    fn what_lies_beyond_the_pressures_of_then_is_not_compared() {
        let mut given = Given::of(&["isobaric-triangles"], &[]);
        let narrow = Domain { pressure_pa: [0.0, 2.5e5], ..domain() };
        let share = keep_within(&mut given.track, &narrow);
        assert!(share > 0.1 && share < 0.9, "{share}");
        let highest = 2.5e5 * (1.0 + BEYOND) + 1.0;
        let mut kept = given.track.instants.iter().zip(&given.track.counted).filter(|(_, counted)| **counted);
        assert!(kept.all(|(instant, _)| instant.moment.pressure_pa <= highest));
    }
}
