//! Which parameters an excitation can identify at all.
//!
//! A recording at one length says nothing of the rubber, one without reversals nothing of friction. Before
//! the search, each parameter's uncertainty is computed from the columns alone, with the range of the
//! search as what is known beforehand. A parameter that the recordings leave nearly as uncertain as
//! before is held at its nominal value, the least certain first, until all that are left are worth fitting.

use nalgebra::DMatrix;
use pam_optim::polish::Residuals;

use crate::error::IdentifyError;
use crate::problem::ForceProblem;
use crate::search_space::{Free, SearchSpace};

/// Uncertainty that must be gone for a parameter to be fitted, as a share of that before.
const MUST_LEARN: f64 = 0.5;
/// Samples that share one independent error: a tenth of a second to a second at usual rates.
const SAMPLES_PER_ERROR: f64 = 50.0;

/// Remaining uncertainty of each parameter as a share of that before the recordings, at `center`.
fn remaining(problem: &ForceProblem<'_>, center: &[f64], noise_n: f64, held: &[bool]) -> Vec<f64> {
    let free: Vec<usize> = (0..held.len()).filter(|&index| !held[index]).collect();
    let jacobian = problem.jacobian(center).select_columns(&free);
    let n_independent = (problem.summary.n_rows() as f64 / SAMPLES_PER_ERROR).max(1.0);
    let information = jacobian.transpose() * &jacobian * (n_independent / (noise_n * noise_n));
    // Uniform over the unit box: variance 1/12.
    let prior = 12.0;
    let total = information + DMatrix::identity(free.len(), free.len()) * prior;
    let mut remaining = vec![0.0; held.len()];
    if let Some(inverse) = total.try_inverse() {
        for (position, &index) in free.iter().enumerate() {
            remaining[index] = (inverse[(position, position)] * prior).sqrt();
        }
    }
    remaining
}

/// Parameters that the recordings cannot identify: true where one is to be held.
pub fn unidentifiable(problem: &ForceProblem<'_>, center: &[f64], noise_n: f64) -> Vec<bool> {
    let mut held = vec![false; problem.n_parameters()];
    loop {
        let remaining = remaining(problem, center, noise_n, &held);
        let mut worst: Option<usize> = None;
        for index in (0..held.len()).filter(|&index| !held[index]) {
            if remaining[index] > MUST_LEARN && worst.is_none_or(|worst| remaining[index] > remaining[worst]) {
                worst = Some(index);
            }
        }
        match worst {
            Some(index) => held[index] = true,
            None => return held,
        }
    }
}

/// Refuses a search that has nothing to move; `path` is the first recording.
///
/// # Errors
/// [`IdentifyError::NothingIdentifiable`], [`IdentifyError::EverythingFixed`].
pub fn something_to_fit(space: &SearchSpace, unidentifiable: &[Free], path: &str) -> Result<(), IdentifyError> {
    if !space.free.is_empty() {
        return Ok(());
    }
    if unidentifiable.is_empty() {
        return Err(IdentifyError::EverythingFixed);
    }
    let names: Vec<&str> = unidentifiable.iter().map(|free| free.name()).collect();
    Err(IdentifyError::NothingIdentifiable { path: path.to_owned(), names: names.join(", ") })
}
