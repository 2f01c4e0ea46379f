//! `JᵀJ` and `Jᵀr` of a network over all samples, block by block.
//!
//! # Design
//! Blocks have a fixed size and are summed in their order, so the result does not depend on the number of
//! threads. Within a block the triangle is worked on tile by tile: a tile stays in vector registers while all rows of
//! a batch pass. Every sum runs over the rows in their order and nothing is fused, so that every processor gives the
//! same bits; a library's matrix product would be chosen by the processor at hand, and with it the last digits of
//! every weight.

use std::ops::{AddAssign, Mul, Range};

use fearless_simd::{Level, Simd, SimdBase as _, dispatch};
use rayon::prelude::*;

use crate::network::{Network, Pass};
use crate::samples::Samples;

/// Most samples in a block.
const BLOCK: usize = 256;
/// Rows of a batch: with 250 parameters they fill 64 kB.
const ROWS: usize = 32;
/// Rows of a tile of `JᵀJ`, and vectors side by side in it.
const TILE: (usize, usize) = (4, 2);
/// Numbers in the longest vector.
const MOST_LANES: usize = 8;

/// Samples that pass through the network side by side.
const SIDE_BY_SIDE: usize = 8;

/// Blocks of about equal size, an even number of them: two threads are done at the same time.
fn blocks(n_samples: usize) -> Vec<Range<usize>> {
    let n_blocks = n_samples.div_ceil(BLOCK).next_multiple_of(2);
    let size = n_samples.div_ceil(n_blocks.max(1)).next_multiple_of(SIDE_BY_SIDE);
    (0..n_samples).step_by(size.max(1)).map(|first| first..(first + size).min(n_samples)).collect()
}

/// Sums over samples.
#[derive(Debug, Clone)]
pub(crate) struct Sums {
    /// `JᵀJ`, row by row, each as long as whole tiles; the upper triangle is filled.
    hessian: Vec<f64>,
    /// Length of these rows.
    width: usize,
    /// `Jᵀr`.
    pub(crate) gradient: Vec<f64>,
    /// `½ Σ r²`.
    pub(crate) cost: f64,
}

impl Sums {
    fn zero(n: usize) -> Self {
        let width = n.next_multiple_of(TILE.1 * MOST_LANES);
        Self { hessian: vec![0.0; width * width], width, gradient: vec![0.0; n], cost: 0.0 }
    }

    /// The rows of `JᵀJ`, whose upper triangle is filled.
    pub(crate) fn triangle(&self) -> &[f64] {
        &self.hessian[..self.gradient.len() * self.width]
    }

    /// Length of these rows.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// An element of the upper triangle of `JᵀJ`.
    pub(crate) fn hessian(&self, row: usize, column: usize) -> f64 {
        self.hessian[row * self.width + column]
    }

    fn sum(&mut self, network: &Network, samples: &Samples, range: Range<usize>) {
        let (n, width) = (self.gradient.len(), self.width);
        self.hessian.fill(0.0);
        self.gradient.fill(0.0);
        self.cost = 0.0;
        let mut pass = network.pass();
        let mut derivatives = vec![[0.0; SIDE_BY_SIDE]; n];
        // What is beyond the parameters stays zero.
        let mut rows = vec![0.0; ROWS * width];
        let level = Level::new();
        let mut filled = 0;
        for first in range.clone().step_by(SIDE_BY_SIDE) {
            let residuals = residuals(network, samples, first, &mut pass);
            network.backward(&mut pass, &[[1.0; SIDE_BY_SIDE]], &mut derivatives);
            for (lane, residual) in residuals.into_iter().enumerate().take(range.end - first) {
                let row = &mut rows[filled * width..][..n];
                for ((entry, sum), derivative) in row.iter_mut().zip(&mut self.gradient).zip(&derivatives) {
                    *entry = derivative[lane];
                    *sum += residual * derivative[lane];
                }
                self.cost += 0.5 * residual * residual;
                filled += 1;
            }
            if filled == ROWS || first + SIDE_BY_SIDE >= range.end {
                let rows = &rows[..filled * width];
                dispatch!(level, simd => add_products(simd, &mut self.hessian, rows, width));
                filled = 0;
            }
        }
    }
}

/// Output less target of as many samples as fit side by side, from `first` on; the last ones stand for those that are
/// missing.
fn residuals(network: &Network, samples: &Samples, first: usize, pass: &mut Pass<SIDE_BY_SIDE>) -> [f64; SIDE_BY_SIDE] {
    let at: [usize; SIDE_BY_SIDE] = std::array::from_fn(|lane| (first + lane).min(samples.len() - 1));
    let inputs: [[f64; SIDE_BY_SIDE]; 3] = std::array::from_fn(|input| at.map(|index| samples.inputs[index][input]));
    network.forward(&inputs, pass);
    std::array::from_fn(|lane| pass.outputs()[0][lane] - samples.targets[at[lane]])
}

/// Sums block by block, in room that is kept from one epoch to the next.
#[derive(Debug, Clone, Default)]
pub(crate) struct NormalEquations {
    /// The first ends up with all of them.
    blocks: Vec<Sums>,
}

impl NormalEquations {
    /// Sums over all samples, the residual being output less target.
    pub(crate) fn sum(&mut self, network: &Network, samples: &Samples) {
        let n = network.parameters().len();
        let ranges = blocks(samples.len());
        self.blocks.resize_with(ranges.len().max(1), || Sums::zero(n));
        self.blocks.par_iter_mut().zip(ranges).for_each(|(block, range)| block.sum(network, samples, range));
        if let Some((all, others)) = self.blocks.split_first_mut() {
            for block in others {
                add(&mut all.hessian, &block.hessian);
                add(&mut all.gradient, &block.gradient);
                all.cost += block.cost;
            }
        }
    }

    /// What the last [`sum`](Self::sum) found.
    pub(crate) fn all(&self) -> &Sums {
        &self.blocks[0]
    }
}

fn add(sum: &mut [f64], terms: &[f64]) {
    for (sum, term) in sum.iter_mut().zip(terms) {
        *sum += term;
    }
}

/// Adds the products of `rows`, each of length `width`, with themselves to the upper triangle of `hessian`.
#[inline(always)]
fn add_products<S: Simd>(simd: S, hessian: &mut [f64], rows: &[f64], width: usize) {
    let lanes = S::f64s::LEN;
    let across = TILE.1 * lanes;
    for top in (0..width).step_by(TILE.0) {
        for left in (top / across * across..width).step_by(across) {
            let mut tile = [[S::f64s::splat(simd, 0.0); TILE.1]; TILE.0];
            for row in rows.chunks_exact(width) {
                let terms: [S::f64s; TILE.1] =
                    std::array::from_fn(|part| S::f64s::from_slice(simd, &row[left + part * lanes..][..lanes]));
                let Some(&factors) = row[top..].first_chunk() else { break };
                add_product(&mut tile, factors, terms);
            }
            for (line, terms) in hessian[top * width..].chunks_mut(width).zip(tile) {
                for (sums, term) in line[left..left + across].chunks_exact_mut(lanes).zip(terms) {
                    (S::f64s::from_slice(simd, sums) + term).store_slice(sums);
                }
            }
        }
    }
}

/// Adds the products of `factors` and `terms` to a tile, nothing fused.
#[inline(always)]
fn add_product<V: Copy + AddAssign + Mul<f64, Output = V>>(
    tile: &mut [[V; TILE.1]; TILE.0],
    factors: [f64; TILE.0],
    terms: [V; TILE.1],
) {
    for (line, factor) in tile.iter_mut().zip(factors) {
        for (sum, term) in line.iter_mut().zip(terms) {
            *sum += term * factor;
        }
    }
}

/// `½ Σ r²` over all samples.
pub(crate) fn cost(network: &Network, samples: &Samples) -> f64 {
    let blocks: Vec<f64> = blocks(samples.len())
        .into_par_iter()
        .map(|block| {
            let mut pass = network.pass();
            let mut sum = 0.0;
            for first in block.clone().step_by(SIDE_BY_SIDE) {
                for residual in residuals(network, samples, first, &mut pass).into_iter().take(block.end - first) {
                    sum += 0.5 * residual * residual;
                }
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
    use pam_artifact::inverse::Activation;

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
        let mut equations = NormalEquations::default();
        equations.sum(&network, &samples);
        // Nothing is left of what was summed before.
        equations.sum(&network, &samples);
        let sums = equations.all();
        let n = network.parameters().len();
        let (mut hessian, mut gradient, mut total) = (vec![0.0; n * n], vec![0.0; n], 0.0);
        let mut pass = network.pass();
        let mut row = vec![[0.0]; n];
        for (inputs, target) in samples.inputs.iter().zip(&samples.targets) {
            network.forward(&inputs.map(|input| [input]), &mut pass);
            let residual = pass.outputs()[0][0] - target;
            network.backward(&mut pass, &[[1.0]], &mut row);
            let row = row.as_flattened();
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
                assert!((sums.hessian(i, j) - hessian[i * n + j]).abs() < 1e-9);
            }
        }
        assert!((sums.cost - total).abs() < 1e-9);
        assert!((cost(&network, &samples) - total).abs() < 1e-9);
    }
}
