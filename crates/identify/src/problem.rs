//! The cost of a point of the search space, from a summary alone.

use nalgebra::{DMatrix, DVector};
use pam_muscle::force::columns::{ForceColumns, N_COLUMNS};
use pam_optim::polish::Residuals;
use pam_optim::summary::{SquareSum, Summary};
use pam_optim::swarm::Axes;

use crate::search_space::SearchSpace;

/// Least squares over a search space. The summary has the columns of eq. 11 and, after them, one column
/// for each dimension that is linearized around its present value (none in the usual fit).
#[derive(Debug)]
pub struct ForceProblem<'a> {
    /// What the recordings condense to.
    pub summary: &'a Summary,
    /// Columns of eq. 11.
    pub columns: &'a ForceColumns,
    /// What is moved.
    pub space: &'a SearchSpace,
    /// Ranges of the steps of the linearized dimensions, in SI.
    pub steps: &'a [(f64, f64)],
}

impl ForceProblem<'_> {
    /// Weights of all columns of the summary at a point of the unit box.
    pub fn weights(&self, x: &[f64]) -> Vec<f64> {
        let mut weights = Vec::with_capacity(self.summary.n_columns());
        self.put_weights(x, &mut weights);
        weights
    }

    /// As [`weights`](Self::weights), in place of what `weights` holds.
    fn put_weights(&self, x: &[f64], weights: &mut Vec<f64>) {
        let n_free = self.space.free.len();
        weights.clear();
        weights.extend(self.columns.weights(&self.space.parameters(&x[..n_free])));
        weights.extend(self.steps.iter().zip(&x[n_free..]).map(|((low, high), x)| low + x * (high - low)));
    }

    /// Derivatives of the [weights](Self::weights) by the coordinates: `n_columns × n_parameters`.
    pub fn weight_jacobian(&self, x: &[f64]) -> DMatrix<f64> {
        let n_free = self.space.free.len();
        let slopes = self.columns.weight_slopes(&self.space.parameters(&x[..n_free]));
        let mut jacobian = DMatrix::zeros(self.summary.n_columns(), n_free + self.steps.len());
        for index in 0..n_free {
            let column = self.space.pull_back(index, &slopes);
            jacobian.view_mut((0, index), (N_COLUMNS, 1)).copy_from_slice(&column);
        }
        for (index, (low, high)) in self.steps.iter().enumerate() {
            jacobian[(N_COLUMNS + index, n_free + index)] = high - low;
        }
        jacobian
    }

    /// Mean square of the residual, in N².
    pub fn mean_square(&self, x: &[f64]) -> f64 {
        self.mean_squares()(x)
    }

    /// The [mean square](Self::mean_square) as a function to be called many times.
    pub fn mean_squares(&self) -> impl FnMut(&[f64]) -> f64 {
        let (square_sum, mut weights) = (SquareSum::of(self.summary), Vec::new());
        move |x| {
            self.put_weights(x, &mut weights);
            square_sum.at(&weights) / self.n_rows()
        }
    }

    /// What weights without bounds leave, in N²: no parameters leave less.
    pub fn floor_mean_square(&self) -> f64 {
        self.summary.residual_floor_square_sum() / self.n_rows()
    }

    fn n_rows(&self) -> f64 {
        self.summary.n_rows().max(1) as f64
    }

    /// Coordinates in which the cost is nearly round at `center`: the Cholesky factor of the Gauss–Newton
    /// Hessian there. None where the Hessian is not positive.
    pub fn round_axes(&self, center: &[f64]) -> Option<Axes> {
        let jacobian = self.jacobian(center);
        let n = jacobian.ncols();
        let mut hessian = jacobian.transpose() * &jacobian;
        // Directions that the data do not see at all keep a length.
        let floor = 1e-12 * hessian.trace() / n as f64;
        for index in 0..n {
            hessian[(index, index)] += floor;
        }
        let factor = hessian.cholesky()?.l();
        let to_round = factor.transpose();
        let from_round = to_round.clone().try_inverse()?;
        // Row-major, as the swarm walks it.
        let rows = |matrix: &DMatrix<f64>| matrix.transpose().as_slice().to_vec();
        Some(Axes { from_round: rows(&from_round), to_round: rows(&to_round) })
    }
}

impl Residuals for ForceProblem<'_> {
    fn n_parameters(&self) -> usize {
        self.space.free.len() + self.steps.len()
    }

    /// `(z - R w) / √n`, and `ρ / √n` last: half their square sum is half the mean square.
    fn residuals(&self, x: &[f64]) -> DVector<f64> {
        let weights = self.weights(x);
        let n = self.summary.n_columns();
        let scale = 1.0 / self.n_rows().sqrt();
        let mut residuals = DVector::zeros(n + 1);
        for row in 0..n {
            let entries = self.summary.row(row);
            let modelled: f64 = entries[row..n].iter().zip(&weights[row..]).map(|(entry, weight)| entry * weight).sum();
            residuals[row] = scale * (entries[n] - modelled);
        }
        residuals[n] = scale * self.summary.residual_floor_square_sum().sqrt();
        residuals
    }

    fn jacobian(&self, x: &[f64]) -> DMatrix<f64> {
        let slopes = self.weight_jacobian(x);
        let n = self.summary.n_columns();
        let scale = 1.0 / self.n_rows().sqrt();
        let mut jacobian = DMatrix::zeros(n + 1, slopes.ncols());
        for parameter in 0..slopes.ncols() {
            let slope = slopes.column(parameter);
            for row in 0..n {
                let entries = self.summary.row(row);
                let mut sum = 0.0;
                for column in row..n {
                    sum += entries[column] * slope[column];
                }
                jacobian[(row, parameter)] = -scale * sum;
            }
        }
        jacobian
    }
}
