use super::*;

use crate::held_error::Left;
use crate::rehearsal::tests::Given;
use crate::search::{Limits, judged, search};
use crate::uncertainty::Uncertainty;

/// Effects on the recordings: id, shape, amplitudes.
type Concealed<'a> = &'a [(&'static str, &'a [f64], &'a [f64])];

/// What is written of `concealed`, named with its own shape, where `left_n` is what a model leaves of every sample held out.
fn settled(concealed: Concealed<'_>, left_n: &dyn Fn(&AugmentedModel) -> f64) -> (Given, Written) {
    let fitted = Given::of(&["isobaric-triangles"], concealed);
    let plain = Setting { floor_square: 0.09, ..fitted.setting() };
    let mut found = search(&plain, &fitted.start, &fitted.model, &Limits::of_test(0, 0.3), &|| {}).expect("a search");
    let guesses = concealed.iter().map(|(id, shape, _)| fitted.guess(id, shape)).collect();
    let state = plain.fit_near(guesses, &found.best.state).expect("a fit");
    found.best = judged(&plain, state).expect("a fit of every fold");
    let state = &found.best.state;
    let folds = plain.fold_fits(state).expect("folds");
    let uncertainty = Uncertainty::of(&folds, plain.space);
    let fit = Fit {
        setting: &plain,
        state,
        found: &found,
        discovery: None,
        besides: &Besides::default(),
        folds: &folds,
        uncertainty: &uncertainty,
        correlated: 1.0,
    };
    let mut written = Written::of(&fit);
    let left = |model: &AugmentedModel| Left::of_each(std::iter::once(vec![(left_n(model), true); 80]));
    written.settle(&fit, HeldAgainst { left: &left, given: &fitted.model });
    (fitted, written)
}

const STEP: (&str, &[f64], &[f64]) = ("force-step", &[0.0, 20.0], &[3.0]);
const DAMPING: (&str, &[f64], &[f64]) = ("viscous-damping", &[], &[4e3, 0.0]);

/// Whether `model` has the effect `id`, in other recordings as well.
fn acts(model: &AugmentedModel, id: &str) -> bool {
    model.elsewhere().terms().iter().any(|term| term.effect.page().id == id)
}

#[test]
fn what_happened_once_is_put_on_the_base_as_given_and_is_nothing_elsewhere() {
    let (fitted, written) = settled(&[STEP], &|_| 1.0);
    assert_eq!(written.base.parameters(), fitted.model.parameters());
    assert!((written.terms[0].amplitudes[0] - 3.0).abs() < 0.1, "{:?}", written.terms);
    assert!(written.model().elsewhere().is_plain() && written.kept.is_none());
    assert_eq!(written.entries[0].parameters, written.effects[0].parameters);
}

#[test]
fn the_refitted_base_is_taken_where_held_out_recordings_are_surely_followed_better_by_it() {
    let given = Given::of(&["isobaric-triangles"], &[STEP]).model;
    let (_, written) =
        settled(&[STEP], &|model| if model.base().parameters() == given.parameters() { 2.0 } else { 1.0 });
    assert_ne!(written.base.parameters(), given.parameters());
}

#[test]
fn a_name_that_is_followed_stays_everywhere() {
    let (fitted, written) = settled(&[DAMPING], &|model| if acts(model, "viscous-damping") { 1.0 } else { 2.0 });
    assert!(written.kept.is_none() && acts(&written.model(), "viscous-damping"));
    assert_ne!(written.base.parameters(), fitted.model.parameters());
    assert!(written.entries.iter().all(|entry| !entry.only_as_fitted));
}

#[test]
fn a_name_that_is_followed_worse_is_kept_to_the_fitted_and_the_other_stays() {
    let lag: (&str, &[f64], &[f64]) = ("pressure-lag", &[0.1, 0.0], &[]);
    let (_, written) = settled(&[DAMPING, lag], &|model| {
        let sized = |id, with, without| if acts(model, id) { with } else { without };
        sized("viscous-damping", 1.0, 2.0) + sized("pressure-lag", 0.5, 0.1)
    });
    let kept = written.kept.as_ref().expect("one is kept");
    assert_eq!(kept.ids, ["pressure-lag"]);
    assert!(acts(&kept.everywhere, "pressure-lag") && !acts(&written.model(), "pressure-lag"));
    assert!(acts(&written.model(), "viscous-damping"));
    let marked: Vec<(&str, bool)> =
        written.entries.iter().map(|entry| (entry.id.as_str(), entry.only_as_fitted)).collect();
    assert_eq!(marked, [("viscous-damping", false), ("pressure-lag", true)]);
}

#[test]
fn where_the_refitted_base_is_followed_worse_as_well_names_are_put_on_the_one_as_given() {
    let given = Given::of(&["isobaric-triangles"], &[DAMPING]).model;
    let (_, written) = settled(&[DAMPING], &|model| {
        let refitted = model.base().parameters() != given.parameters();
        1.0 + f64::from(u8::from(refitted)) + f64::from(u8::from(acts(model, "viscous-damping")))
    });
    assert_eq!(written.base.parameters(), given.parameters());
    assert_eq!(written.kept.as_ref().expect("it is kept").ids, ["viscous-damping"]);
    assert!(written.model().elsewhere().is_plain());
    let size = written.terms[0].amplitudes[0];
    assert!((size - 4e3).abs() < 400.0, "{size}");
    assert!((written.effects[0].parameters[0].value - size).abs() < 1e-9);
}
