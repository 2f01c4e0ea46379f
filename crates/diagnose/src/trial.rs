//! Candidates tried on top of a state.

use std::collections::BTreeMap;

use pam_muscle::effects::{Effect, Kind, Seen, Shape, effect};
use rayon::prelude::*;

use crate::events;
use crate::further_steps;
use crate::hypothesis::{Beginning, CandidateEffect, n_amplitudes};
use crate::joint::HeldOut;
use crate::search::chance;
use crate::state::{Setting, State};
use crate::steps;

/// A candidate on top of a state, at its best shape.
#[derive(Debug, Clone)]
pub struct Trial {
    /// The candidate.
    pub guess: CandidateEffect,
    /// Events of the same kind beside it, which it is judged with.
    pub further: Vec<CandidateEffect>,
    /// Mean square of the joint fit over the sampled instants, in N².
    pub mean_square: f64,
    /// Mean squares over held-out blocks without it, beside the same nuisances.
    pub before: HeldOut,
    /// Mean squares over held-out blocks.
    pub held_out: HeldOut,
    /// Its evidence, `Σ ln(without / with)` over held-out blocks, less what it is charged.
    pub log_ratio: f64,
}

impl Trial {
    /// Of `guess` alone, beside which as much is left as `before`.
    pub(crate) fn gaining_nothing(guess: CandidateEffect, mean_square: f64, before: &HeldOut) -> Self {
        let (before, held_out) = (before.clone(), before.clone());
        Self { guess, further: Vec::new(), mean_square, before, held_out, log_ratio: 0.0 }
    }

    /// Its evidence, whatever it is charged.
    pub(crate) fn uncharged(&self) -> f64 {
        self.before.log_ratio(&self.held_out)
    }

    /// Probability that chance gives that to one of `looks` candidates.
    pub(crate) fn by_chance(&self, looks: usize) -> f64 {
        chance(&self.before, &self.held_out) * looks as f64
    }
}

/// Candidates whose shapes are refined before they are compared.
const REFINED: usize = 5;

/// Share of the mean square that a candidate must explain of what it was fitted to before it is judged on what it was not.
const LEAST_GAIN: f64 = 1e-3;

/// Share of its evidence that an event keeps: it has been looked for at every instant of every recording.
const EVENT_CHARGE: f64 = 0.5;

/// Share of its evidence that an effect keeps whose amplitude presses against the largest that physics has for it: something
/// else of that shape is likelier.
const PRESSED_CHARGE: f64 = 0.7;

/// Share of its evidence that an effect keeps whose shape is at an end of its range: what lies beyond is no longer that
/// effect.
const DEGENERATE_CHARGE: f64 = 0.2;

/// Times the evidence of every other effect from which on one whose share of a whole is all of it, or none, is not charged for that: it
/// may be another effect then, but none that the catalogue has. Of ten looked-at muscles that creep under pressure three were without a
/// name by the charge, with three times the evidence of the next; beside a relaxation creep had one and a half times that.
const FAR_AHEAD: f64 = 2.0;

/// Whether a shape is at an end of its range that says more than how: zero, and the ends that an effect means, say no more.
pub(crate) fn is_degenerate(effect: &dyn Effect, shape: &[f64]) -> bool {
    effect
        .shape()
        .iter()
        .zip(shape)
        .enumerate()
        .any(|(index, (parameter, &value))| is_at_end(effect, index, parameter, value))
}

fn is_at_end(effect: &dyn Effect, index: usize, parameter: &Shape, value: f64) -> bool {
    let (low, high) = parameter.range;
    let near = 1e-3 * (high - low);
    let is_meant = |end: f64| end == 0.0 || effect.may_end(index, end);
    let at_end = value <= low + near.min(0.05 * low.abs()) && !is_meant(low) || value >= high - near && !is_meant(high);
    effect.kind() != Kind::Event && at_end
}

/// Whether the shape `name` of effect `id`, at an end of its range, only says how the effect acts.
pub(crate) fn ends_as_meant(id: &str, name: &str, value: f64) -> bool {
    let Some(effect) = effect(id) else { return false };
    let shapes = effect.shape().iter().enumerate();
    shapes.filter(|(_, shape)| shape.name == name).any(|(index, shape)| !is_at_end(effect, index, shape, value))
}

/// Whether a shape is at an end of its range that is no share of a whole: the data want a length, a time or a speed that nothing
/// published has, of something else that looks like the effect from afar.
pub(crate) fn wants_another(effect: &dyn Effect, shape: &[f64]) -> bool {
    let parameters = effect.shape().iter().zip(shape).enumerate();
    let is_share = |parameter: &Shape| parameter.range == (0.0, 1.0);
    parameters
        .filter(|(_, (parameter, _))| !is_share(parameter))
        .any(|(index, (parameter, &value))| is_at_end(effect, index, parameter, value))
}

/// Share of its evidence that an effect loses for every parameter beyond the first: of two that explain as much, the simpler
/// one is named.
const FREEDOM_CHARGE: f64 = 0.02;

/// Shapes that were best when a candidate was last looked at, by its id.
pub type Shapes = BTreeMap<&'static str, Vec<f64>>;

/// Tries every effect of `setting` that `state` does not have and that `takes` lets through; best first. A
/// candidate in `known` starts from the shape there, the others from all that the catalogue has for them.
pub fn among(
    setting: &Setting<'_>,
    state: &State,
    before: &HeldOut,
    seen: &Seen,
    known: &Shapes,
    takes: &(dyn Fn(&dyn Effect) -> bool + Sync),
) -> Vec<Trial> {
    let candidates: Vec<&'static dyn Effect> = setting
        .effects
        .iter()
        .copied()
        .filter(|&effect| takes(effect) && state.guesses.iter().all(|guess| guess.id() != effect.page().id))
        .collect();
    let jobs: Vec<(usize, CandidateEffect)> = candidates
        .iter()
        .enumerate()
        .flat_map(|(index, &effect)| {
            let shapes = match known.get(effect.page().id) {
                _ if effect.kind() == Kind::Event => steps::shapes(setting, state),
                Some(shape) => vec![shape.clone()],
                None => effect.first_shapes(seen),
            };
            let signs = CandidateEffect::signs(effect);
            let beginnings = CandidateEffect::beginnings(effect, setting.track, setting.muscle);
            let mut guesses = Vec::new();
            for shape in &shapes {
                for &sign in signs {
                    let guess = |beginning: &Beginning| {
                        (index, CandidateEffect { effect, shape: shape.clone(), sign, beginning: beginning.clone() })
                    };
                    let is_event = effect.kind() == Kind::Event;
                    let tells =
                        |beginning: &&Beginning| !is_event || beginning.is_told(shape[0] as usize, setting.track);
                    guesses.extend(beginnings.iter().filter(tells).map(guess));
                }
            }
            guesses
        })
        .collect();
    let residuals_n = setting.residuals_n(state);
    // Shapes are found on some of the instants; what an effect is worth is judged on all.
    let sampled = setting.sampled();
    let Some(thin) = sampled.fit_near(state.guesses.clone(), state) else { return Vec::new() };
    let costs: Vec<Option<f64>> = jobs
        .par_iter()
        .map(|(_, guess)| {
            if guess.effect.kind() != Kind::Event {
                return mean_square(&sampled, &thin, guess);
            }
            let fit = sampled.fit_more(&thin, guess)?;
            let step_n = fit.amplitudes.last()?;
            let gained = 1.0 - fit.mean_square / thin.fit.mean_square;
            steps::is_sudden(setting, &residuals_n, &guess.shape, *step_n, gained).then_some(fit.mean_square)
        })
        .collect();
    // Of every beginning the best: the freer one is always nearer to what it was fitted to.
    let mut best: Vec<[Option<(f64, &CandidateEffect)>; 3]> = vec![[None; 3]; candidates.len()];
    for ((index, guess), cost) in jobs.iter().zip(costs) {
        let best = &mut best[*index][match guess.beginning {
            Beginning::Fresh => 0,
            Beginning::Own => 1,
            Beginning::GoesOn(_) => 2,
        }];
        if let Some(cost) = cost
            && best.is_none_or(|(lowest, _)| cost < lowest)
        {
            *best = Some((cost, guess));
        }
    }
    let mut found: Vec<(f64, CandidateEffect)> =
        best.into_iter().flatten().flatten().map(|(cost, guess)| (cost, guess.clone())).collect();
    found.sort_by(|left, right| left.0.total_cmp(&right.0));
    let refined: Vec<(f64, CandidateEffect)> = found
        .par_iter()
        .enumerate()
        .map(
            |(rank, (cost, guess))| {
                if rank < REFINED { refine(&sampled, &thin, guess, *cost, 1) } else { (*cost, guess.clone()) }
            },
        )
        .collect();
    let mut trials: Vec<Trial> = refined
        .into_par_iter()
        .filter_map(|(mean_square, guess)| {
            let is_other = guess.effect.kind() == Kind::Event && !events::is_even(setting, state, &guess);
            if is_other || mean_square > (1.0 - LEAST_GAIN) * thin.fit.mean_square {
                return Some(Trial::gaining_nothing(guess, mean_square, before));
            }
            let further = match guess.effect.kind() {
                Kind::Event => further_steps::beside(setting, state, &guess),
                _ => Vec::new(),
            };
            let (held_out, is_pressed) = weigh(setting, state, &guess, &further)?;
            let beginnings = if guess.has_own_beginnings() { setting.track.recordings.len() } else { 0 };
            let kept = share_kept(&guess, is_pressed, beginnings + n_parameters(&further));
            let mut evidence = before.log_ratio(&held_out);
            if guess.has_own_beginnings() {
                // What only the beginnings gain says that recordings differ, not by what.
                let begun = setting.weigh_beginnings(state, &guess)?;
                evidence = evidence.min(begun.log_ratio(&held_out));
            }
            let log_ratio = kept * evidence;
            Some(Trial { guess, further, mean_square, before: before.clone(), held_out, log_ratio })
        })
        .collect();
    trials.sort_by(|left, right| right.log_ratio.total_cmp(&left.log_ratio));
    let mut listed: Vec<&str> = Vec::new();
    trials.retain(|trial| {
        let is_first = !listed.contains(&trial.guess.id());
        listed.push(trial.guess.id());
        is_first
    });
    trials
}

/// Gives those of `trials`, of all the catalogue with nothing named before, back what a share at an end of its range cost them that
/// nothing else comes near.
pub(crate) fn restore_leaders(trials: &mut [Trial]) {
    let whole: Vec<f64> = trials
        .iter()
        .map(|trial| {
            let Trial { guess, log_ratio, .. } = trial;
            let is_share = is_degenerate(guess.effect, &guess.shape) && !wants_another(guess.effect, &guess.shape);
            let whole = if is_share { log_ratio / DEGENERATE_CHARGE } else { *log_ratio };
            let others = trials.iter().filter(|other| other.guess.id() != guess.id());
            let nearest = others.map(Trial::uncharged).fold(0.0, f64::max);
            if whole > FAR_AHEAD * nearest { whole } else { *log_ratio }
        })
        .collect();
    trials.iter_mut().zip(whole).for_each(|(trial, whole)| trial.log_ratio = whole);
}

/// Share of its evidence that `guess` keeps for what it is and how freely it was found; `is_pressed` where an amplitude presses
/// against the largest that physics has for it, `more` parameters were fitted beside it: memories of what went before, and further events.
pub(crate) fn share_kept(guess: &CandidateEffect, is_pressed: bool, more: usize) -> f64 {
    let looked_for = if guess.effect.kind() == Kind::Event { EVENT_CHARGE } else { 1.0 };
    let strained = if is_pressed { PRESSED_CHARGE } else { 1.0 };
    let degenerate = if is_degenerate(guess.effect, &guess.shape) { DEGENERATE_CHARGE } else { 1.0 };
    let n_parameters = n_parameters(std::slice::from_ref(guess)) + more;
    let freedom = (1.0 - FREEDOM_CHARGE * n_parameters.saturating_sub(1) as f64).max(0.0);
    looked_for * strained * degenerate * freedom
}

/// Parameters of `guesses`, shapes and amplitudes.
fn n_parameters(guesses: &[CandidateEffect]) -> usize {
    guesses.iter().map(|guess| guess.effect.shape().len() + guess.amplitudes().len()).sum()
}

/// Mean squares over held-out blocks of `state` with one more guess and its `further` events, and whether an amplitude of that presses against the
/// largest that physics has for it: the data want something else of that shape.
pub(crate) fn weigh(
    setting: &Setting<'_>,
    state: &State,
    guess: &CandidateEffect,
    further: &[CandidateEffect],
) -> Option<(HeldOut, bool)> {
    if !guess.only_adds() || !further.is_empty() {
        return Some((setting.hold_out(&with(setting, state, guess, further)?)?, false));
    }
    let (fit, held_out) = setting.weigh_more(state, guess)?;
    let amplitudes = guess.amplitudes();
    let own = &fit.amplitudes[n_amplitudes(&state.guesses)..];
    let is_pressed = own.iter().zip(amplitudes).any(|(value, amplitude)| {
        let (low, high) = amplitude.range;
        let near = 1e-3 * (high - low);
        *value > high - near || (low < 0.0 && *value < low + near)
    });
    Some((held_out, is_pressed))
}

/// Mean square of the joint fit with one more guess.
pub fn mean_square(setting: &Setting<'_>, state: &State, guess: &CandidateEffect) -> Option<f64> {
    if guess.only_adds() {
        setting.fit_more(state, guess).map(|fit| fit.mean_square)
    } else {
        setting.left_near(&state.guesses_with(guess), state)
    }
}

/// `state` with one more guess and its `further` events.
pub fn with(
    setting: &Setting<'_>,
    state: &State,
    guess: &CandidateEffect,
    further: &[CandidateEffect],
) -> Option<State> {
    let mut guesses = state.guesses_with(guess);
    guesses.extend_from_slice(further);
    setting.fit_near(guesses, state)
}

/// Better values of the shape parameters of `guess` on top of `state`, one after the other, `sweeps` times; and the mean
/// square there.
pub fn refine(
    setting: &Setting<'_>,
    state: &State,
    guess: &CandidateEffect,
    cost: f64,
    sweeps: usize,
) -> (f64, CandidateEffect) {
    let mut best = (cost, guess.clone());
    if guess.effect.kind() == Kind::Event {
        return best;
    }
    for _ in 0..sweeps {
        for (index, parameter) in guess.effect.shape().iter().enumerate() {
            let value = best.1.shape[index];
            let step = step_around(parameter.grid, parameter.range, value);
            let mut factor = step;
            // Each round looks to either side of the best so far, at half the distance of the round before.
            for _ in 0..3 {
                let tried = |way: f64| {
                    let mut trial = best.1.clone();
                    trial.shape[index] =
                        (best.1.shape[index] + way * factor).clamp(parameter.range.0, parameter.range.1);
                    // At an end of the range there is nothing on the other side.
                    if trial.shape[index] == best.1.shape[index] {
                        return None;
                    }
                    mean_square(setting, state, &trial).map(|cost| (cost, trial))
                };
                let (below, above) = rayon::join(|| tried(-1.0), || tried(1.0));
                for trial in [below, above].into_iter().flatten() {
                    if trial.0 < best.0 {
                        best = trial;
                    }
                }
                factor *= 0.5;
            }
        }
    }
    best
}

/// Half the distance to the neighbors of `value` on the grid.
pub(crate) fn step_around(grid: &[f64], range: (f64, f64), value: f64) -> f64 {
    let below = grid.iter().copied().filter(|&point| point < value).fold(f64::NAN, f64::max);
    let above = grid.iter().copied().filter(|&point| point > value).fold(f64::NAN, f64::min);
    let distance = match (below.is_finite(), above.is_finite()) {
        (true, true) => (value - below).min(above - value),
        (true, false) => value - below,
        (false, true) => (above - value).min(value.abs().max(0.1 * above.abs())),
        (false, false) => 0.3 * value.abs().max(0.02 * (range.1 - range.0)),
    };
    0.5 * distance
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(id: &str) -> &'static dyn Effect {
        effect(id).expect("an effect of the catalogue")
    }

    #[test]
    fn a_rigid_mount_and_a_whole_share_are_no_degenerate_shapes() {
        assert!(!is_degenerate(of("inertia"), &[200.0]));
        assert!(is_degenerate(of("inertia"), &[12.0]));
        assert!(!is_degenerate(of("series-compliance"), &[1e-5, 1.0, 0.0]));
        assert!(is_degenerate(of("series-compliance"), &[1e-4, 1.0, 0.0]));
        assert!(is_degenerate(of("presliding-hysteresis"), &[2e-4, 0.0, 1.0]));
    }

    #[test]
    fn a_creep_that_is_all_of_the_length_is_a_relaxation_instead() {
        assert!(is_degenerate(of("pressure-creep"), &[6.0, 1.0]));
    }

    #[test]
    fn a_share_that_is_all_costs_nothing_where_no_other_effect_comes_near() {
        let held = HeldOut { blocks: vec![1.0], counts: vec![1.0], floor_square: 0.0 };
        let trial = |id: &str, shape: &[f64], log_ratio: f64| {
            let (sign, beginning) = (crate::hypothesis::Sign::Any, Beginning::Fresh);
            let guess = CandidateEffect { effect: of(id), shape: shape.to_vec(), sign, beginning };
            let held_out = HeldOut { blocks: vec![(-log_ratio).exp()], ..held.clone() };
            Trial { held_out, log_ratio, ..Trial::gaining_nothing(guess, 1.0, &held) }
        };
        let first = |id: &str, shape: &[f64], log_ratio: f64, other: f64| {
            let mut trials = [trial(id, shape, log_ratio), trial("channel-delay", &[0.02, 0.0], other)];
            restore_leaders(&mut trials);
            assert_eq!(trials[1].log_ratio, other);
            trials[0].log_ratio
        };
        assert_eq!(first("pressure-creep", &[6.0, 1.0], 4.0, 9.9), 20.0);
        assert_eq!(first("pressure-creep", &[6.0, 1.0], 4.0, 10.1), 4.0);
        assert_eq!(first("pressure-creep", &[6.0, 0.9], 4.0, 1.0), 4.0, "that was not charged");
        assert_eq!(first("rubber-hysteresis", &[1e-4], 4.0, 1.0), 4.0, "that is a width that nothing has");
    }

    #[test]
    fn rubber_that_settles_at_once_is_softening_and_one_that_never_does_may_be_something_else() {
        assert!(ends_as_meant("mullins-softening", "settling_travel", 0.02));
        assert!(!ends_as_meant("mullins-softening", "settling_travel", 5.0));
        assert!(!ends_as_meant("rubber-hysteresis", "width_m", 1e9) && !ends_as_meant("no-effect", "width_m", 0.0));
    }

    #[test]
    fn an_exponent_at_its_end_is_a_form_and_a_speed_at_its_end_is_another_effect() {
        assert!(!is_degenerate(of("stribeck"), &[5e-3, 0.5, 0.0]));
        assert!(is_degenerate(of("stribeck"), &[5e-2, 1.0, 0.0]));
        assert!(!is_degenerate(of("force-drift"), &[4e3]));
    }

    #[test]
    fn a_shape_beyond_what_is_published_is_something_else_and_a_whole_share_is_not() {
        assert!(wants_another(of("rubber-hysteresis"), &[4e-4]));
        assert!(wants_another(of("rate-dependent-hysteresis"), &[1e-5]));
        assert!(!wants_another(of("rubber-hysteresis"), &[1e-3]));
        // The upper end reaches a thousandth of the range inwards, the lower one a twentieth of its own value.
        assert!(
            wants_another(of("rubber-hysteresis"), &[0.02998]) && !wants_another(of("rubber-hysteresis"), &[0.0299])
        );
        assert!(
            wants_another(of("rubber-hysteresis"), &[4.16e-4]) && !wants_another(of("rubber-hysteresis"), &[4.24e-4])
        );
        assert!(!wants_another(of("pressure-creep"), &[6.0, 1.0]));
        assert!(!wants_another(of("stribeck"), &[5e-3, 2.5, 200.0]));
    }
}

#[cfg(test)]
mod cases;

#[cfg(test)]
mod edges;
