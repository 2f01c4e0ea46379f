//! Layers of neurons, eqs 13 and 14, and their derivatives.
//!
//! ```text
//! h = f(W x + b)   for every layer
//! ```
//!
//! The paper subtracts its biases and leaves them as drawn; here they are added, and trained like weights. The
//! derivatives run back through the layers: with `δ` the derivative by the sum in a neuron,
//!
//! ```text
//! ∂/∂w_jk = δ_j h_k,   ∂/∂b_j = δ_j,   δ_k = f'(h_k) Σ_j δ_j w_jk
//! ```
//!
//! where the sum runs over the neurons `j` after `k`, which eq. 19 misprints.
//!
//! Parameters are one vector: for every layer its weights row by row (`outputs × inputs`), then its biases.

use std::ops::Range;

use pam_artifact::inverse::Activation;
use rand::RngExt as _;
use rand_pcg::Pcg64Dxsm;

use crate::activation::{slope_at_answer, value};

/// A network of fully connected layers; inputs and outputs are scaled numbers without unit.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    layers: Vec<usize>,
    activations: Vec<Activation>,
    parameters: Vec<f64>,
}

/// What one pass of `N` samples side by side through a network leaves behind, for the way back. Every sample is worked on
/// as if it were alone, to the last bit.
#[derive(Debug, Clone)]
pub struct Pass<const N: usize> {
    /// Answers of every layer, the input first.
    answers: Vec<Vec<[f64; N]>>,
    /// Derivatives by the sums of every layer after the input.
    deltas: Vec<Vec<[f64; N]>>,
}

impl<const N: usize> Pass<N> {
    /// Answers of the last layer.
    pub fn outputs(&self) -> &[[f64; N]] {
        self.answers.last().map_or(&[], Vec::as_slice)
    }
}

impl Network {
    /// A network of given parameters; one activation per layer after the input.
    ///
    /// # Panics
    /// If layers, activations and parameters do not fit together.
    pub fn new(layers: Vec<usize>, activations: Vec<Activation>, parameters: Vec<f64>) -> Self {
        assert_eq!(activations.len() + 1, layers.len(), "an activation per layer after the input");
        assert_eq!(parameters.len(), n_parameters(&layers), "weights and biases of every layer");
        Self { layers, activations, parameters }
    }

    /// A network to start from: hidden neurons whose active ranges cover the inputs, -1 to 1, evenly.
    ///
    /// Source: Nguyen and Widrow (1990), "Improving the learning speed of 2-layer neural networks by choosing
    /// initial values of the adaptive weights", IJCNN.
    pub fn initial(layers: &[usize], activations: &[Activation], random: &mut Pcg64Dxsm) -> Self {
        let mut parameters = Vec::with_capacity(n_parameters(layers));
        let mut symmetric = || random.random_range(-1.0..1.0);
        for (layer, activation) in activations.iter().enumerate() {
            let (n_inputs, n_outputs) = (layers[layer], layers[layer + 1]);
            let mut biases = Vec::with_capacity(n_outputs);
            // A sigmoid is a hyperbolic tangent of half its argument.
            let stretch = if *activation == Activation::Sigmoid { 2.0 } else { 1.0 };
            let last = layer + 1 == activations.len();
            let reach = 0.7 * (n_outputs as f64).powf(1.0 / n_inputs as f64) * stretch;
            for neuron in 0..n_outputs {
                let mut row: Vec<f64> = (0..n_inputs).map(|_| symmetric()).collect();
                if last {
                    let size = 0.5 / (n_inputs as f64).sqrt();
                    row.iter_mut().for_each(|weight| *weight *= size);
                    biases.push(0.1 * symmetric());
                } else {
                    let norm = row.iter().map(|weight| weight * weight).sum::<f64>().sqrt().max(1e-3);
                    row.iter_mut().for_each(|weight| *weight *= reach / norm);
                    let even = 2.0 * (neuron as f64 + 0.5) / n_outputs as f64 - 1.0;
                    biases.push(reach * even * row[0].signum());
                }
                parameters.extend(row);
            }
            parameters.extend(biases);
        }
        Self { layers: layers.to_vec(), activations: activations.to_vec(), parameters }
    }

    /// Neurons of every layer, the input first.
    pub fn layers(&self) -> &[usize] {
        &self.layers
    }

    /// Activation of every layer after the input.
    pub fn activations(&self) -> &[Activation] {
        &self.activations
    }

    /// Weights and biases.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Weights and biases, to change.
    pub fn parameters_mut(&mut self) -> &mut [f64] {
        &mut self.parameters
    }

    /// Weights of a layer after the input, `outputs × inputs` row by row, and its biases.
    pub fn layer(&self, layer: usize) -> (&[f64], &[f64]) {
        let (weights, biases) = ranges(&self.layers, layer);
        (&self.parameters[weights], &self.parameters[biases])
    }

    /// Room for passes through this network.
    pub fn pass<const N: usize>(&self) -> Pass<N> {
        let answers: Vec<Vec<[f64; N]>> = self.layers.iter().map(|&width| vec![[0.0; N]; width]).collect();
        Pass { deltas: answers[1..].to_vec(), answers }
    }

    /// Runs `inputs` through the layers, eqs 13 and 14; the answer is [`Pass::outputs`].
    pub fn forward<const N: usize>(&self, inputs: &[[f64; N]], pass: &mut Pass<N>) {
        pass.answers[0].copy_from_slice(inputs);
        for (layer, &activation) in self.activations.iter().enumerate() {
            let (weights, biases) = self.layer(layer);
            let (before, after) = pass.answers.split_at_mut(layer + 1);
            let rows = weights.chunks_exact(self.layers[layer]);
            for ((answers, row), bias) in after[0].iter_mut().zip(rows).zip(biases) {
                let mut sums = [0.0; N];
                for (weight, inputs) in row.iter().zip(&before[layer]) {
                    for (sum, input) in sums.iter_mut().zip(inputs) {
                        *sum += weight * input;
                    }
                }
                *answers = sums.map(|sum| value(activation, sum + bias));
            }
        }
    }

    /// Writes `Σ_j seeds_j ∂y_j/∂θ` into `gradient`, for the outputs `y` of the last [`forward`](Self::forward).
    pub fn backward<const N: usize>(&self, pass: &mut Pass<N>, seeds: &[[f64; N]], gradient: &mut [[f64; N]]) {
        let last = self.activations.len() - 1;
        for ((delta, seed), answer) in pass.deltas[last].iter_mut().zip(seeds).zip(&pass.answers[last + 1]) {
            *delta = *seed;
            scale_by_slope(self.activations[last], answer, delta);
        }
        for layer in (0..=last).rev() {
            let n_inputs = self.layers[layer];
            let (weights_at, biases_at) = ranges(&self.layers, layer);
            let weights = &self.parameters[weights_at.clone()];
            let (deltas_before, deltas) = pass.deltas.split_at_mut(layer);
            let deltas = &deltas[0];
            for (row, delta) in gradient[weights_at].chunks_exact_mut(n_inputs).zip(deltas) {
                for (derivative, input) in row.iter_mut().zip(&pass.answers[layer]) {
                    for ((derivative, delta), input) in derivative.iter_mut().zip(delta).zip(input) {
                        *derivative = delta * input;
                    }
                }
            }
            gradient[biases_at].copy_from_slice(deltas);
            if let Some(before) = deltas_before.last_mut() {
                before.fill([0.0; N]);
                for (row, delta) in weights.chunks_exact(n_inputs).zip(deltas) {
                    for (sum, weight) in before.iter_mut().zip(row) {
                        for (sum, delta) in sum.iter_mut().zip(delta) {
                            *sum += delta * weight;
                        }
                    }
                }
                for (sum, answer) in before.iter_mut().zip(&pass.answers[layer]) {
                    scale_by_slope(self.activations[layer - 1], answer, sum);
                }
            }
        }
    }
}

/// Multiplies `values` with the slopes of neurons at their answers.
fn scale_by_slope<const N: usize>(activation: Activation, answers: &[f64; N], values: &mut [f64; N]) {
    for (value, answer) in values.iter_mut().zip(answers) {
        *value *= slope_at_answer(activation, *answer);
    }
}

/// Weights and biases of a network with these layers.
pub fn n_parameters(layers: &[usize]) -> usize {
    layers.windows(2).map(|pair| (pair[0] + 1) * pair[1]).sum()
}

/// Where the weights and the biases of a layer lie among the parameters.
fn ranges(layers: &[usize], layer: usize) -> (Range<usize>, Range<usize>) {
    let start = n_parameters(&layers[..=layer]);
    let middle = start + layers[layer] * layers[layer + 1];
    (start..middle, middle..middle + layers[layer + 1])
}

#[cfg(test)]
mod tests;
