//! The law of friction at standstill, judged once more beside what was named.
//!
//! An identification chooses the law by what eq. 11 alone leaves, and an effect that is not in the model may have taken a part
//! in that choice. Beside the effects and the static map the choice is theirs no longer. Friction that relaxes is judged here alone: rubber
//! that relaxes changes the force of a hold in the same way, by what the last motion was.

use pam_identification::error::IdentifyError;
use pam_identification::prepare::Prepared;
use pam_muscle::direction::{Direction, Driver, Law, Standstill, Thresholds};
use pam_muscle::effects::Role;
use pam_muscle::force::Form;
use rayon::prelude::*;

use crate::coordinates::Coordinates;
use crate::hypothesis::CandidateEffect;
use crate::nuisance::Nuisance;
use crate::problem::DiagnosisProblem;
use crate::search::Found;
use crate::track::Track;

/// Laws that are compared. Friction that relaxes does so within 0.8 to 25 s in the muscles of two strangers, each within some three times of
/// one of the two time constants.
const LAWS: [Standstill; 10] = [
    Standstill::Held,
    Standstill::Sticks,
    Standstill::Relaxes { time_constant_s: 2.0, to: 0.0 },
    Standstill::Relaxes { time_constant_s: 2.0, to: 0.5 },
    Standstill::Relaxes { time_constant_s: 8.0, to: 0.0 },
    Standstill::Relaxes { time_constant_s: 8.0, to: 0.5 },
    Standstill::AT_ONCE,
    Standstill::Slides { over_pa: 2e4, share: 1.0 },
    Standstill::Slides { over_pa: 5e4, share: 1.0 },
    Standstill::Slides { over_pa: 1.2e5, share: 1.0 },
];

/// Share of the mean square that another law must leave at most to be taken.
const CLEARLY: f64 = 0.9;

/// A law that fits clearly better than that of `thresholds`, beside what was found; none where there is none.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub(crate) fn better(
    question: &DiagnosisProblem<'_>,
    track: &Track,
    found: &Found,
    thresholds: Thresholds,
) -> Result<Option<Standstill>, IdentifyError> {
    if question.model.form == Form::AsPrinted || question.model.config.assumed.standstill.is_some() {
        return Ok(None);
    }
    let others: Vec<Standstill> = LAWS.into_iter().filter(|law| *law != thresholds.standstill).collect();
    let directions: Result<Vec<Vec<Direction>>, IdentifyError> =
        question.estimation.par_iter().map(|prepared| directed(prepared, thresholds, &others)).collect();
    let mut directions: Vec<_> = directions?.into_iter().map(Vec::into_iter).collect();
    let mut best: Option<(f64, Standstill)> = None;
    for standstill in others {
        let under: Vec<Direction> = directions.iter_mut().filter_map(Iterator::next).collect();
        let other = track.redirected(&under);
        let both: Vec<bool> = track.counted.iter().zip(&other.counted).map(|(own, other)| *own && *other).collect();
        // Where hardly anything is left to compare, nothing is decided.
        if 2 * both.iter().filter(|counted| **counted).count() < track.n_counted() {
            continue;
        }
        let [own, new] =
            [track, &other].map(|track| left(question, found, &Track { counted: both.clone(), ..track.clone() }));
        if let (Some(own), Some(new)) = (own, new)
            && new < CLEARLY * own
            && best.is_none_or(|(lowest, _)| new / own < lowest)
        {
            best = Some((new / own, standstill));
        }
    }
    Ok(best.map(|(_, standstill)| standstill))
}

/// Directions of a recording under each of `standstills`.
fn directed(
    prepared: &Prepared,
    thresholds: Thresholds,
    standstills: &[Standstill],
) -> Result<Vec<Direction>, IdentifyError> {
    let laws: Vec<Law> =
        standstills.iter().map(|&standstill| Law::of(Thresholds { standstill, ..thresholds })).collect();
    let n_rows = prepared.recording.samples.n_rows();
    Direction::of_first_under(n_rows, &prepared.recording, thresholds, Driver::Motion, &laws)
        .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })
}

/// Mean square that what was found leaves on `track`, in N²; what replaces the friction of eq. 11 is left out.
fn left(question: &DiagnosisProblem<'_>, found: &Found, track: &Track) -> Option<f64> {
    let model = &found.best.state.model;
    let coordinates = Coordinates::of(track);
    let nuisance = Nuisance::of_recordings(track, question.limits.sensor_floor_n)
        .with_reversals(track, &coordinates, model)
        .with_map(track, &coordinates);
    let setting = question.setting(track, &nuisance);
    let guesses: Vec<CandidateEffect> =
        found.best.state.guesses.iter().filter(|guess| guess.effect.role() != Role::Slides).cloned().collect();
    let near = &found.best.state.fit.x[..question.space.free.len()];
    Some(setting.fit(guesses, near, model)?.fit.mean_square)
}

#[cfg(test)]
mod tests;
