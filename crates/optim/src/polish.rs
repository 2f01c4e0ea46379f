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
mod tests {
    use super::*;

    /// Rosenbrock's valley, in coordinates that put its bottom at (0.75, 0.75) or outside the box.
    struct Rosenbrock {
        scale: f64,
    }

    impl Residuals for Rosenbrock {
        fn n_parameters(&self) -> usize {
            2
        }
        fn residuals(&self, x: &[f64]) -> DVector<f64> {
            let (a, b) = (self.scale * (x[0] - 0.5), self.scale * (x[1] - 0.5));
            DVector::from_vec(vec![10.0 * (b - a * a), 1.0 - a])
        }
        fn jacobian(&self, x: &[f64]) -> DMatrix<f64> {
            let a = self.scale * (x[0] - 0.5);
            DMatrix::from_row_slice(2, 2, &[-20.0 * a * self.scale, 10.0 * self.scale, -self.scale, 0.0])
        }
    }

    #[test]
    fn walks_to_the_end_of_a_curved_valley() {
        let found = descend(&Rosenbrock { scale: 4.0 }, &[0.2, 0.9]);
        assert!(found.termination.converged());
        assert!((found.x[0] - 0.75).abs() < 1e-8 && (found.x[1] - 0.75).abs() < 1e-8, "{:?}", found.x);
        assert_eq!(found.at_bound, [false, false]);
    }

    #[test]
    fn stops_at_the_wall_where_the_bottom_lies_outside() {
        // Bottom at a = b = 1, walls at ±0.5: the best is a = 0.5, b = 0.25.
        let found = descend(&Rosenbrock { scale: 1.0 }, &[0.1, 0.9]);
        assert!(found.termination.converged());
        assert!((found.x[0] - 1.0).abs() < 1e-12 && (found.x[1] - 0.75).abs() < 1e-8, "{:?}", found.x);
        assert_eq!(found.at_bound, [true, false]);
        assert!((found.cost - 0.125).abs() < 1e-10);
    }

    /// `‖A x - b‖²`.
    struct Linear {
        a: DMatrix<f64>,
        b: DVector<f64>,
    }

    impl Residuals for Linear {
        fn n_parameters(&self) -> usize {
            self.a.ncols()
        }
        fn residuals(&self, x: &[f64]) -> DVector<f64> {
            &self.a * DVector::from_row_slice(x) - &self.b
        }
        fn jacobian(&self, _: &[f64]) -> DMatrix<f64> {
            self.a.clone()
        }
    }

    /// Bounded linear problems against the best of all 3ⁿ ways to put parameters on walls.
    #[test]
    fn agrees_with_an_exhaustive_search_over_active_sets() {
        use rand::{RngExt, SeedableRng};
        let mut generator = rand_pcg::Pcg64::seed_from_u64(3);
        for _ in 0..40 {
            let n = 5;
            let a = DMatrix::from_fn(8, n, |_, _| generator.random_range(-1.0..1.0));
            let b = DVector::from_fn(8, |_, _| generator.random_range(-2.0..2.0));
            let problem = Linear { a: a.clone(), b: b.clone() };
            let mut best = f64::INFINITY;
            for code in 0..3_usize.pow(n as u32) {
                let sides: Vec<usize> = (0..n).map(|index| code / 3_usize.pow(index as u32) % 3).collect();
                let free: Vec<usize> = (0..n).filter(|&index| sides[index] == 2).collect();
                let mut x: Vec<f64> = sides.iter().map(|&side| if side == 1 { 1.0 } else { 0.0 }).collect();
                if !free.is_empty() {
                    let rest = &b - &a * DVector::from_row_slice(&x);
                    let solved = a.select_columns(&free).svd(true, true).solve(&rest, 1e-14).unwrap();
                    for (&index, &value) in free.iter().zip(solved.iter()) {
                        x[index] = value;
                    }
                }
                if x.iter().all(|value| (-1e-12..=1.0 + 1e-12).contains(value)) {
                    best = best.min(0.5 * problem.residuals(&x).norm_squared());
                }
            }
            let found = descend(&problem, &vec![0.5; n]);
            assert!(found.termination.converged());
            assert!((found.cost - best).abs() < 1e-9 * best.max(1e-3), "{} {best}", found.cost);
        }
    }
}
