//! `JᵀJ` and `Jᵀr` of a network over all samples, block by block.
//!
//! # Design
//! Blocks have a fixed size and are summed in their order, so the result does not depend on the number of
//! threads. Within a block the triangle is worked on tile by tile: a tile stays in vector registers while all rows of
//! a batch pass. Every sum runs over the rows in their order and nothing is fused, so that every processor gives the
//! same bits; a library's matrix product would be chosen by the processor at hand, and with it the last digits of
//! every weight.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::network::Network;
use crate::samples::Samples;

/// Samples in a block.
const BLOCK: usize = 256;
/// Rows of a batch: with 250 parameters they fill 64 kB.
const ROWS: usize = 32;
/// Rows of a tile of `JᵀJ`, and vectors side by side in it.
const TILE: (usize, usize) = (4, 2);
/// Numbers in the longest vector.
const MOST_LANES: usize = 8;

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
        // Whole tiles; what is beyond the parameters stays zero.
        let width = n.next_multiple_of(TILE.1 * MOST_LANES);
        let mut hessian = vec![0.0; width * width];
        let mut rows = vec![0.0; ROWS * width];
        let arch = Arch::new();
        for batch in range.clone().step_by(ROWS) {
            let n_rows = ROWS.min(range.end - batch);
            for (index, row) in (batch..).zip(rows.chunks_exact_mut(width)).take(n_rows) {
                let row = &mut row[..n];
                network.forward(&samples.inputs[index], &mut pass);
                let residual = pass.outputs()[0] - samples.targets[index];
                network.backward(&mut pass, &[1.0], row);
                for (sum, derivative) in sums.gradient.iter_mut().zip(row) {
                    *sum += residual * *derivative;
                }
                sums.cost += 0.5 * residual * residual;
            }
            arch.dispatch(Products { hessian: &mut hessian, rows: &rows[..n_rows * width], width });
        }
        for (line, padded) in sums.hessian.chunks_exact_mut(n).zip(hessian.chunks_exact(width)) {
            line.copy_from_slice(&padded[..n]);
        }
        sums
    }
}

fn add(sum: &mut [f64], terms: &[f64]) {
    for (sum, term) in sum.iter_mut().zip(terms) {
        *sum += term;
    }
}

/// Adds the products of `rows`, each of length `width`, with themselves to the upper triangle of `hessian`.
struct Products<'a> {
    hessian: &'a mut [f64],
    rows: &'a [f64],
    width: usize,
}

impl WithSimd for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { hessian, rows, width } = self;
        let across = TILE.1 * S::F64_LANES;
        for top in (0..width).step_by(TILE.0) {
            for left in (top / across * across..width).step_by(across) {
                let mut tile = [[simd.splat_f64s(0.0); TILE.1]; TILE.0];
                for row in rows.chunks_exact(width) {
                    let (terms, _) = S::as_simd_f64s(&row[left..left + across]);
                    let (Some(&terms), Some(&factors)) = (terms.first_chunk(), row[top..].first_chunk()) else { break };
                    add_product(simd, &mut tile, factors, terms);
                }
                for (line, terms) in hessian[top * width..].chunks_mut(width).zip(tile) {
                    let (sums, _) = S::as_mut_simd_f64s(&mut line[left..left + across]);
                    for (sum, term) in sums.iter_mut().zip(terms) {
                        *sum = simd.add_f64s(*sum, term);
                    }
                }
            }
        }
    }
}

/// Adds the products of `factors` and `terms` to a tile, nothing fused.
#[inline(always)]
fn add_product<S: Simd>(
    simd: S,
    tile: &mut [[S::f64s; TILE.1]; TILE.0],
    factors: [f64; TILE.0],
    terms: [S::f64s; TILE.1],
) {
    for (line, factor) in tile.iter_mut().zip(factors) {
        let factor = simd.splat_f64s(factor);
        for (sum, term) in line.iter_mut().zip(terms) {
            *sum = simd.add_f64s(*sum, simd.mul_f64s(factor, term));
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
