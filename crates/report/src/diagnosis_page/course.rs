//! The mean course of a line: running means, and a parabola through it.

use super::samples::extent;

/// Means of `window` values around each.
pub(super) fn running_means(values: &[f64], window: usize) -> Vec<f64> {
    let half = window / 2;
    let around = |row: usize| &values[row.saturating_sub(half)..(row + half + 1).min(values.len())];
    (0..values.len()).map(|row| around(row).iter().sum::<f64>() / around(row).len() as f64).collect()
}

/// `a + b u + c u²` with `u = (x - middle) / span`.
#[derive(Debug)]
pub(super) struct Parabola {
    middle: f64,
    span: f64,
    weights: [f64; 3],
}

impl Parabola {
    pub(super) fn at(&self, x: f64) -> f64 {
        let u = (x - self.middle) / self.span;
        self.weights[0] + u * (self.weights[1] + u * self.weights[2])
    }
}

/// Least squares by Gram–Schmidt on 1, u, u²; a column without anything of its own gets no weight.
pub(super) fn parabola(x: &[f64], y: &[f64]) -> Parabola {
    let (lowest, highest) = extent(x.iter().copied());
    let (middle, span) = (0.5 * (lowest + highest), (0.5 * (highest - lowest)).max(1e-9));
    let u: Vec<f64> = x.iter().map(|x| (x - middle) / span).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // Each column with what it is in terms of the powers of u.
    let mut basis: Vec<(Vec<f64>, [f64; 3])> = Vec::new();
    for power in 0..3 {
        let mut column: Vec<f64> = u.iter().map(|u| u.powi(power as i32)).collect();
        let mut terms = [0.0; 3];
        terms[power] = 1.0;
        for (earlier, earlier_terms) in &basis {
            let share = dot(&column, earlier) / dot(earlier, earlier);
            column.iter_mut().zip(earlier).for_each(|(value, earlier)| *value -= share * earlier);
            terms.iter_mut().zip(earlier_terms).for_each(|(term, earlier)| *term -= share * earlier);
        }
        if dot(&column, &column) > 1e-9 * x.len() as f64 {
            basis.push((column, terms));
        }
    }
    let mut weights = [0.0; 3];
    for (column, terms) in &basis {
        let share = dot(column, y) / dot(column, column);
        weights.iter_mut().zip(terms).for_each(|(weight, term)| *weight += share * term);
    }
    Parabola { middle, span, weights }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn running_means_shorten_at_the_ends() {
        assert_eq!(running_means(&[1.0, 2.0, 6.0, 4.0], 3), [1.5, 3.0, 4.0, 5.0]);
    }

    #[test]
    fn a_parabola_is_found_again() {
        let x: Vec<f64> = (0..50).map(|index| 3.0 + 0.1 * f64::from(index)).collect();
        let y: Vec<f64> = x.iter().map(|x| 2.0 - x + 0.5 * x * x).collect();
        let course = parabola(&x, &y);
        assert!(x.iter().zip(&y).all(|(x, y)| (course.at(*x) - y).abs() < 1e-9));
    }

    #[test]
    fn a_channel_that_stands_still_has_a_mean_course() {
        let course = parabola(&[2.0; 4], &[1.0, 2.0, 3.0, 4.0]);
        assert!((course.at(2.0) - 2.5).abs() < 1e-12);
    }
}
