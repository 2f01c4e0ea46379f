//! Plain backpropagation, eqs 15 to 19: a step along the gradient after every sample, or after every epoch.
//!
//! ```text
//! E = ½ Σ_j (g_j - y_j)²
//! w_jk += η δ_j h_k,   δ_j = (g_j - y_j) f'(y_j)              y (1 - y) for a sigmoid, 1 for a linear output
//! v_ki += η δ_k x_i,   δ_k = f'(h_k) Σ_j δ_j w_jk             over the outputs j, with w before the step
//! ```
//!
//! Biases move like weights from an input of 1; the paper leaves them as drawn.

use pam_artifact::inverse::Update;
use rand::seq::SliceRandom as _;
use rand_pcg::Pcg64Dxsm;

use crate::network::{Network, Pass};
use crate::samples::Samples;

/// A descent that is under way.
#[derive(Debug, Clone)]
pub struct Backpropagation {
    learning_rate: f64,
    update: Update,
    random: Pcg64Dxsm,
    order: Vec<usize>,
}

impl Backpropagation {
    /// A descent over `n_samples` samples; `learning_rate` is `η`, `random` draws their order.
    pub fn new(learning_rate: f64, update: Update, n_samples: usize, random: Pcg64Dxsm) -> Self {
        Self { learning_rate, update, random, order: (0..n_samples).collect() }
    }

    /// One epoch. Gives the cost `½ Σ r²` as the samples met it on their way.
    pub fn epoch(&mut self, network: &mut Network, samples: &Samples) -> f64 {
        let mut pass = network.pass();
        let mut gradient = vec![[0.0]; network.parameters().len()];
        let mut cost = 0.0;
        match self.update {
            Update::Sample => {
                self.order.shuffle(&mut self.random);
                for &index in &self.order {
                    cost += derive(network, &mut pass, samples, index, &mut gradient);
                    descend(network, self.learning_rate, gradient.as_flattened());
                }
            }
            Update::Epoch => {
                let mut sum = vec![0.0; gradient.len()];
                for index in 0..samples.len() {
                    cost += derive(network, &mut pass, samples, index, &mut gradient);
                    for (sum, term) in sum.iter_mut().zip(gradient.as_flattened()) {
                        *sum += term;
                    }
                }
                descend(network, self.learning_rate / samples.len().max(1) as f64, &sum);
            }
        }
        cost
    }
}

/// Gradient of one sample's cost, and the cost.
fn derive(network: &Network, pass: &mut Pass<1>, samples: &Samples, index: usize, gradient: &mut [[f64; 1]]) -> f64 {
    network.forward(&samples.inputs[index].map(|input| [input]), pass);
    let residual = pass.outputs()[0][0] - samples.targets[index];
    network.backward(pass, &[[residual]], gradient);
    0.5 * residual * residual
}

fn descend(network: &mut Network, rate: f64, gradient: &[f64]) {
    for (parameter, slope) in network.parameters_mut().iter_mut().zip(gradient) {
        *parameter -= rate * slope;
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::normal_equations::cost;
    use crate::stream::Stream;
    use pam_artifact::inverse::Activation;

    /// Samples of a saddle, inside what every activation can reach.
    pub(crate) fn saddle(n: usize) -> Samples {
        let wave = |index: usize| [(index as f64).sin(), (1.7 * index as f64).cos(), (0.3 * index as f64).sin()];
        let inputs: Vec<[f64; 3]> = (0..n).map(wave).collect();
        let targets = inputs.iter().map(|[x, y, z]| 0.5 + 0.2 * x * y + 0.1 * z).collect();
        Samples { inputs, targets }
    }

    /// A network of eight hidden neurons.
    pub(crate) fn network(hidden: Activation, output: Activation) -> Network {
        Network::initial(&[3, 8, 1], &[hidden, output], &mut Stream::Weights(0).random(1))
    }

    #[test]
    fn the_error_falls_as_printed_and_by_epochs() {
        let samples = saddle(300);
        for (activations, update, rate) in [
            // As the paper prints it: sigmoids everywhere, a step after every sample.
            ((Activation::Sigmoid, Activation::Sigmoid), Update::Sample, 0.5),
            ((Activation::Tanh, Activation::Linear), Update::Sample, 0.02),
            ((Activation::Tanh, Activation::Linear), Update::Epoch, 0.1),
        ] {
            let mut network = network(activations.0, activations.1);
            let mut descent = Backpropagation::new(rate, update, samples.len(), Stream::Order(0).random(1));
            let before = cost(&network, &samples);
            for _ in 0..300 {
                descent.epoch(&mut network, &samples);
            }
            let after = cost(&network, &samples);
            assert!(after < 0.1 * before, "{activations:?} {update:?}: {before} {after}");
        }
    }

    #[test]
    fn one_step_of_the_printed_equations_by_hand() {
        // One input at 0.5 (the other two at 0), one hidden neuron, all sigmoid.
        let parameters = vec![0.4, 0.0, 0.0, -0.1, 0.7, 0.2];
        let activations = vec![Activation::Sigmoid; 2];
        let mut network = Network::new(vec![3, 1, 1], activations, parameters);
        let samples = Samples { inputs: vec![[0.5, 0.0, 0.0]], targets: vec![0.9] };
        let sigmoid = |z: f64| 1.0 / (1.0 + (-z).exp());
        let h = sigmoid(0.4 * 0.5 - 0.1);
        let y = sigmoid(0.7 * h + 0.2);
        let output_delta = (0.9 - y) * y * (1.0 - y);
        let hidden_delta = output_delta * 0.7 * h * (1.0 - h);
        let eta = 0.3;
        Backpropagation::new(eta, Update::Sample, 1, Stream::Order(0).random(1)).epoch(&mut network, &samples);
        let expected = [
            0.4 + eta * hidden_delta * 0.5,
            0.0,
            0.0,
            -0.1 + eta * hidden_delta,
            0.7 + eta * output_delta * h,
            0.2 + eta * output_delta,
        ];
        for (found, expected) in network.parameters().iter().zip(expected) {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
    }
}
