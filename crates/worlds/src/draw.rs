//! Random draws: one seeded generator, with the distributions that worlds are drawn from.

use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

/// A seeded generator.
#[derive(Debug, Clone)]
pub struct Dice {
    generator: Pcg64,
}

impl Dice {
    /// Generator for one purpose: equal `(seed, stream)` give equal draws, whatever else is drawn.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mixed = (seed ^ 0x9e37_79b9_7f4a_7c15).wrapping_mul(0xbf58_476d_1ce4_e5b9)
            ^ stream.wrapping_mul(0x94d0_49bb_1331_11eb);
        let mut generator = Pcg64::seed_from_u64(mixed ^ (mixed >> 29));
        let _: u64 = generator.random();
        Self { generator }
    }

    /// Another generator, whose draws do not move those of this one beyond a single step.
    pub fn fork(&mut self) -> Self {
        let seed = self.generator.random::<u64>();
        Self::new(seed, 1)
    }

    /// Uniform in `[from, to)`.
    pub fn uniform(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.generator.random::<f64>()
    }

    /// Uniform in the logarithm, between two positive bounds.
    pub fn log_uniform(&mut self, from: f64, to: f64) -> f64 {
        self.uniform(from.ln(), to.ln()).exp()
    }

    /// Normal with mean 0 and deviation 1.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.generator)
    }

    /// True with the given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.uniform(0.0, 1.0) < probability
    }

    /// −1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// Whole number in `from..=to`.
    pub fn between(&mut self, from: usize, to: usize) -> usize {
        self.generator.random_range(from..=to)
    }

    /// One of several, all as likely.
    pub fn pick<'a, T>(&mut self, choices: &'a [T]) -> &'a T {
        &choices[self.between(0, choices.len() - 1)]
    }

    /// Index of one of several, by weight.
    pub fn weighted(&mut self, weights: &[f64]) -> usize {
        let mut left = self.uniform(0.0, weights.iter().sum());
        for (index, &weight) in weights.iter().enumerate() {
            if left < weight {
                return index;
            }
            left -= weight;
        }
        weights.len() - 1
    }

    /// Order drawn at random (Fisher and Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.between(0, last));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_seeds_draw_equal_numbers_and_other_streams_other_numbers() {
        let (mut first, mut again, mut other) = (Dice::new(3, 1), Dice::new(3, 1), Dice::new(3, 2));
        let drawn = first.uniform(0.0, 1.0);
        assert_eq!(drawn.to_bits(), again.uniform(0.0, 1.0).to_bits());
        assert_ne!(drawn.to_bits(), other.uniform(0.0, 1.0).to_bits());
    }

    #[test]
    fn weights_are_kept() {
        let mut dice = Dice::new(1, 1);
        let heavy = (0..1000).filter(|_| dice.weighted(&[1.0, 9.0]) == 1).count();
        assert!((850..950).contains(&heavy), "{heavy}");
    }
}
