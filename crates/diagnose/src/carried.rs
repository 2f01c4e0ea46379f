//! Which of what was fitted beside base and effects a model is written with. Within what was fitted the static map is judged by
//! blocks; where other recordings go farther, a bend that was one of the noise or of another misfit may carry a model away. And a
//! model carries no other forms of its effects and no reversals of its recordings: fitted beside them, base and effects may leave
//! more than fitted without.

use pam_muscle::effects::AugmentedModel;

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
/// Both.
const OF_ALL: [Group; 4] = [Group::Reversal, Group::Form, Group::EvenMap, Group::OddMap];

/// How much less a static map may be drawn to zero than in the search, in which what it follows could hide an effect.
const LOOSER: [f64; 2] = [0.1, 0.01];

/// What was found in `setting`, fitted as a model carries it, and what is then in beside it: what leaves least of the force of
/// `held` over all samples. Without `held` the recordings of the fit judge, which cannot tell whether a map foretells anything.
///
/// None where nothing is better than what was found.
pub(crate) fn leaves_least(setting: &Setting<'_>, found: &Found, held: Option<&Track>) -> Option<(State, Nuisance)> {
    let least = of_the_fewest(setting, found, held);
    let looser = held.and_then(|held| {
        let (state, nuisance) =
            least.as_ref().map_or((&found.best.state, &found.nuisance), |(state, nuisance)| (state, nuisance));
        looser(setting, found, held, state, nuisance)
    });
    looser.or(least)
}

/// The same as the search has it, or without some of what is beside it.
fn of_the_fewest(setting: &Setting<'_>, found: &Found, held: Option<&Track>) -> Option<(State, Nuisance)> {
    let best = &found.best.state;
    let left_n = |state: &State, nuisance: &Nuisance| {
        Left::of(&carried(setting, found, state, nuisance), held.unwrap_or(setting.track)).together_n()
    };
    let fewer: [&[Group]; 3] = [&OF_THE_FIT, &MAP, &OF_ALL];
    let others = fewer.into_iter().take(if held.is_some() { 3 } else { 1 });
    let others = others.filter(|groups| found.nuisance.without(groups).n() < found.nuisance.n());
    let others = others.filter_map(|groups| fitted(setting, found, &best.guesses, groups));
    let least = others
        .map(|(state, nuisance)| (left_n(&state, &nuisance), state, nuisance))
        .min_by(|one, other| one.0.total_cmp(&other.0))?;
    (least.0 < left_n(best, &found.nuisance)).then_some((least.1, least.2))
}

/// `state` beside `nuisance` with its static map drawn to zero less; none where the recordings `held` are not surely followed better so.
fn looser(
    setting: &Setting<'_>,
    found: &Found,
    held: &Track,
    state: &State,
    nuisance: &Nuisance,
) -> Option<(State, Nuisance)> {
    if nuisance.without(&MAP).n() == nuisance.n() {
        return None;
    }
    let left = |state: &State, nuisance: &Nuisance| Left::of(&carried(setting, found, state, nuisance), held);
    let before = left(state, nuisance);
    let others = LOOSER.into_iter().filter_map(|factor| {
        let nuisance = nuisance.tightened(factor);
        let setting = setting.beside(&nuisance);
        let state = setting.fit_near(state.guesses.clone(), state)?;
        let after = left(&state, &nuisance);
        before.is_surely_bettered_by(&after).then(|| (after.together_n(), state, nuisance))
    });
    let (_, state, nuisance) = others.min_by(|one, other| one.0.total_cmp(&other.0))?;
    Some((state, nuisance))
}

/// Models of `guesses` beside the base, as they would be written: each beside others of the nuisances that were in; the static map is among
/// them `by_map` alone.
pub(crate) fn models<'a>(
    setting: &'a Setting<'_>,
    found: &'a Found,
    guesses: &'a [CandidateEffect],
    by_map: bool,
) -> impl Iterator<Item = AugmentedModel> {
    let every: &[&[Group]] = if by_map { &[&[], &OF_THE_FIT, &MAP, &OF_ALL] } else { &[&MAP, &OF_ALL] };
    let of = move |groups: &[Group]| {
        let (state, nuisance) = fitted(setting, found, guesses, groups)?;
        Some(carried(setting, found, &state, &nuisance))
    };
    every.iter().copied().filter_map(of)
}

/// `guesses` fitted beside the nuisances that were in, without `groups`.
fn fitted(
    setting: &Setting<'_>,
    found: &Found,
    guesses: &[CandidateEffect],
    groups: &[Group],
) -> Option<(State, Nuisance)> {
    let nuisance = found.nuisance.without(groups);
    let state = setting.beside(&nuisance).fit_near(guesses.to_vec(), &found.best.state)?;
    Some((state, nuisance))
}

/// The model of `state` with what it carries of `nuisance`.
pub(crate) fn carried(setting: &Setting<'_>, found: &Found, state: &State, nuisance: &Nuisance) -> AugmentedModel {
    let beside = nuisance.carried(&state.fit.nuisances, setting.track, &found.coordinates);
    AugmentedModel::new(state.model.clone(), state.terms().into_iter().chain(beside).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;
    use crate::search::{Limits, search};

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
    fn a_map_is_drawn_to_zero_less_where_other_recordings_are_surely_followed_better_so() {
        let fitted = missed("isobaric-triangles", 40.0);
        let limits = Limits { confirmed: true, ..Limits::of_test(0, 0.3) };
        let setting = Setting { floor_square: 0.09, ..fitted.setting() };
        let found = search(&setting, &fitted.start, &fitted.model, &limits, &|| {}).expect("a search");
        // As a search has it that had to draw it more.
        let nuisance = found.nuisance.tightened(100.0);
        let state = setting.beside(&nuisance).fit_near(Vec::new(), &found.best.state).expect("a fit");
        let freed = |held: &Given| looser(&setting, &found, &held.track, &state, &nuisance);
        let (loose, _) = freed(&missed("isobaric-triangles", 40.0)).expect("a looser map");
        assert!(loose.fit.mean_square < state.fit.mean_square);
        assert!(freed(&missed("isobaric-triangles", 0.0)).is_none());
    }
}
