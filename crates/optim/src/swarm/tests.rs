use super::*;

const OPTIONS: SwarmOptions = SwarmOptions { n_particles: 60, n_iterations: 200, seed: 1, start: 0 };

fn quiet() -> impl FnMut(usize, f64) -> ControlFlow<()> {
    |_, _| ControlFlow::Continue(())
}

#[test]
fn finds_the_bottom_of_a_bowl() {
    let mut bowl = |x: &[f64]| x.iter().map(|v| (v - 0.3).powi(2)).sum();
    let found = minimize(6, None, &OPTIONS, &mut bowl, &mut quiet());
    assert!(found.best_cost < 1e-12, "{:e}", found.best_cost);
}

#[test]
fn finds_a_bottom_that_lies_on_the_wall() {
    let mut slope = |x: &[f64]| (x[0] + 0.2).powi(2) + (x[1] - 0.5).powi(2);
    let found = minimize(2, None, &OPTIONS, &mut slope, &mut quiet());
    assert!(found.best[0].abs() < 1e-12 && (found.best[1] - 0.5).abs() < 1e-6);
}

#[test]
fn the_same_seed_gives_the_same_swarm_and_another_start_another() {
    let mut bowl = |x: &[f64]| x.iter().map(|v| (v - 0.3).powi(2)).sum();
    let first = minimize(3, None, &OPTIONS, &mut bowl, &mut quiet());
    assert_eq!(first, minimize(3, None, &OPTIONS, &mut bowl, &mut quiet()));
    let other = minimize(3, None, &SwarmOptions { start: 1, ..OPTIONS }, &mut bowl, &mut quiet());
    assert_ne!(first.history, other.history);
}

#[test]
fn a_cost_that_is_not_finite_is_never_best() {
    let mut holes = |x: &[f64]| if x[0] < 0.5 { f64::NAN } else { x[0] };
    let found = minimize(1, None, &OPTIONS, &mut holes, &mut quiet());
    assert!((found.best[0] - 0.5).abs() < 1e-6);
}

#[test]
fn an_observer_can_end_the_search() {
    let mut bowl = |x: &[f64]| x[0];
    let found = minimize(1, None, &OPTIONS, &mut bowl, &mut |iteration, _| {
        if iteration == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!(found.history.len(), 6);
}

/// A valley a hundred thousand times longer than wide, askew to the axes.
#[test]
fn round_axes_carry_the_swarm_through_a_narrow_valley() {
    let n = 6;
    // x = A u with a full lower triangle: u has cost ‖u - u₀‖².
    let mut from_round = vec![0.0; n * n];
    for row in 0..n {
        for column in 0..=row {
            from_round[row * n + column] =
                if row == column { 10_f64.powi(-(row as i32)) } else { 0.5 * 10_f64.powi(-(column as i32)) };
        }
    }
    let matrix = nalgebra::DMatrix::from_row_slice(n, n, &from_round);
    let inverse = matrix.try_inverse().unwrap();
    let to_round: Vec<f64> = inverse.transpose().as_slice().to_vec();
    let center = vec![0.45; n];
    let mut valley = |x: &[f64]| {
        (0..n)
            .map(|row| {
                let u: f64 = (0..n).map(|c| to_round[row * n + c] * (x[c] - center[c])).sum();
                u * u
            })
            .sum()
    };
    let plain = minimize(n, None, &OPTIONS, &mut valley, &mut quiet());
    let axes = Axes { from_round: from_round.clone(), to_round: to_round.clone() };
    let round = minimize(n, Some(&axes), &OPTIONS, &mut valley, &mut quiet());
    assert!(round.best_cost < 1e-12 * round.history[0], "{:e} of {:e}", round.best_cost, round.history[0]);
    assert!(round.best_cost < 1e-3 * plain.best_cost, "{:e} {:e}", round.best_cost, plain.best_cost);
}
