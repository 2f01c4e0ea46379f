//! What a trial is worth, and where it looks.

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

#[test]
fn evidence_is_charged_for_freedom_ends_pressing_and_events() {
    let kept = |id: &str, shape: &[f64], is_pressed, beginnings| share_kept(&guess(id, shape), is_pressed, beginnings);
    assert_eq!(kept("pressure-lag", &[0.1, 0.0], false, 0), 0.98);
    assert!((kept("pressure-lag", &[0.1, 0.0], false, 3) - 0.92).abs() < 1e-12, "each beginning is a parameter");
    assert!((kept("rubber-hysteresis", &[2e-3], true, 0) - 0.7 * 0.98).abs() < 1e-12);
    assert!((kept("rubber-hysteresis", &[1e-4], false, 0) - 0.2 * 0.98).abs() < 1e-12);
    assert!((kept("force-step", &[0.0, 5.0], false, 0) - 0.5 * 0.96).abs() < 1e-12);
}

#[test]
fn a_step_is_half_the_way_to_the_nearer_neighbor() {
    let grid = [1.0, 2.0, 4.0, 8.0];
    let step = |value| step_around(&grid, (0.5, 10.5), value);
    assert_eq!((step(2.0), step(4.0), step(7.0)), (0.5, 1.0, 0.5));
    // At the upper end to the only one, at the lower as far as a value of its size goes.
    assert_eq!((step(8.0), step(1.0)), (2.0, 0.5));
    assert!((step(0.25) - 0.125).abs() < 1e-12 && (step(0.0) - 0.05).abs() < 1e-12);
    // On a grid of one point, a share of the value or of the range.
    assert!((step_around(&[3.0], (0.0, 10.0), 3.0) - 0.45).abs() < 1e-12);
    assert!((step_around(&[0.0], (0.0, 10.0), 0.0) - 0.03).abs() < 1e-12);
}

/// Whether rubber hysteresis of `width_n`, or a taper, presses where it is fitted to recordings that have it.
fn is_pressed(id: &'static str, shape: &'static [f64], amplitudes: &'static [f64]) -> bool {
    let given = Given::of(&PROTOCOLS, &[(id, shape, amplitudes)]);
    weigh(&given.setting(), &base(&given), &guess(id, shape), &[]).expect("a fit").1
}

#[test]
fn an_amplitude_presses_at_the_largest_that_physics_has_and_not_at_nothing() {
    assert!(!is_pressed("rubber-hysteresis", &[2e-3], &[20.0]));
    assert!(!is_pressed("rubber-hysteresis", &[2e-3], &[0.0]));
    assert!(is_pressed("rubber-hysteresis", &[2e-3], &[400.0]));
    assert!(is_pressed("force-step", &[1.0, 5.0], &[-900.0]), "at either end, where it may have either sign");
}

#[test]
fn what_acts_through_the_base_has_no_amplitude_that_could_press() {
    let given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[])]);
    let (held_out, is_pressed) =
        weigh(&given.setting(), &base(&given), &guess("pressure-lag", &[0.15, 0.0]), &[]).expect("a fit");
    assert!(!is_pressed);
    let before = judged(&given.setting(), base(&given)).expect("folds").held_out;
    assert!(held_out.mean_square() < 0.01 * before.mean_square());
}

#[test]
fn refining_goes_to_where_less_is_left() {
    let given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.2, 0.0], &[])]);
    let (setting, state) = (given.setting(), base(&given));
    let cost = |shape: f64| mean_square(&setting, &state, &guess("pressure-lag", &[shape, 0.0])).expect("a fit");
    for first in [0.16, 0.32] {
        let (left, refined) = refine(&setting, &state, &guess("pressure-lag", &[first, 0.0]), cost(first), 4);
        assert!(left < 0.05 * cost(first), "{first}: {left}");
        assert!((refined.shape[0] - 0.2).abs() < 0.02, "{first}: {:?}", refined.shape);
    }
    // Nothing better, nothing changed; an event is where it was found.
    let (left, same) = refine(&setting, &state, &guess("pressure-lag", &[0.16, 0.0]), -1.0, 1);
    assert_eq!((left, same.shape), (-1.0, vec![0.16, 0.0]));
    let (left, same) = refine(&setting, &state, &guess("force-step", &[0.0, 5.0]), 9.0, 1);
    assert_eq!((left, same.shape), (9.0, vec![0.0, 5.0]));
}

/// Trials on top of `state` in `given`, of the ids in `takes`; `known` are shapes.
fn trials(given: &Given, state: &State, known: &Shapes, takes: &[&str]) -> Vec<Trial> {
    let setting = Setting { floor_square: 0.09, ..given.setting() };
    let before = judged(&setting, state.clone()).expect("folds").held_out;
    let seen = Seen::of(given.track.instants.iter());
    among(&setting, state, &before, &seen, known, &|effect| takes.contains(&effect.page().id))
}

#[test]
fn every_effect_that_may_be_taken_is_tried_once_and_the_best_is_first() {
    let mut given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[])]);
    given.disturb();
    let ids = ["channel-delay", "pressure-lag", "rubber-hysteresis", "force-drift", "mullins-softening"];
    let found = trials(&given, &base(&given), &Shapes::new(), &ids);
    assert_eq!(found[0].guess.id(), "pressure-lag");
    assert!((found[0].guess.shape[0] - 0.15).abs() < 0.02, "{:?}", found[0].guess.shape);
    assert!(found[0].log_ratio > 5.0);
    assert!(found.is_sorted_by(|left, right| left.log_ratio >= right.log_ratio));
    let mut tried: Vec<&str> = found.iter().map(|trial| trial.guess.id()).collect();
    tried.sort_unstable();
    tried.dedup();
    assert_eq!(tried.len(), found.len());
    assert!(tried.iter().all(|id| ids.contains(id)));
}

#[test]
fn what_is_in_already_is_not_tried_again() {
    let mut given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[])]);
    given.disturb();
    let state = with(&given.setting(), &base(&given), &guess("pressure-lag", &[0.15, 0.0]), &[]).expect("a fit");
    assert_eq!(state.guesses.len(), 1);
    assert!(trials(&given, &state, &Shapes::new(), &["pressure-lag"]).is_empty());
}

#[test]
fn what_gains_nothing_has_no_evidence_and_leaves_what_was_left() {
    let mut given = Given::of(&PROTOCOLS, &[]);
    given.disturb();
    let found = trials(&given, &base(&given), &Shapes::new(), &["pressure-lag"]);
    assert_eq!(found.len(), 1);
    assert!(found[0].log_ratio < 0.5, "{}", found[0].log_ratio);
}

#[test]
fn a_shape_that_was_best_before_is_where_a_trial_begins() {
    let mut given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[])]);
    given.disturb();
    // From a shape far away, refining does not reach the best.
    let known = Shapes::from([("pressure-lag", vec![0.9, 0.0])]);
    let found = trials(&given, &base(&given), &known, &["pressure-lag"]);
    assert!(found[0].guess.shape[0] > 0.3, "{:?}", found[0].guess.shape);
}
