//! How a neuron answers, and how steeply.
//!
//! The slopes are written in terms of the answer, as eqs 17 and 19 do for the sigmoid: `y (1 - y)`. For the
//! hyperbolic tangent it is `1 - y²`, for a linear output 1.

use pam_artifact::inverse::Activation;

/// `tanh`, from one exponential: as fast as it gets, and exact to the last bits of 1, which is what a sum of
/// such terms needs.
#[inline]
fn tanh(z: f64) -> f64 {
    let decay = (-2.0 * z.abs()).exp();
    ((1.0 - decay) / (1.0 + decay)).copysign(z)
}

/// Answer of a neuron to the sum `z` of its inputs.
#[inline]
pub fn value(activation: Activation, z: f64) -> f64 {
    match activation {
        Activation::Tanh => tanh(z),
        Activation::Sigmoid => 1.0 / (1.0 + (-z).exp()),
        Activation::Linear => z,
    }
}

/// Slope of the answer, at an answer `y`.
#[inline]
pub fn slope_at_answer(activation: Activation, y: f64) -> f64 {
    match activation {
        Activation::Tanh => 1.0 - y * y,
        Activation::Sigmoid => y * (1.0 - y),
        Activation::Linear => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tangent_agrees_with_the_library() {
        for z in [-800.0, -3.0, -1e-9, 0.0, 0.2, 1.0, 20.0, 800.0_f64] {
            assert!((tanh(z) - z.tanh()).abs() < 3e-16, "{z}");
        }
    }

    #[test]
    fn slopes_agree_with_finite_differences() {
        for activation in [Activation::Tanh, Activation::Sigmoid, Activation::Linear] {
            for z in [-2.0, -0.1, 0.7] {
                let slope = (value(activation, z + 1e-6) - value(activation, z - 1e-6)) / 2e-6;
                assert!((slope - slope_at_answer(activation, value(activation, z))).abs() < 1e-9, "{activation:?}");
            }
        }
    }
}
