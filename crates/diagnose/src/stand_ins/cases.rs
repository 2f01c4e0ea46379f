//! Names that are let go of, and those that stay.

use pam_muscle::effects::effect;

use super::*;
use crate::hypothesis::{Beginning, Sign};
use crate::joint::HeldOut;
use crate::rehearsal::tests::Given;
use crate::search::Taken;
use crate::trial::Trial;

/// Recordings of a muscle with a lag, and a search of them that took `guess`.
struct Desk {
    given: Given,
}

impl Desk {
    fn new() -> Self {
        Self { given: Given::of(&["multisine"], &[("pressure-lag", &[0.15, 0.0], &[])]) }
    }

    /// Asks of a search that took `guesses`.
    fn ask<T>(&self, guesses: Vec<CandidateEffect>, ask: impl FnOnce(&Setting<'_>, Found, &Limits) -> T) -> T {
        self.given.with_found(0.1, guesses, ask)
    }
}

fn guess(id: &str, shape: &[f64]) -> CandidateEffect {
    let effect = effect(id).expect("an id");
    CandidateEffect { effect, shape: shape.to_vec(), sign: Sign::Any, beginning: Beginning::Fresh }
}

fn ids(found: &Found) -> Vec<&'static str> {
    found.best.state.guesses.iter().map(CandidateEffect::id).collect()
}

/// Of `sizes`, with `share` of the mismatch left of the best hypothesis.
fn leaving(sizes: Sizes, share: f64) -> Sizes {
    let mismatch_n = 10.0;
    let best_n = (sizes.floor_square + share * mismatch_n * mismatch_n).sqrt();
    Sizes { mismatch_n, best_n, left_n: 2.0 * sizes.sensors_n, ..sizes }
}

#[test]
fn one_name_that_leaves_more_than_a_third_is_not_believed() {
    let judges = |guesses: Vec<CandidateEffect>, share: f64| {
        Desk::new().ask(guesses, |_, found, limits| leaves_too_much(&found, &leaving(Sizes::of(&found, limits), share)))
    };
    let lag = || guess("pressure-lag", &[0.15, 0.0]);
    assert!(judges(vec![lag()], 0.35) && !judges(vec![lag()], 0.3));
    assert!(!judges(Vec::new(), 0.9), "nothing is named");
    assert!(!judges(vec![lag(), guess("viscous-damping", &[])], 0.9), "two share it");
    assert!(!judges(vec![guess("braid-lockup", &[0.15, 0.01])], 0.9), "the map judges what is static");
    assert!(
        !judges(vec![guess("mullins-softening", &[0.03, 0.5])], 0.9),
        "nobody knows the beginning of what is permanent"
    );
    assert!(!judges(vec![guess("force-step", &[0.0, 5.0])], 0.9), "an event is where it is");
}

#[test]
fn a_shape_where_nothing_published_is_has_no_name() {
    let (any, found) = Desk::new().ask(vec![guess("pressure-lag", &[1.0, 0.0])], |setting, mut found, _| {
        (let_go_of_ends(setting, &mut found), found)
    });
    assert!(any && ids(&found).is_empty());
    assert_eq!((found.unheard_of.as_slice(), found.stand_ins.as_slice()), (["pressure-lag"].as_slice(), [].as_slice()));
    let (any, found) = Desk::new().ask(vec![guess("pressure-lag", &[0.15, 0.0])], |setting, mut found, _| {
        (let_go_of_ends(setting, &mut found), found)
    });
    assert!(!any && found.unheard_of.is_empty());
    assert_eq!(ids(&found), ["pressure-lag"]);
    // Recordings that nothing was fitted to, and strong evidence, know better.
    let let_go_of = |evidence: f64, is_confirmed: bool| {
        Desk::new().ask(vec![guess("pressure-lag", &[1.0, 0.0])], |setting, mut found, _| {
            let held = |square: f64| HeldOut { blocks: vec![square], counts: vec![1.0], floor_square: 0.0 };
            let (without, with) = (held(evidence.exp()), held(1.0));
            found.taken = vec![Taken { without, with, rivals: Vec::new(), is_confirmed }];
            (let_go_of_ends(setting, &mut found), ids(&found).is_empty())
        })
    };
    assert_eq!(let_go_of(0.0, true), (false, false));
    assert_eq!(let_go_of(20.1, false), (false, false));
    assert_eq!(let_go_of(19.9, false), (true, true));
}

#[test]
fn the_only_name_goes_where_another_effect_with_a_memory_explained_more_and_is_not_its_alternative() {
    let lag = || guess("pressure-lag", &[0.15, 0.0]);
    let held = |square: f64| HeldOut { blocks: vec![square], counts: vec![1.0], floor_square: 0.0 };
    let trial = |guess: CandidateEffect, log_ratio: f64| {
        let (before, held_out) = (held(log_ratio.exp()), held(1.0));
        Trial { held_out, ..Trial::gaining_nothing(guess, 1.0, &before) }
    };
    // Where the lag had evidence of 10 in the first look, and another one so much.
    let kept = |guesses: Vec<CandidateEffect>, other: CandidateEffect, log_ratio: f64, is_alternative: bool| {
        Desk::new().ask(guesses, |setting, mut found, _| {
            let rival = Trial { log_ratio: 99.0, ..trial(other.clone(), log_ratio) };
            let rivals = if is_alternative { vec![rival] } else { Vec::new() };
            found.first = vec![trial(lag(), 10.0), trial(other, log_ratio)];
            found.taken = vec![Taken { without: held(10.0), with: held(1.0), rivals, is_confirmed: true }];
            let let_go = let_go_of_outdone(setting, &mut found);
            assert_eq!(let_go, !found.outdone.is_empty());
            ids(&found)
        })
    };
    let damping = || guess("viscous-damping", &[]);
    assert_eq!(kept(vec![lag()], damping(), 10.1, false), Vec::<&str>::new());
    assert_eq!(kept(vec![lag()], damping(), 9.9, false), ["pressure-lag"]);
    assert_eq!(kept(vec![lag()], damping(), 10.1, true), ["pressure-lag"], "it is said that they are not told apart");
    assert_eq!(kept(vec![lag()], guess("slack", &[0.1]), 99.0, false), ["pressure-lag"], "a static one is no rival");
    let two = vec![lag(), damping()];
    assert_eq!(kept(two, guess("channel-delay", &[0.1, 0.0]), 99.0, false), ["pressure-lag", "viscous-damping"]);
}

/// What is left of `guesses` where `share` of the mismatch is unexplained and `left` of it structured; `confirmed` says of the
/// first whether other recordings show it.
fn kept(guesses: Vec<CandidateEffect>, share: f64, left: f64, confirmed: bool) -> Vec<&'static str> {
    Desk::new().ask(guesses, |setting, mut found, limits| {
        let held = || HeldOut { blocks: vec![1.0], counts: vec![1.0], floor_square: 0.0 };
        let taken = |is_confirmed| Taken { without: held(), with: held(), rivals: Vec::new(), is_confirmed };
        found.taken =
            found.best.state.guesses.iter().enumerate().map(|(index, _)| taken(confirmed && index == 0)).collect();
        let sizes = leaving(Sizes::of(&found, limits), share);
        let sizes = Sizes { left_n: 10.0 * left.sqrt(), ..sizes };
        let after = let_go(setting, &mut found, &sizes, limits, None);
        assert_eq!(after, Sizes::of(&found, limits));
        ids(&found)
    })
}

#[test]
fn what_leaves_too_much_is_let_go_of_unless_other_recordings_show_it() {
    let lag = || vec![guess("pressure-lag", &[0.15, 0.0])];
    assert!(kept(lag(), 0.5, 0.01, false).is_empty());
    assert_eq!(kept(lag(), 0.5, 0.01, true), ["pressure-lag"]);
    assert_eq!(kept(lag(), 0.2, 0.01, false), ["pressure-lag"]);
    // A hundredth of a newton is less than the sensors leave.
    assert_eq!(kept(lag(), 0.5, 1e-6, false), ["pressure-lag"]);
}

#[test]
fn strong_evidence_keeps_a_name_that_leaves_much() {
    // Four blocks of which a lag explains so much each.
    let kept = |ratio_of_each: f64| {
        Desk::new().ask(vec![guess("pressure-lag", &[0.15, 0.0])], |setting, mut found, limits| {
            let held = |square: f64| HeldOut { blocks: vec![square; 4], counts: vec![1.0; 4], floor_square: 0.0 };
            let without = held(ratio_of_each.exp());
            found.taken = vec![Taken { without, with: held(1.0), rivals: Vec::new(), is_confirmed: false }];
            let sizes = Sizes { left_n: 1.0, ..leaving(Sizes::of(&found, limits), 0.5) };
            let_go(setting, &mut found, &sizes, limits, None);
            ids(&found)
        })
    };
    assert_eq!(kept(2.6), ["pressure-lag"]);
    assert!(kept(2.4).is_empty());
}

#[test]
fn where_most_is_left_every_name_goes_that_is_not_confirmed() {
    let two = || vec![guess("pressure-lag", &[0.15, 0.0]), guess("viscous-damping", &[])];
    assert!(kept(two(), 0.0, 0.7, false).is_empty());
    assert_eq!(kept(two(), 0.0, 0.7, true), ["pressure-lag"]);
    assert_eq!(kept(two(), 0.0, 0.6, false), ["pressure-lag", "viscous-damping"]);
}

#[test]
fn what_was_found_of_the_names_that_stay_stays_with_them() {
    let guesses = || vec![guess("pressure-lag", &[0.15, 0.0]), guess("viscous-damping", &[])];
    // Names that remain, and what was left without each of them, once the one at `index` is let go of.
    let rest = |index: usize| {
        Desk::new().ask(guesses(), |setting, mut found, _| {
            let held = |square: f64| HeldOut { blocks: vec![square], counts: vec![1.0], floor_square: 0.0 };
            let taken =
                |square| Taken { without: held(square), with: held(1.0), rivals: Vec::new(), is_confirmed: false };
            found.taken = vec![taken(5.0), taken(7.0)];
            assert!(found.let_go(setting, index));
            (ids(&found), found.taken.iter().map(|taken| taken.without.mean_square()).collect::<Vec<_>>())
        })
    };
    assert_eq!(rest(0), (vec!["viscous-damping"], vec![7.0]));
    assert_eq!(rest(1), (vec!["pressure-lag"], vec![5.0]));
}

#[test]
fn a_right_name_stands_for_itself() {
    let left = Desk::new().ask(vec![guess("pressure-lag", &[0.15, 0.0])], |setting, found, _| {
        let whole = found.whole.held_out.mean_square();
        let best = without(setting, found.best.clone(), &found.features, whole, false);
        best.state.guesses.len()
    });
    assert_eq!(left, 1);
}

/// Names that are left of a lag that was called up by a guard that the muscle touches.
fn left_of_a_touch(confirmed: bool) -> usize {
    let mut given = Given::of(&["isobaric-triangles", "multisine"], &[]);
    for instant in &mut given.track.instants {
        instant.force_n += 6.0 * (-((instant.moment.contraction_ratio - 0.05) / 0.012).powi(2)).exp();
    }
    Desk { given }.ask(vec![guess("pressure-lag", &[0.15, 0.0])], |setting, found, _| {
        let whole = found.base.held_out.mean_square();
        without(setting, found.best.clone(), &found.features, whole, confirmed).state.guesses.len()
    })
}

#[test]
fn what_gains_less_than_a_function_of_one_coordinate_stands_in_for_it() {
    assert_eq!(left_of_a_touch(false), 0);
}

#[test]
fn held_out_recordings_judge_a_memory_better_than_structure_does() {
    assert_eq!(left_of_a_touch(true), 1);
}
