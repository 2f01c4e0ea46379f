//! What is asked of a map, to the edge.

use super::*;

#[test]
fn as_much_of_a_map_as_is_asked_is_not_enough() {
    let asked = Asked { least: 20.0, most: 180.0 };
    assert!(!asked.is_met(20.0, false, false) && asked.is_met(20.0 + 1e-9, false, false));
    assert!(!asked.is_met(180.0, false, true) && asked.is_met(180.0 + 1e-9, false, true));
}

#[test]
fn as_much_evidence_as_is_asked_is_not_enough() {
    let stands = |log_ratio, best_ratio| stands_for_map(100.0, 100.0, log_ratio, best_ratio);
    assert!(!stands(LEAST_LOG_RATIO, LEAST_LOG_RATIO) && stands(LEAST_LOG_RATIO + 1e-9, LEAST_LOG_RATIO));
}

#[test]
fn a_static_effect_that_another_one_beats_by_far_does_not_stand_for_the_map() {
    let stands = |log_ratio| stands_for_map(100.0, 100.0, log_ratio, 100.0);
    assert!(!stands(100.0 * RIVAL) && stands(100.0 * RIVAL + 1e-9));
}
