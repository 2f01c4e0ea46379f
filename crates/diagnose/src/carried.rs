//! Which of what was fitted beside base and effects a model is written with. Within what was fitted the static map is judged by
//! blocks; where other recordings go farther, a bend that was one of the noise or of another misfit may carry a model away. And a
//! model carries no other forms of its effects and no reversals of its recordings: fitted beside them, base and effects may leave
//! more than fitted without.

use pam_muscle::effects::{AugmentedModel, Effect, Kind};

use crate::held_error::Left;
use crate::hypothesis::CandidateEffect;
use crate::nuisance::{Group, Nuisance};
use crate::search::Found;
use crate::state::{Setting, State};
use crate::track::Track;

/// What no model carries.
pub(crate) const OF_THE_FIT: [Group; 2] = [Group::Reversal, Group::Form];
/// What it carries only where that helps.
const MAP: [Group; 2] = [Group::EvenMap, Group::OddMap];

/// Share of what is left of the fitted recordings, over all samples and beyond the sensors, that a name must take away with which others
/// are followed worse.
const LEAST_SHARE: f64 = 0.15;

/// What was found in `setting`, fitted as a model carries it, and what is then in beside it: what leaves least of the force of
/// `held` over all samples. Without `held` the recordings of the fit judge, which cannot tell whether a map foretells anything.
///
/// None where nothing is better than what was found.
pub(crate) fn leaves_least(setting: &Setting<'_>, found: &Found, held: Option<&Track>) -> Option<(State, Nuisance)> {
    let best = &found.best.state;
    let left_n = |state: &State, nuisance: &Nuisance| {
        Left::of(&carried(setting, found, state, nuisance), held.unwrap_or(setting.track)).together_n()
    };
    let without = |groups: &[Group]| found.nuisance.without(groups);
    let mut others = vec![without(&OF_THE_FIT)];
    if held.is_some() {
        others.extend([without(&MAP), without(&[OF_THE_FIT, MAP].concat())]);
    }
    let fitted = others.into_iter().filter(|nuisance| nuisance.n() < found.nuisance.n()).filter_map(|nuisance| {
        let state = setting.beside(&nuisance).fit_near(best.guesses.clone(), best)?;
        Some((left_n(&state, &nuisance), state, nuisance))
    });
    let least = fitted.min_by(|one, other| one.0.total_cmp(&other.0))?;
    (least.0 < left_n(best, &found.nuisance)).then_some((least.1, least.2))
}

/// The model of `state` with what it carries of `nuisance`.
fn carried(setting: &Setting<'_>, found: &Found, state: &State, nuisance: &Nuisance) -> AugmentedModel {
    let map = nuisance.map_term(&state.fit.nuisances, setting.track, &found.coordinates);
    AugmentedModel::new(state.model.clone(), state.terms().into_iter().chain(map).collect())
}

/// Lets go of every name of `found` where the model with them leaves more than the base model alone, over all samples, of the
/// recordings that it was fitted to and of `held`: it models nothing. Whether it did.
pub(crate) fn let_go_of_what_models_nothing(setting: &Setting<'_>, found: &mut Found, held: &Track) -> bool {
    // What happened once is on no other recording, and a model knows no beginnings of what outlasts one.
    let is_judged = |guess: &CandidateEffect| guess.effect.kind() != Kind::Event && !guess.effect.outlasts();
    if found.best.state.guesses.is_empty() || !found.best.state.guesses.iter().all(is_judged) {
        return false;
    }
    let (state, nuisance) =
        leaves_least(setting, found, Some(held)).unwrap_or_else(|| (found.best.state.clone(), found.nuisance.clone()));
    let with = carried(setting, found, &state, &nuisance);
    let without = AugmentedModel::new(found.base.state.model.clone(), Vec::new());
    let raises = |track: &Track| Left::of(&with, track).together_n() > Left::of(&without, track).together_n();
    if !raises(setting.track) || !raises(held) {
        return false;
    }
    let ids: Vec<&'static str> = found.best.state.guesses.iter().map(CandidateEffect::id).collect();
    for index in (0..ids.len()).rev() {
        if found.let_go(setting, index) {
            found.denied.push(ids[index]);
        }
    }
    true
}

/// Lets go of names of `found` that model next to nothing, the least first: with them `held` is followed worse than without, and they
/// take away less than [`LEAST_SHARE`] of what is left of the recordings that they were fitted to. Whether it let go of any.
pub(crate) fn let_go_of_what_is_followed_worse(setting: &Setting<'_>, found: &mut Found, held: &Track) -> bool {
    let mut any = false;
    loop {
        let best = &found.best.state;
        let with = carried(setting, found, best, &found.nuisance);
        let held_with = Left::of(&with, held);
        // An event is nothing elsewhere, where a static effect acts others may not have been, and where what outlasts a recording begins
        // in others is not known.
        let is_judged = |effect: &dyn Effect| effect.kind() != Kind::Event && !effect.is_static() && !effect.outlasts();
        let judged = (0..best.guesses.len()).filter(|&index| is_judged(best.guesses[index].effect));
        let shares = judged.filter_map(|index| {
            let without = carried(setting, found, &setting.fit_without(best, index)?, &found.nuisance);
            let is_worse = held_with.is_worse_than(&Left::of(&without, held));
            let [before, after] = [&without, &with].map(|model| mean_square(setting.track, model));
            let share = (before - after) / (before - setting.floor_square).max(f64::MIN_POSITIVE);
            (is_worse && share < LEAST_SHARE).then_some((index, share))
        });
        let Some((index, _)) = shares.min_by(|one, other| one.1.total_cmp(&other.1)) else { return any };
        let id = found.best.state.guesses[index].id();
        if !found.let_go(setting, index) {
            return any;
        }
        found.denied.push(id);
        found.stand_ins.push(id);
        any = true;
    }
}

/// Mean square of what `model` leaves of all instants of the recordings that it was fitted to, in N².
fn mean_square(track: &Track, model: &AugmentedModel) -> f64 {
    let modelled_n = track.modelled_n(model);
    let missed = track.instants.iter().zip(&modelled_n).map(|(instant, modelled_n)| instant.force_n - modelled_n);
    missed.map(|missed_n| missed_n * missed_n).sum::<f64>() / track.n().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nuisance;
    use crate::rehearsal::tests::Given;
    use crate::search::{Limits, judged, search};

    /// Recordings of a muscle that eq. 11 misses by up to so many newtons.
    fn missed(protocol: &str, size_n: f64) -> Given {
        let mut given = Given::of(&[protocol], &[]);
        given.disturb();
        given.bend(size_n);
        given
    }

    #[test]
    fn a_map_is_kept_where_other_recordings_show_it_and_dropped_where_they_do_not() {
        let fitted = missed("isobaric-triangles", 6.0);
        let limits = Limits { confirmed: true, ..Limits::of_test(0, 0.3) };
        let setting = Setting { floor_square: 0.09, ..fitted.setting() };
        let found = search(&setting, &fitted.start, &fitted.model, &limits, &|| {}).expect("a search");
        let has_map = |size_n| match leaves_least(&setting, &found, Some(&missed("multisine", size_n).track)) {
            Some((state, nuisance)) => nuisance.map_term(&state.fit.nuisances, setting.track, &found.coordinates),
            None => found.nuisance.map_term(&found.best.state.fit.nuisances, setting.track, &found.coordinates),
        };
        assert!(has_map(6.0).is_some());
        assert!(has_map(0.0).is_none());
    }

    #[test]
    fn a_name_that_others_are_followed_worse_with_is_let_go_of_where_it_explains_little_of_the_fitted() {
        // Damping in the fitted recordings and in the others, beside so much that eq. 11 misses.
        let names = |fitted_n_s_per_m: f64, others_n_s_per_m: f64, missed_n: f64| {
            let [fitted, held] = [("isobaric-triangles", fitted_n_s_per_m), ("multisine", others_n_s_per_m)].map(
                |(protocol, damping)| {
                    let mut given = Given::of(&[protocol], &[("viscous-damping", &[], &[damping, 0.0])]);
                    given.bend(missed_n);
                    given
                },
            );
            let plain = Setting { floor_square: 0.09, ..fitted.setting() };
            let mut found =
                search(&plain, &fitted.start, &fitted.model, &Limits::of_test(0, 0.3), &|| {}).expect("a search");
            found.nuisance = nuisance::NONE.clone();
            let state = plain.fit_near(vec![fitted.guess("viscous-damping", &[])], &found.best.state);
            found.best = judged(&plain, state.expect("a fit")).expect("a fit of every fold");
            let did = let_go_of_what_is_followed_worse(&plain, &mut found, &held.track);
            assert_eq!(did, !found.stand_ins.is_empty());
            found.best.state.guesses.iter().map(|guess| guess.id()).collect::<Vec<_>>()
        };
        assert_eq!(names(100.0, -3000.0, 60.0), Vec::<&str>::new());
        assert_eq!(names(100.0, 100.0, 60.0), ["viscous-damping"], "the others have it as well");
        assert_eq!(names(3000.0, -3000.0, 0.0), ["viscous-damping"], "it explains the fitted ones");
    }

    #[test]
    fn a_name_that_raises_the_error_everywhere_is_let_go_of_and_one_that_lowers_it_is_not() {
        let names = |id: &'static str, shape: &[f64], concealed: &[(&'static str, &[f64], &[f64])]| {
            let [fitted, held] = ["isobaric-triangles", "multisine"].map(|protocol| Given::of(&[protocol], concealed));
            let limits = Limits::of_test(0, 0.3);
            let plain = Setting { floor_square: 0.09, ..fitted.setting() };
            let mut found = search(&plain, &fitted.start, &fitted.model, &limits, &|| {}).expect("a search");
            let nuisance = found.nuisance.clone();
            let setting = plain.beside(&nuisance);
            let state = setting.fit_near(vec![fitted.guess(id, shape)], &found.best.state);
            found.best = judged(&setting, state.expect("a fit")).expect("a fit of every fold");
            let_go_of_what_models_nothing(&setting, &mut found, &held.track);
            found.best.state.guesses.iter().map(|guess| guess.id()).collect::<Vec<_>>()
        };
        let delay: (&'static str, &[f64], &[f64]) = ("channel-delay", &[0.06, 0.0], &[]);
        assert_eq!(names("channel-delay", &[0.06, 0.0], &[]), Vec::<&str>::new());
        assert_eq!(names("channel-delay", &[0.06, 0.0], &[delay]), ["channel-delay"]);
        // Where it begins is not known.
        assert_eq!(names("thermal-softening", &[300.0], &[]), ["thermal-softening"]);
    }
}
