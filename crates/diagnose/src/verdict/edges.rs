//! Limits of a verdict that are reached and not exceeded.

use super::cases::{SIZES, lag_with, nothing};
use super::*;

#[test]
fn as_much_as_matters_may_be_left_of_an_explanation() {
    let mut found = nothing();
    lag_with(&mut found, &[]);
    let left = |left_n: f64, mismatch_n: f64| verdict(&found, &Sizes { left_n, mismatch_n, ..SIZES }, false);
    // A quarter of the mismatch: more than what matters may be left of, less than what half of it may.
    assert_eq!(left(1.0, 2.0), Verdict::Explained);
    assert_eq!(left(1.0 + 1e-9, 2.0), Verdict::Unexplained);
    // Half of what matters, and half of the mismatch.
    assert_eq!(left(0.5, 0.7), Verdict::Explained);
    assert_eq!(left(0.5 + 1e-9, 0.7), Verdict::Unexplained);
}
