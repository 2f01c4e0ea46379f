//! Paired block bootstrap of two series of errors.
//!
//! ```text
//! d_t = e_b,t² - e_a,t²,   Δ = √mean(e_b²) - √mean(e_a²)
//! ```
//!
//! A resample of a recording is made of blocks of `L` samples in a row, drawn with replacement from all of them (moving
//! blocks), until it is as long; recordings are resampled each by itself. `L` is twice the lag at which the autocorrelation
//! of `d` has died away for good: the rule of Politis and White (2004), "Automatic block-length selection for the dependent
//! bootstrap", Econometric Reviews 23(1), for the lag.
//!
//! `Δ` is given an interval by the percentiles of its resamples; the p-value is two-sided, from how the resampled means of
//! `d` lie about their own mean. Both are widened by `√(n / (n - 1))` for `n` blocks that do not overlap.

use pam_artifact::comparison::Difference;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use rayon::prelude::*;

/// Fewest blocks, all recordings together, from which a chance can be told.
pub const FEWEST_BLOCKS: usize = 10;
/// Blocks that a recording is parted into at least.
const FEWEST_OF_ONE: usize = 4;
/// Autocorrelation that counts as none, at least.
const NEGLIGIBLE: f64 = 0.05;
/// Lags in a row without autocorrelation after which it has died away.
const IN_A_ROW: usize = 5;
/// Ratio of lags that are looked at, where they are long.
const LAG_RATIO: f64 = 1.1;

/// Errors of two models over the same samples of one recording.
#[derive(Debug, Clone, Default)]
pub struct Errors {
    /// Residual of model a, in N.
    pub a_n: Vec<f64>,
    /// Residual of model b, in N.
    pub b_n: Vec<f64>,
    /// Time between samples, in s.
    pub period_s: f64,
}

/// How to resample.
#[derive(Debug, Clone, Copy)]
pub struct Resampling {
    /// Resamples.
    pub n: usize,
    /// Level of the interval.
    pub level: f64,
    /// Seed.
    pub seed: u64,
}

/// Squared errors of both models summed up from the first sample on, and the length of a block.
struct Summed {
    a: Vec<f64>,
    b: Vec<f64>,
    block: usize,
    /// Blocks that tell something on their own: one, where the autocorrelation does not die away within the recording.
    n_blocks: usize,
}

impl Summed {
    fn of(errors: &Errors) -> Self {
        let sums = |residuals: &[f64]| {
            let mut sum = 0.0;
            std::iter::once(0.0)
                .chain(residuals.iter().map(|residual| {
                    sum += residual * residual;
                    sum
                }))
                .collect()
        };
        let (block, died_away) = block_length(errors);
        let n_blocks = if died_away { errors.a_n.len() / block.max(1) } else { 1 };
        Self { a: sums(&errors.a_n), b: sums(&errors.b_n), block, n_blocks }
    }

    fn n(&self) -> usize {
        self.a.len() - 1
    }

    /// Samples that count as one independent block.
    fn independent(&self) -> usize {
        if self.n_blocks > 1 { self.block } else { self.n() }
    }

    /// Sums over a resample.
    fn draw(&self, generator: &mut Pcg64) -> [f64; 2] {
        let mut sums = [0.0; 2];
        let mut left = self.n();
        while left > 0 {
            let take = self.block.min(left);
            let from = generator.random_range(0..=self.n() - take);
            sums[0] += self.a[from + take] - self.a[from];
            sums[1] += self.b[from + take] - self.b[from];
            left -= take;
        }
        sums
    }

    fn sums(&self) -> [f64; 2] {
        [self.a[self.n()], self.b[self.n()]]
    }
}

/// Samples of a block, twice the lag at which the difference of squared errors is no longer like itself; and whether there is
/// such a lag.
fn block_length(errors: &Errors) -> (usize, bool) {
    let differences: Vec<f64> = errors.a_n.iter().zip(&errors.b_n).map(|(a, b)| b * b - a * a).collect();
    let n = differences.len();
    if n < 2 * FEWEST_OF_ONE {
        return (n, false);
    }
    let mean = differences.iter().sum::<f64>() / n as f64;
    let variance = differences.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n as f64;
    let longest = n / FEWEST_OF_ONE;
    let chance = 2.0 * ((n as f64).log10() / n as f64).sqrt();
    let (mut lag, mut died, mut quiet) = (1, 1, 0);
    while variance > 0.0 && lag < longest && quiet < IN_A_ROW {
        let products: f64 =
            differences.iter().zip(&differences[lag..]).map(|(left, right)| (left - mean) * (right - mean)).sum();
        if (products / n as f64 / variance).abs() < chance.max(NEGLIGIBLE) {
            quiet += 1;
        } else {
            quiet = 0;
            died = lag + 1;
        }
        lag = (lag + 1).max((LAG_RATIO * lag as f64) as usize);
    }
    ((2 * died).min(longest).max(1), variance == 0.0 || (quiet == IN_A_ROW && 2 * died <= longest))
}

/// Compares two models over the samples of all `recordings`.
pub fn difference(recordings: &[Errors], resampling: Resampling) -> Difference {
    let summed: Vec<Summed> = recordings.iter().filter(|errors| !errors.a_n.is_empty()).map(Summed::of).collect();
    let n_samples: usize = summed.iter().map(Summed::n).sum();
    let n = n_samples.max(1) as f64;
    let total =
        |sums: &mut dyn Iterator<Item = [f64; 2]>| sums.fold([0.0; 2], |[a, b], more| [a + more[0], b + more[1]]);
    let [a, b] = total(&mut summed.iter().map(Summed::sums)).map(|sum| sum / n);
    let [rmse_a_n, rmse_b_n] = [a, b].map(f64::sqrt);
    let difference_n = rmse_b_n - rmse_a_n;
    let n_blocks: usize = summed.iter().map(|summed| summed.n_blocks).sum();
    let lengths = recordings.iter().filter(|errors| !errors.a_n.is_empty()).zip(&summed);
    let block_s = lengths.map(|(errors, summed)| errors.period_s * summed.independent() as f64).fold(0.0, f64::max);
    let untold =
        Difference { n_samples, rmse_a_n, rmse_b_n, difference_n, interval_n: None, p_value: None, n_blocks, block_s };
    if n_blocks < FEWEST_BLOCKS {
        return untold;
    }
    // Each resample has a stream of its own, so that no number of threads changes a bit.
    let drawn: Vec<[f64; 2]> = (0..resampling.n)
        .into_par_iter()
        .map(|index| {
            let mut generator = Pcg64::seed_from_u64(resampling.seed ^ ((index as u64 + 1) << 20));
            total(&mut summed.iter().map(|summed| summed.draw(&mut generator))).map(|sum| sum / n)
        })
        .collect();
    let widened = (n_blocks as f64 / (n_blocks as f64 - 1.0)).sqrt();
    let mean = drawn.iter().map(|[a, b]| b - a).sum::<f64>() / drawn.len().max(1) as f64;
    let beyond = drawn.iter().filter(|[a_star, b_star]| widened * (b_star - a_star - mean).abs() >= (b - a).abs());
    let p_value = (beyond.count() as f64 + 1.0) / (drawn.len() as f64 + 1.0);
    let mut differences: Vec<f64> = drawn.iter().map(|[a, b]| b.sqrt() - a.sqrt()).collect();
    differences.sort_unstable_by(f64::total_cmp);
    let center = differences.get(differences.len() / 2).copied().unwrap_or(difference_n);
    let quantile = |share: f64| {
        let at = (share * (differences.len() - 1) as f64).round() as usize;
        difference_n + widened * (differences[at] - center)
    };
    let tail = (1.0 - resampling.level) / 2.0;
    Difference { interval_n: Some([quantile(tail), quantile(1.0 - tail)]), p_value: Some(p_value), ..untold }
}

#[cfg(test)]
mod tests {
    use rand_distr::{Distribution as _, StandardNormal};

    use super::*;

    const RESAMPLING: Resampling = Resampling { n: 500, level: 0.95, seed: 1 };

    /// Noise whose neighbors are alike by `rho`, of variance 1.
    fn noise(n: usize, rho: f64, seed: u64) -> Vec<f64> {
        let mut generator = Pcg64::seed_from_u64(seed);
        let mut value = 0.0;
        (0..n)
            .map(|_| {
                let fresh: f64 = StandardNormal.sample(&mut generator);
                value = rho * value + (1.0 - rho * rho).sqrt() * fresh;
                value
            })
            .collect()
    }

    fn errors(rho: f64, seed: u64, bias: f64) -> Errors {
        let [common, a, b] = [0, 1, 2].map(|index| noise(4000, rho, 3 * seed + index));
        let with = |own: &[f64], bias: f64| -> Vec<f64> {
            common.iter().zip(own).map(|(common, own)| common + 0.5 * own + bias).collect()
        };
        Errors { a_n: with(&a, bias), b_n: with(&b, 0.0), period_s: 0.01 }
    }

    #[test]
    fn equal_models_differ_beyond_chance_as_often_as_chance_has_it() {
        for (rho, most) in [(0.0, 0.09), (0.9, 0.09), (0.98, 0.11)] {
            let found = (0..300)
                .filter(|&seed| difference(&[errors(rho, seed, 0.0)], RESAMPLING).p_value.is_some_and(|p| p < 0.05))
                .count();
            // 0.05 is asked for; 300 draws of it are within 0.05 ± 0.038 (three deviations), few blocks are a little worse.
            assert!(found as f64 / 300.0 <= most, "autocorrelation {rho}: {found} of 300");
        }
    }

    #[test]
    fn a_block_is_longer_than_the_autocorrelation() {
        let white = Summed::of(&errors(0.0, 1, 0.0)).block;
        let colored = Summed::of(&errors(0.98, 1, 0.0)).block;
        // The square of an autoregression of 0.98 has 0.96 from sample to sample: a twentieth is left after 74.
        assert!(white <= 4 && colored > 74, "{white} and {colored}");
    }

    #[test]
    fn a_model_that_is_worse_is_found_with_its_interval() {
        let found = difference(&[errors(0.9, 7, 0.5), errors(0.9, 8, 0.5)], RESAMPLING);
        let [low, high] = found.interval_n.unwrap();
        assert!(found.p_value.unwrap() < 0.01 && high < 0.0, "{found:?}");
        // √1.25 against √1.5 N.
        assert!(low < -0.107 && -0.107 < high + 0.05, "{found:?}");
        assert_eq!(found, difference(&[errors(0.9, 7, 0.5), errors(0.9, 8, 0.5)], RESAMPLING));
    }

    #[test]
    fn a_recording_whose_errors_stay_alike_is_one_block_as_long_as_it_lasts() {
        // A drift from end to end: the autocorrelation reaches as far.
        let a_n: Vec<f64> = (0..4000).map(|index| 0.01 * f64::from(index)).collect();
        let found = difference(&[Errors { b_n: vec![0.0; a_n.len()], a_n, period_s: 0.01 }], RESAMPLING);
        assert_eq!((found.n_blocks, found.block_s, found.p_value), (1, 40.0, None));
    }

    #[test]
    fn too_few_blocks_say_nothing() {
        let mut short = errors(0.98, 1, 1.0);
        short.a_n.truncate(200);
        short.b_n.truncate(200);
        let found = difference(&[short], RESAMPLING);
        assert_eq!((found.p_value, found.interval_n), (None, None));
        assert!(difference(&[], RESAMPLING).p_value.is_none());
    }
}
