//! Least squares in one pass: a triangle that stands for any number of rows.
//!
//! For rows `[X | y]` the factorization `[X | y] = Q R` with orthonormal `Q` gives, for every vector of
//! weights `w`,
//!
//! ```text
//! ‖y - X w‖² = ‖z - R_x w‖² + ρ²,   R = [R_x z; 0 ρ]
//! ```
//!
//! so that the triangle `R` answers every least-squares question that the rows can. Blocks of rows are
//! folded in one after the other, and two triangles merge by folding the rows of one into the other:
//! tall-skinny QR, in any grouping. Unlike sums of products (`XᵀX`) it keeps all digits.
//!
//! Source: Demmel, Grigori, Hoemmen and Langou (2012), "Communication-optimal parallel and sequential QR
//! and LU factorizations", SIAM J. Scientific Computing 34(1).

use fearless_simd::{Level, dispatch};

/// Sums that run side by side, in vector registers.
const LANES: usize = 8;

/// Rows folded at a time: a block of 16 columns stays within 64 kB.
pub const BLOCK_ROWS: usize = 512;

/// The triangle that stands for rows `[X | y]`, with their number.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Columns of `X` and one for `y`.
    width: usize,
    /// `R`, `width × width`, row-major, zero below the diagonal.
    triangle: Vec<f64>,
    /// Rows folded in.
    n_rows: u64,
}

impl Summary {
    /// No rows of `n_columns` columns (and `y`).
    pub fn new(n_columns: usize) -> Self {
        let width = n_columns + 1;
        Self { width, triangle: vec![0.0; width * width], n_rows: 0 }
    }

    /// The triangle `R` itself, `(n_columns + 1)²` values, row-major, zero below the diagonal; it stands for `n_rows`
    /// rows.
    ///
    /// # Panics
    /// Where the number of values is not that of a triangle of `n_columns` columns and `y`.
    pub fn from_triangle(n_columns: usize, triangle: Vec<f64>, n_rows: u64) -> Self {
        let width = n_columns + 1;
        assert_eq!(triangle.len(), width * width, "a triangle has as many rows as columns");
        Self { width, triangle, n_rows }
    }

    /// Columns of `X`.
    pub fn n_columns(&self) -> usize {
        self.width - 1
    }

    /// Rows folded in.
    pub fn n_rows(&self) -> u64 {
        self.n_rows
    }

    /// Row `index` of `R`, `n_columns + 1` values, the last of which belongs to `y`.
    pub fn row(&self, index: usize) -> &[f64] {
        &self.triangle[index * self.width..(index + 1) * self.width]
    }

    /// Folds rows in. `block` is column-major, `n_rows × (n_columns + 1)` with `y` last; it is overwritten.
    pub fn fold(&mut self, block: &mut [f64], n_rows: usize) {
        debug_assert_eq!(block.len(), n_rows * self.width);
        self.n_rows += n_rows as u64;
        self.annihilate(block, n_rows);
    }

    /// Folds in the first `n_rows` of a block that is laid out for [`BLOCK_ROWS`] rows; it is overwritten.
    pub fn fold_part(&mut self, block: &mut [f64], n_rows: usize) {
        if n_rows == 0 {
            return;
        }
        // Close the gaps between the columns.
        for column in 1..self.width {
            block.copy_within(column * BLOCK_ROWS..column * BLOCK_ROWS + n_rows, column * n_rows);
        }
        self.fold(&mut block[..n_rows * self.width], n_rows);
    }

    /// Folds the rows that `other` stands for in.
    pub fn merge(&mut self, other: &Self) {
        debug_assert_eq!(self.width, other.width);
        self.n_rows += other.n_rows;
        let mut block = vec![0.0; self.width * self.width];
        for row in 0..self.width {
            for column in row..self.width {
                block[column * self.width + row] = other.triangle[row * self.width + column];
            }
        }
        self.annihilate(&mut block, self.width);
    }

    /// Householder reflections that mix row `j` of the triangle with the whole block and leave the block
    /// zero in column `j`; the other rows of the triangle are zero there already.
    fn annihilate(&mut self, block: &mut [f64], n_rows: usize) {
        // The widest vectors that the processor has. Sums have fixed lanes and nothing is fused, so that every
        // processor gives the same bits.
        dispatch!(Level::new(), _ => reflect(&mut self.triangle, self.width, block, n_rows));
    }

    /// `‖y - X w‖²` for weights `w` (`n_columns` of them).
    pub fn residual_square_sum(&self, weights: &[f64]) -> f64 {
        SquareSum::of(self).at(weights)
    }

    /// `ρ²`: what the best weights leave of `‖y‖²`.
    pub fn residual_floor_square_sum(&self) -> f64 {
        let floor = self.triangle[self.width * self.width - 1];
        floor * floor
    }

    /// `Xᵀ (y - X w)`, `n_columns` values.
    pub fn score(&self, weights: &[f64]) -> Vec<f64> {
        let n = self.n_columns();
        let mut score = vec![0.0; n];
        for row in 0..n {
            let entries = self.row(row);
            let mut residual = entries[self.width - 1];
            for column in row..n {
                residual -= entries[column] * weights[column];
            }
            for column in row..n {
                score[column] += entries[column] * residual;
            }
        }
        score
    }
}

/// The square sum of a [`Summary`], made ready to be asked for many weights: residuals of several rows of the triangle are
/// worked on side by side.
#[derive(Debug, Clone)]
pub struct SquareSum {
    n_columns: usize,
    /// For every band of so many rows: `z`, with `ρ` after it, and then each column that is not zero there.
    bands: Vec<[f64; LANES]>,
}

impl SquareSum {
    /// Of what `summary` stands for.
    pub fn of(summary: &Summary) -> Self {
        let n_columns = summary.n_columns();
        let mut bands = Vec::new();
        for start in (0..=n_columns).step_by(LANES) {
            for column in [n_columns].into_iter().chain(start..n_columns) {
                bands.push(std::array::from_fn(|lane| {
                    let row = start + lane;
                    if row <= n_columns { summary.row(row)[column] } else { 0.0 }
                }));
            }
        }
        Self { n_columns, bands }
    }

    /// `‖y - X w‖²` for `weights`, as many as the summary has columns.
    pub fn at(&self, weights: &[f64]) -> f64 {
        let mut bands = self.bands.iter();
        let mut squares = [0.0; LANES];
        let mut start = 0;
        while let Some(target) = bands.next() {
            let mut residuals = *target;
            for (weight, entries) in weights[start.min(self.n_columns)..].iter().zip(bands.by_ref()) {
                for lane in 0..LANES {
                    residuals[lane] -= entries[lane] * weight;
                }
            }
            for lane in 0..LANES {
                squares[lane] += residuals[lane] * residuals[lane];
            }
            start += LANES;
        }
        squares.iter().sum()
    }
}

/// The work of [`Summary::annihilate`], inlined where the vectors are wide.
#[inline(always)]
fn reflect(triangle: &mut [f64], width: usize, block: &mut [f64], n_rows: usize) {
    for pivot in 0..width {
        let (head, tail) = block.split_at_mut((pivot + 1) * n_rows);
        let vector = &head[pivot * n_rows..];
        let squares = dot(vector, vector);
        if squares <= 0.0 {
            continue;
        }
        let diagonal = triangle[pivot * width + pivot];
        let norm = (diagonal * diagonal + squares).sqrt();
        let reflected = if diagonal > 0.0 { -norm } else { norm };
        let first = diagonal - reflected;
        let scale = 2.0 / (first * first + squares);
        triangle[pivot * width + pivot] = reflected;
        for (offset, column) in tail.chunks_exact_mut(n_rows).enumerate() {
            let entry = &mut triangle[pivot * width + pivot + 1 + offset];
            let factor = scale * (first * *entry + dot(vector, column));
            *entry -= factor * first;
            for (value, &component) in column.iter_mut().zip(vector) {
                *value -= factor * component;
            }
        }
    }
}

/// Scalar product in partial sums.
#[inline(always)]
fn dot(left: &[f64], right: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (left_chunks, right_chunks) = (left.chunks_exact(LANES), right.chunks_exact(LANES));
    let rest: f64 = left_chunks.remainder().iter().zip(right_chunks.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in left_chunks.zip(right_chunks) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests;
