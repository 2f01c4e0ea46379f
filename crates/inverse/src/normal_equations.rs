//! `JᵀJ` and `Jᵀr` of a network over all samples, block by block.
//!
//! # Design
//! Blocks have a fixed size and are summed in their order, so the result does not depend on the number of
//! threads. Within a block four rows are added at a time: the triangle, which fills the cache, passes through the
//! processor a quarter as often. A library's matrix product would be chosen by the processor at hand, and with it
//! the last digits of every weight.

use rayon::prelude::*;

use crate::network::Network;
use crate::samples::Samples;

/// Samples in a block.
const BLOCK: usize = 256;
/// Rows added at a time.
const ROWS: usize = 4;

/// Sums over samples.
#[derive(Debug, Clone)]
pub(crate) struct NormalEquations {
    /// `JᵀJ`, `n × n` row by row; the upper triangle is filled.
    pub(crate) hessian: Vec<f64>,
    /// `Jᵀr`.
    pub(crate) gradient: Vec<f64>,
    /// `½ Σ r²`.
    pub(crate) cost: f64,
}

impl NormalEquations {
    fn zero(n: usize) -> Self {
        Self { hessian: vec![0.0; n * n], gradient: vec![0.0; n], cost: 0.0 }
    }

    /// Sums over all samples, the residual being output less target.
    pub(crate) fn of(network: &Network, samples: &Samples) -> Self {
        let blocks: Vec<Self> = (0..samples.len().div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| Self::of_block(network, samples, block * BLOCK..((block + 1) * BLOCK).min(samples.len())))
            .collect();
        let mut sum = Self::zero(network.parameters().len());
        for block in &blocks {
            add(&mut sum.hessian, &block.hessian);
            add(&mut sum.gradient, &block.gradient);
            sum.cost += block.cost;
        }
        sum
    }

    fn of_block(network: &Network, samples: &Samples, range: std::ops::Range<usize>) -> Self {
        let n = network.parameters().len();
        let mut sums = Self::zero(n);
        let mut pass = network.pass();
        let mut rows = vec![0.0; ROWS * n];
        let mut filled = 0;
        for index in range {
            network.forward(&samples.inputs[index], &mut pass);
            let residual = pass.outputs()[0] - samples.targets[index];
            let row = &mut rows[filled * n..(filled + 1) * n];
            network.backward(&mut pass, &[1.0], row);
            for (sum, derivative) in sums.gradient.iter_mut().zip(row) {
                *sum += residual * *derivative;
            }
            sums.cost += 0.5 * residual * residual;
            filled += 1;
            if filled == ROWS {
                add_products(&mut sums.hessian, &rows, n);
                filled = 0;
            }
        }
        if filled > 0 {
            rows[filled * n..].fill(0.0);
            add_products(&mut sums.hessian, &rows, n);
        }
        sums
    }
}

fn add(sum: &mut [f64], terms: &[f64]) {
    for (sum, term) in sum.iter_mut().zip(terms) {
        *sum += term;
    }
}

/// Adds the products of four rows of length `n` with themselves to the upper triangle.
fn add_products(hessian: &mut [f64], rows: &[f64], n: usize) {
    let (first, rest) = rows.split_at(n);
    let (second, rest) = rest.split_at(n);
    let (third, fourth) = rest.split_at(n);
    for index in 0..n {
        let [a, b, c, d] = [first[index], second[index], third[index], fourth[index]];
        let line = &mut hessian[index * n + index..(index + 1) * n];
        let columns = first[index..].iter().zip(&second[index..]).zip(&third[index..]).zip(&fourth[index..]);
        for (sum, (((w, x), y), z)) in line.iter_mut().zip(columns) {
            *sum += (a * w + b * x) + (c * y + d * z);
        }
    }
}

/// `½ Σ r²` over all samples.
pub(crate) fn cost(network: &Network, samples: &Samples) -> f64 {
    let blocks: Vec<f64> = (0..samples.len().div_ceil(BLOCK))
        .into_par_iter()
        .map(|block| {
            let mut pass = network.pass();
            let mut sum = 0.0;
            for index in block * BLOCK..((block + 1) * BLOCK).min(samples.len()) {
                network.forward(&samples.inputs[index], &mut pass);
                let residual = pass.outputs()[0] - samples.targets[index];
                sum += 0.5 * residual * residual;
            }
            sum
        })
        .collect();
    blocks.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::Stream;
    use pam_core::artifact::inverse::Activation;

    #[test]
    fn sums_agree_with_rows_one_by_one() {
        let layers = [3, 4, 1];
        let activations = [Activation::Tanh, Activation::Linear];
        let network = Network::initial(&layers, &activations, &mut Stream::Weights(0).random(1));
        let n_samples = 2 * BLOCK + 7;
        let wave = |index: usize| [(index as f64).sin(), (2.0 * index as f64).cos(), (0.3 * index as f64).sin()];
        let samples = Samples {
            inputs: (0..n_samples).map(wave).collect(),
            targets: (0..n_samples).map(|index| (0.7 * index as f64).cos()).collect(),
        };
        let sums = NormalEquations::of(&network, &samples);
        let n = network.parameters().len();
        let (mut hessian, mut gradient, mut total) = (vec![0.0; n * n], vec![0.0; n], 0.0);
        let mut pass = network.pass();
        let mut row = vec![0.0; n];
        for (inputs, target) in samples.inputs.iter().zip(&samples.targets) {
            network.forward(inputs, &mut pass);
            let residual = pass.outputs()[0] - target;
            network.backward(&mut pass, &[1.0], &mut row);
            for i in 0..n {
                gradient[i] += row[i] * residual;
                for j in 0..n {
                    hessian[i * n + j] += row[i] * row[j];
                }
            }
            total += 0.5 * residual * residual;
        }
        for i in 0..n {
            assert!((sums.gradient[i] - gradient[i]).abs() < 1e-9);
            for j in i..n {
                assert!((sums.hessian[i * n + j] - hessian[i * n + j]).abs() < 1e-9);
            }
        }
        assert!((sums.cost - total).abs() < 1e-9);
        assert!((cost(&network, &samples) - total).abs() < 1e-9);
    }
}
