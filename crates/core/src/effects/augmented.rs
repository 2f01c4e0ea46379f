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

/// What the terms remember.
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

    /// What comes on top of it.
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// A memory at the beginning of a recording or a simulation.
    pub fn start(&self) -> AugmentedMemory {
        let muscle = self.base.muscle();
        let n_columns = self.terms.iter().map(|term| term.amplitudes.len()).max().unwrap_or(0);
        AugmentedMemory {
            memories: self.terms.iter().map(|term| term.effect.start(muscle, &term.shape)).collect(),
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

    /// The same muscle without instruments, fixture and events.
    pub fn of_the_muscle(&self) -> Self {
        self.with(|kind| kind == Kind::Muscle)
    }

    /// Ids of what [`of_the_muscle`](Self::of_the_muscle) leaves out.
    pub fn beside_the_muscle(&self) -> Vec<&'static str> {
        let beside = self.terms.iter().filter(|term| term.effect.kind() != Kind::Muscle);
        beside.map(|term| term.effect.page().id).collect()
    }

    /// The same without events, which happened once and in no other recording.
    pub fn without_events(&self) -> Self {
        self.with(|kind| kind != Kind::Event)
    }

    fn with(&self, wanted: impl Fn(Kind) -> bool) -> Self {
        let terms = self.terms.iter().filter(|term| wanted(term.effect.kind())).cloned().collect();
        Self::new(self.base.clone(), terms)
    }
}

impl AugmentedMemory {
    /// Force, in N, as the load cell reads it; `model` is the one that the memory was started from.
    pub fn force_n(&mut self, model: &AugmentedModel, mut now: Moment) -> f64 {
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
        let mut force_n = terms.force_n();
        if model.pulls {
            let base = if model.slopes {
                Base::of(&model.base, now.pressure_pa, now.length_m)
            } else {
                Base::from_terms(&model.base, now.pressure_pa, now.length_m, &terms)
            };
            for (term, memory) in model.terms.iter().zip(&mut self.memories) {
                let columns = &mut self.columns[..term.amplitudes.len()];
                if !columns.is_empty() {
                    memory.pulls(&now, &base, columns);
                    force_n += columns.iter().zip(&term.amplitudes).map(|(column, value)| column * value).sum::<f64>();
                }
            }
        }
        self.is_cut = false;
        for memory in &mut self.memories {
            self.is_cut |= memory.cuts(force_n);
            force_n = memory.reads(force_n);
        }
        force_n
    }

    /// Whether the last force was cut: a reading leaves nothing of changes of it.
    pub fn is_cut(&self) -> bool {
        self.is_cut
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CATALOGUE, effect};
    use super::*;
    use crate::force::{BaseParameters, Form};
    use crate::muscle::tests::nominal;

    fn base() -> ForceModel {
        let parameters = BaseParameters { theta: [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.3] };
        ForceModel::new(&nominal(), 3e9, Form::Corrected, parameters)
    }

    fn term(id: &str, shape: &[f64], amplitudes: &[f64]) -> Term {
        Term { effect: effect(id).expect("an id"), shape: shape.to_vec(), amplitudes: amplitudes.to_vec() }
    }

    /// A stroke of 30 mm there and back at changing pressure.
    fn path() -> Vec<Moment> {
        let muscle = nominal();
        (0..400)
            .map(|index| {
                let phase = f64::from(index) * 0.05;
                let settled =
                    Moment::settled(&muscle, 3e5 + 1e5 * (0.7 * phase).sin(), 0.245 + 0.015 * phase.cos(), 1.0);
                Moment {
                    time_s: 0.01 * f64::from(index),
                    step_s: if index == 0 { 0.0 } else { 0.01 },
                    speed_m_per_s: 0.075 * phase.sin(),
                    direction: phase.sin().signum(),
                    force_n: 300.0,
                    ..settled
                }
            })
            .collect()
    }

    #[test]
    fn without_terms_it_is_eq_11_to_the_bit() {
        let model = AugmentedModel::new(base(), Vec::new());
        let mut memory = model.start();
        for now in path() {
            let expected_n = base().force_n(now.pressure_pa, now.length_m, now.direction);
            assert_eq!(memory.force_n(&model, now).to_bits(), expected_n.to_bits());
            assert_eq!(
                model.settled_force_n(now.pressure_pa, now.length_m, -1.0),
                base().force_n(now.pressure_pa, now.length_m, -1.0)
            );
        }
    }

    #[test]
    fn settled_presliding_is_eq_11() {
        let model = AugmentedModel::new(base(), vec![term("presliding-hysteresis", &[1e-3, 1.0], &[])]);
        for direction in [1.0, 0.0, -1.0] {
            let settled_n = model.settled_force_n(3e5, 0.24, direction);
            assert!((settled_n - base().force_n(3e5, 0.24, direction)).abs() < 1e-9);
        }
    }

    #[test]
    fn a_reversal_lets_go_of_the_friction_over_the_slip_distance() {
        let model = AugmentedModel::new(base(), vec![term("presliding-hysteresis", &[1e-3, 1.0], &[])]);
        let mut memory = model.start();
        let at =
            |length_m, step_s, direction| Moment { step_s, ..Moment::settled(&nominal(), 3e5, length_m, direction) };
        memory.force_n(&model, at(0.24, 0.0, 1.0));
        let turned_n = memory.force_n(&model, at(0.240_01, 0.01, -1.0));
        let before_n = base().force_n(3e5, 0.240_01, 1.0);
        let after_n = base().force_n(3e5, 0.240_01, -1.0);
        assert!((turned_n - before_n).abs() < 0.05 * (after_n - before_n));
        let slid_n = memory.force_n(&model, at(0.25, 0.01, -1.0));
        assert!((slid_n - base().force_n(3e5, 0.25, -1.0)).abs() < 1e-9);
    }

    #[test]
    fn amplitudes_of_zero_change_nothing() {
        for effect in CATALOGUE.iter().filter(|effect| effect.role() == Role::Pulls) {
            let shape: Vec<f64> = effect.shape().iter().map(|shape| shape.grid[0]).collect();
            let zeros = vec![0.0; effect.amplitudes().len()];
            let model = AugmentedModel::new(base(), vec![Term { effect: *effect, shape, amplitudes: zeros }]);
            let mut memory = model.start();
            for now in path() {
                let expected_n = base().force_n(now.pressure_pa, now.length_m, now.direction);
                assert!((memory.force_n(&model, now) - expected_n).abs() < 1e-12, "{}", effect.page().id);
            }
        }
    }

    #[test]
    fn the_force_is_linear_in_the_amplitudes() {
        for effect in CATALOGUE.iter().filter(|effect| effect.role() == Role::Pulls) {
            let shape: Vec<f64> = effect.shape().iter().map(|shape| shape.grid[0]).collect();
            let added_n = |factor: f64| -> Vec<f64> {
                let amplitudes = effect.amplitudes().iter().map(|amplitude| factor * amplitude.range.1).collect();
                let term = Term { effect: *effect, shape: shape.clone(), amplitudes };
                let model = AugmentedModel::new(base(), vec![term]);
                let mut memory = model.start();
                let base_n = |now: &Moment| base().force_n(now.pressure_pa, now.length_m, now.direction);
                path().into_iter().map(|now| memory.force_n(&model, now) - base_n(&now)).collect()
            };
            for (half_n, whole_n) in added_n(0.5).iter().zip(added_n(1.0)) {
                let error_n = (2.0 * half_n - whole_n).abs();
                assert!(error_n < 1e-9 * whole_n.abs().max(1.0), "{}: {half_n} {whole_n}", effect.page().id);
            }
        }
    }

    #[test]
    fn terms_act_in_the_order_of_their_roles() {
        let model = AugmentedModel::new(
            base(),
            vec![
                term("slack", &[10.0, 0.0], &[]),
                term("viscous-damping", &[], &[1e4, 0.0]),
                term("threshold-pressure", &[5e4], &[]),
            ],
        );
        let fast = Moment { speed_m_per_s: 1.0, ..Moment::settled(&nominal(), 3e5, 0.24, 1.0) };
        assert_eq!(model.start().force_n(&model, fast), 10.0);
        let slow = Moment { speed_m_per_s: 1e-3, ..fast };
        let seen = AugmentedModel::new(base(), vec![term("threshold-pressure", &[5e4], &[])]);
        let expected_n = seen.settled_force_n(3e5, 0.24, 1.0) - 10.0;
        assert!((model.start().force_n(&model, slow) - expected_n).abs() < 1e-9);
        assert!(expected_n + 10.0 < base().force_n(3e5, 0.24, 1.0) - 40.0);
    }

    #[test]
    fn a_settled_fixture_is_stretched_by_the_force_that_results() {
        for (compliance_m_per_n, length_m) in [(2e-5, 0.24), (4e-5, 0.266), (1e-4, 0.266)] {
            let model =
                AugmentedModel::new(base(), vec![term("series-compliance", &[compliance_m_per_n, 1.0, 0.0], &[])]);
            let force_n = model.settled_force_n(3e5, length_m, 1.0);
            let expected_n = base().force_n(3e5, length_m - compliance_m_per_n * force_n, 1.0);
            assert!((force_n - expected_n).abs() < 1e-9 * force_n, "{force_n} {expected_n}");
        }
    }

    #[test]
    fn a_muscle_leaves_instruments_and_fixture_behind() {
        let model = AugmentedModel::new(
            base(),
            vec![
                term("force-drift", &[30.0], &[0.1, 0.0]),
                term("slack", &[0.0, 0.0], &[]),
                term("pressure-lag", &[0.05], &[]),
                term("force-step", &[0.0, 1.0], &[3.0]),
            ],
        );
        let muscle = model.of_the_muscle();
        let ids: Vec<&str> = muscle.terms().iter().map(|term| term.effect.page().id).collect();
        assert_eq!(ids, ["slack", "pressure-lag"]);
        assert_eq!(model.beside_the_muscle(), ["force-drift", "force-step"]);
        assert_eq!(model.without_events().terms().len(), 3);
    }
}
