//! The finished network: force, length and direction in, pressure out, and a flag where it must not be trusted.
//!
//! # Design
//! A control loop asks thousands of times, so an evaluation allocates nothing: the answers of two neighboring
//! layers live on the stack, which is why layers have a largest width.

use pam_artifact::InverseArtifact;
use pam_artifact::inverse::{InverseDomain, MAX_WIDTH};

use crate::activation::value;
use crate::network::Network;
use crate::samples::Scaling;

/// Forces this much beyond the reach, as a share of the range of force, are still inside: between the lengths that
/// it is written down at, the reach is known to about that.
const FORCE_MARGIN: f64 = 2e-4;
/// Likewise for lengths, for rounding alone.
const LENGTH_MARGIN: f64 = 1e-9;

/// What a network answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// Gauge pressure, in Pa.
    pub pressure_pa: f64,
    /// Whether the question lies where the network was not trained, or where no pressure gives the force. The
    /// pressure is then an extrapolation, and not to be relied on.
    pub outside: bool,
}

/// A trained network with its scaling and its domain.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseNetwork {
    network: Network,
    scaling: Scaling,
    domain: InverseDomain,
    /// Lowest and highest force while extending, then while contracting, per length of the reach; NaN for none.
    reach_n: Vec<[f64; 4]>,
    lengths_per_m: f64,
    force_margin_n: f64,
    length_margin_m: f64,
}

impl InverseNetwork {
    /// A network with the scaling and the domain that belong to it.
    ///
    /// # Panics
    /// If the network is no network from three inputs to one output with layers of up to [`MAX_WIDTH`], or the
    /// domain has fewer than two lengths.
    pub fn new(network: Network, scaling: Scaling, domain: InverseDomain) -> Self {
        let layers = network.layers();
        assert!(layers[0] == 3 && layers[layers.len() - 1] == 1, "three inputs and one output");
        assert!(layers.iter().all(|&width| width <= MAX_WIDTH), "layers of {MAX_WIDTH} at most");
        assert!(domain.reach.len() > 1, "two lengths or more");
        let reach_n = domain.reach.iter().map(|reach| {
            let none = [f64::NAN; 2];
            let extending = reach.extending_force_n.unwrap_or(none);
            let contracting = reach.contracting_force_n.unwrap_or(none);
            [extending[0], extending[1], contracting[0], contracting[1]]
        });
        let reach_n: Vec<[f64; 4]> = reach_n.collect();
        let span_m = domain.length_m[1] - domain.length_m[0];
        Self {
            lengths_per_m: (reach_n.len() - 1) as f64 / span_m,
            force_margin_n: FORCE_MARGIN * (domain.force_n[1] - domain.force_n[0]),
            length_margin_m: LENGTH_MARGIN * span_m,
            reach_n,
            network,
            scaling,
            domain,
        }
    }

    /// The network of an artifact that was read, and thereby checked.
    pub fn from_artifact(artifact: &InverseArtifact) -> Self {
        let mut parameters = Vec::new();
        for (weights, biases) in artifact.weights.iter().zip(&artifact.biases) {
            weights.iter().for_each(|row| parameters.extend(row));
            parameters.extend(biases);
        }
        let network = Network::new(artifact.layers.clone(), artifact.activations.clone(), parameters);
        let inputs = std::array::from_fn(|index| artifact.input_scaling[index].clone());
        let scaling = Scaling { inputs, output: artifact.output_scaling.clone() };
        Self::new(network, scaling, artifact.domain.clone())
    }

    /// Layers with their weights.
    pub fn network(&self) -> &Network {
        &self.network
    }

    /// How inputs and output are scaled.
    pub fn scaling(&self) -> &Scaling {
        &self.scaling
    }

    /// By how much a force may lie beyond the reach and count as inside, in N.
    pub fn force_margin_n(&self) -> f64 {
        self.force_margin_n
    }

    /// Where the network may be asked.
    pub fn domain(&self) -> &InverseDomain {
        &self.domain
    }

    /// Pressure for a force at a length while moving in a direction (+1 contracting, -1 extending, between them
    /// where friction has not yet turned). Allocates nothing.
    pub fn pressure_pa(&self, force_n: f64, length_m: f64, direction: f64) -> Evaluation {
        let mut answers = [0.0; MAX_WIDTH];
        let mut next = [0.0; MAX_WIDTH];
        answers[..3].copy_from_slice(&self.scaling.inputs(force_n, length_m, direction));
        let layers = self.network.layers();
        for (layer, &activation) in self.network.activations().iter().enumerate() {
            let (weights, biases) = self.network.layer(layer);
            let n_inputs = layers[layer];
            let inputs = &answers[..n_inputs];
            for ((answer, row), bias) in next.iter_mut().zip(weights.chunks_exact(n_inputs)).zip(biases) {
                let sum: f64 = row.iter().zip(inputs).map(|(weight, input)| weight * input).sum();
                *answer = value(activation, sum + bias);
            }
            std::mem::swap(&mut answers, &mut next);
        }
        let output = &self.scaling.output;
        Evaluation {
            pressure_pa: output.offset + output.scale * answers[0],
            outside: !self.is_inside(force_n, length_m, direction),
        }
    }

    /// Whether some pressure of the domain gives the force there.
    pub fn is_inside(&self, force_n: f64, length_m: f64, direction: f64) -> bool {
        match self.reach_n(length_m, direction) {
            Some([lowest_n, highest_n]) => {
                force_n >= lowest_n - self.force_margin_n && force_n <= highest_n + self.force_margin_n
            }
            None => false,
        }
    }

    /// Lowest and highest force at a length and direction, in N; none outside the domain.
    pub fn reach_n(&self, length_m: f64, direction: f64) -> Option<[f64; 2]> {
        let [shortest_m, longest_m] = self.domain.length_m;
        let length_inside =
            length_m >= shortest_m - self.length_margin_m && length_m <= longest_m + self.length_margin_m;
        if !length_inside || !(-1.0..=1.0).contains(&direction) {
            return None;
        }
        let position = ((length_m - shortest_m) * self.lengths_per_m).clamp(0.0, (self.reach_n.len() - 1) as f64);
        let below = (position as usize).min(self.reach_n.len() - 2);
        let share = position - below as f64;
        let at = |index: usize| (1.0 - share) * self.reach_n[below][index] + share * self.reach_n[below + 1][index];
        let contracting = 0.5 * (1.0 + direction);
        let between = |extending: f64, contracted: f64| (1.0 - contracting) * extending + contracting * contracted;
        let reach_n = [between(at(0), at(2)), between(at(1), at(3))];
        // Beside a length without any reach there is none either.
        reach_n[0].is_finite().then_some(reach_n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::tests::{BOX, nominal_inverse};
    use crate::stream::Stream;
    use pam_artifact::inverse::Activation;

    fn untrained() -> InverseNetwork {
        let activations = [Activation::Tanh, Activation::Linear];
        let network = Network::initial(&[3, 6, 1], &activations, &mut Stream::Weights(0).random(1));
        InverseNetwork::new(network, Scaling::of(&BOX, Activation::Linear), nominal_inverse().domain())
    }

    #[test]
    fn an_evaluation_is_the_forward_pass_with_scaling() {
        let inverse = untrained();
        let mut pass = inverse.network().pass();
        for (force_n, length_m, direction) in [(100.0, 0.25, 1.0), (40.0, 0.22, -1.0), (5000.0, 0.1, 0.0)] {
            inverse
                .network()
                .forward(&inverse.scaling().inputs(force_n, length_m, direction).map(|input| [input]), &mut pass);
            let output = &inverse.scaling().output;
            let expected_pa = output.offset + output.scale * pass.outputs()[0][0];
            assert_eq!(inverse.pressure_pa(force_n, length_m, direction).pressure_pa, expected_pa);
        }
    }

    #[test]
    fn a_question_outside_the_domain_is_flagged() {
        let inverse = untrained();
        let outside = |force_n, length_m, direction| inverse.pressure_pa(force_n, length_m, direction).outside;
        assert!(!outside(100.0, 0.25, 1.0) && !outside(100.0, 0.25, -1.0) && !outside(100.0, 0.25, 0.0));
        assert!(outside(100.0, 0.2, 1.0) && outside(100.0, 0.28, 1.0), "length");
        assert!(outside(100.0, 0.25, 1.01), "direction");
        assert!(outside(900.0, 0.25, 1.0), "no pressure of the domain gives so much at this length");
        assert!(!outside(900.0, 0.265, 1.0));
        assert!(outside(1.0, 0.25, 1.0) && outside(-20.0, 0.25, -1.0), "slack");
        for broken in [(f64::NAN, 0.25, 1.0), (100.0, f64::NAN, 1.0), (100.0, 0.25, f64::NAN)] {
            assert!(outside(broken.0, broken.1, broken.2), "{broken:?}");
        }
    }

    #[test]
    fn the_flag_agrees_with_the_exact_inverse() {
        let (inverse, exact) = (untrained(), nominal_inverse());
        let (mut n_differ, mut n) = (0, 0);
        for row in 0..60 {
            for column in 0..60 {
                let length_m = 0.205 + 0.07 * f64::from(column) / 59.0;
                let force_n = -50.0 + 1250.0 * f64::from(row) / 59.0;
                for direction in [-1.0, 1.0] {
                    let possible = exact.pressure_pa(force_n, length_m, direction).is_ok();
                    n_differ += i32::from(possible != inverse.is_inside(force_n, length_m, direction));
                    n += 1;
                }
            }
        }
        // Only what lies within the margin of the edge may differ.
        assert!(n_differ * 1000 <= n, "{n_differ} of {n}");
    }
}
