//! Robust weights: samples far from the model count less.
//!
//! Huber's loss by iteratively reweighted least squares. A residual within `c = 1.345` robust standard
//! deviations (`1.4826` times the median of absolute residuals) has weight 1, one beyond it weight
//! `c σ / |r|`. Each round is one more pass over the recordings.
//!
//! Source: Huber (1964), "Robust estimation of a location parameter"; `c` keeps 95 % of the efficiency on
//! normal errors.

use pam_muscle::force::ForceModel;
use pam_muscle::force::columns::ForceColumns;
use pam_optim::polish::descend;

use crate::condense::{Condensed, condense};
use crate::error::IdentifyError;
use crate::fit::Fit;
use crate::prepare::Prepared;
use crate::problem::ForceProblem;
use crate::search_space::SearchSpace;
use crate::trace::trace;

const TUNING: f64 = 1.345;
const MAX_ROUNDS: usize = 40;

/// Continues `fit` with Huber's loss; gives the weighted summary that it ended with.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn reweight(
    recordings: &[Prepared],
    columns: &ForceColumns,
    space: &SearchSpace,
    model_of: &dyn Fn(&[f64]) -> ForceModel,
    mut fit: Fit,
) -> Result<(Fit, Condensed), IdentifyError> {
    let mut rounds = 0;
    loop {
        let scale_n = robust_scale_n(recordings, &model_of(&fit.x))?;
        let weights = columns.weights(&space.parameters(&fit.x));
        let weight = |force_n: f64, row: &[f64]| {
            let modelled_n: f64 = row.iter().zip(&weights).map(|(column, weight)| column * weight).sum();
            (TUNING * scale_n / (force_n - modelled_n).abs().max(f64::MIN_POSITIVE)).min(1.0)
        };
        let condensed = condense(recordings, columns, 1, Some(&weight))?;
        let problem = ForceProblem { summary: &condensed.total, columns, space, steps: &[] };
        let polished = descend(&problem, &fit.x);
        let moved = polished.x.iter().zip(&fit.x).map(|(new, old)| (new - old).abs()).fold(0.0, f64::max);
        fit.x = polished.x;
        fit.at_bound = polished.at_bound;
        fit.mean_square = 2.0 * polished.cost;
        rounds += 1;
        if moved < 1e-7 || rounds == MAX_ROUNDS {
            fit.converged = polished.termination.converged() && moved < 1e-4;
            return Ok((fit, condensed));
        }
    }
}

/// `1.4826` times the median of absolute residuals, in N.
fn robust_scale_n(recordings: &[Prepared], model: &ForceModel) -> Result<f64, IdentifyError> {
    let mut magnitudes: Vec<f64> = Vec::new();
    for prepared in recordings {
        let trace = trace(prepared, model)?;
        let residuals = trace.force_n.iter().zip(&trace.model_n).zip(&trace.settled);
        magnitudes.extend(residuals.filter(|(_, settled)| **settled).map(|((force, model), _)| (force - model).abs()));
    }
    magnitudes.retain(|value| value.is_finite());
    if magnitudes.is_empty() {
        return Ok(1.0);
    }
    let middle = magnitudes.len() / 2;
    let (_, median, _) = magnitudes.select_nth_unstable_by(middle, f64::total_cmp);
    Ok((1.4826 * *median).max(1e-9))
}
