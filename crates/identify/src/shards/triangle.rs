//! Summaries as artifacts carry them.

use pam_artifact::summary::Triangle;
use pam_optim::summary::Summary;

/// As an artifact carries it.
pub(super) fn triangle(summary: &Summary) -> Triangle {
    let n_columns = summary.n_columns();
    let upper = (0..=n_columns).flat_map(|row| summary.row(row)[row..].to_vec()).collect();
    Triangle { n_columns, n_rows: summary.n_rows(), upper }
}

/// What an artifact carries; none where it is no triangle.
pub(super) fn summary(triangle: &Triangle) -> Option<Summary> {
    let width = triangle.n_columns + 1;
    if triangle.upper.len() != width * (width + 1) / 2 {
        return None;
    }
    let mut whole = vec![0.0; width * width];
    let mut entries = triangle.upper.iter();
    for row in 0..width {
        for (entry, value) in whole[row * width + row..(row + 1) * width].iter_mut().zip(&mut entries) {
            *entry = *value;
        }
    }
    Some(Summary::from_triangle(triangle.n_columns, whole, triangle.n_rows))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_read_as_it_was_written() {
        let mut of_rows = Summary::new(2);
        of_rows.fold(&mut [1.0, 2.0, 3.0, 4.0, 0.5, 7.0, -1.0, 2.0, 2.5], 3);
        assert_eq!(summary(&triangle(&of_rows)), Some(of_rows));
    }
}
