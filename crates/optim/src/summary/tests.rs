use super::*;
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};

fn random_rows(n_rows: usize, n_columns: usize) -> (DMatrix<f64>, DVector<f64>) {
    let mut generator = rand_pcg::Pcg64::seed_from_u64(7);
    let x =
        DMatrix::from_fn(n_rows, n_columns, |_, column| generator.random_range(-1.0..1.0) * 10_f64.powi(column as i32));
    let y = DVector::from_fn(n_rows, |_, _| generator.random_range(-1.0..1.0));
    (x, y)
}

fn block_of(x: &DMatrix<f64>, y: &DVector<f64>, rows: std::ops::Range<usize>) -> Vec<f64> {
    let mut block: Vec<f64> = Vec::new();
    for column in 0..x.ncols() {
        block.extend(rows.clone().map(|row| x[(row, column)]));
    }
    block.extend(rows.map(|row| y[row]));
    block
}

#[test]
fn triangle_answers_as_the_rows_do() {
    let (x, y) = random_rows(1000, 6);
    let mut summary = Summary::new(6);
    for start in (0..1000).step_by(300) {
        let end = (start + 300).min(1000);
        summary.fold(&mut block_of(&x, &y, start..end), end - start);
    }
    let weights = [0.3, -0.02, 1e-3, 2e-4, -1e-5, 3e-6];
    let residual = &y - &x * DVector::from_row_slice(&weights);
    assert!((summary.residual_square_sum(&weights) / residual.norm_squared() - 1.0).abs() < 1e-13);
    let score = x.transpose() * &residual;
    for (found, expected) in summary.score(&weights).iter().zip(score.iter()) {
        assert!((found - expected).abs() < 1e-10 * score.norm());
    }
    let best = x.clone().svd(true, true).solve(&y, 1e-14).unwrap();
    let floor = (&y - &x * best).norm_squared();
    assert!((summary.residual_floor_square_sum() / floor - 1.0).abs() < 1e-12);
}

#[test]
fn merged_halves_stand_for_the_whole() {
    let (x, y) = random_rows(800, 5);
    let mut whole = Summary::new(5);
    whole.fold(&mut block_of(&x, &y, 0..800), 800);
    let mut first = Summary::new(5);
    first.fold(&mut block_of(&x, &y, 0..500), 500);
    let mut second = Summary::new(5);
    second.fold(&mut block_of(&x, &y, 500..800), 300);
    first.merge(&second);
    assert_eq!(first.n_rows(), 800);
    for row in 0..=5 {
        for column in row..=5 {
            let (a, b) = (whole.row(row)[column].abs(), first.row(row)[column].abs());
            assert!((a - b).abs() < 1e-11 * a.max(1.0));
        }
    }
}

#[test]
fn a_column_of_zeros_is_harmless() {
    let (mut x, y) = random_rows(100, 3);
    x.column_mut(1).fill(0.0);
    let mut summary = Summary::new(3);
    summary.fold(&mut block_of(&x, &y, 0..100), 100);
    assert!(summary.residual_square_sum(&[0.1, 5.0, 0.0]).is_finite());
    assert!(summary.row(1)[1].abs() < f64::EPSILON);
}
