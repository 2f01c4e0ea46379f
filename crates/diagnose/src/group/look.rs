//! A look at what the rig may do, in all muscles together.

use pam_core::artifact::group::Says;
use pam_core::effects::{Effect, Term};

use super::member::{Estimate, Member, Worth};
use super::shared::{Shared, best, is_apart, own_value, pooled, spread};
use crate::hypothesis::Guess;
use crate::verdict::{DECLARED_RIVAL, RIVAL};

/// Log predictive ratio of a muscle that shows an effect, or, below zero, speaks against it.
pub(super) const TELLS: f64 = 1.0;
/// Log predictive ratio that all muscles together must reach: what a further effect must in one.
const LEAST_LOG_RATIO: f64 = 3.0;
/// Muscles that must show an effect before it is one of the rig.
const LEAST_MUSCLES: usize = 2;
/// Share of what is left beyond the sensors that it must explain in all muscles together.
const LEAST_SHARE: f64 = 0.1;

/// An effect of the rig that was taken.
#[derive(Debug)]
pub(super) struct Taken {
    pub(super) guess: Guess,
    pub(super) shared: Estimate,
    pub(super) each: Vec<Has>,
    /// Ids of others that gain nearly as much.
    pub(super) rivals: Vec<&'static str>,
}

/// What a muscle has of it.
#[derive(Debug)]
pub(super) struct Has {
    pub(super) says: Says,
    pub(super) worth: Worth,
    /// Its shape and its amplitudes: the shared shape unless it differs.
    pub(super) guess: Guess,
    pub(super) own: Option<Estimate>,
    /// What is taken off its recordings; none where they speak against it.
    pub(super) term: Option<Term>,
}

/// Every effect of `effects` at the shape that gains most in all `members`, the best first.
pub(super) fn look(members: &[Member<'_>], effects: &[&'static dyn Effect]) -> Vec<Shared> {
    let all: Vec<&Member<'_>> = members.iter().collect();
    let mut found: Vec<Shared> = effects.iter().filter_map(|effect| best(&all, *effect)).collect();
    found.sort_by(|left, right| right.log_ratio().total_cmp(&left.log_ratio()));
    found
}

/// The best of `found` that is one of the rig, with what each muscle has of it.
pub(super) fn taken(members: &[Member<'_>], found: &[Shared]) -> Option<Taken> {
    let chosen = found.iter().find(|shared| stands(members, shared))?;
    let rivals = found
        .iter()
        .filter(|other| other.guess.id() != chosen.guess.id())
        .filter(|other| {
            let confused = chosen.guess.effect.page().confused_with;
            let declared = confused.iter().any(|confusion| confusion.id == other.guess.id());
            other.log_ratio() > if declared { DECLARED_RIVAL } else { RIVAL } * chosen.log_ratio()
        })
        .map(|other| other.guess.id())
        .collect();
    Some(settled(members, chosen.clone(), rivals))
}

/// Whether the muscles together say that it is there.
fn stands(members: &[Member<'_>], shared: &Shared) -> bool {
    let shown = shared.each.iter().filter(|worth| worth.log_ratio > TELLS).count();
    let denied = shared.each.iter().filter(|worth| worth.log_ratio < -TELLS).count();
    let (mut gained, mut left) = (0.0, 0.0);
    for (member, worth) in members.iter().zip(&shared.each) {
        // In units of each muscle's sensors, so that the strongest does not decide alone.
        let square = member.floor_square().max(f64::MIN_POSITIVE);
        gained += member.n_counted() as f64 * (worth.without - worth.with) / square;
        left += member.n_counted() as f64 * (worth.without - member.floor_square()).max(0.0) / square;
    }
    shown >= LEAST_MUSCLES && shown > 2 * denied && shared.log_ratio() > LEAST_LOG_RATIO && gained > LEAST_SHARE * left
}

/// What each muscle has of `shared`; those with a value of their own have no part in the shared one.
fn settled(members: &[Member<'_>], mut shared: Shared, rivals: Vec<&'static str>) -> Taken {
    let own: Vec<Option<(Guess, Worth)>> =
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
    let mut each: Vec<Has> = members
        .iter()
        .zip(own)
        .zip(&shared.each)
        .map(|((member, own), &worth)| {
            let differs = own.is_some();
            let guess = own.map_or_else(|| shared.guess.clone(), |(guess, _)| guess);
            let says = if differs {
                Says::Differs
            } else if worth.log_ratio > TELLS {
                Says::Shows
            } else if worth.log_ratio < -TELLS {
                Says::Denies
            } else {
                Says::CannotShow
            };
            Has { says, worth, own: member.estimate(&guess), guess, term: None }
        })
        .collect();
    let scatter = spread(&alike, &shared.guess);
    let telling = |each: &[Has]| -> Estimate {
        let told = each.iter().filter(|has| matches!(has.says, Says::Shows | Says::CannotShow));
        pooled(&shared.guess, &told.filter_map(|has| has.own.as_ref()).collect::<Vec<_>>(), &scatter)
    };
    let first = telling(&each);
    for has in each.iter_mut().filter(|has| has.says == Says::Shows && !has.guess.effect.outlasts()) {
        if has.own.as_ref().is_some_and(|own| is_apart(&shared.guess, own, &first)) {
            has.says = Says::Differs;
        }
    }
    let estimate = telling(&each);
    for has in each.iter_mut().filter(|has| has.says != Says::Denies) {
        let n_shapes = has.guess.shape.len();
        // What a drift begins with is of each recording's hour.
        let is_own = has.says == Says::Differs || has.guess.effect.outlasts();
        let values = has.own.as_ref().filter(|_| is_own).unwrap_or(&estimate);
        let ranges = has.guess.amplitudes().iter().map(|amplitude| amplitude.range);
        let amplitudes =
            values.values[n_shapes..].iter().zip(ranges).map(|(value, (low, high))| value.clamp(low, high));
        has.term =
            Some(Term { effect: has.guess.effect, amplitudes: amplitudes.collect(), shape: has.guess.shape.clone() });
    }
    Taken { guess: shared.guess, shared: estimate, each, rivals }
}
