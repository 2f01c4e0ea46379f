//! A step of the force at rest: neither pressure nor length moves, and the force jumps all the same.
//!
//! The search judges an effect by what it gains on blocks beside a static map that bends. In a muscle that is held at one length
//! and inflated once, such a map takes a step near the highest pressure for friction, and the step gains nothing. But no map, no
//! friction and no delay makes the force jump where all drives rest. So a jump is looked for in the force itself, on the grid, and stands on
//! how far it passes what the force does at the other rests of that recording. What it explains is taken off before the search goes on.

use std::ops::Range;

use pam_artifact::diagnosis::{Evidence, NamedEffect, Region};
use pam_artifact::model::{ParameterEntry, ParameterStatus};
use pam_muscle::Coordinate;
use pam_muscle::direction::Thresholds;
use pam_muscle::effects::{Base, Term, effect};
use pam_muscle::geometry::Muscle;
use pam_muscle::motion::Instant;

use crate::hypothesis::{Beginning, CandidateEffect, Sign};
use crate::joint::HeldOut;
use crate::named::{evidence, named_besides, past_entries};
use crate::steps::{PARTS, stands_alone};
use crate::track::Track;
use crate::uncertainty::entry;

/// Catalogue id of what jumps.
pub(crate) const ID: &str = "force-step";

/// Time to either side in which drives rest, in s: between the pulses of a valve they seldom do for longer.
const REST_S: f64 = 0.1;
/// Instants to either side whose medians are compared: those of that time on the grid.
const NEAR: usize = 5;
/// By how much friction turns over where it does not rest.
const TURNS: f64 = 0.5;
/// Share of a jump that lies between two neighbors of the grid: what takes longer is no jump. Of six steps that were added to recordings
/// of real muscles 0.69 or more did; of four on other worlds that were none and had been named without this, 0.44 at most.
const SHARP: f64 = 0.5;
/// Probability by chance, corrected for the rests that were looked at, that is still believed.
const CHANCE: f64 = 0.01;

/// A step of the force at rest.
#[derive(Debug, Clone)]
pub(crate) struct RestingStep {
    guess: CandidateEffect,
    step_n: f64,
    stderr_n: f64,
    chance: f64,
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
    /// The one of `track` that chance gives least, with every beginning that it may have; `direction` says by how much channels move
    /// while they rest, `without` is what the search found without it.
    pub(crate) fn all(track: &Track, direction: Thresholds, muscle: &Muscle, without: &HeldOut) -> Vec<Self> {
        let Some(effect) = effect(ID) else { return Vec::new() };
        let found = track.recordings.iter().enumerate().filter_map(|(index, range)| {
            let jump = Jump::of(track, range.clone(), direction)?;
            Some((index, jump, track.instants.get(range.end.checked_sub(1)?)?.moment.time_s))
        });
        let Some((index, jump, ends_s)) = found.min_by(|left, right| left.1.chance.total_cmp(&right.1.chance)) else {
            return Vec::new();
        };
        let goes_on = |beginning: &Beginning| matches!(beginning, Beginning::GoesOn(_));
        // After the last recording there is none that would tell.
        let tells = |beginning: &Beginning| !goes_on(beginning) || index + 1 < track.recordings.len();
        let beginnings = CandidateEffect::beginnings(effect, track, muscle).into_iter().filter(tells);
        let step = |beginning: Beginning| {
            let shape = vec![index as f64, jump.instant_s];
            let mut step = Self {
                guess: CandidateEffect { effect, shape, sign: Sign::Any, beginning },
                step_n: jump.step_n,
                stderr_n: jump.stderr_n,
                chance: jump.chance,
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

    /// What it pulls at every instant of `track`, in N.
    fn pulls_n(&self, track: &Track, muscle: &Muscle) -> Vec<f64> {
        let mut pulls_n = Vec::with_capacity(track.n());
        for (index, range) in track.recordings.iter().enumerate() {
            let mut memory = self.guess.start_in(index, muscle);
            for instant in &track.instants[range.clone()] {
                let mut column = [0.0];
                memory.pulls(&instant.moment, &Base::default(), &mut column);
                pulls_n.push(self.step_n * column[0]);
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

    /// The same with what was found once it was taken off.
    #[must_use]
    pub(crate) fn compared(self, with: &HeldOut) -> Self {
        Self { with: with.clone(), ..self }
    }

    /// As a model has it.
    pub(crate) fn term(&self) -> Term {
        let Self { guess, step_n, .. } = self;
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
        let sizes = sizes.map(|size| entry(size.name, size.unit, self.step_n, size.range, Some(self.stderr_n)));
        let mut entries: Vec<ParameterEntry> = shapes.chain(sizes).collect();
        entries.extend(past_entries(&self.guess));
        entries
    }

    /// As a diagnosis names it.
    pub(crate) fn named(&self) -> NamedEffect {
        let evidence = Evidence { p_value: self.chance, ..evidence(&self.without, &self.with, 1) };
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
            p_value: self.chance,
            recording: paths.get(self.guess.shape[0] as usize).cloned(),
        }
    }
}

/// A jump at rest in one recording.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Jump {
    instant_s: f64,
    step_n: f64,
    stderr_n: f64,
    chance: f64,
}

impl Jump {
    /// The largest in `range` of `track`, where it stands alone among those at other rests and passes them by more than chance.
    fn of(track: &Track, range: Range<usize>, direction: Thresholds) -> Option<Self> {
        let n = range.len();
        let jumps: Vec<(usize, f64)> =
            range.clone().filter_map(|at| Some((at, jump_n(track, &range, at, direction)?))).collect();
        let &(at, step_n) = jumps.iter().max_by(|left, right| left.1.abs().total_cmp(&right.1.abs()))?;
        let part = |at: usize| (at - range.start) * PARTS / n;
        let mut largest_n = [None; PARTS];
        for (at, jump_n) in &jumps {
            let largest_n = &mut largest_n[part(*at)];
            *largest_n = Some(jump_n.abs().max(largest_n.unwrap_or(0.0)));
        }
        // What overlaps it is part of it.
        let others = jumps.iter().filter(|(other, _)| other.abs_diff(at) > 2 * NEAR);
        let (n_others, squares) = others.fold((0.0, 0.0), |(n, sum), (_, jump_n)| (n + 1.0, sum + jump_n * jump_n));
        let stderr_n = f64::sqrt(squares / f64::max(n_others, 1.0));
        let by_chance = libm::erfc(step_n.abs() / stderr_n / std::f64::consts::SQRT_2);
        let chance = (by_chance * jumps.len() as f64 / NEAR as f64 * track.recordings.len() as f64).min(1.0);
        let near = &track.instants[at - NEAR..at + NEAR];
        let after = split(near);
        let steepest_n = near.windows(2).map(|pair| (pair[1].force_n - pair[0].force_n).abs()).fold(0.0, f64::max);
        let is_sharp = steepest_n > SHARP * step_n.abs();
        // Where a recording begins, or ends, the force is on its way from, or to, something that nobody sees.
        let is_within = (1..PARTS - 1).contains(&part(at));
        let instant_s = near[after].moment.time_s;
        (is_within && is_sharp && stands_alone(&largest_n, part(at), step_n.abs()) && chance < CHANCE).then_some(Self {
            instant_s,
            step_n,
            stderr_n,
            chance,
        })
    }
}

/// The first of `near`, as many before a jump as after it, whose force is one of those after it.
fn split(near: &[Instant]) -> usize {
    let (before_n, after_n) = (median_n(&near[..NEAR]), median_n(&near[NEAR..]));
    let is_after = |instant: &Instant| (instant.force_n - after_n).abs() < (instant.force_n - before_n).abs();
    let right = |at: &usize| {
        let before = near[..*at].iter().filter(|instant| !is_after(instant)).count();
        before + near[*at..].iter().filter(|instant| is_after(instant)).count()
    };
    (0..near.len()).max_by_key(right).unwrap_or(NEAR)
}

/// Median force of [`NEAR`] instants, in N.
fn median_n(side: &[Instant]) -> f64 {
    let mut values_n: Vec<f64> = side.iter().map(|instant| instant.force_n).collect();
    values_n.sort_by(f64::total_cmp);
    values_n[NEAR / 2]
}

/// Median force of the instants from `at` on less that of those before it, in N; none where not all of them count, are at hand
/// and rest.
fn jump_n(track: &Track, range: &Range<usize>, at: usize, direction: Thresholds) -> Option<f64> {
    let (first, end) = (at.checked_sub(NEAR)?, at + NEAR);
    if first < range.start || end > range.end || !track.counted[first..end].iter().all(|counted| *counted) {
        return None;
    }
    let near = &track.instants[first..end];
    let lasts_s = near[near.len() - 1].moment.time_s - near[0].moment.time_s;
    let swing = |of: fn(&Instant) -> f64| {
        let (low, high) = near
            .iter()
            .map(of)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        high - low
    };
    let rests = swing(|instant| instant.moment.pressure_pa) < direction.pressure_pa
        && swing(|instant| instant.moment.length_m) < direction.length_m
        && swing(|instant| instant.moment.direction) <= TURNS;
    (rests && lasts_s <= 2.0 * REST_S).then(|| median_n(&near[NEAR..]) - median_n(&near[..NEAR]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    use pam_muscle::direction::Standstill;

    const DIRECTION: Thresholds =
        Thresholds { length_m: 2e-5, pressure_pa: 2e3, held_m: 0.0, turn_m: 0.0, standstill: Standstill::AT_ONCE };

    /// Half a minute at one length, the pressure higher by 20 kPa every half second, which rings for a while and is followed late; from
    /// `step_s` on the force is higher by 9 N, over so many instants.
    fn pulsed(step_s: f64, over: usize) -> Given {
        let mut given = Given::of(&["isobaric-triangles"], &[]);
        let first = given.track.instants[0];
        let instant = |at: usize| {
            let time_s = 0.02 * at as f64;
            let (pulse, since_s) = ((time_s / 0.5).floor(), time_s % 0.5);
            let ringing_pa = 3e4 * (-since_s / 0.03).exp() * (60.0 * since_s).cos();
            let step_n = 9.0 * ((time_s - step_s) / (0.02 * over as f64) + 1.0).clamp(0.0, 1.0);
            let wobble_n = 0.3 * ((at * 7919 % 1013) as f64 / 506.0 - 1.0);
            let mut instant = first;
            instant.moment.time_s = time_s;
            instant.moment.pressure_pa = 5e4 + 2e4 * pulse + ringing_pa;
            instant.moment.direction = 1.0;
            instant.force_n = 1e-3 * (instant.moment.pressure_pa - 1.5 * ringing_pa) + step_n + wobble_n;
            instant.settled = true;
            instant
        };
        given.track.instants = (0..1500).map(instant).collect();
        given.track.recordings = vec![0..1500; 1];
        given.track.counted = vec![true; 1500];
        given
    }

    fn found(given: &Given) -> Option<RestingStep> {
        let without = HeldOut { blocks: Vec::new(), counts: Vec::new(), floor_square: 0.0 };
        RestingStep::all(&given.track, DIRECTION, &given.muscle, &without).into_iter().next()
    }

    #[test]
    fn a_force_that_jumps_between_two_pulses_is_found_with_its_size_and_taken_off() {
        let given = pulsed(12.3, 1);
        let step = found(&given).expect("a step");
        assert!((step.guess.shape[1] - 12.3).abs() < 0.021 && (step.step_n - 9.0).abs() < 0.5, "{step:?}");
        assert!(step.chance < 1e-6 && step.stderr_n < 0.5, "{step:?}");
        let bare = step.taken_off(given.track.clone(), &given.muscle);
        assert!(found(&Given { track: bare, ..given }).is_none());
    }

    #[test]
    fn pulses_alone_and_a_force_that_rises_slowly_are_no_step() {
        assert!(found(&pulsed(1e3, 1)).is_none());
        assert!(found(&pulsed(12.4, 6)).is_none());
    }

    #[test]
    fn a_jump_as_a_pulse_comes_or_as_the_recording_begins_is_not_judged() {
        assert!(found(&pulsed(12.02, 1)).is_none());
        assert!(found(&pulsed(0.3, 1)).is_none());
    }
}
