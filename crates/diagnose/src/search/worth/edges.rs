//! Where what must be gained ends: a little more is enough, and as much is not.

use pam_muscle::effects::effect;

use super::*;
use crate::hypothesis::{Beginning, CandidateEffect, Sign};
use crate::trial::Trial;

fn held(square: f64) -> HeldOut {
    HeldOut { blocks: vec![square; 4], counts: vec![10.0; 4], floor_square: 0.01 }
}

/// Of a first effect: its id, what it leaves of what was left before it, both in N², with so much evidence, where no model gets below
/// `floor_square`.
fn first(id: &str, (before, after): (f64, f64), log_ratio: f64, floor_square: f64, limits: &Limits) -> bool {
    let effect = effect(id).expect("an id");
    let shape = effect.shape().iter().map(|parameter| parameter.grid[0]).collect();
    let guess = CandidateEffect { effect, shape, sign: Sign::Any, beginning: Beginning::Fresh };
    let trial = Trial { held_out: held(after), log_ratio, ..Trial::gaining_nothing(guess, after, &held(before)) };
    worth(&trial, false, &held(before), floor_square, limits)
}

#[test]
fn an_effect_explains_a_share_of_all_that_is_left_unless_it_is_local_or_its_evidence_strong() {
    // No model gets below most of what is left, so that the share of the mismatch is small, and the sensors leave much of the rest.
    let limits = Limits { matters_above_n: Some(1e-3), ..Limits::of_test(4, 2.0) };
    let (before, floor_square) = (44.0, 40.0);
    let edge = LEAST_OF_LEFT * (before - 2.0_f64.powi(2));
    let gains = |id: &str, share: f64, log_ratio: f64| {
        first(id, (before, before - share * edge), log_ratio, floor_square, &limits)
    };
    assert!(gains("pressure-lag", 1.01, 5.0) && !gains("pressure-lag", 0.99, 5.0));
    assert!(gains("threshold-pressure", 0.99, 5.0), "what acts in a part of the range alone");
    assert!(gains("pressure-lag", 0.99, STRONG_LOG_RATIO + 0.1));
    assert!(!gains("pressure-lag", 0.99, STRONG_LOG_RATIO), "as much is not beyond");
}

#[test]
fn an_effect_that_gains_as_much_as_is_asked_gains_no_more() {
    let limits = |limit_n| Limits { matters_above_n: Some(limit_n), ..Limits::of_test(4, 0.0) };
    // A newton squared, by a limit of a newton.
    assert!(!first("pressure-lag", (4.0, 3.0), 9.0, 0.0, &limits(1.0)));
    assert!(first("pressure-lag", (4.0, 3.0), 9.0, 0.0, &limits(0.99)));
    // The least share of a mismatch without a floor.
    let after = 20.0 - LEAST_SHARE * 20.0;
    assert!(!first("pressure-lag", (20.0, after), 9.0, 0.0, &limits(0.1)));
    assert!(first("pressure-lag", (20.0, 0.999 * after), 9.0, 0.0, &limits(0.1)));
}

#[test]
fn a_limit_of_what_matters_is_a_size_that_counts_in_squares() {
    let limits = Limits { matters_above_n: Some(2.0), ..Limits::of_test(4, 0.0) };
    assert!(first("pressure-lag", (9.0, 4.9), 9.0, 0.0, &limits));
    assert!(!first("pressure-lag", (9.0, 5.1), 9.0, 0.0, &limits));
}

#[test]
fn validates_against_the_normal_distribution_of_a_mean_of_three_blocks() {
    // Log ratios of 1, 2 and 3: a mean of 2 with a standard error of 1/√3, and 1 - Φ(2 √3) = 2.660e-4.
    let of = |blocks: &[f64]| HeldOut { blocks: blocks.to_vec(), counts: vec![10.0; blocks.len()], floor_square: 0.0 };
    let without = of(&[1.0_f64, 2.0, 3.0].map(f64::exp));
    let chance = chance(&without, &of(&[1.0; 3]));
    assert!((chance - 2.660e-4).abs() < 5e-8, "{chance}");
}
