//! A recording that is there twice.
//!
//! Fitted twice, its samples count twice and standard errors shrink for nothing; fitted and held out, it proves nothing. Its
//! samples tell, not its name: see [`first_shared`].

use pam_recording::{Recording, first_shared, repeats_itself};
use rayon::prelude::*;

use crate::error::IdentifyError;

/// Refuses recordings that share samples.
///
/// # Errors
/// [`IdentifyError::FittedTwice`], [`IdentifyError::HeldOutAndFitted`] or [`IdentifyError::HeldOutTwice`] names both;
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn check(estimation: &[Recording], holdout: &[Recording]) -> Result<(), IdentifyError> {
    let all: Vec<&Recording> = estimation.iter().chain(holdout).collect();
    let shared = first_shared(&all);
    let shared = shared.map_err(|(index, reason)| IdentifyError::Samples { path: all[index].path.clone(), reason })?;
    let Some((first, second)) = shared else { return Ok(()) };
    let (path, other) = (all[second].path.clone(), all[first].path.clone());
    let n_estimation = estimation.len();
    Err(match (first < n_estimation, second < n_estimation) {
        (_, true) => IdentifyError::FittedTwice { path, other },
        (true, false) => IdentifyError::HeldOutAndFitted { path, other },
        (false, false) => IdentifyError::HeldOutTwice { path, other },
    })
}

/// Message about recordings of which a stretch stands in them once more: a word for each.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn repeated(recordings: &[&Recording]) -> Result<Vec<String>, IdentifyError> {
    let of_one = |recording: &&Recording| {
        let repeated = repeats_itself(recording);
        let repeated = repeated.map_err(|reason| IdentifyError::Samples { path: recording.path.clone(), reason })?;
        Ok(repeated.map(|found| {
            format!(
                "{}: rows from {} on stand there once more from {} on, noise and all ({} % of the recording): they count twice, and \
                 standard errors are too small; cut one of the two out",
                recording.path,
                found.row + 1,
                found.again + 1,
                found.percent
            )
        }))
    };
    let words: Result<Vec<Option<String>>, IdentifyError> = recordings.par_iter().map(of_one).collect();
    Ok(words?.into_iter().flatten().collect())
}
