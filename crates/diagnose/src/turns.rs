//! Where friction went the other way than its direction says: beside turns, which noise dates by some samples.
//!
//! What a turn that is dated late leaves is up to twice the friction, tens of times the noise, over a few instants. One in a hundred of
//! these is most of the mean square of a healthy muscle, and hides whatever is smaller. They are told by what eq. 11 leaves of them
//! beside a free static map, and left out of what effects are fitted to and judged by; only beside turns, where nothing but the
//! direction is in doubt, and where an effect that acts after a turn goes on beyond. Laws of standstill are compared with them.

use std::ops::Range;

use pam_muscle::force::ForceModel;

use crate::coordinates::Coordinates;
use crate::nuisance::Nuisance;
use crate::state::Setting;
use crate::track::Track;

/// Time beside an instant whose direction is not settled within which another may be mistaken, in s.
const BESIDE_S: f64 = 0.1;
/// The same as a travel, in m, where the muscle is slow: all in which friction turns over that is no pre-sliding.
const BESIDE_M: f64 = 2e-4;
/// Longest time in which it may take that travel, in s.
const LONGEST_S: f64 = 1.0;
/// A muscle that takes longer for that travel, in s, rests: what is left there is something else.
const RESTS_S: f64 = 0.5;
/// Robust deviations of what is left of its recording beyond which an instant is mistaken: one in sixteen thousand by chance.
const SURELY: f64 = 4.0;
/// Times that what is mistaken is looked for, beside a fit without it.
const ROUNDS: usize = 5;
/// Deviations of a normal distribution in its median of sizes.
const PER_MEDIAN: f64 = 1.4826;

/// The track of `setting` without instants beside turns whose direction is mistaken.
pub(crate) fn without_mistaken(setting: &Setting<'_>, start: &[f64], model: &ForceModel, floor_n: f64) -> Track {
    let beside = beside(setting.track);
    let mut track = setting.track.clone();
    let mut before = Vec::new();
    for _ in 0..ROUNDS {
        let coordinates = Coordinates::of(&track);
        let nuisance = Nuisance::of_recordings(&track, floor_n)
            .with_reversals(&track, &coordinates, model)
            .with_free_map(&track, &coordinates);
        let fitted = Setting { track: &track, nuisance: &nuisance, ..*setting };
        let Some(state) = fitted.fit(Vec::new(), start, model) else { break };
        // What a mistaken neighbor made of an instant is taken back.
        let mistaken = mistaken(setting.track, &beside, &fitted.residuals_n(&state));
        if mistaken == before {
            break;
        }
        track.counted.clone_from(&setting.track.counted);
        mistaken.iter().for_each(|&at| track.counted[at] = false);
        track.sample();
        before = mistaken;
    }
    track
}

/// Counted instants of `track` that lie `beside` a turn and are left by far more than others.
fn mistaken(track: &Track, beside: &[bool], residuals_n: &[f64]) -> Vec<usize> {
    let mut found = Vec::new();
    for range in &track.recordings {
        let counted = range.clone().filter(|&at| track.counted[at]);
        let Some(typical_n) = typical_n(counted.clone().map(|at| residuals_n[at])) else { continue };
        found.extend(counted.filter(|&at| beside[at] && residuals_n[at].abs() > SURELY * typical_n));
    }
    found
}

/// Deviation of a normal distribution with the median size of what is `left`, in its unit, which does not care for a few stretches; none
/// where there is nothing.
pub(crate) fn typical_n(left: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sizes: Vec<f64> = left.map(f64::abs).collect();
    let middle = sizes.len() / 2;
    (!sizes.is_empty()).then(|| PER_MEDIAN * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Which instants of `track` lie beside one whose direction is not settled, or beside the beginning of a recording, or where the
/// muscle slows down so far that its friction may turn over for a moment; none at rest, where the pressure turns friction over and
/// says so itself.
fn beside(track: &Track) -> Vec<bool> {
    let mut beside = vec![false; track.n()];
    for range in &track.recordings {
        mark(track, range, range.clone(), &mut beside);
        mark(track, range, range.clone().rev(), &mut beside);
        for at in range.clone() {
            let stays = |for_s: f64| stays(track, range, at, 0.5 * for_s);
            beside[at] = (beside[at] || stays(BESIDE_S)) && !stays(RESTS_S);
        }
    }
    beside
}

/// Whether the length stays within [`BESIDE_M`] of what it is at instant `at`, so long to either side.
fn stays(track: &Track, range: &Range<usize>, at: usize, within_s: f64) -> bool {
    let here = &track.instants[at].moment;
    let stays = |other: usize| (track.instants[other].moment.length_m - here.length_m).abs() < BESIDE_M;
    let near = |other: &usize| (track.instants[*other].moment.time_s - here.time_s).abs() <= within_s;
    (range.start..at).rev().take_while(near).all(stays) && (at..range.end).take_while(near).all(stays)
}

/// Marks the instants of `range` within reach of the last unsettled one before them, in the order of `instants`.
fn mark(track: &Track, range: &Range<usize>, instants: impl Iterator<Item = usize>, beside: &mut [bool]) {
    let mut last = range.start;
    for at in instants {
        if !track.counted[at] {
            last = at;
            continue;
        }
        let (here, there) = (&track.instants[at].moment, &track.instants[last].moment);
        let away_s = (here.time_s - there.time_s).abs();
        let is_slow = away_s < LONGEST_S && (here.length_m - there.length_m).abs() < BESIDE_M;
        beside[at] |= away_s < BESIDE_S || is_slow;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    fn trimmed(given: &Given) -> Track {
        without_mistaken(&given.setting(), &given.start, &given.model, 0.3)
    }

    /// Instants that were counted before and are not any more.
    fn left_out(given: &Given) -> Vec<usize> {
        let after = trimmed(given);
        (0..after.n()).filter(|&at| given.track.counted[at] && !after.counted[at]).collect()
    }

    /// The two counted instants after every third turn.
    fn after_turns(track: &Track) -> Vec<usize> {
        let is_first = |at: &usize| track.counted[*at] && !track.counted[*at - 1];
        let turns = (1..track.n() - 1).filter(is_first).step_by(3);
        turns.flat_map(|at| [at, at + 1]).filter(|&at| track.counted[at]).collect()
    }

    fn given() -> Given {
        let mut given = Given::of(&["isobaric-triangles", "multisine"], &[]);
        given.disturb();
        given
    }

    #[test]
    fn nothing_is_mistaken_where_friction_turns_as_its_direction_says() {
        assert_eq!(left_out(&given()), Vec::<usize>::new());
    }

    #[test]
    fn a_turn_that_is_dated_early_is_left_out_and_hardly_anything_else() {
        let mut given = given();
        let mut late = after_turns(&given.track);
        let beside = beside(&given.track);
        late.retain(|&at| beside[at] && given.track.instants[at].moment.direction.abs() > 0.5);
        for &at in &late {
            let direction = given.track.instants[at].moment.direction;
            given.track.instants[at].force_n += 2.0 * 12.0 * direction;
        }
        assert!(late.len() > 20);
        let left_out = left_out(&given);
        assert!(late.iter().all(|at| left_out.contains(at)), "{left_out:?}");
        assert!(left_out.len() * 5 < late.len() * 6, "{} for {}", left_out.len(), late.len());
    }

    #[test]
    fn a_knock_far_from_every_turn_stays() {
        let mut given = given();
        let beside = beside(&given.track);
        let far = (0..given.track.n()).filter(|&at| given.track.counted[at] && !beside[at]).step_by(97);
        far.for_each(|at| given.track.instants[at].force_n += 25.0);
        assert_eq!(left_out(&given), Vec::<usize>::new());
    }
}
