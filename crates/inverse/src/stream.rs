//! Named streams of random numbers: what one part draws moves no other part.

use rand::{Rng as _, SeedableRng as _};
use rand_pcg::Pcg64Dxsm;

/// A stream of its own for every use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stream {
    /// Shift of the design points.
    Design,
    /// Which points validate.
    Validation,
    /// Points that the finished network is judged on.
    Evaluation,
    /// First weights of a start.
    Weights(u32),
    /// Order of the samples in the epochs of a start.
    Order(u32),
}

impl Stream {
    /// The generator of this stream: PCG DXSM, whose numbers are the same everywhere.
    pub fn random(self, seed: u64) -> Pcg64Dxsm {
        let (kind, index) = match self {
            Self::Design => (1, 0),
            Self::Validation => (2, 0),
            Self::Evaluation => (3, 0),
            Self::Weights(start) => (4, start),
            Self::Order(start) => (5, start),
        };
        let stream = (kind << 32) | u128::from(index);
        // Streams that share a state resemble one another, so the state differs as well.
        let mut root = Pcg64Dxsm::seed_from_u64(seed);
        let state = (u128::from(root.next_u64()) << 64 | u128::from(root.next_u64()))
            ^ stream.wrapping_mul(0xda94_2042_e4dd_58b5_2360_ed05_1fc6_5da5);
        Pcg64Dxsm::new(state, stream)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_of_one_seed_differ_and_repeat() {
        let first = |stream: Stream| stream.random(1).next_u64();
        assert_eq!(first(Stream::Design), first(Stream::Design));
        assert_ne!(first(Stream::Design), first(Stream::Evaluation));
        assert_ne!(first(Stream::Weights(0)), first(Stream::Weights(1)));
    }
}
