//! What gives way and what stays, to the edge.

use super::*;
use crate::rehearsal::tests::Given;

fn of(given: &Given, id: &str, shape: &[f64]) -> Judged {
    let setting = given.setting();
    let state = setting.fit(vec![given.guess(id, shape)], &given.start, &given.model).expect("a fit");
    judged(&setting, state).expect("a fit of every fold")
}

#[test]
fn as_much_evidence_as_is_asked_of_a_rival_is_no_better() {
    // Beside nothing, a tenth.
    assert!(!is_better(0.1, 0.0) && is_better(0.1 + 1e-12, 0.0));
}

#[test]
fn a_shape_without_which_as_much_is_lost_as_noise_would_lose_says_something() {
    // A sixteenth of sixteen rows, and the least share of any number of them.
    assert!(!is_nothing(16.0, 0.0625) && is_nothing(15.9, 0.0625));
    assert!(!is_nothing(1e6, WORTH_A_SHAPE));
}

#[test]
fn a_time_that_cannot_be_zero_does_not_rest_there() {
    // Nothing lags, so that no time of a lag, and no mass of air, is told from any other.
    let mut given = Given::of(&["isobaric-triangles"], &[]);
    given.disturb();
    let rested = at_rest(&given.setting(), of(&given, "pressure-lag", &[1e-3, 0.1])).expect("a fit");
    assert_eq!(rested.state.guesses[0].shape, [1e-3, 0.0]);
}

#[test]
fn what_has_no_shape_is_polished_already() {
    let mut given = Given::of(&["isobaric-triangles"], &[("viscous-damping", &[], &[300.0, 100.0])]);
    given.disturb();
    let best = of(&given, "viscous-damping", &[]);
    let polished = polished(&given.setting(), best.clone()).expect("a fit");
    assert_eq!(polished.held_out, best.held_out);
    assert_eq!(polished.state.fit.x, best.state.fit.x);
}
