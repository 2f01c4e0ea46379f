//! Effects of the catalogue that come nearest to a term, and what speaks against each.

use pam_artifact::diagnosis::NearestEffect;

use crate::joint::HeldOut;
use crate::search::Found;

/// Effects that are listed.
const LISTED: usize = 3;
/// Evidence below which an effect is not near.
const NEAR: f64 = 0.5;

/// The effects that gain most alone and were not named; `with` is what the terms leave.
pub(super) fn nearest(found: &Found, with: &HeldOut) -> Vec<NearestEffect> {
    let named: Vec<&str> = found.best.state.guesses.iter().map(|guess| guess.id()).collect();
    let near = found.first.iter().filter(|trial| trial.log_ratio > NEAR && !named.contains(&trial.guess.id()));
    near.take(LISTED)
        .map(|trial| {
            let left_n = trial.held_out.mean_square().sqrt();
            let (without_n, with_n) = (trial.before.mean_square().sqrt(), with.mean_square().sqrt());
            let harmed = trial.before.log_ratios(&trial.held_out).filter(|ratio| *ratio < -0.05).count();
            let against = if left_n >= without_n {
                format!("cross-validated RMSE {left_n:.2} N, no better than without it ({without_n:.2} N)")
            } else {
                let blocks = if harmed > 0 {
                    format!("; {harmed} of {} blocks become worse", trial.held_out.blocks.len())
                } else {
                    String::new()
                };
                format!("cross-validated RMSE {left_n:.2} N, where the empirical terms leave {with_n:.2} N{blocks}")
            };
            NearestEffect { id: trial.guess.id().to_owned(), rmse_with_n: left_n, against }
        })
        .collect()
}
