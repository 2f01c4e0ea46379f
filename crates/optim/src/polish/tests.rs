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
