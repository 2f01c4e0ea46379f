//! Which of what was fitted beside base and effects a model is written with. Within what was fitted the static map is judged by
//! blocks; where other recordings go farther, a bend that was one of the noise or of another misfit may carry a model away. And a
//! model carries no other forms of its effects and no reversals of its recordings: fitted beside them, base and effects may leave
//! more than fitted without.

use pam_muscle::effects::{AugmentedModel, Kind};

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

#[cfg(test)]
mod tests {
    use super::*;
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
