//! What is asked of a map, to the edge.

use super::*;

#[test]
fn as_much_of_a_map_as_is_asked_is_not_enough() {
    let asked = Asked { least: 20.0, most: 180.0, sure: 0.1 };
    assert!(!asked.is_met(20.0, false, false) && asked.is_met(20.0 + 1e-9, false, false));
    assert!(!asked.is_met(180.0, false, true) && asked.is_met(180.0 + 1e-9, false, true));
}

#[test]
fn evidence_that_a_sure_effect_must_exceed_is_not_exceeded_by_as_much() {
    assert!(!surely_stands_for_map(100.0, 100.0, SURELY_LOG_RATIO));
    assert!(surely_stands_for_map(100.0, 100.0, SURELY_LOG_RATIO + 1e-9));
    assert!(!surely_stands_for_map(100.0 * SURELY_OF_THE_MAP, 100.0, 2.0 * SURELY_LOG_RATIO));
    assert!(!stands_for_map(100.0, 100.0, LEAST_LOG_RATIO) && stands_for_map(100.0, 100.0, LEAST_LOG_RATIO + 1e-9));
}

#[test]
fn what_matters_is_what_a_sure_effect_must_take_up_in_squares() {
    let sure = |limit_n: f64, sensors_n: f64| {
        let limits = Limits { matters_above_n: Some(limit_n), ..Limits::of_test(3, sensors_n) };
        Asked::of(&limits, 0.02, 1000.0).sure
    };
    assert!((sure(0.5, 0.3) - 0.25).abs() < 1e-12 && (sure(3.0, 0.3) - 9.0).abs() < 1e-12);
    // Without a limit, what the sensors leave; never more than is asked of any effect.
    let of = |sensors_n: f64, range_n: f64| Asked::of(&Limits::of_test(3, sensors_n), 0.02, range_n);
    assert!((of(0.3, 1000.0).sure - 0.09).abs() < 1e-12);
    let limits = Limits { matters_above_n: Some(50.0), ..Limits::of_test(3, 0.3) };
    let asked = Asked::of(&limits, 0.02, 1000.0);
    assert!((asked.sure - asked.least).abs() < 1e-12 && (asked.least - 2500.0).abs() < 1e-9);
}
