//! Eq. 11 with effects of the catalogue.
//!
//! At every [`Moment`], in this order: every term changes what the muscle sees; the friction of eq. 11 slides as
//! the last term of [`Role::Slides`] says; eq. 11; the pulls, each column times its amplitude; the readings. Terms of
//! one role follow one another in the order of the model. A delay between channels ([`Role::Shift`]) belongs to
//! recordings and does nothing here.

use std::fmt;

use super::{Base, Effect, Kind, Memory, Moment, Role};
use crate::force::ForceModel;

/// Largest disagreement between the force that a settled fixture is stretched by and the force that results,
/// relative to the force.
const TOLERANCE: f64 = 1e-12;
/// Steps towards it; three or four do.
const MAX_STEPS: usize = 50;

/// An effect with values for its parameters.
#[derive(Clone)]
pub struct Term {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// Values of [`Effect::shape`].
    pub shape: Vec<f64>,
    /// Values of [`Effect::amplitudes`].
    pub amplitudes: Vec<f64>,
    /// History of the muscle.
    pub past: Past,
    /// Whether it acts in the recordings alone that the model was fitted to.
    pub only_as_fitted: bool,
}

/// History of a muscle before a recording, as [`Effect::keeps`] lists it; nothing by default.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Past {
    /// Before each of the recordings that a model was fitted to; empty where nothing was, or where that is not known.
    pub began: Vec<Vec<f64>>,
    /// Before any other recording.
    pub after: Vec<f64>,
}

impl Past {
    /// Before recording `index` of those that a model was fitted to, or before others.
    pub fn before(&self, index: usize) -> &[f64] {
        self.began.get(index).unwrap_or(&self.after)
    }
}

impl Term {
    /// `effect` in a muscle that has been through nothing.
    pub fn new(effect: &'static dyn Effect, shape: Vec<f64>, amplitudes: Vec<f64>) -> Self {
        Self { effect, shape, amplitudes, past: Past::default(), only_as_fitted: false }
    }

    /// Whether it acts in other recordings than those that the model was fitted to: events happened once.
    pub fn acts_elsewhere(&self) -> bool {
        self.effect.kind() != Kind::Event && !self.only_as_fitted
    }

    /// Whether it is of the muscle rather than of its instruments and fixture, or of one recording.
    pub fn is_of_the_muscle(&self) -> bool {
        self.effect.kind() == Kind::Muscle
    }
}

impl fmt::Debug for Term {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Term")
            .field("effect", &self.effect.page().id)
            .field("shape", &self.shape)
            .field("amplitudes", &self.amplitudes)
            .finish()
    }
}

/// Eq. 11 and terms beyond it.
#[derive(Debug, Clone)]
pub struct AugmentedModel {
    base: ForceModel,
    terms: Vec<Term>,
    /// Whether any term pulls, and whether one of them needs slopes.
    pulls: bool,
    slopes: bool,
}

/// Memory of the terms.
pub struct AugmentedMemory {
    /// One for each term.
    memories: Vec<Box<dyn Memory>>,
    /// As long as the most amplitudes of a term.
    columns: Vec<f64>,
    /// Whether a reading left nothing of changes of the last force.
    is_cut: bool,
}

impl fmt::Debug for AugmentedMemory {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("AugmentedMemory").field("n_terms", &self.memories.len()).finish_non_exhaustive()
    }
}

impl From<ForceModel> for AugmentedModel {
    /// Eq. 11 and nothing beyond it.
    fn from(base: ForceModel) -> Self {
        Self::new(base, Vec::new())
    }
}

impl AugmentedModel {
    /// `base` with `terms`.
    ///
    /// # Panics
    /// Where a term has more or fewer values than its effect has parameters.
    pub fn new(base: ForceModel, terms: Vec<Term>) -> Self {
        for term in &terms {
            let expected = (term.effect.shape().len(), term.effect.amplitudes().len());
            assert_eq!((term.shape.len(), term.amplitudes.len()), expected, "parameters of {}", term.effect.page().id);
        }
        let pulls = terms.iter().any(|term| term.effect.role() == Role::Pulls);
        let slopes = terms.iter().any(|term| term.effect.uses_slopes());
        Self { base, terms, pulls, slopes }
    }

    /// Eq. 11 alone.
    pub fn base(&self) -> &ForceModel {
        &self.base
    }

    /// Whether nothing comes on top of it.
    pub fn is_plain(&self) -> bool {
        self.terms.is_empty()
    }

    /// The same terms on top of another eq. 11.
    pub fn on(&self, base: ForceModel) -> Self {
        Self { base, ..self.clone() }
    }

    /// Force added to it.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// A memory at the beginning of a simulation, or of a recording that the model was not fitted to.
    pub fn start(&self) -> AugmentedMemory {
        self.start_after(|past| &past.after)
    }

    /// A memory at the beginning of recording `index` of those that the model was fitted to.
    pub fn start_in(&self, index: usize) -> AugmentedMemory {
        self.start_after(|past| past.before(index))
    }

    fn start_after(&self, past: impl Fn(&Past) -> &[f64]) -> AugmentedMemory {
        let muscle = self.base.muscle();
        let n_columns = self.terms.iter().map(|term| term.amplitudes.len()).max().unwrap_or(0);
        let begun = |term: &Term| {
            let mut memory = term.effect.start(muscle, &term.shape);
            memory.go_on(past(&term.past));
            memory
        };
        AugmentedMemory {
            memories: self.terms.iter().map(begun).collect(),
            columns: vec![0.0; n_columns],
            is_cut: false,
        }
    }

    /// Force, in N, where the muscle has long been and where it came slowly in `direction` (+1 contracting, -1
    /// extending, 0 neither).
    pub fn settled_force_n(&self, pressure_pa: f64, length_m: f64, direction: f64) -> f64 {
        if self.is_plain() {
            return self.base.force_n(pressure_pa, length_m, direction);
        }
        let settled = Moment::settled(self.base.muscle(), pressure_pa, length_m, direction);
        let result_n = |force_n| self.start().force_n(self, Moment { force_n, ..settled });
        if !self.terms.iter().any(|term| term.effect.role() == Role::Sees) {
            return result_n(0.0);
        }
        // What the muscle sees may depend on the force: a secant towards the force that results in itself.
        let (mut before_n, mut excess_before_n) = (0.0, result_n(0.0));
        let mut force_n = excess_before_n;
        for _ in 0..MAX_STEPS {
            let excess_n = result_n(force_n) - force_n;
            let slope = (excess_n - excess_before_n) / (force_n - before_n);
            // Not a number where the force itself is none, or the same twice.
            if excess_n.abs() <= TOLERANCE * force_n.abs() || !slope.is_finite() || slope == 0.0 {
                return force_n + excess_n;
            }
            (before_n, excess_before_n) = (force_n, excess_n);
            force_n -= excess_n / slope;
        }
        force_n
    }

    /// By how much the channels of pressure and length are late behind the force, in s.
    pub fn delays_s(&self) -> [f64; 2] {
        let delays = self.terms.iter().map(|term| term.effect.delays_s(&term.shape));
        delays.fold([0.0; 2], |sum, delays| [sum[0] + delays[0], sum[1] + delays[1]])
    }

    /// The same muscle without instruments, fixture, events and what acts in the fitted recordings alone.
    pub fn of_the_muscle(&self) -> Self {
        self.with(|term| term.is_of_the_muscle() && term.acts_elsewhere())
    }

    /// Ids of instruments, fixture and events.
    pub fn beside_the_muscle(&self) -> Vec<&'static str> {
        self.without(Term::is_of_the_muscle)
    }

    /// The same for other recordings than those it was fitted to: without what acts in these alone, and after all that the muscle was
    /// through in them.
    pub fn elsewhere(&self) -> Self {
        let mut other = self.with(Term::acts_elsewhere);
        other.terms.iter_mut().for_each(|term| term.past.began.clear());
        other
    }

    /// Lets term `index` act in the recordings alone that the model was fitted to.
    ///
    /// # Panics
    /// Where there is no such term.
    pub fn keep_to_fitted(&mut self, index: usize) {
        self.terms[index].only_as_fitted = true;
    }

    /// Ids of what [`elsewhere`](Self::elsewhere) leaves out.
    pub fn not_elsewhere(&self) -> Vec<&'static str> {
        self.without(Term::acts_elsewhere)
    }

    fn with(&self, wanted: impl Fn(&Term) -> bool) -> Self {
        let terms = self.terms.iter().filter(|term| wanted(term)).cloned().collect();
        Self::new(self.base.clone(), terms)
    }

    fn without(&self, wanted: impl Fn(&Term) -> bool) -> Vec<&'static str> {
        self.terms.iter().filter(|term| !wanted(term)).map(|term| term.effect.page().id).collect()
    }
}

impl AugmentedMemory {
    /// Force, in N, as the load cell reads it; `model` is the one that the memory was started from.
    pub fn force_n(&mut self, model: &AugmentedModel, mut now: Moment) -> f64 {
        let recorded = now;
        for memory in &mut self.memories {
            memory.sees(&mut now);
        }
        let mut slide = now.direction;
        for (term, memory) in model.terms.iter().zip(&mut self.memories) {
            if term.effect.role() == Role::Slides {
                slide = memory.slides(&now);
            }
        }
        let terms = model.base.terms(now.pressure_pa, now.length_m, slide);
        let (mut force_n, mut event_n) = (terms.force_n(), 0.0);
        if model.pulls {
            let base = if model.slopes {
                Base::of(&model.base, now.pressure_pa, now.length_m)
            } else {
                Base::from_terms(&model.base, now.pressure_pa, now.length_m, &terms)
            };
            for (term, memory) in model.terms.iter().zip(&mut self.memories) {
                let columns = &mut self.columns[..term.amplitudes.len()];
                if !columns.is_empty() {
                    let as_recorded = term.effect.pulls_as_recorded();
                    memory.pulls(if as_recorded { &recorded } else { &now }, &base, columns);
                    let pull_n =
                        columns.iter().zip(&term.amplitudes).map(|(column, value)| column * value).sum::<f64>();
                    // A cell that was knocked reads more of a slack muscle as well.
                    *(if term.effect.kind() == Kind::Event { &mut event_n } else { &mut force_n }) += pull_n;
                }
            }
        }
        self.is_cut = false;
        for memory in &mut self.memories {
            self.is_cut |= memory.cuts(force_n);
            force_n = memory.reads(force_n);
        }
        force_n + event_n
    }

    /// Whether the last force was cut: a reading leaves nothing of changes of it.
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }
}

#[cfg(test)]
mod tests;
