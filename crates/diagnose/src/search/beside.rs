//! What a hypothesis is judged beside: nuisances of the recordings, and a static map that is smooth or bends.

use rayon::prelude::*;

use super::{Judged, again};
use crate::coordinates::Coordinates;
use crate::nuisance::Nuisance;
use crate::state::Setting;

/// What a hypothesis is judged beside.
pub(crate) struct Beside {
    /// Nuisances of the recordings alone, and what named effects remember of what went before them.
    pub(crate) plain: Nuisance,
    /// A smooth static map as well.
    pub(crate) smooth: Nuisance,
    /// A static map that bends instead.
    pub(crate) free: Nuisance,
}

impl Beside {
    /// For `best`; `of_recordings` is what is in by any means.
    pub(crate) fn of(
        setting: &Setting<'_>,
        of_recordings: &Nuisance,
        coordinates: &Coordinates,
        best: &Judged,
    ) -> Option<Self> {
        let track = setting.track;
        let carried = best.state.guesses.iter().filter(|guess| guess.has_own_beginnings());
        let plain = carried.fold(of_recordings.clone(), |nuisance, guess| setting.begun(&nuisance, &best.state, guess));
        let bare = setting.beside(&plain);
        let (smooth_square, smooth) = fitting(&bare, best, &plain.with_map(track, coordinates))?;
        let (free_square, free) = fitting(&bare, best, &plain.with_free_map(track, coordinates))?;
        // Where bends foretell nothing, there are none.
        let free = if free_square < smooth_square { free } else { smooth.clone() };
        Some(Self { plain, smooth, free })
    }
}

/// How strongly a static map may be drawn to zero, in units of its loosest prior; the last leaves none of it.
const STRENGTHS: [f64; 5] = [1.0, 10.0, 100.0, 1000.0, 1e7];

/// `map` with the prior under which it foretells held-out blocks best, beside `best`: what a few recordings say of a static
/// force somewhere is no license to bend it elsewhere. With what it leaves, as a mean square.
pub(crate) fn fitting(plain: &Setting<'_>, best: &Judged, map: &Nuisance) -> Option<(f64, Nuisance)> {
    let judge = |factor: f64| {
        let tightened = map.tightened(factor);
        Some((again(&plain.beside(&tightened), best)?.held_out.mean_square(), tightened))
    };
    let tried: Vec<(f64, Nuisance)> = STRENGTHS.into_par_iter().filter_map(judge).collect();
    tried.into_iter().min_by(|left, right| left.0.total_cmp(&right.0))
}

/// Share of the mean square over held-out blocks that the static map must take up to be kept.
const WORTH_A_MAP: f64 = 0.02;

/// `best` with the static map, or without where it gains nothing on held-out blocks.
pub(super) fn kept_map(plain: &Setting<'_>, best: Judged, map: Nuisance) -> Option<(Judged, Nuisance)> {
    let bare = again(plain, &best)?;
    let keeps = best.held_out.mean_square() < (1.0 - WORTH_A_MAP) * bare.held_out.mean_square();
    Some(if keeps { (best, map) } else { (bare, plain.nuisance.clone()) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;
    use crate::search::judged;

    const PROTOCOLS: [&str; 3] = ["isobaric-triangles", "isometric-ramps", "multisine"];

    /// Whether a static map is kept beside the base model of a muscle that eq. 11 misses by up to so many newtons.
    fn keeps_map(size_n: f64) -> bool {
        let mut given = Given::of(&PROTOCOLS, &[]);
        given.disturb();
        given.bend(size_n);
        let plain = Setting { floor_square: 0.09, ..given.setting() };
        let base = judged(&plain, plain.fit(Vec::new(), &given.start, &given.model).expect("a fit")).expect("folds");
        let coordinates = Coordinates::of(&given.track);
        let (_, map) = fitting(&plain, &base, &plain.nuisance.with_map(&given.track, &coordinates)).expect("a map");
        let mapped = again(&plain.beside(&map), &base).expect("a fit beside it");
        let (_, kept) = kept_map(&plain, mapped, map).expect("a choice");
        kept.n() > plain.nuisance.n()
    }

    #[test]
    fn a_static_map_is_kept_where_it_foretells_and_dropped_where_nothing_is_missing() {
        assert!(keeps_map(6.0));
        assert!(!keeps_map(0.0));
    }
}

#[cfg(test)]
mod cases;
