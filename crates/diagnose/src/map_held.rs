//! Whether the static map foretells recordings that nothing was fitted to. Within what was fitted it is judged by blocks; where other
//! recordings go farther, a bend that was one of the noise or of another misfit may carry a model away.

use pam_core::effects::AugmentedModel;

use crate::nuisance::Nuisance;
use crate::question::Question;
use crate::search::Found;
use crate::state::State;
use crate::track::Track;
use crate::veto::force_n;

/// What was found, fitted without the static map, and what is then in beside it; none where there is no map, or where it foretells the
/// force of `held` better than eq. 11 alone.
pub(crate) fn without_it(
    question: &Question<'_>,
    track: &Track,
    found: &Found,
    held: &Track,
) -> Option<(State, Nuisance)> {
    let best = &found.best.state;
    let map = found.nuisance.map_term(&best.fit.nuisances, track, &found.coordinates)?;
    let nuisance = found.nuisance.without_map();
    let lean = question.setting(track, &nuisance).fit_near(best.guesses.clone(), best)?;
    let mut terms = best.terms();
    terms.push(map);
    let with_it = mean_square(held, &AugmentedModel::new(best.model.clone(), terms));
    let without_it = mean_square(held, &AugmentedModel::new(lean.model.clone(), lean.terms()));
    (without_it < with_it).then_some((lean, nuisance))
}

/// Mean square of what `model` leaves of the samples of `held` that count, in N².
fn mean_square(held: &Track, model: &AugmentedModel) -> f64 {
    let modelled_n = force_n(held, &model.without_events());
    let rows = held.instants.iter().zip(&modelled_n).zip(&held.counted).filter(|(_, counted)| **counted);
    let squares = rows.map(|((instant, modelled_n), _)| (instant.force_n - modelled_n).powi(2));
    squares.sum::<f64>() / held.n_counted().max(1) as f64
}
