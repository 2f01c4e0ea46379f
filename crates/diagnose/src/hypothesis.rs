//! A hypothesis: the base model and some effects with their shapes.

use pam_core::effects::{Amplitude, Effect, Role};

/// An effect with values for its shape.
#[derive(Clone)]
pub struct CandidateEffect {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// Values of its shape parameters, SI.
    pub shape: Vec<f64>,
    /// Which sign its amplitudes may have.
    pub sign: Sign,
    /// Whether every recording begins with a memory of its own, of what went before; else with none.
    pub carried: bool,
}

/// Which sign the amplitudes of an effect may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sign {
    /// Any that the page allows.
    Any,
    /// None below zero.
    Positive,
    /// None above zero.
    Negative,
}

impl CandidateEffect {
    /// Catalogue id.
    pub fn id(&self) -> &'static str {
        self.effect.page().id
    }

    /// Whether it adds columns and leaves those of eq. 11 as they are.
    pub fn only_adds(&self) -> bool {
        self.effect.role() == Role::Pulls
    }

    /// Every sign that `effect` has to be tried with.
    pub fn signs(effect: &dyn Effect) -> &'static [Sign] {
        if effect.has_one_sign() { &[Sign::Positive, Sign::Negative] } else { &[Sign::Any] }
    }

    /// Every beginning that `effect` has to be tried with.
    pub fn beginnings(effect: &dyn Effect) -> &'static [bool] {
        if effect.outlasts() { &[false, true] } else { &[false] }
    }

    /// Ranges of its amplitudes.
    pub fn ranges(&self) -> impl Iterator<Item = (f64, f64)> {
        self.amplitudes().iter().map(|amplitude| match self.sign {
            Sign::Any => amplitude.range,
            Sign::Positive => (0.0, amplitude.range.1),
            Sign::Negative => (amplitude.range.0, 0.0),
        })
    }

    /// Parameters in which it is linear.
    pub fn amplitudes(&self) -> &'static [Amplitude] {
        self.effect.amplitudes()
    }
}

impl std::fmt::Debug for CandidateEffect {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("CandidateEffect").field("id", &self.id()).field("shape", &self.shape).finish()
    }
}

/// Amplitudes of several guesses together.
pub fn n_amplitudes(guesses: &[CandidateEffect]) -> usize {
    guesses.iter().map(|guess| guess.amplitudes().len()).sum()
}

/// Ranges of the amplitudes of several guesses, in order.
pub fn ranges(guesses: &[CandidateEffect]) -> Vec<(f64, f64)> {
    guesses.iter().flat_map(CandidateEffect::ranges).collect()
}
