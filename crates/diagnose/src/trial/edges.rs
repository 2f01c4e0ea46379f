//! Ends of ranges and neighbors on grids, to the edge, and how a trial comes by its evidence.

use super::*;
use crate::hypothesis::Sign;
use crate::rehearsal::tests::Given;
use crate::search::judged;

const PROTOCOLS: [&str; 2] = ["isobaric-triangles", "multisine"];

fn guess(id: &str, shape: &[f64]) -> CandidateEffect {
    let effect = effect(id).expect("an id");
    CandidateEffect { effect, shape: shape.to_vec(), sign: Sign::Any, beginning: Beginning::Fresh }
}

/// The base alone, fitted to `given`.
fn base(given: &Given) -> State {
    given.setting().fit(Vec::new(), &given.start, &given.model).expect("a fit")
}

/// Trials of `ids` on top of the base in `given`, and what was left before them.
fn trials(given: &Given, ids: &[&str]) -> (Vec<Trial>, HeldOut) {
    let setting = Setting { floor_square: 0.09, ..given.setting() };
    let state = base(given);
    let before = judged(&setting, state.clone()).expect("folds").held_out;
    let seen = Seen::of(given.track.instants.iter());
    let takes = |effect: &dyn Effect| ids.contains(&effect.page().id);
    (among(&setting, &state, &before, &seen, &Shapes::new(), &takes), before)
}

#[test]
fn a_range_on_both_sides_of_zero_has_its_ends_where_it_ends() {
    // A delay of 0.2 s at most to either side; a thousandth of the 0.4 s between them is at the end.
    let delay = effect("channel-delay").expect("an id");
    assert!(wants_another(delay, &[0.1997, 0.0]) && wants_another(delay, &[-0.1997, 0.0]));
    assert!(!wants_another(delay, &[0.1995, 0.0]) && !wants_another(delay, &[-0.1995, 0.0]));
    assert!(!wants_another(delay, &[0.0, 0.0]));
}

#[test]
fn beside_the_lowest_point_of_a_grid_a_step_goes_no_further_than_the_point_or_the_value_is_large() {
    let grid = [2.0, 4.0, 8.0];
    let step = |value| step_around(&grid, (0.0, 10.0), value);
    // Half a unit below the lowest point, and far below it, where a tenth of the point is the least.
    assert!((step(1.5) - 0.25).abs() < 1e-12, "{}", step(1.5));
    assert!((step(0.0) - 0.1).abs() < 1e-12, "{}", step(0.0));
    // A grid of one point: of a value near zero, a share of the width of the range, wherever that lies.
    assert!((step_around(&[3.0], (2.0, 502.0), 3.0) - 0.5 * 0.3 * 10.0).abs() < 1e-12);
}

/// Whether rubber hysteresis of `share` of the largest width that physics has for it presses, in recordings that have it.
fn presses_at(share: f64) -> bool {
    let shape: &[f64] = &[2e-3];
    let largest_n = guess("rubber-hysteresis", shape).amplitudes()[0].range.1;
    let given = Given::of(&PROTOCOLS, &[("rubber-hysteresis", shape, &[share * largest_n])]);
    weigh(&given.setting(), &base(&given), &guess("rubber-hysteresis", shape), &[]).expect("a fit").1
}

#[test]
fn an_amplitude_presses_within_a_thousandth_of_the_largest() {
    assert!(presses_at(0.9995) && !presses_at(0.998));
}

#[test]
fn evidence_is_that_of_blocks_left_out_less_what_an_effect_is_charged() {
    let mut given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[])]);
    given.disturb();
    let (found, before) = trials(&given, &["pressure-lag"]);
    let lag = &found[0];
    let expected = share_kept(&lag.guess, false, 0) * before.log_ratio(&lag.held_out);
    assert!(expected > 5.0 && (lag.log_ratio - expected).abs() < 1e-9 * expected, "{} {expected}", lag.log_ratio);
}

#[test]
fn what_explains_nothing_of_what_it_is_fitted_to_is_not_judged_on_what_it_is_not() {
    let mut given = Given::of(&PROTOCOLS, &[]);
    given.disturb();
    let (found, before) = trials(&given, &["mullins-softening", "threshold-pressure", "rubber-hysteresis"]);
    assert!(!found.is_empty());
    let state = base(&given);
    let sampled = given.setting().sampled();
    let thin = sampled.fit_near(Vec::new(), &state).expect("a fit").fit.mean_square;
    let mut n_idle = 0;
    for trial in &found {
        let is_idle = trial.mean_square > (1.0 - LEAST_GAIN) * thin;
        assert_eq!(is_idle, trial.held_out == before, "{} leaves {} of {thin}", trial.guess.id(), trial.mean_square);
        assert!(!is_idle || trial.log_ratio == 0.0);
        n_idle += usize::from(is_idle);
    }
    assert!(n_idle > 0, "{found:?}");
}

#[test]
fn of_all_shapes_of_an_effect_the_one_that_leaves_least_is_refined() {
    let given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.3, 0.0], &[])]);
    let (found, _) = trials(&given, &["pressure-lag"]);
    assert!((found[0].guess.shape[0] - 0.3).abs() < 0.06, "{:?}", found[0].guess.shape);
    let state = base(&given);
    let sampled = given.setting().sampled();
    let left = |shape: &[f64]| mean_square(&sampled, &state, &guess("pressure-lag", shape)).expect("a fit");
    let seen = Seen::of(given.track.instants.iter());
    let shapes = found[0].guess.effect.first_shapes(&seen);
    assert!(shapes.iter().all(|shape| found[0].mean_square <= left(shape)), "{:?}", found[0].guess.shape);
}

/// Recordings of which the first has a jump of 6 N in its middle, that one alone or all after it as well.
fn stepped(goes_on: bool) -> Given {
    let mut given = Given::of(&["multisine", "isobaric-triangles"], &[]);
    let range = given.track.recordings[0].clone();
    let end = if goes_on { given.track.instants.len() } else { range.end };
    for instant in &mut given.track.instants[range.start + range.len() / 2..end] {
        instant.force_n += 6.0;
    }
    given.disturb();
    given
}

#[test]
fn a_force_that_jumps_is_found_where_it_jumps_and_goes_on_where_later_recordings_have_it() {
    for goes_on in [false, true] {
        let given = stepped(goes_on);
        let middle = given.track.recordings[0].start + given.track.recordings[0].len() / 2;
        let (found, before) = trials(&given, &["force-step", "pressure-lag"]);
        let step = found.iter().find(|trial| trial.guess.id() == "force-step").expect("a trial");
        assert!(step.log_ratio > 1.0 && step.held_out.mean_square() < before.mean_square(), "{step:?}");
        assert_eq!(step.guess.shape[0], 0.0);
        let apart_s = step.guess.shape[1] - given.track.instants[middle].moment.time_s;
        assert!(apart_s.abs() < 0.5, "{apart_s}");
        assert_eq!(matches!(step.guess.beginning, Beginning::GoesOn(_)), goes_on);
    }
}

#[test]
fn a_jump_in_the_last_recording_is_not_said_to_go_on() {
    let mut given = Given::of(&["isobaric-triangles", "multisine"], &[]);
    let range = given.track.recordings.last().expect("recordings").clone();
    for instant in &mut given.track.instants[range.start + range.len() / 2..range.end] {
        instant.force_n += 6.0;
    }
    given.disturb();
    let (found, _) = trials(&given, &["force-step"]);
    let step = found.first().expect("a trial");
    assert!(step.log_ratio > 1.0 && step.guess.shape[0] as usize == given.track.recordings.len() - 1, "{step:?}");
    assert_eq!(step.guess.beginning, Beginning::Fresh);
}

#[test]
fn a_length_that_slips_is_no_jump_of_the_force() {
    let mut given = Given::of(&["multisine", "isobaric-triangles"], &[]);
    let range = given.track.recordings[0].clone();
    for instant in &mut given.track.instants[range.start + range.len() / 2..range.end] {
        instant.force_n += 6.0 * instant.moment.pressure_pa / 3e5;
    }
    given.disturb();
    let (found, before) = trials(&given, &["force-step"]);
    assert!(found.iter().all(|trial| trial.log_ratio == 0.0 && trial.held_out == before), "{found:?}");
}
