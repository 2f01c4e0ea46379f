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
