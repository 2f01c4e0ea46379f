//! Levenberg–Marquardt: steps between those of Gauss and Newton and those along the gradient.
//!
//! ```text
//! (JᵀJ + μ I) Δθ = -Jᵀ r
//! ```
//!
//! with the residual `r` (output less target) and its Jacobian `J` over all samples. The damping `μ` falls while
//! the cost falls as the linear model foretold, and grows while it does not; only steps that lower the cost are
//! taken.
//!
//! Source: Hagan and Menhaj (1994), "Training feedforward networks with the Marquardt algorithm", IEEE Trans.
//! Neural Networks 5(6); the rule for `μ` is that of Nielsen (1999), "Damping parameter in Marquardt's method",
//! report IMM-REP-1999-05, Technical University of Denmark.

use crate::cholesky::Triangle;
use crate::network::Network;
use crate::normal_equations::{NormalEquations, cost};
use crate::samples::Samples;

/// First damping, as a share of the largest diagonal element of `JᵀJ`.
const FIRST_DAMPING: f64 = 1e-3;
/// Steps in a row that may fail before nothing more is expected.
const MOST_FAILURES: u32 = 12;
/// Largest damping; beyond it a step is nothing but rounding.
const MOST_DAMPING: f64 = 1e12;

/// A descent that is under way.
#[derive(Debug, Clone)]
pub struct LevenbergMarquardt {
    damping: Option<f64>,
    growth: f64,
    sums: NormalEquations,
    damped: Triangle,
    step: Vec<f64>,
}

/// What came of an epoch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Step {
    /// The cost fell to this.
    Lower(f64),
    /// No step lowers the cost.
    Stuck,
}

impl Default for LevenbergMarquardt {
    fn default() -> Self {
        Self {
            damping: None,
            growth: 2.0,
            sums: NormalEquations::default(),
            damped: Triangle::default(),
            step: Vec::new(),
        }
    }
}

impl LevenbergMarquardt {
    /// One epoch: moves the network by a step that lowers the cost `½ Σ r²`, if there is one.
    pub fn epoch(&mut self, network: &mut Network, samples: &Samples) -> Step {
        let n = network.parameters().len();
        self.sums.sum(network, samples);
        let sums = self.sums.all();
        if !sums.cost.is_finite() {
            return Step::Stuck;
        }
        let diagonal = (0..n).map(|index| sums.hessian(index, index)).fold(0.0, f64::max);
        let mut damping = self.damping.unwrap_or(FIRST_DAMPING * diagonal);
        let mut moved = network.clone();
        for _ in 0..MOST_FAILURES {
            self.damped.put(sums.triangle(), (n, sums.width()), damping);
            if self.damped.factorize() {
                self.step.clone_from(&sums.gradient);
                self.damped.solve(&mut self.step);
                self.step.iter_mut().for_each(|step| *step = -*step);
                for ((new, old), by) in moved.parameters_mut().iter_mut().zip(network.parameters()).zip(&self.step) {
                    *new = old + by;
                }
                let lowered = sums.cost - cost(&moved, samples);
                let downhill = |(step, slope): (&f64, &f64)| step * (damping * step - slope);
                let foretold = 0.5 * self.step.iter().zip(&sums.gradient).map(downhill).sum::<f64>();
                if lowered > 0.0 && foretold > 0.0 {
                    let trust = 2.0 * (lowered / foretold) - 1.0;
                    let shrink = (1.0 - trust * trust * trust).max(1.0 / 3.0);
                    self.damping = Some((damping * shrink).max(1e-15 * diagonal));
                    self.growth = 2.0;
                    network.parameters_mut().copy_from_slice(moved.parameters());
                    return Step::Lower(sums.cost - lowered);
                }
            }
            damping *= self.growth;
            self.growth *= 2.0;
            if damping > MOST_DAMPING * diagonal.max(f64::MIN_POSITIVE) {
                break;
            }
        }
        Step::Stuck
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backpropagation::tests::{network, saddle};
    use pam_artifact::inverse::Activation;

    #[test]
    fn the_cost_falls_at_every_step() {
        let samples = saddle(300);
        for (hidden, output) in [(Activation::Tanh, Activation::Linear), (Activation::Sigmoid, Activation::Sigmoid)] {
            let mut network = network(hidden, output);
            let mut descent = LevenbergMarquardt::default();
            let first = cost(&network, &samples);
            let mut before = first;
            for epoch in 0..40 {
                let Step::Lower(after) = descent.epoch(&mut network, &samples) else { break };
                assert!(after < before, "{epoch}: {before} {after}");
                assert!((after - cost(&network, &samples)).abs() <= 1e-12 * first, "{epoch}");
                before = after;
            }
            assert!(before < 1e-3 * first, "{hidden:?}: {first} {before}");
        }
    }

    #[test]
    fn a_network_that_fits_already_is_left_alone() {
        let network_to_fit = network(Activation::Tanh, Activation::Linear);
        let mut samples = saddle(50);
        let mut pass = network_to_fit.pass();
        for (target, inputs) in samples.targets.iter_mut().zip(&samples.inputs) {
            network_to_fit.forward(&inputs.map(|input| [input]), &mut pass);
            *target = pass.outputs()[0][0];
        }
        let mut network = network_to_fit.clone();
        assert_eq!(LevenbergMarquardt::default().epoch(&mut network, &samples), Step::Stuck);
        assert_eq!(network, network_to_fit);
    }
}
