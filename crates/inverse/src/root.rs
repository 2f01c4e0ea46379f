//! The root of a continuous function between two points of different sign.
//!
//! ITP: interpolation where the function is nearly straight, and never slower than bisection by more than one
//! step.
//!
//! Source: Oliveira and Takahashi (2020), "An enhancement of the bisection method average performance preserving
//! minmax optimality", ACM Trans. Mathematical Software 47(1).

/// The root of `f` in `[low, high]`, to `tolerance`; `f(low) ≤ 0 ≤ f(high)` is the caller's promise. NaN where
/// `f` is not finite on the way.
pub fn root(f: impl Fn(f64) -> f64, low: f64, high: f64, tolerance: f64) -> f64 {
    let (mut a, mut b) = (low, high);
    let (mut at_a, mut at_b) = (f(a), f(b));
    if at_a >= 0.0 {
        return a;
    }
    if at_b <= 0.0 {
        return b;
    }
    // The constants that the authors recommend.
    let truncation = 0.2 / (b - a);
    let half_steps = ((b - a) / (2.0 * tolerance)).log2().ceil().max(0.0);
    let mut radius = tolerance * (half_steps + 1.0).exp2();
    while b - a > 2.0 * tolerance {
        let middle = 0.5 * (a + b);
        let room = radius - 0.5 * (b - a);
        let straight = (at_b * a - at_a * b) / (at_b - at_a);
        let toward = (middle - straight).signum();
        let cut = truncation * (b - a) * (b - a);
        let truncated = if cut <= (middle - straight).abs() { straight + toward * cut } else { middle };
        let x = if (truncated - middle).abs() <= room { truncated } else { middle - toward * room };
        let at_x = f(x);
        if at_x > 0.0 {
            (b, at_b) = (x, at_x);
        } else if at_x < 0.0 {
            (a, at_a) = (x, at_x);
        } else {
            // Zero, or not a number.
            return if at_x.is_nan() { f64::NAN } else { x };
        }
        radius *= 0.5;
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn roots_of_known_functions_are_found() {
        assert!((root(|x| x * x - 2.0, 0.0, 2.0, 1e-12) - 2.0_f64.sqrt()).abs() < 1e-11);
        assert!((root(|x| x.powi(9) - 1e-9, 0.0, 1.0, 1e-12) - 0.1).abs() < 1e-11);
        assert!((root(|x| x - 0.25, 0.25, 1.0, 1e-12) - 0.25).abs() < 1e-15);
        assert!(root(|_| f64::NAN, 0.0, 1.0, 1e-9).is_nan());
    }

    #[test]
    fn never_much_slower_than_bisection() {
        let calls = Cell::new(0);
        let f = |x: f64| {
            calls.set(calls.get() + 1);
            if x < 0.123 { -1e-30 } else { 1e30 }
        };
        let _ = root(f, 0.0, 1.0, 1e-9);
        assert!(calls.get() <= 33, "{}", calls.get());
    }
}
