//! Cholesky's factors of a symmetric matrix, `A = Uᵀ U`, and what they solve.
//!
//! # Design
//! Rows of `U` come about some at a time; then all rows below are cleared of them at once, so that each passes through the
//! processor once for [`PANEL`] of them. Every difference is taken in the same order and nothing is fused: every processor
//! gives the same bits, as with the products that the matrix is made of.

use fearless_simd::{Level, Simd, SimdBase as _, dispatch};

/// Rows that the others are cleared of at once.
const PANEL: usize = 8;

/// The upper triangle of a matrix, row by row.
#[derive(Debug, Clone, Default)]
pub(crate) struct Triangle {
    n: usize,
    /// Length of a row: whole vectors.
    width: usize,
    rows: Vec<f64>,
}

impl Triangle {
    /// Takes over the upper triangle of an `n × n` matrix in rows of `width`, which whole vectors fill, with `more` added to
    /// its diagonal.
    pub(crate) fn put(&mut self, rows: &[f64], (n, width): (usize, usize), more: f64) {
        (self.n, self.width) = (n, width);
        self.rows.clear();
        self.rows.extend_from_slice(rows);
        for index in 0..n {
            self.rows[index * width + index] += more;
        }
    }

    /// Turns the matrix into its factor `U`; false where it is not positive definite.
    pub(crate) fn factorize(&mut self) -> bool {
        let (n, width) = (self.n, self.width);
        let level = Level::new();
        for first in (0..n).step_by(PANEL) {
            let end = (first + PANEL).min(n);
            let (above, below) = self.rows.split_at_mut(end * width);
            let panel = &mut above[first * width..];
            for row in 0..end - first {
                let (done, rest) = panel.split_at_mut(row * width);
                let rest = &mut rest[..width];
                let from = first + row;
                for done in done.chunks_exact(width) {
                    let factor = done[from];
                    for (value, known) in rest[from..].iter_mut().zip(&done[from..]) {
                        *value -= factor * known;
                    }
                }
                let pivot = rest[from];
                if !(pivot > 0.0 && pivot.is_finite()) {
                    return false;
                }
                let root = pivot.sqrt();
                rest[from..].iter_mut().for_each(|value| *value /= root);
            }
            let below = &mut below[..(n - end) * width];
            dispatch!(level, simd => clear(simd, panel, below, width, end));
        }
        true
    }

    /// Solves `Uᵀ U x = b` in place.
    pub(crate) fn solve(&self, b: &mut [f64]) {
        for index in 0..self.n {
            let row = &self.rows[index * self.width..][..self.n];
            b[index] /= row[index];
            let known = b[index];
            for (value, factor) in b[index + 1..].iter_mut().zip(&row[index + 1..]) {
                *value -= factor * known;
            }
        }
        for index in (0..self.n).rev() {
            let row = &self.rows[index * self.width..][..self.n];
            let known: f64 = row[index + 1..].iter().zip(&b[index + 1..]).map(|(factor, value)| factor * value).sum();
            b[index] = (b[index] - known) / row[index];
        }
    }
}

/// Clears the rows `below`, each of length `width` and the first of which is row `first` of the matrix, of those of `panel`.
#[inline(always)]
fn clear<S: Simd>(simd: S, panel: &[f64], below: &mut [f64], width: usize, first: usize) {
    let lanes = S::f64s::LEN;
    for (index, row) in below.chunks_exact_mut(width).enumerate() {
        let column = first + index;
        // Whole vectors: what is left of the diagonal belongs to nobody.
        let from = column / lanes * lanes;
        let values = row[from..].chunks_exact_mut(lanes);
        if panel.len() == PANEL * width {
            let known: [&[f64]; PANEL] = std::array::from_fn(|line| &panel[line * width..(line + 1) * width]);
            let factors = known.map(|known| known[column]);
            for (at, values) in values.enumerate() {
                let mut left = S::f64s::from_slice(simd, values);
                for line in 0..PANEL {
                    left -= S::f64s::from_slice(simd, &known[line][from + at * lanes..][..lanes]) * factors[line];
                }
                left.store_slice(values);
            }
        } else {
            for (at, values) in values.enumerate() {
                let mut left = S::f64s::from_slice(simd, values);
                for known in panel.chunks_exact(width) {
                    left -= S::f64s::from_slice(simd, &known[from + at * lanes..][..lanes]) * known[column];
                }
                left.store_slice(values);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use rand::RngExt as _;

    use super::*;
    use crate::stream::Stream;

    fn triangle(matrix: &DMatrix<f64>, more: f64) -> Triangle {
        let n = matrix.nrows();
        let width = n.next_multiple_of(16);
        let mut rows = vec![0.0; n * width];
        for row in 0..n {
            for column in row..n {
                rows[row * width + column] = matrix[(row, column)];
            }
        }
        let mut triangle = Triangle::default();
        triangle.put(&rows, (n, width), more);
        triangle
    }

    #[test]
    fn it_solves_what_a_library_solves() {
        let mut random = Stream::Weights(0).random(3);
        for n in [1, 7, 8, 9, 41, 101] {
            let half = DMatrix::from_fn(n, n, |_, _| random.random_range(-1.0..1.0));
            let matrix = half.transpose() * &half;
            let right = DVector::from_fn(n, |_, _| random.random_range(-1.0..1.0));
            let expected = (&matrix + DMatrix::from_diagonal_element(n, n, 0.1)).cholesky().unwrap().solve(&right);
            let mut triangle = triangle(&matrix, 0.1);
            assert!(triangle.factorize());
            let mut found: Vec<f64> = right.iter().copied().collect();
            triangle.solve(&mut found);
            for (found, expected) in found.iter().zip(expected.iter()) {
                assert!((found - expected).abs() < 1e-10 * expected.abs().max(1.0), "{n}: {found} {expected}");
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_refused() {
        let mut matrix = DMatrix::identity(20, 20);
        matrix[(13, 13)] = -1e-3;
        assert!(!triangle(&matrix, 0.0).factorize());
        assert!(triangle(&matrix, 1e-2).factorize());
        matrix[(13, 13)] = f64::NAN;
        assert!(!triangle(&matrix, 0.0).factorize());
    }
}
