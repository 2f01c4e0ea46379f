//! A look at what the rig may do, in all muscles together.

use pam_artifact::group::{RigCandidate, Says};
use pam_muscle::effects::{Effect, Term};

use super::member::{Estimate, Fitted, Member, Worth};
use super::shared::{OnGrid, Shared, best, is_apart, on_grid, own_value, polished, pooled, spread};
use crate::hypothesis::CandidateEffect;
use crate::verdict::{DECLARED_RIVAL, RIVAL};
use crate::veto::Share;

/// Log predictive ratio below which, below zero, a muscle speaks against an effect, or beyond which it shows one that no other does.
pub(super) const TELLS: f64 = 1.0;
/// The same of a muscle that shows it as others do.
const SHOWS: f64 = 0.5;
/// Log predictive ratio that all muscles together must reach: what a further effect must in one.
const LEAST_LOG_RATIO: f64 = 3.0;
/// The same without the muscle that says most: what one of them shows alone is its own. As much as a name has to gain.
const LEAST_OF_OTHERS: f64 = 1.5;
/// The same that a further effect must reach in all muscles together before any other was taken off.
const LEAST_ALONE: f64 = 1.5;
/// Muscles that share a value, at least.
const LEAST_MUSCLES: usize = 2;
/// Share of what the best effect gains on its grid that another must gain there for its shape to be looked for: what is refined seldom
/// gains more than twice as much.
const PROMISES: f64 = 0.25;
/// Share of what is left beyond the sensors that it must explain in the muscles that show it, on average.
const LEAST_SHARE: f64 = 0.1;

/// An effect of the rig that was taken.
#[derive(Debug)]
pub(super) struct Taken {
    pub(super) guess: CandidateEffect,
    pub(super) shared: Estimate,
    pub(super) each: Vec<Has>,
    /// Ids of others that gain nearly as much.
    pub(super) rivals: Vec<&'static str>,
    /// With how much of its size it is there on what was held out of all muscles.
    pub(super) held: Option<Share>,
}

/// What a muscle has of it.
#[derive(Debug)]
pub(super) struct Has {
    pub(super) says: Says,
    pub(super) worth: Worth,
    /// Its shape and its amplitudes: the shared shape unless it differs.
    pub(super) guess: CandidateEffect,
    pub(super) own: Option<Fitted>,
    /// What is taken off its recordings; none where they speak against it.
    pub(super) term: Option<Term>,
}

impl Has {
    /// Its values.
    pub(super) fn estimate(&self) -> Option<&Estimate> {
        self.own.as_ref().map(|own| &own.estimate)
    }
}

/// Every effect of `effects` at the shape that gains most in all `members`, the best first.
pub(super) fn look(members: &[Member<'_>], effects: &[&'static dyn Effect]) -> Vec<Shared> {
    let all: Vec<&Member<'_>> = members.iter().collect();
    let on_grid: Vec<OnGrid> = effects.iter().filter_map(|effect| on_grid(&all, *effect)).collect();
    let most = on_grid.iter().map(|one| one.log_ratio).fold(0.0, f64::max);
    // What gains too little to be taken is not refined either.
    let least = PROMISES * most.max(LEAST_LOG_RATIO);
    let shared = |one: OnGrid| if one.log_ratio > least { one.refined(&all) } else { one.unrefined(&all) };
    let mut found: Vec<Shared> = on_grid.into_iter().filter_map(shared).collect();
    found.sort_by(|left, right| right.log_ratio().total_cmp(&left.log_ratio()));
    found
}

/// What became of a look.
#[derive(Debug, Default)]
pub(super) struct Outcome {
    /// The best that is one of the rig, with what each muscle has of it.
    pub(super) taken: Option<Taken>,
    /// Ids of those before it that what was held out denies.
    pub(super) denied: Vec<&'static str>,
    /// Ids of those before it that have a value of their own in nearly every muscle.
    pub(super) apart: Vec<&'static str>,
}

/// Ids of what may be taken after another was, by what every effect gained before any was: what gains nothing until another effect has
/// been taken off is the remainder of that one. No shared value is exactly right for every muscle, and no effect has exactly the form of
/// its page.
pub(super) fn own_gains(first: &[RigCandidate]) -> Vec<&str> {
    let gains = first.iter().filter(|candidate| candidate.log_ratio >= LEAST_ALONE);
    gains.map(|candidate| candidate.id.as_str()).collect()
}

/// The best of `found` that is one of the rig.
pub(super) fn taken(members: &[Member<'_>], found: &[Shared]) -> Outcome {
    let mut outcome = Outcome::default();
    for chosen in found.iter().filter(|shared| stands(members, shared)) {
        let Outcome { denied, apart, .. } = &outcome;
        let rivals = found
            .iter()
            .map(|other| (other.guess.id(), other.log_ratio()))
            .filter(|(id, _)| *id != chosen.guess.id() && !denied.contains(id) && !apart.contains(id))
            .filter(|(id, log_ratio)| {
                let declared = chosen.guess.effect.page().confusion_with(id).is_some();
                *log_ratio > if declared { DECLARED_RIVAL } else { RIVAL } * chosen.log_ratio()
            })
            .map(|(id, _)| id)
            .collect();
        let taken = settled(members, chosen.clone(), rivals);
        if taken.held.is_some_and(|held| held.denies(taken.guess.effect)) {
            outcome.denied.push(chosen.guess.id());
        } else if taken.each.iter().filter(|has| has.says == Says::Shows).count() < LEAST_MUSCLES {
            outcome.apart.push(chosen.guess.id());
        } else {
            return Outcome { taken: Some(taken), ..outcome };
        }
    }
    outcome
}

/// Whether the muscles together say that it is there.
fn stands(members: &[Member<'_>], shared: &Shared) -> bool {
    let most = shared.each.iter().map(|worth| worth.log_ratio).fold(f64::NEG_INFINITY, f64::max);
    let shown = shared.each.iter().filter(|worth| worth.log_ratio > SHOWS).count();
    let denied = shared.each.iter().filter(|worth| worth.log_ratio < -TELLS).count();
    // Every muscle alike, so that the one that eq. 11 misses most does not decide alone.
    let each = members.iter().zip(&shared.each).filter(|(_, worth)| worth.log_ratio > SHOWS);
    let shares = each.map(|(member, worth)| {
        let left = (worth.without - member.floor_square()).max(f64::MIN_POSITIVE);
        ((worth.without - worth.with) / left).clamp(0.0, 1.0)
    });
    let share = shares.sum::<f64>() / shown.max(1) as f64;
    let log_ratio = shared.log_ratio();
    log_ratio > LEAST_LOG_RATIO && log_ratio - most > LEAST_OF_OTHERS && shown > 2 * denied && share > LEAST_SHARE
}

/// What each muscle has of `shared`; those with a value of their own have no part in the shared one.
fn settled(members: &[Member<'_>], mut shared: Shared, rivals: Vec<&'static str>) -> Taken {
    let own: Vec<Option<(CandidateEffect, Worth)>> =
        members.iter().zip(&shared.each).map(|(member, worth)| own_value(member, &shared.guess, *worth)).collect();
    let alike: Vec<&Member<'_>> =
        members.iter().zip(&own).filter(|(_, own)| own.is_none()).map(|(member, _)| member).collect();
    if alike.len() >= LEAST_MUSCLES
        && alike.len() < members.len()
        && let Some(others) = best(&alike, shared.guess.effect)
    {
        let each = members
            .iter()
            .zip(&shared.each)
            .map(|(member, worth)| member.worth(&others.guess, false).unwrap_or(*worth));
        shared = Shared { each: each.collect(), guess: others.guess };
    }
    let guess = polished(&alike, shared.guess);
    let each = members.iter().zip(&shared.each).map(|(member, worth)| member.worth(&guess, false).unwrap_or(*worth));
    let shared = Shared { each: each.collect(), guess };
    let mut each: Vec<Has> = members
        .iter()
        .zip(own)
        .zip(&shared.each)
        .map(|((member, own), &worth)| {
            let differs = own.is_some();
            let guess = own.map_or_else(|| shared.guess.clone(), |(guess, _)| guess);
            let own = member.fitted(&guess);
            let held = own.as_ref().and_then(|own| own.held);
            let says = if held.is_some_and(|held| held.denies(guess.effect)) || worth.log_ratio < -TELLS {
                Says::Denies
            } else if differs {
                Says::Differs
            } else if worth.log_ratio > SHOWS || worth.log_ratio > 0.0 && held.is_some_and(Share::shows) {
                Says::Shows
            } else {
                Says::CannotShow
            };
            Has { says, worth, own, guess, term: None }
        })
        .collect();
    let scatter = spread(&alike, &shared.guess);
    let telling = |each: &[Has]| -> Estimate {
        let told = each.iter().filter(|has| matches!(has.says, Says::Shows | Says::CannotShow));
        pooled(&shared.guess, &told.filter_map(Has::estimate).collect::<Vec<_>>(), &scatter)
    };
    let first = telling(&each);
    for has in each.iter_mut().filter(|has| has.says == Says::Shows && !has.guess.effect.outlasts()) {
        if has.estimate().is_some_and(|own| is_apart(&shared.guess, own, &first)) {
            has.says = Says::Differs;
        }
    }
    let estimate = telling(&each);
    for has in each.iter_mut().filter(|has| has.says != Says::Denies) {
        let n_shapes = has.guess.shape.len();
        // What a drift begins with is of each recording's hour.
        let is_own = has.says == Says::Differs || has.guess.effect.outlasts();
        let values = has.estimate().filter(|_| is_own).unwrap_or(&estimate);
        let ranges = has.guess.amplitudes().iter().map(|amplitude| amplitude.range);
        let amplitudes =
            values.values[n_shapes..].iter().zip(ranges).map(|(value, (low, high))| value.clamp(low, high));
        has.term = Some(Term::new(has.guess.effect, has.guess.shape.clone(), amplitudes.collect()));
    }
    let held: Vec<Share> = each.iter().filter_map(|has| has.own.as_ref()?.held).collect();
    Taken { guess: shared.guess, shared: estimate, held: Share::pooled(&held), each, rivals }
}
