//! The same columns with weights free of any sign or range: what eq. 11 could reach if physics did not bind it.

use nalgebra::{DMatrix, DVector};
use pam_artifact::model::{ImpliedParameter, UnboundedFit};
use pam_muscle::force::columns::{BLADDER, BRAID, FRICTION, ForceColumns, N_COLUMNS};
use pam_optim::summary::Summary;

use crate::condense::{Condensed, condense};
use crate::error::IdentifyError;
use crate::prepare::Prepared;

/// Columns that take part: the stretch of the strands with its first-order column alone, as the others bend
/// it to no purpose here.
const TAKING_PART: [usize; 9] = [0, 1, 2, 3, BLADDER, BLADDER + 1, BRAID, FRICTION, FRICTION + 1];

/// Rotations after which a decomposition has failed; some dozen do, and columns beyond all sense never end.
const MAX_ROTATIONS: usize = 1000;

/// Weights that fit `summary` best, with no bound on any of them; all [`N_COLUMNS`], those that take no part
/// zero. None where the columns are so far from any muscle's that arithmetic fails.
pub fn best_weights(summary: &Summary) -> Option<Vec<f64>> {
    let n = summary.n_columns();
    let mut matrix = DMatrix::from_fn(n, TAKING_PART.len(), |row, column| summary.row(row)[TAKING_PART[column]]);
    let rhs = DVector::from_fn(n, |row, _| summary.row(row)[n]);
    let scales: Vec<f64> =
        matrix.column_iter().map(|column| Some(column.norm()).filter(|norm| *norm > 0.0).unwrap_or(1.0)).collect();
    for (mut column, scale) in matrix.column_iter_mut().zip(&scales) {
        column /= *scale;
    }
    let mut weights = vec![0.0; N_COLUMNS];
    // Columns that the data cannot tell apart share their weight: minimum norm.
    let solved = matrix.try_svd(true, true, 5.0 * f64::EPSILON, MAX_ROTATIONS)?.solve(&rhs, 1e-10).ok()?;
    for (position, &column) in TAKING_PART.iter().enumerate() {
        weights[column] = solved[position] / scales[position];
    }
    weights.iter().all(|weight| weight.is_finite()).then_some(weights)
}

/// What free weights would mean as parameters, and whether a muscle can have them.
pub fn implied(columns: &ForceColumns, weights: &[f64]) -> Vec<ImpliedParameter> {
    let [k1, k1_k2, k1_k2_k2] = columns.gas().implied([weights[0], weights[1], weights[2]]);
    let sign = columns.form().bladder_sign();
    let compliance = weights[BRAID] * columns.first_node_per_pa();
    let entry = |name: &str, value: f64, unit: &str, physical: bool| ImpliedParameter {
        name: name.to_owned(),
        value,
        unit: unit.to_owned(),
        physical,
    };
    let positive = |value: f64| value >= 0.0;
    vec![
        entry("k1", k1, "1", positive(k1)),
        entry("k1 k2", k1_k2, "1", positive(k1_k2)),
        // Three weights for two parameters: physical only where they agree.
        entry("k1 k2^2", k1_k2_k2, "1", positive(k1_k2_k2) && agrees(k1 * k1_k2_k2, k1_k2 * k1_k2)),
        entry("k3", weights[3], "N", weights[3].abs() <= 50.0),
        entry("c10", sign * weights[BLADDER], "Pa", positive(sign * weights[BLADDER])),
        entry("c01", sign * weights[BLADDER + 1], "Pa", positive(sign * weights[BLADDER + 1])),
        entry("1/strand_modulus", compliance, "1/Pa", positive(compliance)),
        entry("rubber_friction", weights[FRICTION], "1", positive(weights[FRICTION])),
        entry("strand_friction", weights[FRICTION + 1], "1", positive(weights[FRICTION + 1])),
    ]
}

/// Within 20 %, which no uncertainty of a bench recording exceeds.
fn agrees(left: f64, right: f64) -> bool {
    (left - right).abs() <= 0.2 * left.abs().max(right.abs())
}

/// Weights without bounds; none where the recordings are so far from any muscle's that there are none.
pub(crate) fn unbounded_fit(
    columns: &ForceColumns,
    condensed: &Condensed,
    validation: &[Prepared],
) -> Result<Option<UnboundedFit>, IdentifyError> {
    let Some(weights) = best_weights(&condensed.total) else { return Ok(None) };
    let rmse_n = |condensed: &Condensed| {
        (condensed.total.residual_square_sum(&weights) / condensed.total.n_rows().max(1) as f64).sqrt()
    };
    let validation_rmse_n =
        if validation.is_empty() { None } else { Some(rmse_n(&condense(validation, columns, 1, None)?)) };
    Ok(Some(UnboundedFit {
        estimation_rmse_n: rmse_n(condensed),
        validation_rmse_n,
        implied: implied(columns, &weights),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns that have nothing to do with one another, and `y` with a share of 1 of each.
    fn summary(first: f64) -> Summary {
        let width = N_COLUMNS + 1;
        let mut triangle = vec![0.0; width * width];
        for row in 0..N_COLUMNS {
            triangle[row * width + row] = 1.0;
            triangle[row * width + N_COLUMNS] = 1.0;
        }
        triangle[0] = first;
        Summary::from_triangle(N_COLUMNS, triangle, 100)
    }

    #[test]
    fn weights_are_those_of_the_columns() {
        let weights = best_weights(&summary(2.0)).expect("columns in order");
        assert!((weights[0] - 0.5).abs() < 1e-12 && (weights[1] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn columns_beyond_all_sense_have_no_weights_and_end() {
        for first in [f64::INFINITY, f64::NAN, 1e-320] {
            assert!(
                best_weights(&summary(first)).is_none_or(|weights| weights.iter().all(|weight| weight.is_finite()))
            );
        }
        assert_eq!(best_weights(&summary(f64::INFINITY)), None);
    }
}
