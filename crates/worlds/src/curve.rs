//! Smooth interpolation without kinks: polynomials of Chebyshev in one and in two coordinates.
//!
//! A function that is smooth is sampled at Chebyshev nodes once and evaluated by Clenshaw's recurrence; every derivative
//! of the interpolant is continuous, so that no table shows in a force.
//!
//! Source: Trefethen, *Approximation Theory and Approximation Practice* (2013), chapters 2 to 4.

use std::f64::consts::PI;

/// Node `index` of `count`, in `[from, to]`.
pub fn chebyshev_node(index: usize, count: usize, from: f64, to: f64) -> f64 {
    let unit = (PI * (index as f64 + 0.5) / count as f64).cos();
    0.5 * (from + to) + 0.5 * (to - from) * unit
}

fn coefficients(values: &[f64]) -> Vec<f64> {
    let count = values.len();
    (0..count)
        .map(|order| {
            let sum: f64 = values
                .iter()
                .enumerate()
                .map(|(index, value)| value * (PI * order as f64 * (index as f64 + 0.5) / count as f64).cos())
                .sum();
            sum * if order == 0 { 1.0 } else { 2.0 } / count as f64
        })
        .collect()
}

fn clenshaw(coefficients: &[f64], unit: f64) -> f64 {
    let (mut next, mut after) = (0.0, 0.0);
    for &coefficient in coefficients.iter().skip(1).rev() {
        let here = 2.0 * unit * next - after + coefficient;
        after = next;
        next = here;
    }
    unit * next - after + coefficients[0]
}

/// Function of one coordinate.
#[derive(Debug, Clone)]
pub struct Curve {
    from: f64,
    to: f64,
    coefficients: Vec<f64>,
}

impl Curve {
    /// Interpolates `function` on `[from, to]` by a polynomial of degree `count − 1`.
    pub fn new(from: f64, to: f64, count: usize, function: impl Fn(f64) -> f64) -> Self {
        let values: Vec<f64> = (0..count).map(|index| function(chebyshev_node(index, count, from, to))).collect();
        Self { from, to, coefficients: coefficients(&values) }
    }

    /// Value at `x`; beyond the ends the value at the end.
    pub fn at(&self, x: f64) -> f64 {
        let unit = (2.0 * x - self.from - self.to) / (self.to - self.from);
        clenshaw(&self.coefficients, unit.clamp(-1.0, 1.0))
    }
}

/// Most nodes along one coordinate of a surface.
const MOST_NODES: usize = 16;

/// Three functions of two coordinates: tensors of Chebyshev polynomials on one grid.
#[derive(Debug, Clone)]
pub struct Surfaces {
    x: (f64, f64),
    y: (f64, f64),
    count_x: usize,
    /// By order in x, function, order in y.
    coefficients: Vec<[f64; MOST_NODES]>,
}

/// Polynomials of all orders at a point of −1…1.
fn basis(unit: f64) -> [f64; MOST_NODES] {
    let mut values = [1.0; MOST_NODES];
    values[1] = unit;
    for order in 2..MOST_NODES {
        values[order] = 2.0 * unit * values[order - 1] - values[order - 2];
    }
    values
}

impl Surfaces {
    /// From values at the nodes, row by row: `values[index_x * count_y + index_y]`.
    pub fn from_nodes(x: (f64, f64), y: (f64, f64), count_x: usize, count_y: usize, functions: [&[f64]; 3]) -> Self {
        let mut all = vec![[0.0; MOST_NODES]; 3 * count_x];
        for (function, values) in functions.into_iter().enumerate() {
            let mut by_row = vec![0.0; count_x * count_y];
            for row in 0..count_x {
                by_row[row * count_y..][..count_y].copy_from_slice(&coefficients(&values[row * count_y..][..count_y]));
            }
            for column in 0..count_y {
                let along: Vec<f64> = (0..count_x).map(|row| by_row[row * count_y + column]).collect();
                for (row, value) in coefficients(&along).into_iter().enumerate() {
                    all[3 * row + function][column] = value;
                }
            }
        }
        Self { x, y, count_x, coefficients: all }
    }

    /// Values at `(x, y)`; beyond the ends the values at the end.
    pub fn at(&self, x: f64, y: f64) -> [f64; 3] {
        let of_x = basis(((2.0 * x - self.x.0 - self.x.1) / (self.x.1 - self.x.0)).clamp(-1.0, 1.0));
        let of_y = basis(((2.0 * y - self.y.0 - self.y.1) / (self.y.1 - self.y.0)).clamp(-1.0, 1.0));
        let mut sums = [[0.0; MOST_NODES]; 3];
        for (weight, rows) in of_x[..self.count_x].iter().zip(self.coefficients.chunks_exact(3)) {
            for (sum, row) in sums.iter_mut().zip(rows) {
                for (sum, value) in sum.iter_mut().zip(row) {
                    *sum += weight * value;
                }
            }
        }
        sums.map(|sum| sum.iter().zip(&of_y).map(|(a, b)| a * b).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_curve_is_met_to_rounding() {
        let curve = Curve::new(0.2, 1.7, 24, |x| (2.0 * x).sin() / x);
        for step in 0..50 {
            let x = 0.2 + 0.03 * f64::from(step);
            assert!((curve.at(x) - (2.0 * x).sin() / x).abs() < 1e-9);
        }
    }

    #[test]
    fn a_smooth_surface_is_met_between_its_nodes() {
        let (count_x, count_y) = (12, 14);
        let function = |x: f64, y: f64| (x * y).exp() + x;
        let mut values = Vec::new();
        for i in 0..count_x {
            for j in 0..count_y {
                values.push(function(chebyshev_node(i, count_x, 0.0, 1.0), chebyshev_node(j, count_y, -1.0, 2.0)));
            }
        }
        let surface = Surfaces::from_nodes((0.0, 1.0), (-1.0, 2.0), count_x, count_y, [&values, &values, &values]);
        assert!((surface.at(0.37, 1.21)[1] - function(0.37, 1.21)).abs() < 1e-8);
    }
}
