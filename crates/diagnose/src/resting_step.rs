//! A step of the force at rest: neither pressure nor length moves, and the force jumps all the same.
//!
//! The search judges an effect by what it gains on blocks beside a static map that bends. In a muscle that is held at one length
//! and inflated once, such a map takes a step near the highest pressure for friction, and one of a muscle that hangs slack for
//! what the load cell reads there, and the step gains nothing. But no map, no friction and no delay makes the force jump where all
//! drives rest. So a jump is looked for in the force itself, as it was recorded, and stands on how far it passes what the force does
//! at the other rests of that recording. What it explains is taken off before the search goes on.

mod jump;

use crate::hypothesis::{Beginning, CandidateEffect, Sign};
use crate::joint::HeldOut;
use crate::named::{evidence, named_besides, past_entries};
use crate::track::Track;
use crate::uncertainty::entry;
use pam_artifact::diagnosis::{Evidence, NamedEffect, Region};
use pam_artifact::model::{ParameterEntry, ParameterStatus};
use pam_identification::error::IdentifyError;
use pam_identification::prepare::Prepared;
use pam_muscle::Coordinate;
use pam_muscle::direction::Thresholds;
use pam_muscle::effects::{Base, Term, effect};
use pam_muscle::geometry::Muscle;
use rayon::prelude::*;

use jump::{Jump, Rows};

/// Catalogue id of what jumps.
pub(crate) const ID: &str = "force-step";

/// By how much a search on the grid is off of the instant of a step, at most, in s.
const SAME_S: f64 = 0.5;

/// Share of what an abrupt step explains that taking it off may cost: where a static map takes it, taking it off gains nothing, but
/// where no step is, taking one off leaves all of it.
const COSTS: f64 = 0.1;
/// The same of one that is not abrupt, or in whose place the search found one elsewhere: times the mean square that it left with that,
/// below which it must come without. When jumps were looked for on the grid, six steps of 9 N that were added to recordings of real
/// muscles left at most 0.90 times; of four on other worlds that were none, three left 0.97 and more, and the fourth, as a recording
/// began, 0.83.
const CLEARLY_LESS: f64 = 0.95;
/// Evidence of held-out blocks against a step from which on it is none, odds of twenty to one. Of 22 named steps in 471 cases that were
/// looked at one had more, 9.7, in a muscle that lacked nothing; all others had evidence for them.
const AGAINST: f64 = 3.0;

/// Share of what the force jumps by that all which follows must be off by, as a size that held-out recordings show must be half of what
/// was named. Of 19 looked-at jumps that were named, ten of which were added to recordings of real muscles, the 13 steps have 0.89 and
/// more, and of the six that are none four have 0.31 at most.
const LASTS: f64 = 0.5;

/// A step of the force at rest.
#[derive(Debug, Clone)]
pub(crate) struct RestingStep {
    guess: CandidateEffect,
    jump: Jump,
    /// What it explains, root mean square over all instants that count, in N.
    pub(crate) all_instants_n: f64,
    /// Mean squares over held-out blocks of what the search found without it.
    without: HeldOut,
    /// And with it; the same before it was taken off.
    with: HeldOut,
    /// When its recording ends, in s.
    ends_s: f64,
}

impl RestingStep {
    /// The one of `recordings`, which `track` is a grid of, that stands out most, with every beginning that it may have; `direction`
    /// says by how much channels move while they rest, `without` is what the search found without it.
    ///
    /// # Errors
    /// [`IdentifyError::Samples`] where samples cannot be read back.
    pub(crate) fn all(
        recordings: &[Prepared],
        track: &Track,
        direction: Thresholds,
        muscle: &Muscle,
        without: &HeldOut,
    ) -> Result<Vec<Self>, IdentifyError> {
        let jumps: Result<Vec<Option<Jump>>, IdentifyError> = recordings
            .par_iter()
            .zip(&track.recordings)
            .map(|(prepared, range)| {
                let rows = Rows::of(prepared)
                    .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
                Ok(Jump::of(track, range.clone(), &rows, direction))
            })
            .collect();
        Ok(Self::largest(&jumps?, track, muscle, without))
    }

    /// The one of `jumps`, one of each recording of `track`, that stands out most.
    fn largest(jumps: &[Option<Jump>], track: &Track, muscle: &Muscle, without: &HeldOut) -> Vec<Self> {
        let Some(effect) = effect(ID) else { return Vec::new() };
        let found = jumps.iter().zip(&track.recordings).enumerate().filter_map(|(index, (jump, range))| {
            Some((index, (*jump)?, track.instants.get(range.end.checked_sub(1)?)?.moment.time_s))
        });
        // Of two that stand out by much, the probabilities by chance are both zero in a float.
        let stands_out = |jump: &Jump| jump.step_n.abs() / jump.stderr_n;
        let most = found.max_by(|left, right| stands_out(&left.1).total_cmp(&stands_out(&right.1)));
        let Some((index, jump, ends_s)) = most else { return Vec::new() };
        let tells = |beginning: &Beginning| beginning.is_told(index, track);
        let beginnings = CandidateEffect::beginnings(effect, track, muscle).into_iter().filter(tells);
        let step = |beginning: Beginning| {
            let shape = vec![index as f64, jump.instant_s];
            let mut step = Self {
                guess: CandidateEffect { effect, shape, sign: Sign::Any, beginning },
                jump,
                all_instants_n: 0.0,
                without: without.clone(),
                with: without.clone(),
                ends_s,
            };
            step.all_instants_n = step.size_n(track, muscle);
            step
        };
        beginnings.map(step).collect()
    }

    /// Mean square in N² that may be left once it is taken off, where the search leaves `before` and has `found` with it in place.
    pub(crate) fn may_leave(&self, before: f64, found: &[Term]) -> f64 {
        if self.jump.is_abrupt && !found.iter().any(|term| self.loses(term)) {
            before + COSTS * self.all_instants_n.powi(2)
        } else {
            CLEARLY_LESS * before
        }
    }

    /// Whether `term` is a step at another instant.
    fn loses(&self, term: &Term) -> bool {
        let is_here =
            |shape: &[f64]| shape[0] == self.guess.shape[0] && (shape[1] - self.guess.shape[1]).abs() < SAME_S;
        term.effect.page().id == ID && !is_here(&term.shape)
    }

    /// What it pulls at every instant of `track`, in N.
    fn pulls_n(&self, track: &Track, muscle: &Muscle) -> Vec<f64> {
        let mut pulls_n = Vec::with_capacity(track.n());
        for (index, range) in track.recordings.iter().enumerate() {
            let mut memory = self.guess.start_in(index, muscle);
            for instant in &track.instants[range.clone()] {
                let mut column = [0.0];
                memory.pulls(&instant.moment, &Base::default(), &mut column);
                pulls_n.push(self.jump.step_n * column[0]);
            }
        }
        pulls_n
    }

    fn size_n(&self, track: &Track, muscle: &Muscle) -> f64 {
        let pulls_n = self.pulls_n(track, muscle);
        let counted = pulls_n.iter().zip(&track.counted).filter(|(_, counted)| **counted);
        let squares: f64 = counted.map(|(pull_n, _)| pull_n * pull_n).sum();
        (squares / track.n_counted().max(1) as f64).sqrt()
    }

    /// `track` without it.
    pub(crate) fn taken_off(&self, mut track: Track, muscle: &Muscle) -> Track {
        let pulls_n = self.pulls_n(&track, muscle);
        for (instant, pull_n) in track.instants.iter_mut().zip(pulls_n) {
            instant.force_n -= pull_n;
        }
        track
    }

    /// Whether held-out blocks clearly speak against it, of which `with` is left once it is taken off.
    pub(crate) fn is_spoken_against(&self, with: &HeldOut) -> bool {
        self.without.log_ratio(with) < -AGAINST
    }

    /// The same with what was found once it was taken off.
    #[must_use]
    pub(crate) fn compared(self, with: &HeldOut) -> Self {
        Self { with: with.clone(), ..self }
    }

    /// Whether a step that is fitted to all that follows as `size_n` is what the force jumps by.
    pub(crate) fn lasts(&self, size_n: f64) -> bool {
        size_n / self.jump.step_n >= LASTS
    }

    /// As a hypothesis has it.
    pub(crate) fn guess(&self) -> CandidateEffect {
        self.guess.clone()
    }

    /// As a model has it.
    pub(crate) fn term(&self) -> Term {
        let Self { guess, jump: Jump { step_n, .. }, .. } = self;
        Term { past: guess.beginning.past(), ..Term::new(guess.effect, guess.shape.clone(), vec![*step_n]) }
    }

    /// As an artifact has it.
    fn entries(&self) -> Vec<ParameterEntry> {
        // When and where an event happened has no bound of physics.
        let shapes = self.guess.effect.shape().iter().zip(&self.guess.shape);
        let shapes = shapes.map(|(shape, &value)| ParameterEntry {
            status: ParameterStatus::Fitted,
            ..entry(shape.name, shape.unit, value, shape.range, None)
        });
        let sizes = self.guess.amplitudes().iter();
        let sizes =
            sizes.map(|size| entry(size.name, size.unit, self.jump.step_n, size.range, Some(self.jump.stderr_n)));
        let mut entries: Vec<ParameterEntry> = shapes.chain(sizes).collect();
        entries.extend(past_entries(&self.guess));
        entries
    }

    /// As a diagnosis names it.
    pub(crate) fn named(&self) -> NamedEffect {
        let evidence = Evidence { p_value: self.jump.chance, ..evidence(&self.without, &self.with, 1) };
        named_besides(self.guess.effect, self.entries(), evidence)
    }

    /// Where it lies, in one of the recordings of `paths`; `mismatch_n` is the whole mismatch.
    pub(crate) fn region(&self, mismatch_n: f64, paths: &[String]) -> Region {
        Region {
            coordinate: Coordinate::Time,
            from: self.guess.shape[1],
            to: self.ends_s,
            unit: Coordinate::Time.unit().to_owned(),
            share_of_excess: (self.all_instants_n / mismatch_n).powi(2).min(1.0),
            p_value: self.jump.chance,
            recording: paths.get(self.guess.shape[0] as usize).cloned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::jump::tests::pulsed;
    use super::*;

    fn held_out() -> HeldOut {
        HeldOut { blocks: Vec::new(), counts: Vec::new(), floor_square: 0.0 }
    }

    #[test]
    fn what_jumps_between_two_pulses_is_taken_off_with_all_that_follows() {
        let given = pulsed(|time_s| if time_s < 12.3 { 0.0 } else { 9.0 });
        let jumps = [given.jump()];
        let step = RestingStep::largest(&jumps, &given.track, &given.muscle, &held_out()).swap_remove(0);
        let bare = step.taken_off(given.track.clone(), &given.muscle);
        let difference_n = |at: usize| given.track.instants[at].force_n - bare.instants[at].force_n;
        assert!(difference_n(0) == 0.0 && (difference_n(1499) - 9.0).abs() < 0.5, "{step:?}");
        let of_all = (1500.0 - 615.0) / 1500.0;
        assert!((step.all_instants_n - 9.0 * f64::sqrt(of_all)).abs() < 0.5, "{step:?}");
    }

    #[test]
    fn a_step_lasts_if_what_follows_is_off_by_half_of_it_or_more() {
        let given = pulsed(|time_s| if time_s < 12.3 { 0.0 } else { -9.0 });
        let step = RestingStep::largest(&[given.jump()], &given.track, &given.muscle, &held_out()).swap_remove(0);
        assert!(step.lasts(-9.0) && step.lasts(-4.6) && step.lasts(-30.0));
        assert!(!step.lasts(-4.2) && !step.lasts(9.0) && !step.lasts(0.0));
    }

    #[test]
    fn a_step_that_was_found_at_the_same_instant_is_not_lost_and_one_elsewhere_is() {
        let given = pulsed(|time_s| if time_s < 12.3 { 0.0 } else { 9.0 });
        let step = RestingStep::largest(&[given.jump()], &given.track, &given.muscle, &held_out()).swap_remove(0);
        let at = |instant_s: f64| Term { shape: vec![0.0, instant_s], ..step.term() };
        assert!(!step.loses(&at(12.35)) && step.loses(&at(14.0)));
        assert!(step.loses(&Term { shape: vec![1.0, 12.3], ..step.term() }));
    }

    #[test]
    fn a_step_that_held_out_blocks_clearly_speak_against_is_none() {
        let given = pulsed(|time_s| if time_s < 12.3 { 0.0 } else { 9.0 });
        let leaves = |square: f64| HeldOut { blocks: vec![square], counts: vec![1.0], floor_square: 0.0 };
        let step = RestingStep::largest(&[given.jump()], &given.track, &given.muscle, &leaves(1.0)).swap_remove(0);
        assert!(step.is_spoken_against(&leaves(AGAINST.exp() * 1.01)));
        assert!(!step.is_spoken_against(&leaves(AGAINST.exp() * 0.99)) && !step.is_spoken_against(&leaves(0.1)));
    }

    #[test]
    fn an_abrupt_step_may_leave_a_little_more_but_not_where_it_takes_the_place_of_one_found_elsewhere() {
        let given = pulsed(|time_s| if time_s < 12.3 { 0.0 } else { 9.0 });
        let step = RestingStep::largest(&[given.jump()], &given.track, &given.muscle, &held_out()).swap_remove(0);
        let at = |instant_s: f64| Term { shape: vec![0.0, instant_s], ..step.term() };
        assert!(step.may_leave(50.0, &[]) > 50.0 && step.may_leave(50.0, &[at(12.35)]) > 50.0);
        let elsewhere = step.may_leave(50.0, &[at(14.0)]);
        assert!(elsewhere < 50.0, "{elsewhere}");
        let slower = RestingStep { jump: Jump { is_abrupt: false, ..step.jump }, ..step.clone() };
        assert_eq!(slower.may_leave(50.0, &[]).to_bits(), elsewhere.to_bits());
    }

    #[test]
    fn of_two_jumps_that_chance_does_not_give_the_one_that_stands_out_more_is_taken() {
        let given = pulsed(|time_s| if time_s < 12.3 { 0.0 } else { 9.0 });
        let jump = given.jump().expect("a jump");
        let mut track = given.track.clone();
        track.recordings = vec![0..750, 750..1500];
        let jumps =
            [Some(Jump { step_n: 15.0, chance: 0.0, ..jump }), Some(Jump { step_n: -18.0, chance: 0.0, ..jump })];
        let step = RestingStep::largest(&jumps, &track, &given.muscle, &held_out()).swap_remove(0);
        assert!(step.jump.step_n == -18.0 && step.guess.shape[0] == 1.0, "{step:?}");
    }
}
