//! A hypothesis: the base model and some effects with their shapes.

use std::sync::Arc;

use pam_muscle::Muscle;
use pam_muscle::effects::{Amplitude, Base, Effect, Kind, Memory, Past, Role};

use crate::track::Track;

/// An effect with values for its shape.
#[derive(Clone)]
pub struct CandidateEffect {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// Values of its shape parameters, SI.
    pub shape: Vec<f64>,
    /// Which sign its amplitudes may have.
    pub sign: Sign,
    /// What its memory begins every recording with.
    pub beginning: Beginning,
}

/// What the memory of an effect begins a recording with.
#[derive(Debug, Clone, PartialEq)]
pub enum Beginning {
    /// Nothing: the muscle was fresh.
    Fresh,
    /// Something of its own in every recording, which the fit tells.
    Own,
    /// What the recordings before it have left for good: they were made one after the other, as they are given.
    GoesOn(Arc<Past>),
}

impl Beginning {
    /// What of the past is known.
    pub fn past(&self) -> Past {
        match self {
            Self::GoesOn(past) => Past::clone(past),
            Self::Fresh | Self::Own => Past::default(),
        }
    }

    /// Whether recordings of `track` would tell that of an event in recording `index`: one that goes on after the last is told by none.
    pub(crate) fn is_told(&self, index: usize, track: &Track) -> bool {
        !matches!(self, Self::GoesOn(_)) || index + 1 < track.recordings.len()
    }
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
    pub fn beginnings(effect: &dyn Effect, track: &Track, muscle: &Muscle) -> Vec<Beginning> {
        let own = effect.outlasts().then_some(Beginning::Own);
        let goes_on = effect.is_permanent().then(|| Beginning::GoesOn(Arc::new(past(effect, track, muscle))));
        // In a single recording both are the same, and others are made after it; an event may have been put right by then.
        let is_event = effect.kind() == Kind::Event;
        let fresh = (goes_on.is_none() || is_event || track.recordings.len() > 1).then_some(Beginning::Fresh);
        fresh.into_iter().chain(own).chain(goes_on).collect()
    }

    /// Whether every recording begins with something of its own.
    pub fn has_own_beginnings(&self) -> bool {
        self.beginning == Beginning::Own
    }

    /// Its memory at the beginning of recording `index`.
    pub fn start_in(&self, index: usize, muscle: &Muscle) -> Box<dyn Memory> {
        let mut memory = self.effect.start(muscle, &self.shape);
        if let Beginning::GoesOn(past) = &self.beginning {
            memory.go_on(past.before(index));
        }
        memory
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

/// What the recordings of `track`, one after the other, do to `muscle` for good.
fn past(effect: &dyn Effect, track: &Track, muscle: &Muscle) -> Past {
    let shape: Vec<f64> = effect.shape().iter().map(|parameter| parameter.grid[0]).collect();
    let mut unused = vec![0.0; effect.amplitudes().len()];
    let mut past = Past { began: Vec::new(), after: effect.keeps().iter().map(|kept| kept.fresh).collect() };
    for range in &track.recordings {
        let mut memory = effect.start(muscle, &shape);
        memory.go_on(&past.after);
        for instant in &track.instants[range.clone()] {
            memory.pulls(&instant.moment, &Base::default(), &mut unused);
        }
        past.began.push(std::mem::replace(&mut past.after, memory.past()));
    }
    past
}

/// Effects among `guesses`, each once however often it happened.
pub(crate) fn n_effects(guesses: &[CandidateEffect]) -> usize {
    let is_first = |index: &usize| guesses[..*index].iter().all(|before| before.id() != guesses[*index].id());
    (0..guesses.len()).filter(is_first).count()
}

/// Amplitudes of several guesses together.
pub fn n_amplitudes(guesses: &[CandidateEffect]) -> usize {
    guesses.iter().map(|guess| guess.amplitudes().len()).sum()
}

/// Ranges of the amplitudes of several guesses, in order.
pub fn ranges(guesses: &[CandidateEffect]) -> Vec<(f64, f64)> {
    guesses.iter().flat_map(CandidateEffect::ranges).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    use pam_muscle::effects::effect;

    fn past_of(given: &Given, id: &str) -> Past {
        past(effect(id).expect("an id"), &given.track, &given.muscle)
    }

    #[test]
    fn what_one_recording_wears_the_next_begins_with() {
        let [one, two] = [&["isobaric-triangles"][..], &["isobaric-triangles", "isobaric-triangles"][..]];
        let (once, twice) =
            (past_of(&Given::of(one, &[]), "fatigue-wear"), past_of(&Given::of(two, &[]), "fatigue-wear"));
        assert_eq!((once.began[0][0], twice.began.len() % 2), (0.0, 0));
        let half = twice.began.len() / 2;
        assert!(once.after[0] > 0.05 && (twice.began[half][0] - once.after[0]).abs() < 1e-12);
        assert!((twice.after[0] - 2.0 * once.after[0]).abs() < 1e-9);
    }

    #[test]
    fn only_what_is_permanent_goes_on_and_a_single_recording_has_nothing_before_it() {
        let given = Given::of(&["isobaric-triangles", "multisine"], &[]);
        let beginnings = |id: &str, given: &Given| {
            CandidateEffect::beginnings(effect(id).expect("an id"), &given.track, &given.muscle)
        };
        assert!(matches!(
            beginnings("mullins-softening", &given)[..],
            [Beginning::Fresh, Beginning::Own, Beginning::GoesOn(_)]
        ));
        assert_eq!(beginnings("thermal-softening", &given), [Beginning::Fresh, Beginning::Own]);
        assert_eq!(beginnings("pressure-lag", &given), [Beginning::Fresh]);
    }
}
