//! Whether the static map foretells recordings that nothing was fitted to. Within what was fitted it is judged by blocks; where other
//! recordings go farther, a bend that was one of the noise or of another misfit may carry a model away.

use pam_core::effects::AugmentedModel;

use crate::held_error::Left;
use crate::nuisance::Nuisance;
use crate::search::Found;
use crate::state::{Setting, State};
use crate::track::Track;

/// What was found in `setting`, fitted without the static map, and what is then in beside it.
///
/// None where there is no map, or where it foretells the force of `held` better than eq. 11 alone, over all samples.
pub(crate) fn without_it(setting: &Setting<'_>, found: &Found, held: &Track) -> Option<(State, Nuisance)> {
    let best = &found.best.state;
    let map = found.nuisance.map_term(&best.fit.nuisances, setting.track, &found.coordinates)?;
    let nuisance = found.nuisance.without_map();
    let lean = setting.beside(&nuisance).fit_near(best.guesses.clone(), best)?;
    let mut terms = best.terms();
    terms.push(map);
    let with_it = Left::of(&AugmentedModel::new(best.model.clone(), terms), held);
    let without_it = Left::of(&AugmentedModel::new(lean.model.clone(), lean.terms()), held);
    (without_it.together_n() < with_it.together_n()).then_some((lean, nuisance))
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
        let dropped = |size_n| without_it(&setting, &found, &missed("multisine", size_n).track);
        assert!(dropped(6.0).is_none());
        let (lean, nuisance) = dropped(0.0).expect("a fit without the map");
        assert!(nuisance.map_term(&lean.fit.nuisances, setting.track, &found.coordinates).is_none());
    }
}
