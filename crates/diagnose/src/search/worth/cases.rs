//! What must be gained, to the edge.

use pam_muscle::effects::effect;

use super::*;
use crate::hypothesis::{Beginning, CandidateEffect, Sign};
use crate::trial::Trial;

fn held(square: f64) -> HeldOut {
    HeldOut { blocks: vec![square; 8], counts: vec![10.0; 8], floor_square: 0.01 }
}

/// Whether effect `id` that leaves `after` of `before` with so much evidence is worth taking; sensors leave 0.3 N.
fn is_worth(id: &str, (before, after): (f64, f64), log_ratio: f64, whole: Option<f64>, limits: &Limits) -> bool {
    let effect = effect(id).expect("an id");
    let guess = CandidateEffect {
        effect,
        shape: vec![0.1; effect.shape().len()],
        sign: Sign::Any,
        beginning: Beginning::Fresh,
    };
    let trial = Trial { held_out: held(after), log_ratio, ..Trial::gaining_nothing(guess, after, &held(before)) };
    worth(&trial, whole.is_some(), &held(whole.unwrap_or(before)), 0.1, limits)
}

fn limits() -> Limits {
    Limits::of_test(4, 0.3)
}

#[test]
fn a_tenth_of_what_is_left_of_the_mismatch_is_the_least() {
    // 3.9 N² beyond the floor.
    assert!(is_worth("pressure-lag", (4.0, 3.60), 5.0, None, &limits()));
    assert!(!is_worth("pressure-lag", (4.0, 3.62), 5.0, None, &limits()));
}

#[test]
fn what_does_not_matter_is_not_worth_a_name() {
    // A tenth of what sensors and floor leave, 0.19 N².
    assert!(is_worth("pressure-lag", (0.20, 0.18), 5.0, None, &limits()));
    assert!(!is_worth("pressure-lag", (0.20, 0.182), 5.0, None, &limits()));
    let limited = Limits { matters_above_n: Some(1.0), ..limits() };
    assert!(is_worth("pressure-lag", (4.0, 2.9), 5.0, None, &limited));
    assert!(!is_worth("pressure-lag", (4.0, 3.1), 5.0, None, &limited));
    // Where the floor is far above the sensors, theirs is the measure: four times of it.
    let quiet = Limits::of_test(4, 0.05);
    assert!(is_worth("pressure-lag", (0.12, 0.11), 5.0, None, &quiet));
}

#[test]
fn the_first_effect_needs_less_evidence_than_a_further_one() {
    let first = |log_ratio| is_worth("pressure-lag", (4.0, 1.0), log_ratio, None, &limits());
    assert!(first(1.6) && !first(1.5));
    let further = |log_ratio| is_worth("pressure-lag", (4.0, 1.0), log_ratio, Some(4.0), &limits());
    assert!(further(3.1) && !further(3.0));
}

#[test]
fn a_further_effect_explains_a_share_of_the_whole_or_has_strong_evidence() {
    // Half a newton squared of a whole of 12.5 is a twenty-fifth.
    let further =
        |whole, log_ratio, limits: &Limits| is_worth("pressure-lag", (1.0, 0.5), log_ratio, Some(whole), limits);
    assert!(further(12.5, 4.0, &limits()) && !further(12.7, 4.0, &limits()));
    assert!(further(12.7, 8.1, &limits()) && !further(12.7, 8.0, &limits()));
    let confirmed = Limits { confirmed: true, ..limits() };
    assert!(further(25.0, 4.0, &confirmed) && !further(25.2, 4.0, &confirmed));
    // Held-out recordings say nothing more of what is static.
    assert!(!is_worth("end-taper", (1.0, 0.5), 4.0, Some(20.0), &confirmed));
}

#[test]
fn chance_asks_for_three_blocks_and_counts_those_that_are_touched() {
    let of = |blocks: &[f64]| HeldOut { blocks: blocks.to_vec(), counts: vec![10.0; blocks.len()], floor_square: 0.0 };
    assert_eq!(chance(&of(&[4.0, 4.0]), &of(&[1.0, 1.1])), 1.0);
    let three = chance(&of(&[4.0, 4.0, 4.0]), &of(&[2.0, 1.0, 3.0]));
    assert!((0.001..0.05).contains(&three), "{three}");
    // Blocks that stay as they are say nothing.
    let with_idle = chance(&of(&[4.0, 4.0, 4.0, 9.0, 9.0]), &of(&[2.0, 1.0, 3.0, 9.0, 9.0]));
    assert!((with_idle - three).abs() < 1e-12);
    // What gets worse as often as better is chance.
    let even = chance(&of(&[4.0, 4.0, 4.0, 4.0]), &of(&[2.0, 8.0, 2.0, 8.0]));
    assert!((even - 0.5).abs() < 1e-9, "{even}");
}
