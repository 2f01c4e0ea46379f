//! What was held out decides the verdict: a recording that the diagnosed model misses is named, with what would explain it.
//!
//! A recording of the same muscle is followed a little worse than those that were fitted, by every model. One whose residual is
//! several times theirs under both the base and the diagnosed model differs in something that no fit has seen: an instrument,
//! or the muscle.

use pam_identification::evaluate::{noise_floor_n, trace_augmented};
use pam_identification::faults::reading::{self, MISSES};

use crate::artifact::{Agreement, together};
use crate::diagnose::Diagnosis;
use crate::error::DiagnoseError;

/// Times what is left of the fitted recordings that may be left of a held-out one, whatever the reason. A recording or two do
/// not say what eq. 11 is elsewhere (2.6 times was seen of a healthy muscle), and memory goes on from recording to recording.
const MOST: f64 = 4.0;

/// Each held-out recording that the diagnosed model misses, with the reason, in words.
pub(crate) fn missed(diagnosis: &Diagnosis, agreement: &Agreement) -> Result<Vec<String>, DiagnoseError> {
    let model = diagnosis.augmented.without_events();
    let fitted_n = together(&agreement.estimation).rmse_n;
    let base_n = together(&agreement.base_estimation).rmse_n;
    let mut words = Vec::new();
    for (index, prepared) in diagnosis.holdout.iter().enumerate() {
        let (left_n, base_left_n) = (agreement.holdout.each[index].rmse_n, agreement.base_holdout.each[index].rmse_n);
        let floor_n = noise_floor_n(std::slice::from_ref(prepared), model.base())?;
        let own_n = fitted_n.max(floor_n).max(diagnosis.sizes.sensors_n);
        if left_n <= MISSES * own_n || base_left_n <= MISSES * base_n.max(floor_n) {
            continue;
        }
        let trace = trace_augmented(prepared, &model, diagnosis.model.direction, index)?;
        let reason = match reading::said(&reading::explain(&[trace], model.base(), own_n)) {
            Some(instrument) => instrument,
            None if left_n > MOST * own_n => {
                "it is of another muscle, or differs in something that was not fitted".to_owned()
            }
            None => continue,
        };
        let path = &prepared.recording.path;
        words.push(format!(
            "{path} is missed by {left_n:.2} N, where {own_n:.2} N are left of what was fitted: {reason}"
        ));
    }
    Ok(words)
}
