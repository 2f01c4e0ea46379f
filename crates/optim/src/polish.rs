//! Least squares in the unit box: Levenberg–Marquardt on the free parameters, an active set for the rest.
//!
//! The steps are those of [`levenberg_marquardt`](crate::levenberg_marquardt), which knows no
//! bounds. It is given walls that yield like stiff springs, one more residual per parameter; a parameter that
//! comes to rest inside a wall is put on it and held, and the rest settle again. Once nobody presses
//! against a wall, a held one whose gradient points inwards is released. A cost close to a parabola, as a
//! force model has, settles in a handful of rounds.
//!
//! Source: Moré (1978), "The Levenberg-Marquardt algorithm: implementation and theory"; Lawson and Hanson
//! (1974), "Solving Least Squares Problems", chapter 23, for the active set.

use nalgebra::{DMatrix, DVector};

use crate::levenberg_marquardt::{LeastSquares, minimize};

/// A sum of squares over the unit box.
pub trait Residuals {
    /// Number of parameters.
    fn n_parameters(&self) -> usize;
    /// The residuals at `x`.
    fn residuals(&self, x: &[f64]) -> DVector<f64>;
    /// Their derivatives, `n_residuals × n_parameters`.
    fn jacobian(&self, x: &[f64]) -> DMatrix<f64>;
}

/// Why the descent ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Termination {
    /// No free parameter can lower the cost any further, and no held one wants to come back.
    Converged,
    /// The rounds were used up.
    RoundsUsedUp,
    /// The residuals are not finite at the start.
    NotFinite,
}

impl Termination {
    /// Whether the result is an optimum.
    pub fn converged(self) -> bool {
        self == Self::Converged
    }
}

/// Where a descent ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Polished {
    /// The optimum, inside the unit box.
    pub x: Vec<f64>,
    /// `½ ‖r‖²` there.
    pub cost: f64,
    /// Parameters that lie on a wall and press against it.
    pub at_bound: Vec<bool>,
    /// Why it ended.
    pub termination: Termination,
    /// Evaluations of the residuals.
    pub n_evaluations: usize,
}

/// Rounds of the active set: each holds or releases one parameter.
const MAX_ROUNDS: usize = 100;

/// Descends from `start` to the nearest optimum in the unit box.
pub fn descend(problem: &dyn Residuals, start: &[f64]) -> Polished {
    let n = problem.n_parameters();
    let mut x: Vec<f64> = start.iter().map(|value| value.clamp(0.0, 1.0)).collect();
    let mut held = vec![false; n];
    let mut n_evaluations = 0;
    let mut cost = 0.5 * problem.residuals(&x).norm_squared();
    if !cost.is_finite() {
        return Polished { x, cost, at_bound: held, termination: Termination::NotFinite, n_evaluations: 1 };
    }
    let mut best = (cost, x.clone(), held.clone());
    let mut termination = Termination::RoundsUsedUp;
    for _ in 0..MAX_ROUNDS {
        let free: Vec<usize> = (0..n).filter(|&index| !held[index]).collect();
        if !free.is_empty() {
            x = settle(problem, &x, &free, &mut n_evaluations);
        }
        let mut pressed = false;
        for (value, held) in x.iter_mut().zip(&mut held) {
            if !(0.0..=1.0).contains(value) {
                *value = value.clamp(0.0, 1.0);
                *held = true;
                pressed = true;
            }
        }
        if pressed {
            continue;
        }
        cost = 0.5 * problem.residuals(&x).norm_squared();
        n_evaluations += 1;
        if cost <= best.0 {
            best = (cost, x.clone(), held.clone());
        }
        match most_eager(problem, &x, &held) {
            Some(index) => held[index] = false,
            None => {
                termination = Termination::Converged;
                break;
            }
        }
    }
    let (cost, x, at_bound) = best;
    Polished { x, cost, at_bound, termination, n_evaluations }
}

/// The held parameter that would lower the cost most by moving inwards; none if all press outwards.
fn most_eager(problem: &dyn Residuals, x: &[f64], held: &[bool]) -> Option<usize> {
    if !held.contains(&true) {
        return None;
    }
    let residuals = problem.residuals(x);
    let jacobian = problem.jacobian(x);
    let mut eager: Option<(f64, usize)> = None;
    for index in (0..x.len()).filter(|&index| held[index]) {
        let column = jacobian.column(index);
        let gradient = column.dot(&residuals);
        // Cosine between residual and column: what is left to gain, free of scale.
        let cosine = gradient / (column.norm() * residuals.norm()).max(f64::MIN_POSITIVE);
        let inwards = if x[index] >= 0.5 { cosine } else { -cosine };
        if inwards > 1e-9 && eager.is_none_or(|(most, _)| inwards > most) {
            eager = Some((inwards, index));
        }
    }
    eager.map(|(_, index)| index)
}

/// Levenberg–Marquardt over the free parameters, with walls that yield.
fn settle(problem: &dyn Residuals, x: &[f64], free: &[usize], n_evaluations: &mut usize) -> Vec<f64> {
    let jacobian = problem.jacobian(x);
    let stiffness = free.iter().map(|&index| WALL_STIFFNESS * jacobian.column(index).norm()).collect();
    let section = Section { problem, x, free, stiffness };
    let (values, evaluations) = minimize(&section, free.iter().map(|&index| x[index]).collect());
    *n_evaluations += evaluations;
    section.all(&values)
}

/// Stiffness of a wall, related to the parameter's own column: only its sign matters in the end, as
/// whoever rests inside the wall is put on it.
const WALL_STIFFNESS: f64 = 10.0;

/// The problem with some parameters held.
struct Section<'a> {
    problem: &'a dyn Residuals,
    /// Values of all parameters, of which those that are held stay.
    x: &'a [f64],
    free: &'a [usize],
    /// Of the wall of each free parameter.
    stiffness: Vec<f64>,
}

impl Section<'_> {
    /// All parameters, where the free ones have `values`.
    fn all(&self, values: &[f64]) -> Vec<f64> {
        let mut x = self.x.to_vec();
        self.free.iter().zip(values).for_each(|(&index, &value)| x[index] = value);
        x
    }
}

impl LeastSquares for Section<'_> {
    fn residuals(&self, values: &[f64]) -> DVector<f64> {
        let inner = self.problem.residuals(&self.all(values));
        let walls =
            values.iter().zip(&self.stiffness).map(|(value, stiffness)| stiffness * (value - value.clamp(0.0, 1.0)));
        let n = inner.len() + values.len();
        DVector::from_iterator(n, inner.iter().copied().chain(walls))
    }

    fn jacobian(&self, values: &[f64]) -> DMatrix<f64> {
        let inner = self.problem.jacobian(&self.all(values)).select_columns(self.free);
        let n = inner.nrows();
        let mut jacobian = inner.insert_rows(n, self.free.len(), 0.0);
        for (column, value) in values.iter().enumerate() {
            if !(0.0..=1.0).contains(value) {
                jacobian[(n + column, column)] = self.stiffness[column];
            }
        }
        jacobian
    }
}

#[cfg(test)]
mod tests;
