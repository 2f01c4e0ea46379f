//! What was held out decides the verdict: a recording that the diagnosed model misses is named, with what would explain it.
//!
//! A recording of the same muscle is followed a little worse than those that were fitted, by every model. One whose residual is
//! several times theirs under both the base and the diagnosed model differs in something that no fit has seen: an instrument,
//! or the muscle.

use pam_identification::evaluate::{Evaluation, noise_floor_n};
use pam_identification::faults::reading::{self, MISSES, Reading, Wrong};
use pam_identification::trace::{Trace, trace};

use crate::artifact::{Agreement, together};
use crate::coverage::Coverage;
use crate::diagnose::Diagnosis;
use crate::error::DiagnoseError;
use crate::typical;

/// Times what is left of the fitted recordings that may be left of a held-out one, whatever the reason. A recording or two do
/// not say what eq. 11 is elsewhere (2.6 times was seen of a healthy muscle), and memory goes on from recording to recording.
const MOST: f64 = 4.0;

/// Times what is left of the fitted recordings beyond which a held-out one is missed however little of it is: one of steps that is late is
/// missed as they are made alone. Of the hold-outs of 114 healthy muscles, together, 5.9 times at most were left but of one, which left 45
/// times and is none of another muscle where fitted recordings have been.
pub(crate) const FAR: f64 = 10.0;

/// Times the worst error with which one of the fitted recordings is foretold by the others: so much is foretold of any recording.
const AS_OTHERS: f64 = 2.0;

/// Tares of a zeroed load cell that a recording may be off by: what was fitted has one as well.
const TARES: f64 = 2.0;

/// Share of a held-out recording within what was fitted from which on it is judged, there alone.
const LEAST_WITHIN: f64 = 0.1;
/// Share of it outside from which on that is said.
const TOLD_OUTSIDE: f64 = 0.5;

/// What was held out and is missed.
#[derive(Debug, Default)]
pub(crate) struct Held {
    /// Each recording that the diagnosed model misses where the fitted ones have been, with the reason, in words.
    pub(crate) missed: Vec<String>,
    /// Each recording that is mostly elsewhere, or tared otherwise, in words.
    pub(crate) noticed: Vec<String>,
    /// What the model misses of such a recording there, which judges the extrapolation alone, in words.
    pub(crate) unjudged: Vec<String>,
    /// Each recording that would be missed if one model of all did not follow it, in words.
    pub(crate) followed: Vec<String>,
}

/// Whether one recording of `held` is followed worse than those of `fitted` are, by more than recordings of one muscle are.
pub(crate) fn misses_any(fitted: &Evaluation, held: &Evaluation) -> bool {
    let own_n = fitted.together.map_or(0.0, |together| together.rmse_n);
    held.each.iter().any(|each| each.rmse_n > MISSES * own_n)
}

/// Judges the held-out recordings of `diagnosis`.
///
/// # Errors
/// [`DiagnoseError::Recording`] where samples cannot be read back, or the model has no force for one.
pub(crate) fn judge(diagnosis: &Diagnosis, agreement: &Agreement) -> Result<Held, DiagnoseError> {
    let model = diagnosis.augmented.elsewhere();
    let fitted: Vec<Trace> =
        diagnosis.estimation.iter().map(|prepared| trace(prepared, model.base())).collect::<Result<_, _>>()?;
    let coverage = Coverage::of(&fitted);
    let fitted_n = together(&agreement.estimation).rmse_n;
    let base_n = together(&agreement.base_estimation).rmse_n;
    let mut held = Held::default();
    let traces = diagnosis.held.traces(&diagnosis.holdout, &model)?;
    for ((index, prepared), trace) in diagnosis.holdout.iter().enumerate().zip(traces) {
        let (left_n, base_left_n) = (agreement.holdout.each[index].rmse_n, agreement.base_holdout.each[index].rmse_n);
        let floor_n = noise_floor_n(std::slice::from_ref(prepared), model.base())?;
        let own_n = fitted_n.max(floor_n).max(diagnosis.sizes.sensors_n);
        let path = &prepared.recording.path;
        let within = coverage.within(&trace);
        let share_within = within.time_s.len() as f64 / trace.time_s.len().max(1) as f64;
        if share_within < 1.0 - TOLD_OUTSIDE {
            held.noticed.push(format!(
                "{path} is at pressures and lengths that no fitted recording was near for {:.0} % of its samples: what the model \
                 says there is extrapolated",
                100.0 * (1.0 - share_within)
            ));
        }
        if left_n <= MISSES * own_n || base_left_n <= MISSES * base_n.max(floor_n) {
            continue;
        }
        // A wrong unit or zero takes a recording elsewhere, too.
        let most_n = typical::most_tare_n(&trace, TARES);
        let readings = reading::explain(&[trace], model.base(), own_n);
        if let Some(tare) = readings.iter().find(|reading| is_tare(reading, most_n)) {
            let words = tare.words();
            held.noticed.push(format!("{path}: {words}, no more than a load cell that is tared before each recording"));
            continue;
        }
        let instrument = reading::said(&readings);
        let all_n = left_n;
        let left_n = if instrument.is_some() { left_n } else { left_n.min(rmse_n(&within)) };
        let is_of_another =
            is_of_another(left_n, typical::left_n(std::slice::from_ref(&within)), own_n, diagnosis.worst_foretold_n);
        let reason = match instrument {
            Some(instrument) => instrument,
            None if is_of_another && share_within >= LEAST_WITHIN => {
                "it is of another muscle, or differs in something that was not fitted".to_owned()
            }
            None => {
                if share_within < 1.0 - TOLD_OUTSIDE && all_n > MOST * own_n {
                    held.unjudged.push(format!("{path} is missed by {all_n:.2} N where no fitted recording was near"));
                }
                continue;
            }
        };
        let pooled_n = diagnosis.pooled.as_ref().map(|pooled| pooled.held[index].rmse_n);
        if let Some(pooled_n) = pooled_n.filter(|pooled_n| *pooled_n <= MISSES * own_n) {
            held.followed.push(format!(
                "{path} is missed by {all_n:.2} N, and by one model of all recordings by {pooled_n:.2} N"
            ));
            continue;
        }
        held.missed.push(format!(
            "{path} is missed by {left_n:.2} N, where {own_n:.2} N are left of what was fitted: {reason}"
        ));
    }
    Ok(held)
}

/// Whether a recording of which so much is left, root mean square and typically, is of another muscle than those that leave `own_n`, and
/// of which the worst is foretold by the others with an error of `worst_foretold_n`. That one is missed wherever it goes, or by far; where
/// a hand trembles, friction turns over at rest and no more is missed.
fn is_of_another(left_n: f64, typical_n: f64, own_n: f64, worst_foretold_n: f64) -> bool {
    left_n > MOST * own_n
        && left_n > AS_OTHERS * worst_foretold_n
        && (typical_n > MISSES * own_n || left_n > FAR * own_n)
}

/// Whether `reading` is a tare of `most_n` at most: as fitted recordings have one of their own each, so may one that was held out.
fn is_tare(reading: &Reading, most_n: f64) -> bool {
    matches!(reading.wrong, Wrong::Zero(zero_n) if reading.channel == "force" && zero_n.abs() <= most_n)
}

/// Root mean square of what the model of `trace` leaves of its counted samples, in N.
fn rmse_n(trace: &Trace) -> f64 {
    let counted = (0..trace.time_s.len()).filter(|&at| trace.settled[at]);
    let (sum, n) =
        counted.fold((0.0, 0_u32), |(sum, n), at| (sum + (trace.force_n[at] - trace.model_n[at]).powi(2), n + 1));
    (sum / f64::from(n.max(1))).sqrt()
}

#[cfg(test)]
mod tests;
