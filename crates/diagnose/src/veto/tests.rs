//! Names that held-out recordings confirm or deny, and those of which they tell nothing.

use pam_muscle::effects::effect;

use super::*;
use crate::joint::HeldOut;
use crate::rehearsal::tests::Given;
use crate::search::{Limits, Taken, search};

/// The share of a lag of 150 ms in `held`, where `fitted` has all of it.
fn seen(held: &Given, fitted: &Given) -> Option<Share> {
    let state = fitted.setting().fit(vec![fitted.guess("pressure-lag", &[0.15, 0.0])], &fitted.start, &fitted.model)?;
    let coordinates = Coordinates::of(&held.track);
    let beside = Nuisance::of_recordings(&held.track, 0.1).with_map(&held.track, &coordinates);
    share(&held.setting().beside(&beside), &state, 0)
}

#[test]
fn an_effect_that_is_held_out_as_well_is_confirmed_and_one_that_is_not_is_denied() {
    let lag: (&'static str, &[f64], &[f64]) = ("pressure-lag", &[0.15, 0.0], &[]);
    let fitted = Given::of(&["isobaric-triangles", "isometric-ramps"], &[lag]);
    let same = Given::of(&["multisine"], &[lag]);
    let other = Given::of(&["multisine"], &[]);
    let (confirmed, denied) = (seen(&same, &fitted).expect("a share"), seen(&other, &fitted).expect("a share"));
    assert!((confirmed.value - 1.0).abs() < 0.1, "{confirmed:?}");
    assert!(denied.most() < SEEN, "{denied:?}");
}

#[test]
fn an_effect_far_below_the_noise_may_be_seen_but_is_not_missed() {
    let lag: (&'static str, &[f64], &[f64]) = ("pressure-lag", &[0.15, 0.0], &[]);
    let fitted = Given::of(&["isobaric-triangles", "isometric-ramps"], &[lag]);
    let guesses = vec![fitted.guess("pressure-lag", &[0.15, 0.0])];
    let state = fitted.setting().fit(guesses, &fitted.start, &fitted.model).expect("a fit");
    // Of recordings of which noise leaves so many times the mean square of the lag itself.
    let seen = |effects: &[(&'static str, &[f64], &[f64])], times: f64| {
        let held = Given::of(&["multisine"], effects);
        let force = |terms| held.track.modelled_n(&AugmentedModel::new(state.model.clone(), terms));
        let own_n = crate::explain::rms(&force(state.terms()), &force(Vec::new()));
        share(&Setting { floor_square: times * own_n * own_n, ..held.setting() }, &state, 0)
    };
    assert!(seen(&[lag], 6.0).expect("it is there").shows());
    assert!(!seen(&[], 2.0).expect("large enough to tell of").shows());
    assert!(seen(&[], 6.0).is_none());
}

#[test]
fn an_effect_that_is_held_out_much_larger_than_it_was_fitted_is_another_one() {
    let damped = |protocols: &[&str], damping: f64| Given::of(protocols, &[("viscous-damping", &[], &[damping])]);
    let fitted = damped(&["isobaric-triangles", "isometric-ramps"], 40.0);
    let state = |given: &Given| {
        given.setting().fit(vec![given.guess("viscous-damping", &[])], &given.start, &given.model).expect("a fit")
    };
    let seen = |damping: f64| {
        let held = damped(&["multisine"], damping);
        share(&held.setting(), &state(&fitted), 0).expect("a share")
    };
    assert!((seen(60.0).value - 1.5).abs() < 0.1 && seen(60.0).least() < MOST_SEEN, "{:?}", seen(60.0));
    assert!(seen(120.0).least() > MOST_SEEN, "{:?}", seen(120.0));
}

#[test]
fn a_further_effect_that_nothing_held_out_tells_stands_on_strong_evidence_alone() {
    let lag: (&'static str, &[f64], &[f64]) = ("pressure-lag", &[0.15, 0.0], &[]);
    let damping: (&'static str, &[f64], &[f64]) = ("viscous-damping", &[], &[120.0]);
    let mut given = Given::of(&["isobaric-triangles", "isometric-ramps", "multisine"], &[lag, damping]);
    given.disturb();
    let limits = Limits { confirmed: true, ..Limits::of_test(2, 0.3) };
    let setting = Setting { floor_square: 0.09, ..given.setting() };
    let mut found = search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search");
    assert_eq!(found.taken.len(), 2, "{:?}", found.best.state.guesses);
    let seen = Some(Share { value: 1.0, error: 0.05 });
    let absent = Some(Share { value: 0.0, error: 0.1 });
    let further = (0..2).min_by(|&one, &other| found.evidence(one).total_cmp(&found.evidence(other)));
    let further = further.expect("two effects");
    let with = |share| if further == 0 { [share, seen] } else { [seen, share] };
    assert!(found.evidence(further) > STANDS_ALONE);
    assert!(denied(&found, &with(None)).is_none());
    assert!(denied(&found, &with(Some(Share { value: 0.1, error: 2.0 }))).is_none());
    assert_eq!(denied(&found, &with(absent)).map(|denied| denied.index), Some(further));
    // What was left without it is hardly more.
    found.taken[further].without = found.taken[further].with.clone();
    assert_eq!(denied(&found, &with(None)).map(|denied| denied.index), Some(further));
    assert_eq!(strongest(&found, &with(None)), Some(1 - further));
    // Of two that nothing shows, the weaker one, whichever was found first.
    let third = found.best.state.guesses[further].clone();
    found.best.state.guesses.push(third);
    let mut taken = found.taken[further].clone();
    taken.without.blocks.iter_mut().for_each(|square| *square *= 1.1);
    found.taken.push(taken);
    assert!(found.evidence(2) > found.evidence(further) && found.evidence(2) < STANDS_ALONE);
    let shares = [with(None).as_slice(), &[None]].concat();
    assert_eq!(denied(&found, &shares).map(|denied| denied.index), Some(further));
    found.taken.swap(2, further);
    assert_eq!(denied(&found, &shares).map(|denied| denied.index), Some(2));
}

#[test]
fn evidence_beyond_a_limit_is_enough_but_never_for_a_static_effect() {
    let stands = |id: &str, evidence, chance| stands_on_evidence(effect(id).expect("an id"), evidence, chance);
    for id in ["pressure-lag", "force-drift"] {
        assert!(!stands(id, STANDS_ALONE, 1e-3) && stands(id, STANDS_ALONE + 1e-9, 1e-3));
    }
    assert!(stands("pressure-lag", STANDS_ALONE + 1e-9, 0.5));
    assert!(!stands("force-drift", OUTLASTS_ALONE, 0.02) && stands("force-drift", OUTLASTS_ALONE + 1e-9, 0.02));
    assert!(!stands("threshold-pressure", 1e3, 0.0));
    let unheard_of = |id: &str, evidence| stands_unheard_of(effect(id).expect("an id"), evidence);
    assert!(!unheard_of("pressure-lag", OUTLASTS_ALONE) && unheard_of("pressure-lag", OUTLASTS_ALONE + 1e-9));
    assert!(!unheard_of("threshold-pressure", 1e3));
}

#[test]
fn what_other_recordings_cannot_show_stands_on_strong_evidence_alone() {
    let stands = |id: &str, shape: &[f64], times: f64| {
        let given = Given::of(&["multisine"], &[]);
        let limits = Limits::of_test(0, 0.1);
        let plain = given.setting();
        let mut found = search(&plain, &given.start, &given.model, &limits, &|| {}).expect("a search");
        let state = plain.fit_near(vec![given.guess(id, shape)], &found.best.state).expect("a fit");
        found.best.state = state;
        let held = |square| HeldOut { blocks: vec![square; 10], counts: vec![10.0; 10], floor_square: 0.0 };
        let (without, with) = (held(times), held(1.0));
        found.taken = vec![Taken { without, with, rivals: Vec::new(), is_confirmed: false }];
        stands_unseen(&found)
    };
    // Ten blocks of a ninth are 22, of a fifth 16.
    assert!(stands("force-step", &[0.0, 5.0], 9.0) && stands("thermal-softening", &[300.0, 0.0], 9.0));
    assert!(!stands("force-step", &[0.0, 5.0], 5.0) && !stands("pressure-lag", &[0.15, 0.0], 9.0));
}

#[test]
fn what_outlasts_a_recording_and_leads_all_others_beyond_doubt_is_not_denied_by_its_size_elsewhere() {
    let lag: (&'static str, &[f64], &[f64]) = ("pressure-lag", &[0.15, 0.0], &[]);
    let mut given = Given::of(&["isobaric-triangles", "isometric-ramps", "multisine"], &[lag]);
    given.disturb();
    let limits = Limits { confirmed: true, ..Limits::of_test(1, 0.3) };
    let setting = Setting { floor_square: 0.09, ..given.setting() };
    let mut found = search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search");
    let held = |square| HeldOut { blocks: vec![square; 10], counts: vec![10.0; 10], floor_square: 0.0 };
    let (before, after) = (held(9.0), held(1.0));
    let wobbles = |held: HeldOut| HeldOut {
        blocks: held.blocks.iter().enumerate().map(|(at, block)| block * (1.0 + 0.1 * (at % 3) as f64)).collect(),
        ..held
    };
    let own = found.first.iter().position(|trial| trial.guess.id() == "force-drift").expect("a trial");
    let name = |found: &mut Found, id: &str, shape: &[f64]| {
        found.first[own].guess = given.guess(id, shape);
        found.best.state.guesses[0] = given.guess(id, shape);
    };
    name(&mut found, "force-drift", &[120.0]);
    (found.first[own].before, found.first[own].held_out) = (before.clone(), wobbles(after.clone()));
    (found.taken[0].without, found.taken[0].with) = (before, after);
    let absent = [Some(Share { value: 0.0, error: 0.1 })];
    let leads = |found: &mut Found, log_ratio: f64, other: f64| {
        found.first.iter_mut().for_each(|trial| trial.log_ratio = other);
        found.first[own].log_ratio = log_ratio;
        assert_eq!(leads_beyond_doubt(found, 0), denied(found, &absent).is_none());
        leads_beyond_doubt(found, 0)
    };
    assert!(leads(&mut found, OVERWHELMING, OVERWHELMING - 0.1));
    assert!(!leads(&mut found, OVERWHELMING - 0.1, 0.0), "chance or another may give it");
    assert!(!leads(&mut found, OVERWHELMING, OVERWHELMING + 0.1), "another explains more");
    found.looked_at_all = false;
    assert!(!leads(&mut found, OVERWHELMING, 0.0), "what was excluded may explain more");
    found.looked_at_all = true;
    name(&mut found, "pressure-lag", &[0.15, 0.0]);
    assert!(!leads(&mut found, OVERWHELMING, 0.0), "a lag is the same in every recording");
    name(&mut found, "force-drift", &[120.0]);
    // Beside what else was found next to nothing is left for it.
    found.taken[0].without = found.taken[0].with.clone();
    assert!(!leads(&mut found, OVERWHELMING, 0.0));
}
