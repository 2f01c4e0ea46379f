//! Sizes and verdicts of searches whose outcome is made up.

use pam_muscle::effects::effect;

use super::*;
use crate::hypothesis::{Beginning, CandidateEffect, Sign};
use crate::joint::HeldOut;
use crate::rehearsal::tests::Given;
use crate::search::search;
use crate::state::Setting;
use crate::trial::Trial;

/// A search that took nothing, in a muscle that lacks nothing.
pub(super) fn nothing() -> Found {
    let mut given = Given::of(&["multisine"], &[]);
    given.disturb();
    let setting = Setting { floor_square: 0.09, ..given.setting() };
    search(&setting, &given.start, &given.model, &Limits::of_test(0, 0.3), &|| {}).expect("a search")
}

fn guess(id: &str) -> CandidateEffect {
    let effect = effect(id).expect("an id");
    let shape = effect.shape().iter().map(|parameter| parameter.grid[0]).collect();
    CandidateEffect { effect, shape, sign: Sign::Any, beginning: Beginning::Fresh }
}

fn held(square: f64) -> HeldOut {
    HeldOut { blocks: vec![square; 8], counts: vec![10.0; 8], floor_square: 0.0 }
}

/// `found` with a lag that leaves 1 of 4 N², with rivals that leave so much of it, of so much evidence: those of the lag are
/// eight times ln 4.
pub(super) fn lag_with(found: &mut Found, rivals: &[(&str, f64, f64)]) {
    found.best.state.guesses = vec![guess("pressure-lag")];
    let rivals = rivals.iter().map(|&(id, left, log_ratio)| Trial {
        held_out: held(left),
        log_ratio,
        ..Trial::gaining_nothing(guess(id), left, &held(4.0))
    });
    found.taken = vec![Taken { without: held(4.0), with: held(1.0), rivals: rivals.collect(), is_confirmed: false }];
}

/// A mismatch of 10 N over a floor of 1 N, all of it explained.
pub(crate) const SIZES: Sizes = Sizes {
    floor_n: 1.0,
    mismatch_n: 10.0,
    left_n: 0.0,
    matters_n: 1.0,
    structured_share: 0.9,
    floor_square: 1.0,
    best_n: 1.0,
    sensors_n: 1.0,
    static_n: None,
    limited: false,
};

#[test]
fn what_is_left_is_a_share_of_mean_squares_and_never_more_than_all() {
    assert_eq!(Sizes { left_n: 5.0, ..SIZES }.share_left(), 0.25);
    assert_eq!(Sizes { left_n: 20.0, ..SIZES }.share_left(), 1.0);
    assert_eq!(Sizes { left_n: 5.0, mismatch_n: 0.0, ..SIZES }.share_left(), 0.0);
    assert!(!Sizes { left_n: 8.1, ..SIZES }.most_is_left());
    assert!(Sizes { left_n: 8.2, ..SIZES }.most_is_left());
}

#[test]
fn what_knocks_explain_besides_adds_to_the_mismatch_in_squares() {
    let with = Sizes { left_n: 3.0, ..SIZES }.with(7.5);
    assert_eq!((with.mismatch_n, with.left_n), (12.5, 3.0));
}

#[test]
fn what_is_unexplained_is_what_the_best_hypothesis_leaves_above_the_floor() {
    assert!((Sizes { best_n: 26.0_f64.sqrt(), ..SIZES }.share_unexplained() - 0.25).abs() < 1e-12);
    assert_eq!(Sizes { best_n: 0.5, ..SIZES }.share_unexplained(), 0.0);
    assert_eq!(Sizes { best_n: 50.0, ..SIZES }.share_unexplained(), 1.0);
    assert_eq!(Sizes { best_n: 5.0, mismatch_n: 0.0, ..SIZES }.share_unexplained(), 0.0);
}

#[test]
fn sizes_are_those_of_the_search_beyond_its_floor() {
    let mut found = nothing();
    (found.floor_square, found.base.held_out, found.whole.held_out) = (0.16, held(25.0), held(9.0));
    (found.best.held_out, found.form_square) = (held(4.0), 15.0);
    found.left.as_mut().expect("structure").held_out = held(1.75);
    let limits = Limits::of_test(0, 0.3);
    let sizes = Sizes::of(&found, &limits);
    assert!((sizes.floor_n - 0.5).abs() < 1e-12);
    // Half as much again as the floor.
    assert!((sizes.matters_n - 0.5 * 1.25_f64.sqrt()).abs() < 1e-12);
    assert!((sizes.mismatch_n - (9.0_f64 - 0.16).sqrt()).abs() < 1e-12, "beside a static map");
    assert!((sizes.structured_share - (9.0 - 0.16) / 9.0).abs() < 1e-12);
    assert!((sizes.left_n - 1.5).abs() < 1e-12);
    assert_eq!((sizes.best_n, sizes.sensors_n, sizes.limited), (2.0, 0.3, false));
    assert_eq!(sizes.static_n, Some(4.0));
    let told = Sizes::of(&found, &Limits { matters_above_n: Some(3.0), ..limits });
    assert_eq!((told.matters_n, told.limited), (3.0, true));
}

#[test]
fn a_static_map_that_takes_no_more_than_of_any_muscle_is_none() {
    let mut found = nothing();
    (found.base.held_out, found.whole.held_out, found.form_square) = (held(25.0), held(9.0), 17.0);
    assert_eq!(beyond_form(&found), None);
    found.form_square = 16.0;
    assert_eq!(beyond_form(&found), None, "as much is not more");
    found.left = None;
    assert_eq!(Sizes::of(&found, &Limits::of_test(0, 0.3)).left_n, 0.0);
}

#[test]
fn without_a_name_a_muscle_is_consistent_unless_something_is_missing() {
    let found = nothing();
    let quiet = Sizes { mismatch_n: 1.0, best_n: 2.5, ..SIZES };
    assert_eq!(verdict(&found, &quiet, false), Verdict::Consistent);
    assert_eq!(verdict(&found, &Sizes { mismatch_n: 1.1, ..quiet }, false), Verdict::Unexplained);
    assert_eq!(verdict(&found, &Sizes { best_n: 2.6, ..quiet }, false), Verdict::Unexplained, "beyond the sensors");
    assert_eq!(
        verdict(&found, &Sizes { best_n: 2.6, limited: true, ..quiet }, false),
        Verdict::Consistent,
        "said not to matter"
    );
    assert_eq!(verdict(&found, &Sizes { static_n: Some(3.0), ..quiet }, false), Verdict::Unexplained);
    let mut let_go = Found { stand_ins: vec!["slack"], ..found };
    assert_eq!(verdict(&let_go, &quiet, false), Verdict::Unexplained, "what called up a name is there");
    (let_go.stand_ins, let_go.unheard_of) = (Vec::new(), vec!["force-drift"]);
    assert_eq!(verdict(&let_go, &quiet, false), Verdict::Unexplained, "and what fits with no shape that is known");
    (let_go.unheard_of, let_go.replaced) = (Vec::new(), vec!["stribeck"]);
    assert_eq!(verdict(&let_go, &quiet, false), Verdict::Unexplained, "and what a term says better");
    (let_go.replaced, let_go.as_well) = (Vec::new(), vec![("presliding-hysteresis", &crate::nameless::RIG)]);
    assert_eq!(verdict(&let_go, &quiet, false), Verdict::Unexplained, "and what the rig may do");
    (let_go.as_well, let_go.nameless) = (Vec::new(), vec![("fatigue-wear", "a clamp that creeps")]);
    assert_eq!(
        verdict(&let_go, &quiet, false),
        Verdict::Unexplained,
        "and what a force without a name explains better"
    );
}

#[test]
fn a_mass_that_knocks_is_a_name() {
    assert_eq!(verdict(&nothing(), &SIZES, true), Verdict::Explained);
}

#[test]
fn a_name_explains_unless_much_is_left_that_matters() {
    let mut found = nothing();
    lag_with(&mut found, &[]);
    let left = |left_n, mismatch_n| verdict(&found, &Sizes { left_n, mismatch_n, ..SIZES }, false);
    assert_eq!(left(0.0, 10.0), Verdict::Explained);
    // More than matters, but hardly anything of the mismatch.
    assert_eq!(left(1.1, 10.0), Verdict::Explained);
    assert_eq!(left(2.9, 10.0), Verdict::Unexplained, "a twelfth of it");
    // A third of the mismatch, where half of what matters is left and where less is.
    assert_eq!(left(0.6, 1.0), Verdict::Unexplained);
    assert_eq!(left(0.49, 0.8), Verdict::Explained);
    assert_eq!(left(0.6, 1.2), Verdict::Explained, "a quarter");
}

#[test]
fn a_rival_that_explains_nearly_as_much_makes_a_name_ambiguous() {
    let own = 8.0 * 4.0_f64.ln();
    let mut found = nothing();
    // The catalogue says that a delay looks like a lag; of damping it says nothing, so that it has to come nearer.
    for (id, share) in [("channel-delay", DECLARED_RIVAL), ("viscous-damping", RIVAL)] {
        let mut of = |gained: f64, evidence: f64| {
            lag_with(&mut found, &[(id, 4.0 - 3.0 * gained, evidence * own)]);
            alternatives(&found, 0)
        };
        assert_eq!(of(share + 0.01, share + 0.01), [id]);
        assert!(of(share - 0.01, share + 0.01).is_empty(), "{id} gains less");
        assert!(of(share + 0.01, share - 0.01).is_empty(), "{id} has less evidence");
        assert!(of(share + 0.01, share).is_empty(), "{id} has no more");
    }
    lag_with(&mut found, &[("channel-delay", 1.0, own)]);
    assert_eq!(verdict(&found, &SIZES, false), Verdict::Ambiguous);
    assert!(alternatives(&found, 1).is_empty(), "nothing was taken there");
    lag_with(&mut found, &[("pressure-lag", 1.0, own)]);
    assert!(alternatives(&found, 0).is_empty(), "another shape of its own");
}
