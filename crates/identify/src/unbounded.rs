//! The same columns with weights free of any sign or range: what eq. 11 could reach if physics did not bind it.

use nalgebra::{DMatrix, DVector};
use pam_core::artifact::model::ImpliedParameter;
use pam_core::force::columns::{BLADDER, BRAID, FRICTION, ForceColumns, N_COLUMNS};
use pam_optim::summary::Summary;

/// Columns that take part: the stretch of the strands with its first-order column alone, as the others bend
/// it to no purpose here.
const TAKING_PART: [usize; 9] = [0, 1, 2, 3, BLADDER, BLADDER + 1, BRAID, FRICTION, FRICTION + 1];

/// Weights that fit `summary` best, with no bound on any of them; all [`N_COLUMNS`], those that take no part
/// zero.
pub fn best_weights(summary: &Summary) -> Vec<f64> {
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
    if let Ok(solved) = matrix.svd(true, true).solve(&rhs, 1e-10) {
        for (position, &column) in TAKING_PART.iter().enumerate() {
            weights[column] = solved[position] / scales[position];
        }
    }
    weights
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
