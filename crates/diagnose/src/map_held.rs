//! Whether the static map foretells recordings that nothing was fitted to. Within what was fitted it is judged by blocks; where other
//! recordings go farther, a bend that was one of the noise or of another misfit may carry a model away.

use pam_core::effects::AugmentedModel;

use crate::nuisance::Nuisance;
use crate::search::Found;
use crate::state::{Setting, State};
use crate::track::Track;
use crate::veto::force_n;

/// What was found in `setting`, fitted without the static map, and what is then in beside it; none where there is no map, or where it foretells the
/// force of `held` better than eq. 11 alone.
pub(crate) fn without_it(setting: &Setting<'_>, found: &Found, held: &Track) -> Option<(State, Nuisance)> {
    let best = &found.best.state;
    let map = found.nuisance.map_term(&best.fit.nuisances, setting.track, &found.coordinates)?;
    let nuisance = found.nuisance.without_map();
    let lean = setting.beside(&nuisance).fit_near(best.guesses.clone(), best)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;
    use crate::search::{Limits, search};

    /// Recordings of a muscle that eq. 11 misses by up to so many newtons.
    fn missed(protocol: &str, size_n: f64) -> Given {
        let mut given = Given::of(&[protocol], &[]);
        for (at, instant) in given.track.instants.iter_mut().enumerate() {
            let (p, e) = (instant.moment.pressure_pa * 2e-6, instant.moment.contraction_ratio * 5.0);
            instant.force_n += size_n * (2.5 * p + 2.0 * e).sin() * p + 0.2 * (0.37 * at as f64).sin();
        }
        given
    }

    #[test]
    fn a_map_is_kept_where_other_recordings_show_it_and_dropped_where_they_do_not() {
        let fitted = missed("isobaric-triangles", 6.0);
        let limits = Limits {
            max_effects: 0,
            excluded: Vec::new(),
            own: Vec::new(),
            matters_above_n: None,
            sensor_floor_n: 0.3,
            confirmed: true,
        };
        let setting = Setting { floor_square: 0.09, ..fitted.setting() };
        let found = search(&setting, &fitted.start, &fitted.model, &limits, &|| {}).expect("a search");
        let dropped = |size_n| without_it(&setting, &found, &missed("multisine", size_n).track);
        assert!(dropped(6.0).is_none());
        let (lean, nuisance) = dropped(0.0).expect("a fit without the map");
        assert!(nuisance.map_term(&lean.fit.nuisances, setting.track, &found.coordinates).is_none());
    }
}
