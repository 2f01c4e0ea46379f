//! Standard errors that respect autocorrelation: leave one stretch out, over all stretches.
//!
//! Neighboring residuals share their errors, so that a recording is worth far fewer independent samples than
//! it has rows. The estimate is therefore repeated without each stretch in turn; how far it moves says how
//! uncertain it is, whatever the correlation inside a stretch. With the scores `g_b = J_bᵀ r_b` and the
//! Gauss–Newton Hessians `H_b` of the stretches, both of which their summaries give,
//!
//! ```text
//! δ_b = -(H - H_b)⁻¹ g_b,   cov = (G - 1)/G Σ_b δ_b δ_bᵀ
//! ```
//!
//! Stretches of a few seconds or more outlast the correlation of sensor noise. A misfit of the model that lasts a
//! whole recording outlasts them, and is then underestimated; the report of the fit shows it.
//!
//! Source: the delete-a-group jackknife, CV₃ of MacKinnon, Nielsen and Webb (2023), "Cluster-robust
//! inference: a guide to empirical practice", J. Econometrics 232(2).

use nalgebra::{DMatrix, DVector};

use crate::condense::Condensed;
use crate::problem::ForceProblem;

/// Covariance of an estimate, in coordinates of the unit box.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// Standard error of each coordinate; none for one at its bound or held.
    pub stderr: Vec<Option<f64>>,
    /// Correlation between coordinates; 0 off the diagonal where either has no standard error.
    pub correlation: DMatrix<f64>,
    /// Independent samples that the recordings are worth: rows times the variance that white residuals
    /// would give, over the variance found, at its median over the parameters.
    pub effective_samples: f64,
}

/// Uncertainty of the estimate `x`, with coordinates `at_bound` held there.
pub fn jackknife(problem: &ForceProblem<'_>, condensed: &Condensed, x: &[f64], at_bound: &[bool]) -> Uncertainty {
    let n = x.len();
    let free: Vec<usize> = (0..n).filter(|&index| !at_bound[index]).collect();
    let mut stderr = vec![None; n];
    let mut correlation = DMatrix::identity(n, n);
    let slopes = problem.weight_jacobian(x).select_columns(&free);
    let weights = problem.weights(x);
    let pieces: Vec<(DMatrix<f64>, DVector<f64>)> = condensed
        .stretches
        .iter()
        .filter(|stretch| stretch.summary.n_rows() > 0)
        .map(|stretch| {
            let columns = stretch.summary.n_columns();
            let triangle = DMatrix::from_fn(columns, columns, |row, column| stretch.summary.row(row)[column]);
            let jacobian = triangle * &slopes;
            let score = slopes.transpose() * DVector::from_vec(stretch.summary.score(&weights));
            (jacobian.transpose() * &jacobian, score)
        })
        .collect();
    let n_rows = condensed.total.n_rows() as f64;
    let white = Uncertainty { stderr: stderr.clone(), correlation: correlation.clone(), effective_samples: n_rows };
    if free.is_empty() || pieces.len() < 2 {
        return white;
    }
    let hessian = pieces.iter().fold(DMatrix::zeros(free.len(), free.len()), |sum, (piece, _)| sum + piece);
    let mut covariance = DMatrix::zeros(free.len(), free.len());
    for (piece, score) in &pieces {
        // A stretch that alone determines a parameter cannot be left out; its neighbors speak for it.
        if let Some(factor) = (&hessian - piece).cholesky() {
            let shift = factor.solve(score);
            covariance += &shift * shift.transpose();
        }
    }
    covariance *= (pieces.len() - 1) as f64 / pieces.len() as f64;
    let Some(inverse) = hessian.try_inverse() else { return white };
    let mean_square = problem.mean_square(x);
    let mut shares: Vec<f64> = Vec::new();
    for (position, &index) in free.iter().enumerate() {
        let variance = covariance[(position, position)];
        stderr[index] = Some(variance.sqrt());
        if variance > 0.0 {
            shares.push(mean_square * inverse[(position, position)] / variance);
        }
        for (other_position, &other) in free.iter().enumerate() {
            let scale = (variance * covariance[(other_position, other_position)]).sqrt();
            if index != other && scale > 0.0 {
                correlation[(index, other)] = covariance[(position, other_position)] / scale;
            }
        }
    }
    shares.sort_unstable_by(f64::total_cmp);
    let share = shares.get(shares.len() / 2).copied().unwrap_or(1.0);
    Uncertainty { stderr, correlation, effective_samples: (share * n_rows).min(n_rows) }
}
