//! Shapes of the way from sticking to sliding, as the slope of friction's state over travel.
//!
//! ```text
//! dz/dx = g(h)/δ,   h = z sgn(dx)
//! endochronic     g = (1 − h)/(1 − κ h)
//! power           g = (1 − h)^i
//! elasto-plastic  g = 1 below the breakaway b, then 1 − α h with α = ½ + ½ sin(π (h − ½ (1 + b))/(1 − b))
//! ```
//!
//! `z`: state, −1…1; `δ`: pre-sliding distance, m. Every `g` vanishes at `h = 1`, where the braid slides.
//!
//! Sources: Valanis (1971) and Gaul and Lenz (1997), endochronic; Dahl (1976), exponent; Dupont, Hayward, Armstrong and Altpeter
//! (2002), elasto-plastic.

use std::f64::consts::PI;

/// A shape with its parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Valanis' endochronic law with `κ` in 0…1; 0 is Dahl's law, 1 a stop operator.
    Endochronic(f64),
    /// Dahl's law with an exponent other than 1: below 1 brittle, above 1 ductile.
    Power(f64),
    /// Elastic up to this breakaway, 0…1, and gradually sliding beyond.
    ElastoPlastic(f64),
}

/// Travel of one step of integration, over the pre-sliding distance, and most steps.
const STEP: f64 = 0.04;
const MOST_STEPS: f64 = 80.0;

impl Shape {
    /// Slope of the state over travel in units of the pre-sliding distance, at `ahead` = `z sgn(dx)`.
    pub fn slope(self, ahead: f64) -> f64 {
        let left = (1.0 - ahead).max(0.0);
        match self {
            Self::Endochronic(kappa) => left / (1.0 - kappa * ahead),
            Self::Power(exponent) => left.powf(exponent),
            Self::ElastoPlastic(breakaway) => {
                if ahead <= breakaway {
                    1.0
                } else {
                    let place = (ahead - 0.5 * (1.0 + breakaway)) / (1.0 - breakaway);
                    let share = 0.5 + 0.5 * (PI * place.min(0.5)).sin();
                    (1.0 - share * ahead).max(0.0)
                }
            }
        }
    }

    /// State after a travel in units of the pre-sliding distance.
    pub fn step(self, state: f64, travel: f64) -> f64 {
        if travel == 0.0 {
            return state;
        }
        let direction = travel.signum();
        let parts = (travel.abs() / STEP).ceil().clamp(1.0, MOST_STEPS);
        let part = travel.abs() / parts;
        let mut ahead = state * direction;
        for _ in 0..parts as usize {
            // The middle of the step (Runge and Kutta's second order), which never goes past sliding.
            let half = (ahead + 0.5 * part * self.slope(ahead)).min(1.0);
            ahead = (ahead + part * self.slope(half)).min(1.0);
        }
        ahead * direction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPES: [Shape; 5] = [
        Shape::Endochronic(0.0),
        Shape::Endochronic(0.8),
        Shape::Power(0.5),
        Shape::Power(1.8),
        Shape::ElastoPlastic(0.6),
    ];

    #[test]
    fn every_shape_slides_in_the_end_and_not_before() {
        for shape in SHAPES {
            assert!(shape.slope(1.0) < 1e-9, "{shape:?}");
            let (mut state, mut last) = (-1.0, -1.0);
            for _ in 0..40_000 {
                state = shape.step(state, 0.02);
                assert!((last..=1.0).contains(&state), "{shape:?}: {state}");
                last = state;
            }
            assert!(state > 0.99, "{shape:?}: {state}");
        }
    }

    #[test]
    fn without_kappa_the_endochronic_law_is_the_exponential_of_dahl() {
        let mut state = -1.0;
        for _ in 0..100 {
            state = Shape::Endochronic(0.0).step(state, 0.01);
        }
        assert!((state - (1.0 - 2.0 * (-1.0_f64).exp())).abs() < 1e-4, "{state}");
    }

    #[test]
    fn a_closed_loop_takes_work() {
        for shape in SHAPES {
            let (mut state, mut work) = (0.0, 0.0);
            for step in 0..20_000 {
                let travel = 0.05 * (f64::from(step) * 0.01).cos();
                let next = shape.step(state, travel);
                work += 0.5 * (state + next) * travel;
                state = next;
            }
            assert!(work > 0.0, "{shape:?}: {work}");
        }
    }
}
