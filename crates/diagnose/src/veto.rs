//! What was held out confirms or vetoes what was named.

use pam_core::effects::{AugmentedModel, Kind, Moment};
use pam_core::shift::shifted;

use crate::nuisance::Nuisance;
use crate::search::{Found, Judged, judged};
use crate::state::{Setting, State};
use crate::structure::{Feature, Remainder};
use crate::track::Track;

/// An effect is vetoed where the held-out error without it is less than this share of the one with it.
const HARMS: f64 = 0.98;

/// `found` without the effects that make the prediction of `heldout` worse.
pub(crate) fn confirmed(setting: &Setting<'_>, mut found: Found, heldout: &Track) -> Found {
    while let Some((index, rest)) = harmful(setting, &found, heldout) {
        found.best = rest;
        if index < found.taken.len() {
            found.taken.remove(index);
        }
        let every: Vec<&Feature> = found.features.iter().collect();
        found.left = Remainder::of(setting, &found.best.state).structure(&every);
    }
    found
}

/// The effect that harms most, with what is left without it.
fn harmful(setting: &Setting<'_>, found: &Found, heldout: &Track) -> Option<(usize, Judged)> {
    let with = error_n(setting, found, &found.best.state, heldout)?;
    let mut worst: Option<(f64, usize, Judged)> = None;
    for index in 0..found.best.state.guesses.len() {
        let effect = found.best.state.guesses[index].effect;
        // An event is none of the others' recordings; in the place of a static effect the static map would do as well.
        if effect.kind() == Kind::Event || effect.is_static() {
            continue;
        }
        let Some(rest) = setting.fit_without(&found.best.state, index).and_then(|state| judged(setting, state)) else {
            continue;
        };
        let Some(without) = error_n(setting, found, &rest.state, heldout) else { continue };
        if without < HARMS * with && worst.as_ref().is_none_or(|(lowest, ..)| without < *lowest) {
            worst = Some((without, index, rest));
        }
    }
    worst.map(|(_, index, rest)| (index, rest))
}

/// Root mean square of the residual over the settled instants of `heldout`, in N.
fn error_n(setting: &Setting<'_>, found: &Found, state: &State, heldout: &Track) -> Option<f64> {
    let model = with_map(setting.nuisance, setting.track, found, state).without_events();
    let delays_s = model.delays_s();
    let (mut squares, mut count) = (0.0, 0.0);
    for range in &heldout.recordings {
        let instants = &heldout.instants[range.clone()];
        let moments: Vec<Moment> = if delays_s == [0.0; 2] {
            instants.iter().map(|instant| instant.moment).collect()
        } else {
            shifted(instants, delays_s)
        };
        let mut memory = model.start();
        for ((instant, moment), at) in instants.iter().zip(moments).zip(range.clone()) {
            let residual_n = instant.force_n - memory.force_n(&model, moment);
            if heldout.counted[at] {
                squares += residual_n * residual_n;
                count += 1.0;
            }
        }
    }
    let error_n = f64::sqrt(squares / count);
    error_n.is_finite().then_some(error_n)
}

/// Base, effects and the static map of `state`.
pub(crate) fn with_map(nuisance: &Nuisance, track: &Track, found: &Found, state: &State) -> AugmentedModel {
    let mut terms = state.terms();
    terms.extend(nuisance.map_term(&state.fit.nuisances, track, &found.coordinates));
    AugmentedModel::new(state.model.clone(), terms)
}
