//! Which pressures have a force of their own.
//!
//! At one length and direction a pressure can be told from its force where the force grows with the pressure:
//! `dF/dp ≥` a threshold. Stretching strands bend `F(p)` over at high pressure, a threshold of the bladder or
//! friction can hold it flat at low pressure; what rises in one piece is a *branch*. Where there are several,
//! the longest is the one that is inverted, and the lower of two equal ones.

use pam_muscle::effects::AugmentedModel;

/// Steps that the range of pressure is searched with; a branch shorter than one may be missed.
const STEPS: usize = 64;
/// Distance over which a slope is taken, as a share of the range of pressure.
const REACH: f64 = 1e-5;
/// Halvings that find the end of a branch.
const HALVINGS: usize = 30;

/// `dF/dp` of the settled force in N/Pa by central difference; `span_pa` is the range of pressure that it is taken for. The error of
/// the difference is some 1e-8 of the slope, far below any threshold.
pub fn slope_n_per_pa(model: &AugmentedModel, pressure_pa: f64, length_m: f64, direction: f64, span_pa: f64) -> f64 {
    let step_pa = REACH * span_pa;
    let above_n = model.settled_force_n(pressure_pa + step_pa, length_m, direction);
    let below_n = model.settled_force_n(pressure_pa - step_pa, length_m, direction);
    (above_n - below_n) / (2.0 * step_pa)
}

/// Ranges of pressure, in Pa, over which the force grows by at least `min_slope_n_per_pa`, rising. Where the
/// force is not finite it does not grow.
pub fn rising(
    model: &AugmentedModel,
    length_m: f64,
    direction: f64,
    [from_pa, to_pa]: [f64; 2],
    min_slope_n_per_pa: f64,
) -> Vec<[f64; 2]> {
    let span_pa = to_pa - from_pa;
    let rises =
        |pressure_pa: f64| slope_n_per_pa(model, pressure_pa, length_m, direction, span_pa) >= min_slope_n_per_pa;
    // Between a pressure where the force rises and one where it does not.
    let end = |mut inside: f64, mut outside: f64| {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if rises(middle) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        inside
    };
    let mut branches = Vec::new();
    let mut open: Option<f64> = None;
    let mut before_pa = from_pa;
    for step in 0..=STEPS {
        let pressure_pa = if step == STEPS { to_pa } else { from_pa + span_pa * step as f64 / STEPS as f64 };
        match (rises(pressure_pa), open) {
            (true, None) => open = Some(if step == 0 { from_pa } else { end(pressure_pa, before_pa) }),
            (false, Some(start_pa)) => {
                branches.push([start_pa, end(before_pa, pressure_pa)]);
                open = None;
            }
            _ => {}
        }
        before_pa = pressure_pa;
    }
    branches.extend(open.map(|start_pa| [start_pa, to_pa]));
    branches
}

/// The longest of `branches`, and the lower of two equal ones.
pub fn longest(branches: &[[f64; 2]]) -> Option<[f64; 2]> {
    let length = |branch: &[f64; 2]| branch[1] - branch[0];
    branches.iter().copied().reduce(|best, next| if length(&next) > length(&best) { next } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::tests::{nominal, soft};

    #[test]
    fn a_stiff_muscle_rises_everywhere() {
        assert_eq!(rising(&nominal().into(), 0.24, 1.0, [0.0, 5e5], 1e-5), [[0.0, 5e5]]);
    }

    #[test]
    fn a_soft_braid_bends_the_force_over() {
        let model = soft().into();
        let branches = rising(&model, 0.2, 1.0, [0.0, 5e5], 1e-5);
        assert_eq!(branches.len(), 1);
        let [start_pa, end_pa] = branches[0];
        assert!(start_pa.abs() < 1e-9 && end_pa > 1e4 && end_pa < 4e5, "{branches:?}");
        let slope = slope_n_per_pa(&model, end_pa, 0.2, 1.0, 5e5);
        assert!((slope - 1e-5).abs() < 1e-9, "{slope}");
    }

    #[test]
    fn the_longest_branch_wins_and_the_lower_of_equal_ones() {
        assert_eq!(longest(&[[0.0, 1.0], [2.0, 4.0], [5.0, 7.0]]), Some([2.0, 4.0]));
        assert_eq!(longest(&[]), None);
    }

    #[test]
    fn strands_pulled_straight_have_no_inverse() {
        assert!(rising(&nominal().into(), 0.5, 1.0, [0.0, 5e5], 1e-5).is_empty());
    }
}
