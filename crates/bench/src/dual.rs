//! Derivatives without step sizes: a number that carries its derivative along.
//!
//! The bench states energies and takes tensions as their derivatives. Forward-mode differentiation
//! yields those to rounding, so that no force formula has to be derived, printed or mistyped.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its derivative with respect to one variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dual {
    /// Value.
    pub(crate) value: f64,
    /// Derivative.
    pub(crate) slope: f64,
}

impl Dual {
    /// The variable itself.
    pub(crate) fn variable(value: f64) -> Self {
        Self { value, slope: 1.0 }
    }

    /// A number that does not depend on the variable.
    pub(crate) fn constant(value: f64) -> Self {
        Self { value, slope: 0.0 }
    }

    /// Square root.
    pub(crate) fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Self { value: root, slope: self.slope / (2.0 * root) }
    }

    /// Square.
    pub(crate) fn squared(self) -> Self {
        self * self
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, slope: self.slope * other.value + self.value * other.slope }
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self { value, slope: (self.slope - value * other.slope) / other.value }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope }
    }
}

impl Mul<Dual> for f64 {
    type Output = Dual;
    fn mul(self, other: Dual) -> Dual {
        Dual { value: self * other.value, slope: self * other.slope }
    }
}

/// Derivative of `function` at `at`.
pub(crate) fn derivative(function: impl Fn(Dual) -> Dual, at: f64) -> f64 {
    function(Dual::variable(at)).slope
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivative_of_a_formula_with_every_operation_is_that_of_calculus() {
        // f = √(x² + 3) / (5 - x) - 2 x
        let slope =
            derivative(|x| (x.squared() + Dual::constant(3.0)).sqrt() / (Dual::constant(5.0) - x) + -(2.0 * x), 1.0);
        // f' = x / (√(x² + 3) (5 - x)) + √(x² + 3) / (5 - x)² - 2 = 1/8 + 2/16 - 2 at x = 1.
        assert!((slope + 1.75).abs() < 1e-15);
    }
}
