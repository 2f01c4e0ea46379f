//! The value of an effect of the rig that all muscles share: where their evidence together is largest.

use pam_muscle::effects::{Effect, Seen, Shape};
use rayon::prelude::*;

use super::member::{Estimate, Member, Worth};
use crate::hypothesis::{Beginning, CandidateEffect};
use crate::trial::step_around;
use crate::uncertainty::jackknife_stderr;

/// Shapes of the grid that are refined, the best of those whose first differs: where friction turns over with a channel that is late, there is more than one
/// delay that is better than its neighbors.
const STARTS: usize = 2;
/// Rounds in which shapes are refined, at half the distance each time.
const ROUNDS: usize = 6;
/// Steps to one side in a round, at most.
const MOST_STEPS: usize = 4;
/// The same on all instants, and the first step there as a share of the distance on the grid.
const POLISH_ROUNDS: usize = 4;
/// See [`POLISH_ROUNDS`].
const POLISH: f64 = 0.25;
/// Log predictive ratio that a value of its own must gain in a muscle before it is said to differ.
const OWN_VALUE: f64 = 3.0;
/// Standard errors by which an amplitude of its own must differ, and by which share of the shared one at least.
const APART: (f64, f64) = (4.0, 0.3);

/// An effect of the rig with one shape for all.
#[derive(Debug, Clone)]
pub(super) struct Shared {
    pub(super) guess: CandidateEffect,
    /// What it is worth in each muscle.
    pub(super) each: Vec<Worth>,
}

impl Shared {
    fn of(members: &[&Member<'_>], guess: CandidateEffect) -> Option<Self> {
        let each = members.par_iter().map(|member| member.worth(&guess, false)).collect::<Option<Vec<_>>>()?;
        Some(Self { guess, each })
    }

    /// Log predictive ratio of all muscles together.
    pub(super) fn log_ratio(&self) -> f64 {
        self.each.iter().map(|worth| worth.log_ratio).sum()
    }
}

/// `effect` with the shape that gains most in `members` together; none where some of them determine no fit with it.
pub(super) fn best(members: &[&Member<'_>], effect: &'static dyn Effect) -> Option<Shared> {
    on_grid(members, effect)?.refined(members)
}

/// An effect at the shapes of its grid.
pub(super) struct OnGrid {
    /// Those that are refined with how closely they are followed, the best first.
    starts: Vec<(f64, CandidateEffect)>,
    /// What the first is worth, on the instants that a search for a shape looks at.
    pub(super) log_ratio: f64,
}

/// `effect` on its grid in `members` together; none where some of them determine no fit with it.
pub(super) fn on_grid(members: &[&Member<'_>], effect: &'static dyn Effect) -> Option<OnGrid> {
    let seen = members.iter().map(|member| member.seen).reduce(wider)?;
    let guesses: Vec<CandidateEffect> = effect
        .first_shapes(&seen)
        .into_iter()
        .flat_map(|shape| {
            let guess =
                move |&sign| CandidateEffect { effect, shape: shape.clone(), sign, beginning: Beginning::Fresh };
            CandidateEffect::signs(effect).iter().map(guess)
        })
        .collect();
    let tried = guesses.into_par_iter().filter_map(|guess| Some((follows(members, &guess, true)?, guess)));
    let mut starts: Vec<(f64, CandidateEffect)> = tried.collect();
    starts.sort_by(|left, right| right.0.total_cmp(&left.0));
    // Neighbors of one another that differ in the second shape alone lead to one place.
    let mut firsts: Vec<Option<f64>> = Vec::new();
    starts.retain(|(_, guess)| {
        let first = guess.shape.first().copied();
        let is_new = !firsts.contains(&first);
        firsts.push(first);
        is_new
    });
    starts.truncate(STARTS);
    let log_ratio: Option<f64> =
        members.par_iter().map(|member| Some(member.worth(&starts.first()?.1, true)?.log_ratio)).sum();
    log_ratio.map(|log_ratio| OnGrid { starts, log_ratio })
}

impl OnGrid {
    /// With the shape that gains most, near the best of the grid.
    pub(super) fn refined(self, members: &[&Member<'_>]) -> Option<Shared> {
        let refined = self.starts.into_par_iter().filter_map(|(followed, guess)| {
            let guess = refined(members, guess, followed);
            Some((follows(members, &guess, true)?, guess))
        });
        let (_, guess) = refined.max_by(|left, right| left.0.total_cmp(&right.0))?;
        Shared::of(members, guess)
    }

    /// As it is on the grid.
    pub(super) fn unrefined(self, members: &[&Member<'_>]) -> Option<Shared> {
        Shared::of(members, self.starts.into_iter().next()?.1)
    }
}

/// How closely all `members` are followed with `guess`, the closer the more: the logarithm of what is left, so that every muscle counts
/// alike. Evidence would not do: what is left below the form of eq. 11 gains nothing there, and a value half as large as the right one
/// may already leave no more.
fn follows(members: &[&Member<'_>], guess: &CandidateEffect, thinly: bool) -> Option<f64> {
    members.par_iter().map(|member| Some(-member.worth(guess, thinly)?.with.max(f64::MIN_POSITIVE).ln())).sum()
}

/// `guess`, with which `followed` is how closely, with better values of its shapes, on the instants that a search for a shape looks at.
fn refined(members: &[&Member<'_>], guess: CandidateEffect, followed: f64) -> CandidateEffect {
    descended(guess, followed, 1.0, ROUNDS, &|guess| follows(members, guess, true))
}

/// The same on all instants, from near by: `guess` is good on those that a search for a shape looks at.
pub(super) fn polished(members: &[&Member<'_>], guess: CandidateEffect) -> CandidateEffect {
    let gains = |guess: &CandidateEffect| follows(members, guess, false);
    let Some(followed) = gains(&guess) else { return guess };
    descended(guess, followed, POLISH, POLISH_ROUNDS, &gains)
}

/// `guess`, which gains `gained`, with shapes that gain most by `gains`: steps to all sides, one shape or two at a time, since
/// one of two delays makes up for the other. The first are `share` of the distance on the grid, half as long in every round; two of
/// one unit are of one length.
fn descended(
    guess: CandidateEffect,
    gained: f64,
    share: f64,
    rounds: usize,
    gains: &dyn Fn(&CandidateEffect) -> Option<f64>,
) -> CandidateEffect {
    let shapes = guess.effect.shape();
    let step = |(parameter, &value): (&Shape, &f64)| share * step_around(parameter.grid, parameter.range, value);
    let mut steps: Vec<f64> = shapes.iter().zip(&guess.shape).map(step).collect();
    let sides = sides(shapes.len());
    let mut best = (gained, guess);
    // Steps from neighbors lead to the same places, none of which is better.
    let mut places = vec![best.1.shape.clone()];
    let is_near = |left: &[f64], right: &[f64], steps: &[f64]| {
        left.iter().zip(right).zip(steps).all(|((left, right), step)| (left - right).abs() <= 1e-6 * step)
    };
    for _ in 0..rounds {
        for _ in 0..MOST_STEPS {
            // The steepest way, as a first one that only rises may lead to a lesser top.
            let stepped = sides.iter().filter_map(|side| {
                let mut tried = best.1.clone();
                for ((value, parameter), (way, step)) in
                    tried.shape.iter_mut().zip(shapes).zip(side.iter().zip(alike(shapes, &steps, side)))
                {
                    *value = (*value + way * step).clamp(parameter.range.0, parameter.range.1);
                }
                if places.iter().any(|place| is_near(place, &tried.shape, &steps)) {
                    return None;
                }
                places.push(tried.shape.clone());
                Some((gains(&tried)?, tried))
            });
            match stepped.max_by(|left, right| left.0.total_cmp(&right.0)).filter(|(gained, _)| *gained > best.0) {
                Some(higher) => best = higher,
                None => break,
            }
        }
        steps.iter_mut().for_each(|step| *step *= 0.5);
    }
    best.1
}

/// `steps` along `side`; shapes of one unit that move together make the longest of them.
fn alike(shapes: &[Shape], steps: &[f64], side: &[f64]) -> Vec<f64> {
    let longest = |unit: &str| {
        let moved = shapes.iter().zip(steps).zip(side).filter(|((shape, _), way)| shape.unit == unit && **way != 0.0);
        moved.map(|((_, step), _)| *step).fold(0.0, f64::max)
    };
    shapes.iter().map(|shape| longest(shape.unit)).collect()
}

/// Ways to step among `n` shapes: along each, and along every two of them.
fn sides(n: usize) -> Vec<Vec<f64>> {
    let along = |moved: &[(usize, f64)]| {
        let mut side = vec![0.0; n];
        moved.iter().for_each(|&(index, way)| side[index] = way);
        side
    };
    let mut sides = Vec::new();
    for index in 0..n {
        sides.extend([-1.0, 1.0].map(|way| along(&[(index, way)])));
        for other in index + 1..n {
            for way in [-1.0, 1.0] {
                sides.extend([-1.0, 1.0].map(|other_way| along(&[(index, way), (other, other_way)])));
            }
        }
    }
    sides
}

/// Standard error of each shape of `guess`: the jackknife over muscles, which counts what no curvature of a fit does, that each
/// of them is missed by eq. 11 in its own way.
pub(super) fn spread(members: &[&Member<'_>], guess: &CandidateEffect) -> Vec<f64> {
    let left_out = |index: usize| {
        let others: Vec<&Member<'_>> =
            members.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, member)| *member).collect();
        let gains = |guess: &CandidateEffect| follows(&others, guess, true);
        let followed = gains(guess)?;
        // What one muscle less moves lies near by.
        Some(descended(guess.clone(), followed, POLISH, POLISH_ROUNDS, &gains).shape)
    };
    let shapes: Vec<Vec<f64>> = (0..members.len()).filter_map(left_out).collect();
    let spread = |index: usize| jackknife_stderr(shapes.iter().map(|shape| shape[index]));
    (0..guess.shape.len()).map(|index| if shapes.is_empty() { 0.0 } else { spread(index) }).collect()
}

/// The value that `member` has for itself, where it gains clearly more than the shared one does.
pub(super) fn own_value(
    member: &Member<'_>,
    shared: &CandidateEffect,
    worth: Worth,
) -> Option<(CandidateEffect, Worth)> {
    let alone = best(&[member], shared.effect)?;
    (alone.each[0].log_ratio > worth.log_ratio + OWN_VALUE).then_some((alone.guess, alone.each[0]))
}

/// The shared estimate: shapes as they are, with the standard errors of all muscles together but no less than their `spread`, and
/// the weighted mean of the amplitudes, with no less than what they scatter by.
pub(super) fn pooled(guess: &CandidateEffect, each: &[&Estimate], spread: &[f64]) -> Estimate {
    let n_shapes = guess.shape.len();
    let n = n_shapes + guess.amplitudes().len();
    let (mut values, mut errors) = (guess.shape.clone(), Vec::with_capacity(n));
    for index in 0..n {
        let told = each.iter().filter_map(|estimate| {
            let error = estimate.errors[index].filter(|error| error.is_finite() && *error > 0.0)?;
            Some((estimate.values[index], error.powi(-2)))
        });
        let (weighted, weight) = told.fold((0.0, 0.0), |sum, (value, weight)| (sum.0 + weight * value, sum.1 + weight));
        if index >= n_shapes {
            let plain = each.iter().map(|estimate| estimate.values[index]).sum::<f64>() / each.len().max(1) as f64;
            values.push(if weight > 0.0 { weighted / weight } else { plain });
        }
        let scattered = match spread.get(index) {
            Some(spread) => *spread,
            None => {
                let squares = each.iter().map(|estimate| (estimate.values[index] - values[index]).powi(2)).sum::<f64>();
                let n = each.len() as f64;
                if n > 1.0 { (squares / (n * (n - 1.0))).sqrt() } else { 0.0 }
            }
        };
        errors.push((weight > 0.0).then(|| weight.sqrt().recip().max(scattered)));
    }
    Estimate { values, errors }
}

/// Whether an amplitude of `own` differs from that of `shared` by more than chance and by enough to matter.
pub(super) fn is_apart(guess: &CandidateEffect, own: &Estimate, shared: &Estimate) -> bool {
    (guess.shape.len()..own.values.len()).any(|index| {
        let error = |estimate: &Estimate| estimate.errors[index].unwrap_or(f64::INFINITY);
        let apart = (own.values[index] - shared.values[index]).abs();
        apart > APART.0 * error(own).hypot(error(shared)) && apart > APART.1 * shared.values[index].abs()
    })
}

/// What both cover.
fn wider(left: Seen, right: Seen) -> Seen {
    let both = |left: (f64, f64), right: (f64, f64)| (left.0.min(right.0), left.1.max(right.1));
    Seen {
        contraction_ratio: both(left.contraction_ratio, right.contraction_ratio),
        pressure_pa: both(left.pressure_pa, right.pressure_pa),
        force_n: both(left.force_n, right.force_n),
        warmth_k: both(left.warmth_k, right.warmth_k),
        duration_s: left.duration_s.max(right.duration_s),
    }
}

#[cfg(test)]
mod tests;
