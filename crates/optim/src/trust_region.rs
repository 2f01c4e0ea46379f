//! The step of Levenberg and Marquardt: linear least squares within a bound on the length of the step.
//!
//! For a Jacobian `J`, residuals `r`, scales `D` and a bound `Δ` it is the `p` that solves
//!
//! ```text
//! min ‖J p - r‖   with   ‖D p‖ ≤ Δ,   (JᵀJ + λ D²) p = Jᵀ r,
//! ```
//!
//! with `λ = 0` where the bound does not matter, and otherwise so that `‖D p‖` is within a tenth of `Δ`. `J` is factored once,
//! with pivots; each `λ` costs some Givens rotations of the triangle.
//!
//! Source: Moré (1978), "The Levenberg-Marquardt algorithm: implementation and theory", which MINPACK's `qrfac`, `qrsolv` and
//! `lmpar` are an implementation of; column norms after Drmač and Bujanović (2008), "On the failure of rank-revealing QR
//! factorization software", ACM TOMS 35(2).

use nalgebra::{DMatrix, DVector};

/// Relative difference between `Δ` and `‖D p‖` that is good enough.
const NEAR: f64 = 0.1;
/// Values of `λ` that are tried at most.
const MOST_TRIALS: usize = 10;

/// A step with what it took.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Step {
    /// `p`.
    pub(crate) p: Vec<f64>,
    /// `λ`.
    pub(crate) lambda: f64,
    /// `‖D p‖`.
    pub(crate) scaled_norm: f64,
}

/// `J P = Q R` and what of `r` it needs.
#[derive(Debug)]
pub(crate) struct Factored {
    n: usize,
    /// `R`, `n × n`, column-major; nothing below the diagonal is read.
    r: Vec<f64>,
    /// First `n` values of `Qᵀ r`.
    qt_r: Vec<f64>,
    /// Column of `J` behind each column of `R`.
    permutation: Vec<usize>,
    /// Norm of each column of `J`.
    pub(crate) column_norms: Vec<f64>,
}

/// The triangle after `√λ D` was rotated into it: `L Lᵀ = RᵀR + λ PᵀD²P`, `n × n`, column-major.
struct Lower {
    n: usize,
    l: Vec<f64>,
}

impl Factored {
    /// Factors a Jacobian that has at least as many rows as columns.
    pub(crate) fn of(jacobian: &DMatrix<f64>, residuals: &DVector<f64>) -> Self {
        let (m, n) = jacobian.shape();
        debug_assert!(m >= n);
        let mut columns: Vec<Vec<f64>> =
            jacobian.column_iter().map(|column| column.iter().copied().collect()).collect();
        let column_norms: Vec<f64> = columns.iter().map(|column| norm(column)).collect();
        // Norms of what is left of each column, and as they were when last computed from it.
        let (mut left, mut exact) = (column_norms.clone(), column_norms.clone());
        let mut permutation: Vec<usize> = (0..n).collect();
        let mut right: Vec<f64> = residuals.iter().copied().collect();
        let mut diagonal = vec![0.0; n];
        for j in 0..n {
            let longest = (j..n).fold(j, |best, k| if left[k] > left[best] { k } else { best });
            columns.swap(j, longest);
            permutation.swap(j, longest);
            left.swap(j, longest);
            exact.swap(j, longest);
            let (head, tail) = columns.split_at_mut(j + 1);
            let axis = &mut head[j][j..];
            let length = norm(axis);
            if length == 0.0 {
                continue;
            }
            let length = if axis[0] < 0.0 { -length } else { length };
            diagonal[j] = -length;
            axis.iter_mut().for_each(|value| *value /= length);
            axis[0] += 1.0;
            for (column, k) in tail.iter_mut().zip(j + 1..) {
                reflect(&mut column[j..], axis);
                if left[k] == 0.0 {
                    continue;
                }
                left[k] *= (1.0 - (column[j] / left[k]).powi(2)).max(0.0).sqrt();
                if 0.05 * (left[k] / exact[k]).powi(2) <= f64::EPSILON {
                    left[k] = norm(&column[j + 1..]);
                    exact[k] = left[k];
                }
            }
            reflect(&mut right[j..], axis);
        }
        let mut r = vec![0.0; n * n];
        for (k, column) in columns.iter().enumerate() {
            r[k * n..k * n + k].copy_from_slice(&column[..k]);
            r[k * n + k] = diagonal[k];
        }
        right.truncate(n);
        Self { n, r, qt_r: right, permutation, column_norms }
    }

    /// Column `k` of `R`, down to its diagonal.
    fn column(&self, k: usize) -> &[f64] {
        &self.r[k * self.n..=k * self.n + k]
    }

    /// Largest cosine between the residuals, whose norm is `residual_norm`, and a column of the Jacobian; none where it is no
    /// number.
    pub(crate) fn largest_cosine(&self, residual_norm: f64) -> Option<f64> {
        let mut largest: f64 = 0.0;
        for k in 0..self.n {
            let scale = self.column_norms[self.permutation[k]];
            if scale > 0.0 {
                let cosine = (dot(self.column(k), &self.qt_r) / residual_norm / scale).abs();
                if cosine.is_nan() {
                    return None;
                }
                largest = largest.max(cosine);
            }
        }
        Some(largest)
    }

    /// `‖J p‖`.
    pub(crate) fn image_norm(&self, p: &[f64]) -> f64 {
        let mut image = vec![0.0; self.n];
        for k in 0..self.n {
            add(&mut image, p[self.permutation[k]], self.column(k));
        }
        norm(&image)
    }

    /// The step within `bound` under the scales `d`; `lambda` is that of the step before.
    pub(crate) fn step(&self, d: &[f64], bound: f64, lambda: f64) -> Step {
        let mut p = self.newton();
        let mut scaled = product(&p, d);
        let mut scaled_norm = norm(&scaled);
        let mut over = scaled_norm - bound;
        if over <= NEAR * bound {
            return Step { p, lambda: 0.0, scaled_norm };
        }
        // Newton's method on ‖D p(λ)‖ = Δ, between bounds that only come nearer.
        let is_regular = (0..self.n).all(|k| self.r[k * self.n + k] != 0.0);
        let mut lowest = if is_regular {
            let slope = norm(&self.solve_transposed(self.direction(&scaled, d, scaled_norm)));
            over / bound / slope / slope
        } else {
            0.0
        };
        let gradient: Vec<f64> =
            (0..self.n).map(|k| dot(self.column(k), &self.qt_r) / d[self.permutation[k]]).collect();
        let gradient_norm = norm(&gradient);
        let mut highest = gradient_norm / bound;
        if highest == 0.0 {
            highest = f64::MIN_POSITIVE / bound.min(NEAR);
        }
        let mut lambda = lambda.max(lowest).min(highest);
        if lambda == 0.0 {
            lambda = gradient_norm / scaled_norm;
        }
        for trial in 1..=MOST_TRIALS {
            if lambda == 0.0 {
                lambda = f64::MIN_POSITIVE.max(1e-3 * highest);
            }
            let root = lambda.sqrt();
            let damping: Vec<f64> = d.iter().map(|scale| root * scale).collect();
            let (solution, lower) = self.damped(&damping);
            p = solution;
            scaled = product(&p, d);
            scaled_norm = norm(&scaled);
            let before = over;
            over = scaled_norm - bound;
            let falls_short = lowest == 0.0 && over <= before && before < 0.0;
            if trial == MOST_TRIALS || over.abs() <= NEAR * bound || falls_short {
                break;
            }
            let slope = norm(&lower.solve(self.direction(&scaled, d, scaled_norm)));
            let correction = over / bound / slope / slope;
            if over > 0.0 {
                lowest = lowest.max(lambda);
            } else {
                highest = highest.min(lambda);
            }
            lambda = lowest.max(lambda + correction);
        }
        Step { p, lambda, scaled_norm }
    }

    /// `Pᵀ D (D p) / ‖D p‖`.
    fn direction(&self, scaled: &[f64], d: &[f64], scaled_norm: f64) -> Vec<f64> {
        self.permutation.iter().map(|&column| scaled[column] / scaled_norm * d[column]).collect()
    }

    /// The step without a bound; what the triangle does not determine stays zero.
    fn newton(&self) -> Vec<f64> {
        let rank = (0..self.n).find(|&k| self.r[k * self.n + k] == 0.0).unwrap_or(self.n);
        let mut solution = self.qt_r[..rank].to_vec();
        for k in (0..rank).rev() {
            let column = self.column(k);
            solution[k] /= column[k];
            let known = solution[k];
            add(&mut solution[..k], -known, &column[..k]);
        }
        self.permuted_back(&solution)
    }

    fn permuted_back(&self, solution: &[f64]) -> Vec<f64> {
        let mut p = vec![0.0; self.n];
        for (&column, &value) in self.permutation.iter().zip(solution) {
            p[column] = value;
        }
        p
    }

    /// Solves `Rᵀ x = b`.
    fn solve_transposed(&self, mut b: Vec<f64>) -> Vec<f64> {
        for k in 0..self.n {
            let column = self.column(k);
            b[k] = (b[k] - dot(&column[..k], &b[..k])) / column[k];
        }
        b
    }

    /// The step under `‖J p - r‖² + ‖damping p‖²`, and the triangle that it was solved with.
    fn damped(&self, damping: &[f64]) -> (Vec<f64>, Lower) {
        let n = self.n;
        let mut l = vec![0.0; n * n];
        for k in 0..n {
            for (row, value) in self.column(k).iter().enumerate() {
                l[row * n + k] = *value;
            }
        }
        let mut right = self.qt_r.clone();
        let mut row = vec![0.0; n];
        for j in 0..n {
            // One row of the damping, rotated into the triangle from its diagonal on.
            row[j..].fill(0.0);
            row[j] = damping[self.permutation[j]];
            let mut row_right = 0.0;
            for k in j..n {
                if row[k] == 0.0 {
                    continue;
                }
                let column = &mut l[k * n + k..(k + 1) * n];
                let (sin, cos) = rotation(column[0], row[k]);
                for (value, other) in column.iter_mut().zip(&mut row[k..]) {
                    (*value, *other) = (cos * *value + sin * *other, cos * *other - sin * *value);
                }
                (right[k], row_right) = (cos * right[k] + sin * row_right, cos * row_right - sin * right[k]);
            }
        }
        let lower = Lower { n, l };
        let solution = lower.solve_transposed(right);
        (self.permuted_back(&solution), lower)
    }
}

impl Lower {
    /// Column `k`, from its diagonal on.
    fn column(&self, k: usize) -> &[f64] {
        &self.l[k * self.n + k..(k + 1) * self.n]
    }

    /// Solves `Lᵀ x = b`; what is not determined is zero.
    fn solve_transposed(&self, mut b: Vec<f64>) -> Vec<f64> {
        let rank = (0..self.n).find(|&k| self.column(k)[0] == 0.0).unwrap_or(self.n);
        b[rank..].fill(0.0);
        for k in (0..rank).rev() {
            let column = self.column(k);
            b[k] = (b[k] - dot(&column[1..], &b[k + 1..])) / column[0];
        }
        b
    }

    /// Solves `L x = b`.
    fn solve(&self, mut b: Vec<f64>) -> Vec<f64> {
        for k in 0..self.n {
            let column = self.column(k);
            b[k] /= column[0];
            let known = b[k];
            add(&mut b[k + 1..], -known, &column[1..]);
        }
        b
    }
}

/// Sine and cosine that turn `other` into nothing and `value` into the root of both squares, without overflow.
fn rotation(value: f64, other: f64) -> (f64, f64) {
    if value.abs() < other.abs() {
        let cot = value / other;
        let sin = 0.5 / (0.25 + 0.25 * cot * cot).sqrt();
        (sin, sin * cot)
    } else {
        let tan = other / value;
        let cos = 0.5 / (0.25 + 0.25 * tan * tan).sqrt();
        (cos * tan, cos)
    }
}

/// Householder's reflection by `axis`, whose first component is one more than that of a unit vector.
fn reflect(column: &mut [f64], axis: &[f64]) {
    let factor = -dot(column, axis) / axis[0];
    add(column, factor, axis);
}

fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(left, right)| left * right).sum()
}

fn add(sum: &mut [f64], factor: f64, terms: &[f64]) {
    sum.iter_mut().zip(terms).for_each(|(sum, term)| *sum += factor * term);
}

fn product(left: &[f64], right: &[f64]) -> Vec<f64> {
    left.iter().zip(right).map(|(left, right)| left * right).collect()
}

pub(crate) fn norm(values: &[f64]) -> f64 {
    dot(values, values).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(jacobian: &[f64; 12], residuals: [f64; 4], d: [f64; 3]) -> Step {
        let jacobian = DMatrix::from_column_slice(4, 3, jacobian);
        Factored::of(&jacobian, &DVector::from_row_slice(&residuals)).step(&d, 0.5, 0.2)
    }

    /// Steps that MINPACK's `lmpar` gives, from the tests of the crate levenberg-marquardt 0.15.
    #[test]
    fn validates_against_minpack() {
        let cases = [
            (
                step(
                    &[33., -40., 44., -43., -37., -1., -40., 48., 43., -11., -40., 43.],
                    [7., -1., 0., -1.],
                    [18.2, 18.2, 3.2],
                ),
                34.62864355815634,
                [0.017591648698939, -0.020395135814051, 0.059285196018896],
            ),
            (
                step(
                    &[-7., 28., -40., 29., 7., -49., -39., 43., -25., -47., -11., 34.],
                    [-7., -8., -8., -10.],
                    [10.2, 13.2, 1.2],
                ),
                0.0,
                [-0.048474221517806, -0.007207732068190, 0.083138659283539],
            ),
            (
                step(
                    &[8., -42., -34., -31., -30., -15., -36., -1., 27., 22., 44., 6.],
                    [1., -5., 2., 7.],
                    [4.2, 8.2, 11.2],
                ),
                0.017646940861467262,
                [-0.008462374169585, 0.033658082419054, 0.037230479167632],
            ),
        ];
        for (found, lambda, p) in cases {
            assert!((found.lambda - lambda).abs() <= 1e-12 * lambda, "{found:?}");
            for (found, expected) in found.p.iter().zip(p) {
                assert!((found - expected).abs() < 1e-14, "{found} {expected}");
            }
        }
    }

    #[test]
    fn a_column_that_is_zero_or_there_twice_moves_nothing_to_infinity() {
        let jacobian = DMatrix::from_column_slice(4, 3, &[1., 2., 3., 4., 0., 0., 0., 0., 1., 2., 3., 4.]);
        let factored = Factored::of(&jacobian, &DVector::from_row_slice(&[1., 1., 1., 1.]));
        for bound in [1e-3, 1e3] {
            let step = factored.step(&[1.0; 3], bound, 0.0);
            assert!(step.p.iter().all(|value| value.is_finite()), "{step:?}");
            assert!(step.scaled_norm <= 1.1 * bound, "{step:?}");
        }
    }
}
