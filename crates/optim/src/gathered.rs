//! Rows that come one at a time, gathered into blocks on their way into a triangle.

use crate::summary::{BLOCK_ROWS, Summary};

/// A triangle, and the rows that are not in it yet.
#[derive(Debug, Clone)]
pub struct Gathered {
    summary: Summary,
    /// Column-major, [`BLOCK_ROWS`] rows.
    block: Vec<f64>,
    /// Rows of the block that are taken.
    filled: usize,
}

impl Gathered {
    /// No rows of `n_columns` columns (and `y`).
    pub fn new(n_columns: usize) -> Self {
        Self::after(Summary::new(n_columns), &[])
    }

    /// After whole blocks in `summary`, and rows that wait for theirs to be full, one after the other.
    pub fn after(summary: Summary, waiting: &[f64]) -> Self {
        let width = summary.n_columns() + 1;
        let mut gathered = Self { summary, block: vec![0.0; BLOCK_ROWS * width], filled: 0 };
        waiting.chunks_exact(width).for_each(|row| gathered.push(row.iter().copied()));
        gathered
    }

    /// The triangle of whole blocks, and the rows that wait, as [`after`](Self::after) takes them.
    pub fn open(&self) -> (&Summary, Vec<f64>) {
        let n_columns = self.summary.n_columns();
        let row = |row: usize| (0..=n_columns).map(move |column| self.block[column * BLOCK_ROWS + row]);
        (&self.summary, (0..self.filled).flat_map(row).collect())
    }

    /// Adds a row of `n_columns + 1` values, `y` last.
    pub fn push(&mut self, row: impl IntoIterator<Item = f64>) {
        for (column, value) in row.into_iter().enumerate() {
            self.block[column * BLOCK_ROWS + self.filled] = value;
        }
        self.filled += 1;
        if self.filled == BLOCK_ROWS {
            self.summary.fold(&mut self.block, BLOCK_ROWS);
            self.filled = 0;
        }
    }

    /// The triangle of every row.
    pub fn summary(mut self) -> Summary {
        self.summary.fold_part(&mut self.block, self.filled);
        self.summary
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three columns and `y` of row `index`.
    fn row(index: usize) -> [f64; 4] {
        let at = index as f64;
        [1.0, at.sin(), (0.3 * at).cos(), 2.0 + 3.0 * at.sin()]
    }

    #[test]
    fn rows_are_those_of_one_block_whatever_their_number() {
        for n_rows in [0, 1, BLOCK_ROWS, BLOCK_ROWS + 1, 3 * BLOCK_ROWS - 7] {
            let mut gathered = Gathered::new(3);
            (0..n_rows).for_each(|index| gathered.push(row(index)));
            let summary = gathered.summary();
            assert_eq!(summary.n_rows(), n_rows as u64);
            let mut block: Vec<f64> =
                (0..4).flat_map(|column| (0..n_rows).map(move |index| row(index)[column])).collect();
            let mut whole = Summary::new(3);
            whole.fold(&mut block, n_rows);
            let weights = [1.0, 2.0, 0.5];
            let (parts, at_once) = (summary.residual_square_sum(&weights), whole.residual_square_sum(&weights));
            assert!((parts - at_once).abs() <= 1e-12 * at_once, "{n_rows}: {parts} {at_once}");
        }
    }
}
