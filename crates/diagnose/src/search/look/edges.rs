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
    assert!(!stands_for_map(100.0, 100.0, LEAST_LOG_RATIO) && stands_for_map(100.0, 100.0, LEAST_LOG_RATIO + 1e-9));
}
