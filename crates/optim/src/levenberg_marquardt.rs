//! Nonlinear least squares without bounds, by Levenberg and Marquardt.
//!
//! Each step minimizes the linearized sum of squares within a region in which the linearization is trusted; the region grows
//! where the sum falls as predicted and shrinks where it does not.
//!
//! Source: Moré (1978), "The Levenberg-Marquardt algorithm: implementation and theory", in the scaling and with the
//! constants of MINPACK's `lmder`.

use nalgebra::{DMatrix, DVector};

use crate::trust_region::{Factored, Step, norm};

/// Relative reduction of the sum of squares, relative step, and cosine between residuals and columns, below each of which
/// it ends: the rounding of the cost itself.
const TOLERANCE: f64 = 1e-14;
/// Evaluations per parameter (and one), at most.
const PATIENCE: usize = 100;
/// The first region, in scaled lengths of the start.
const FIRST_REGION: f64 = 100.0;

/// Residuals and their derivatives.
pub(crate) trait LeastSquares {
    /// At `x`.
    fn residuals(&self, x: &[f64]) -> DVector<f64>;
    /// At `x`, `n_residuals × n_parameters`, with at least as many rows as columns.
    fn jacobian(&self, x: &[f64]) -> DMatrix<f64>;
}

/// Where it is, and how far it is trusted.
struct State {
    x: Vec<f64>,
    residual_norm: f64,
    /// Scale of each parameter: the largest norm that its column had.
    d: Vec<f64>,
    /// `‖D x‖`.
    scaled_norm: f64,
    bound: f64,
    lambda: f64,
    n_evaluations: usize,
}

/// What became of a step.
enum Outcome {
    /// It was taken; residuals there.
    Taken(DVector<f64>),
    /// It was not: the region is smaller now.
    Refused,
    /// There is nothing left to gain.
    Done,
}

/// Descends from `start`: where it ends, and how often the residuals were evaluated.
pub(crate) fn minimize(problem: &dyn LeastSquares, start: Vec<f64>) -> (Vec<f64>, usize) {
    let mut residuals = problem.residuals(&start);
    let residual_norm = norm(residuals.as_slice());
    let n = start.len();
    let mut state =
        State { x: start, residual_norm, d: vec![0.0; n], scaled_norm: 0.0, bound: 0.0, lambda: 0.0, n_evaluations: 1 };
    if n == 0 || !residual_norm.is_finite() || residual_norm <= f64::MIN_POSITIVE {
        return (state.x, state.n_evaluations);
    }
    let mut is_first = true;
    'moves: loop {
        let factored = Factored::of(&problem.jacobian(&state.x), &residuals);
        let Some(cosine) = factored.largest_cosine(state.residual_norm).filter(|cosine| *cosine > TOLERANCE) else {
            break;
        };
        state.rescale(&factored, is_first);
        if !state.scaled_norm.is_finite() {
            break;
        }
        residuals = loop {
            let step = factored.step(&state.d, state.bound, state.lambda);
            match state.take(problem, &factored, &step, std::mem::take(&mut is_first)) {
                Outcome::Taken(residuals) => break residuals,
                Outcome::Refused if cosine > f64::EPSILON => {}
                Outcome::Refused | Outcome::Done => break 'moves,
            }
        };
    }
    (state.x, state.n_evaluations)
}

impl State {
    fn rescale(&mut self, factored: &Factored, is_first: bool) {
        for (scale, &column) in self.d.iter_mut().zip(&factored.column_norms) {
            *scale = if is_first && column == 0.0 { 1.0 } else { scale.max(column) };
        }
        if is_first {
            self.scaled_norm = self.scaled();
            self.bound = if self.scaled_norm == 0.0 { FIRST_REGION } else { FIRST_REGION * self.scaled_norm };
        }
    }

    /// `‖D x‖`.
    fn scaled(&self) -> f64 {
        self.x.iter().zip(&self.d).map(|(x, d)| (x * d) * (x * d)).sum::<f64>().sqrt()
    }

    /// Takes `step` where it lowers the sum of squares, and fits the region to how well that was predicted.
    fn take(&mut self, problem: &dyn LeastSquares, factored: &Factored, step: &Step, is_first: bool) -> Outcome {
        self.lambda = step.lambda;
        let length = step.scaled_norm;
        let linear = (factored.image_norm(&step.p) / self.residual_norm).powi(2);
        let damping = (step.lambda.sqrt() * length / self.residual_norm).powi(2);
        if !(length.is_finite() && linear.is_finite() && damping.is_finite()) {
            return Outcome::Done;
        }
        let predicted = linear + 2.0 * damping;
        let slope = -(linear + damping);
        if is_first && length < self.bound {
            self.bound = length;
        }
        let x: Vec<f64> = self.x.iter().zip(&step.p).map(|(x, p)| x - p).collect();
        let residuals = problem.residuals(&x);
        self.n_evaluations += 1;
        let residual_norm = norm(residuals.as_slice());
        // What grows tenfold is refused without a look at how far.
        let is_far = 0.1 * residual_norm >= self.residual_norm;
        let actual = if 0.1 * residual_norm < self.residual_norm {
            1.0 - (residual_norm / self.residual_norm).powi(2)
        } else {
            -1.0
        };
        let ratio = if predicted == 0.0 { 0.0 } else { actual / predicted };
        if ratio <= 0.25 {
            let shrunk = if actual >= 0.0 { 0.5 } else { 0.5 * slope / (slope + 0.5 * actual) };
            let factor = if is_far || shrunk < 0.1 { 0.1 } else { shrunk };
            self.bound = factor * self.bound.min(10.0 * length);
            self.lambda /= factor;
        } else if self.lambda == 0.0 || ratio >= 0.75 {
            self.bound = 2.0 * length;
            self.lambda *= 0.5;
        }
        let is_taken = ratio >= 1e-4;
        if is_taken {
            self.x = x;
            self.scaled_norm = self.scaled();
            self.residual_norm = residual_norm;
        }
        let no_gain = actual.abs() <= TOLERANCE && predicted <= TOLERANCE && ratio <= 2.0;
        let no_move = self.bound <= TOLERANCE * self.scaled_norm;
        let is_zero = self.residual_norm <= f64::MIN_POSITIVE;
        let out_of_patience = self.n_evaluations >= PATIENCE * (self.x.len() + 1);
        if no_gain || no_move || is_zero || out_of_patience || !self.scaled_norm.is_finite() {
            return Outcome::Done;
        }
        if is_taken { Outcome::Taken(residuals) } else { Outcome::Refused }
    }
}
