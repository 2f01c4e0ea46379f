//! A hypothesis: the base model and some effects with their shapes.

use pam_core::effects::{Amplitude, Effect, Role};

/// An effect with values for its shape.
#[derive(Clone)]
pub struct Guess {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// Values of its shape parameters, SI.
    pub shape: Vec<f64>,
}

impl Guess {
    /// Catalogue id.
    pub fn id(&self) -> &'static str {
        self.effect.page().id
    }

    /// Whether it adds columns and leaves those of eq. 11 as they are.
    pub fn only_adds(&self) -> bool {
        self.effect.role() == Role::Pulls
    }

    /// Parameters in which it is linear.
    pub fn amplitudes(&self) -> &'static [Amplitude] {
        self.effect.amplitudes()
    }
}

impl std::fmt::Debug for Guess {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Guess").field("id", &self.id()).field("shape", &self.shape).finish()
    }
}

/// Amplitudes of several guesses together.
pub fn n_amplitudes(guesses: &[Guess]) -> usize {
    guesses.iter().map(|guess| guess.amplitudes().len()).sum()
}

/// Ranges of the amplitudes of several guesses, in order.
pub fn ranges(guesses: &[Guess]) -> Vec<(f64, f64)> {
    guesses.iter().flat_map(|guess| guess.amplitudes()).map(|amplitude| amplitude.range).collect()
}
