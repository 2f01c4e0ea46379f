//! Where model and recordings differ, in regions over the coordinates.

use pam_artifact::diagnosis::Region;
use pam_muscle::Coordinate;
use pam_muscle::effects::{AugmentedModel, Kind, Role};

use crate::regions::{By, Place, concentrated, from_event};
use crate::search::{Found, chance};
use crate::state::{Setting, State};
use crate::structure::ProjectedResidual;

/// Where the mismatch lies: what each effect explains over its own coordinate, then what the residual says by itself.
pub(crate) fn regions(setting: &Setting<'_>, found: &Found, paths: &[String]) -> Vec<Region> {
    let mut regions: Vec<(f64, Region)> = Vec::new();
    let state = &found.best.state;
    let after = setting.residuals_n(state);
    for (index, guess) in state.guesses.iter().enumerate() {
        let Some(rest) = setting.fit_without(state, index) else { continue };
        let before = setting.residuals_n(&rest);
        let excess: Vec<f64> =
            before.iter().zip(&after).map(|(before, after)| before * before - after * after).collect();
        let coordinate = guess.effect.page().coordinate;
        let (log_ratio, p_value) = found.taken.get(index).map_or((0.0, 1.0), |taken| {
            (
                taken.without.log_ratio(&taken.with),
                (chance(&taken.without, &taken.with) * found.first.len() as f64).min(1.0),
            )
        });
        let region = if guess.effect.kind() == Kind::Event {
            from_event(setting, guess, &excess, p_value, paths)
        } else {
            // A base refitted without friction, rate or memory spreads what these do over all: where they act says it, and where
            // the reading of a force alone is changed. What another static effect does is smooth nearly everywhere, and a mismatch
            // where eq. 11 cannot follow.
            let is_smooth = guess.effect.is_static() && guess.effect.role() != Role::Reads;
            let (acts, by) =
                if is_smooth { (excess, By::Refit) } else { (own_square(setting, state, index), By::Force) };
            concentrated(setting, &found.coordinates, coordinate, (&acts, by), p_value, paths).map(|place| place.region)
        };
        regions.extend(region.map(|region| (log_ratio, region)));
    }
    regions.sort_by(|left, right| right.0.total_cmp(&left.0));
    let mut out: Vec<Region> = regions.into_iter().map(|(_, region)| region).collect();
    let known: Vec<Coordinate> = out.iter().map(|region| region.coordinate).collect();
    out.extend(telling(structured(setting, &found.whole.state, found, paths), &known));
    out
}

/// Square of the force that effect `index` of `state` has at every instant beside all else as it was fitted, in N².
fn own_square(setting: &Setting<'_>, state: &State, index: usize) -> Vec<f64> {
    let mut others = state.terms();
    let all = AugmentedModel::new(state.model.clone(), others.clone());
    others.remove(index);
    let [with, without] =
        [all, AugmentedModel::new(state.model.clone(), others)].map(|model| setting.track.modelled_n(&model));
    with.iter().zip(&without).map(|(with, without)| (with - without).powi(2)).collect()
}

/// Those of `places`, the most telling first, over none of the coordinates `known`; what is everywhere only where there is
/// nothing before it.
pub(crate) fn telling(places: Vec<Place>, known: &[Coordinate]) -> Vec<Region> {
    let news = places.into_iter().filter(|place| !known.contains(&place.region.coordinate)).enumerate();
    news.filter(|(index, place)| !place.is_everywhere || (*index == 0 && known.is_empty()))
        .map(|(_, place)| place.region)
        .collect()
}

/// Coordinates over which the residual of a state is structured, the most telling first.
pub(crate) fn structured(setting: &Setting<'_>, state: &State, found: &Found, paths: &[String]) -> Vec<Place> {
    let remainder = ProjectedResidual::of(setting, state);
    let Some(nothing) = remainder.structure(&[]) else { return Vec::new() };
    let mut places: Vec<(f64, Place)> = Vec::new();
    for coordinate in Coordinate::ALL {
        let best = found
            .features
            .iter()
            .filter(|feature| feature.coordinate == coordinate && !feature.plane)
            .filter_map(|feature| Some((feature, remainder.structure(&[feature])?)))
            .map(|(feature, structure)| (nothing.held_out.log_ratio(&structure.held_out), feature, structure))
            .max_by(|left, right| left.0.total_cmp(&right.0));
        let Some((gain, feature, structure)) = best.filter(|(gain, ..)| *gain > 0.5) else { continue };
        // Every recording has a time of its own.
        let structure =
            if coordinate == Coordinate::Time { None } else { remainder.narrowest(feature) }.unwrap_or(structure);
        let excess: Vec<f64> = structure.values_n.iter().map(|value| value * value).collect();
        let looks = found.features.len() as f64;
        let p_value = (chance(&nothing.held_out, &structure.held_out) * looks).min(1.0);
        if let Some(place) = concentrated(setting, &found.coordinates, coordinate, (&excess, By::Force), p_value, paths)
        {
            places.push((gain, place));
        }
    }
    places.sort_by(|left, right| right.0.total_cmp(&left.0));
    places.into_iter().map(|(_, place)| place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hypothesis::CandidateEffect;
    use crate::rehearsal::tests::Given;

    /// From where to where over its own coordinate the effect `id` lies, concealed and found with `shape`.
    fn region(id: &'static str, shape: &[f64], size: &[f64]) -> Region {
        let mut given = Given::of(&["isobaric-triangles", "isometric-ramps", "multisine"], &[(id, shape, size)]);
        given.disturb();
        let guess = CandidateEffect { shape: shape.to_vec(), ..given.guess(id, &[]) };
        let effect = guess.effect;
        let regions = given.with_found(0.3, vec![guess], |setting, found, _| regions(setting, &found, &[]));
        regions.into_iter().find(|region| region.coordinate == effect.page().coordinate).expect("a region")
    }

    #[test]
    fn friction_of_slow_motion_lies_at_slow_motion_though_a_base_without_it_is_wrong_everywhere() {
        let region = region("stribeck", &[5e-3, 1.0, 0.0], &[4e-3]);
        assert!(region.from < 1e-3 && (5e-3..15e-3).contains(&region.to), "{region:?}");
    }
}
