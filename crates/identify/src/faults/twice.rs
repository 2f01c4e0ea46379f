//! A recording that is there twice.
//!
//! Fitted twice, its samples count twice and standard errors shrink for nothing; fitted and held out, it proves nothing. Its
//! samples tell, not its name: see [`share_samples`].

use pam_core::recording::{Recording, share_samples};
use rayon::prelude::*;

use crate::error::IdentifyError;

/// Refuses recordings that share samples.
///
/// # Errors
/// [`IdentifyError::FittedTwice`], [`IdentifyError::HeldOutAndFitted`] or [`IdentifyError::HeldOutTwice`] names both;
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn check(estimation: &[Recording], holdout: &[Recording]) -> Result<(), IdentifyError> {
    let all: Vec<&Recording> = estimation.iter().chain(holdout).collect();
    let pairs: Vec<(usize, usize)> =
        (0..all.len()).flat_map(|second| (0..second).map(move |first| (first, second))).collect();
    let shared: Result<Vec<bool>, IdentifyError> = pairs
        .par_iter()
        .map(|&(first, second)| {
            share_samples(all[first], all[second])
                .map_err(|reason| IdentifyError::Samples { path: all[second].path.clone(), reason })
        })
        .collect();
    let Some(place) = shared?.into_iter().position(|shared| shared) else { return Ok(()) };
    let (first, second) = pairs[place];
    let (path, other) = (all[second].path.clone(), all[first].path.clone());
    let n_estimation = estimation.len();
    Err(match (first < n_estimation, second < n_estimation) {
        (_, true) => IdentifyError::FittedTwice { path, other },
        (true, false) => IdentifyError::HeldOutAndFitted { path, other },
        (false, false) => IdentifyError::HeldOutTwice { path, other },
    })
}
