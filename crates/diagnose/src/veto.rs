//! What was held out confirms or vetoes what was named.
//!
//! The force of an effect, as it was fitted, is predicted on recordings that nothing was fitted to, and compared there with
//! what the base leaves beside a static map and a tare of each recording: a muscle that lies a few newtons off everywhere
//! else, or a state that nobody knows at the start, speaks neither for the effect nor against it. What is there with less
//! than half of its size or more than twice, and surely so, was another one: where that had the strongest evidence, the
//! next best is looked for.

use pam_muscle::effects::{AugmentedModel, Effect, Kind};
use pam_muscle::force::ForceModel;

use crate::coordinates::Coordinates;
use crate::error::DiagnoseError;
use crate::events;
use crate::held_error::Left;
use crate::hypothesis::{Beginning, CandidateEffect};
use crate::nuisance::Nuisance;
use crate::problem::DiagnosisProblem;
use crate::search::Found;
use crate::state::{Setting, State};
use crate::track::Track;
use crate::uncertainty::{correlated_instants, jackknife_stderr};

/// Share of its size that an effect must be seen with on what was held out: half way between there and not there.
const SEEN: f64 = 0.5;
/// The same at most: a factor of two either way, since what is fitted where it hardly shows comes out small.
const MOST_SEEN: f64 = 2.0;
/// Standard errors by which it must fall short of that: one in forty by chance.
const SURELY: f64 = 2.0;
/// Pieces of the held-out recordings that stand for independent ones.
const PIECES: usize = 16;

/// Standard error of that share from which on what was held out tells nothing of an effect.
const TELLS: f64 = 0.3;
/// Evidence within what was fitted that stands where nothing held out tells. Of 400 cases that this was chosen by, all five effects
/// with more were right that do not outlast a recording, and both with 9 to 10 were wrong.
const STANDS_ALONE: f64 = 10.0;
/// The same for what outlasts a recording, since what it was at the beginning of each is fitted beside it and helps any of them; for
/// what is taken in the place of a name that was denied; and for a shape that nothing published has.
const OUTLASTS_ALONE: f64 = 20.0;
/// Probability of as much evidence within what was fitted by chance, corrected for multiple comparisons, from which on what held-out
/// recordings cannot tell does not stand on it, and what outlasts a recording needs the more. Of 180 names that were looked at, 104 of
/// them right, 97 right and 34 wrong ones stand; with half of it as many, with its double 97 and 36.
pub(crate) const UNLIKELY: f64 = 0.01;

/// Whether `evidence` within what was fitted, as chance gives with the probability `chance`, is enough for `effect` to stand where nothing
/// else speaks for it: not for a static one, since a misfit of eq. 11 is there in every block.
pub(crate) fn stands_on_evidence(effect: &dyn Effect, evidence: f64, chance: f64) -> bool {
    let alone = if effect.outlasts() && chance > UNLIKELY { OUTLASTS_ALONE } else { STANDS_ALONE };
    !effect.is_static() && evidence > alone
}

/// Whether `evidence` is enough for `effect` to stand with a shape that nothing published has.
pub(crate) fn stands_unheard_of(effect: &dyn Effect, evidence: f64) -> bool {
    !effect.is_static() && evidence > OUTLASTS_ALONE
}

/// Evidence in the first look from which on what outlasts a recording stands where it has the most of all, whatever held-out recordings
/// say of its size. Of some 380 cases that were looked at, five such names that led with more were denied all the same, all of them right.
const OVERWHELMING: f64 = 16.0;

/// Whether effect `index` of `found` outlasts a recording and had the most evidence of all in the first look, so much that neither chance
/// nor another effect of the catalogue gives it: held-out recordings that deny its size then say that it is not the same there, as the
/// drift of a load cell that has warmed up by then, and not that it is no name. Not where a part of the catalogue is excluded, of which one
/// may explain more.
fn leads_beyond_doubt(found: &Found, index: usize) -> bool {
    let guess = &found.best.state.guesses[index];
    let most = found.first.iter().max_by(|left, right| left.log_ratio.total_cmp(&right.log_ratio));
    most.is_some_and(|most| {
        found.looked_at_all
            && guess.effect.outlasts()
            && most.guess.id() == guess.id()
            && most.log_ratio >= OVERWHELMING
            && most.by_chance(found.first.len()) < UNLIKELY
            && found.evidence(index) > STANDS_ALONE
    })
}

/// Searches again without what was denied, at most.
const MOST_AGAIN: usize = 2;

/// `found` on `track` without the effects that `heldout` says are not there, and the others marked where it surely shows them. Where
/// the strongest is none, the next best may be the one: it is taken in its place where `heldout` surely shows that,
/// or cannot show it and the evidence is strong.
///
/// # Errors
/// As [`DiagnosisProblem::search_without`].
pub(crate) fn confirmed(
    question: &DiagnosisProblem<'_>,
    track: &Track,
    found: Found,
    heldout: &Track,
) -> Result<Found, DiagnoseError> {
    let (mut found, mut strongest) = without_denied(question, track, found, heldout);
    let mut excluded = Vec::new();
    while let Some(id) = strongest
        && found.taken.iter().all(|taken| !taken.is_confirmed)
        && excluded.len() < MOST_AGAIN
    {
        excluded.push(id);
        let next = question.search_without(track, &excluded)?;
        let (mut next, its_strongest) = without_denied(question, track, next, heldout);
        strongest = its_strongest;
        if next.taken.iter().any(|taken| taken.is_confirmed) || stands_unseen(&next) {
            next.first = found.first;
            next.denied.extend(found.denied);
            found = next;
        }
    }
    Ok(found)
}

/// Whether the strongest of `found`, of which nothing was denied, is one that other recordings may not show, on evidence that nothing
/// else is asked for.
fn stands_unseen(found: &Found) -> bool {
    let evidence = |index: &usize| found.evidence(*index);
    let strongest = (0..found.taken.len()).max_by(|one, other| evidence(one).total_cmp(&evidence(other)));
    strongest.is_some_and(|index| {
        let effect = found.best.state.guesses[index].effect;
        (effect.kind() == Kind::Event || effect.outlasts()) && evidence(&index) > OUTLASTS_ALONE
    })
}

/// `found` without what was denied, and the id of the one with the strongest evidence if that was.
fn without_denied(
    question: &DiagnosisProblem<'_>,
    track: &Track,
    mut found: Found,
    heldout: &Track,
) -> (Found, Option<&'static str>) {
    let nuisance = found.nuisance.clone();
    let setting = question.setting(track, &nuisance);
    events::told_by(&setting, &mut found, heldout);
    let beside = beside(question, heldout, &found.best.state.model);
    let held = question.setting(heldout, &beside);
    let mut strongest_denied = None;
    loop {
        let shares = shares(&setting, &held, &found);
        let Some(Denied { index, too_large, .. }) = denied(&found, &shares) else {
            for (taken, share) in found.taken.iter_mut().zip(&shares) {
                taken.is_confirmed = share.is_some_and(Share::shows);
            }
            return (found, strongest_denied);
        };
        let id = found.best.state.guesses[index].id();
        let is_strongest = strongest(&found, &shares) == Some(index);
        if !found.let_go(&setting, index) {
            return (found, strongest_denied);
        }
        found.denied.push(id);
        if is_strongest {
            strongest_denied = strongest_denied.or(Some(id));
        }
        if too_large {
            found.stand_ins.push(id);
        }
    }
}

/// What anything is judged beside on `heldout`.
fn beside(question: &DiagnosisProblem<'_>, heldout: &Track, model: &ForceModel) -> Nuisance {
    let coordinates = Coordinates::of(heldout);
    Nuisance::of_recordings(heldout, question.limits.sensor_floor_n)
        .with_reversals(heldout, &coordinates, model)
        .with_map(heldout, &coordinates)
}

/// With how much of its size effect `index` of `state` is there on `heldout`; none where nothing can be said.
pub(crate) fn held_share(
    question: &DiagnosisProblem<'_>,
    heldout: &Track,
    state: &State,
    index: usize,
) -> Option<Share> {
    let beside = beside(question, heldout, &state.model);
    is_judged(state.guesses[index].effect).then(|| share(&question.setting(heldout, &beside), state, index)).flatten()
}

/// An effect that what was held out denies.
#[derive(Debug, Clone, Copy)]
struct Denied {
    index: usize,
    /// Largest share with which it may be there.
    most: f64,
    /// For it within what was fitted: of what nothing held out tells, the weakest goes first.
    evidence: f64,
    /// Whether something is there, but more than it.
    too_large: bool,
}

/// The effect of `found` with the strongest evidence among those that are surely there on what was held out, or among all where none
/// is. What outlasts a recording is asked for nothing there: its beginnings are unknown.
fn strongest(found: &Found, shares: &[Option<Share>]) -> Option<usize> {
    let is_there = |index: &usize| match shares[*index] {
        Some(share) => share.shows(),
        None => found.best.state.guesses[*index].effect.outlasts(),
    };
    let among = |takes: &dyn Fn(&usize) -> bool| {
        let every = (0..shares.len()).filter(takes);
        every.max_by(|&left, &right| found.evidence(left).total_cmp(&found.evidence(right)))
    };
    among(&is_there).or_else(|| among(&|_| true))
}

/// The effect of `found`, there with `shares`, that what was held out denies most clearly, or does not confirm where another one is
/// stronger: what is left of the strongest is easily taken for a second one.
fn denied(found: &Found, shares: &[Option<Share>]) -> Option<Denied> {
    let strongest = strongest(found, shares);
    let mut least: Option<Denied> = None;
    for (index, (guess, share)) in found.best.state.guesses.iter().zip(shares).enumerate() {
        if !is_judged(guess.effect) || leads_beyond_doubt(found, index) {
            continue;
        }
        // What acts in a part of the range alone may not have been there.
        let stands = strongest == Some(index) || guess.effect.is_static();
        let too_large = share.is_some_and(|share| share.is_too_large(guess.effect));
        let is_denied = share.is_some_and(|share| share.denies(guess.effect));
        let tells = share.is_some_and(|share| share.error < TELLS);
        let is_open = !guess.effect.outlasts() || matches!(guess.beginning, Beginning::GoesOn(_));
        // What is permanent may have come to its end before what was held out.
        let alone = if is_open {
            STANDS_ALONE
        } else if guess.effect.is_permanent() {
            OUTLASTS_ALONE
        } else {
            f64::INFINITY
        };
        let stands = stands || !tells && found.evidence(index) > alone;
        let is_unseen = !stands && share.is_none_or(|share| share.least() <= 0.0);
        // What is denied goes before what is only not seen.
        let most = match share {
            Some(share) if is_denied => share.most(),
            Some(share) => share.value.max(SEEN),
            None => SEEN,
        };
        let evidence = found.evidence(index);
        if (is_denied || is_unseen) && least.is_none_or(|least| (most, evidence) < (least.most, least.evidence)) {
            least = Some(Denied { index, most, evidence, too_large });
        }
    }
    least
}

/// With how much of its size each effect of `found` is there on `held`; none where nothing can be said.
fn shares(setting: &Setting<'_>, held: &Setting<'_>, found: &Found) -> Vec<Option<Share>> {
    let state = &found.best.state;
    let of = |(index, guess): (usize, &CandidateEffect)| {
        if matches!(guess.beginning, Beginning::GoesOn(_)) {
            return foretold(setting, held.track, found, index);
        }
        is_judged(guess.effect).then(|| share(held, state, index)).flatten()
    };
    state.guesses.iter().enumerate().map(of).collect()
}

/// The share of effect `index`, which goes on from recording to recording: what was held out comes after it, and shows nothing of it
/// but what the base would be without it. All of it where `held` is foretold better with it, its opposite where without it.
fn foretold(setting: &Setting<'_>, held: &Track, found: &Found, index: usize) -> Option<Share> {
    let with = &found.best.state;
    let without = setting.fit_without(with, index)?;
    // Beside the static map, or a misfit of eq. 11 would decide.
    let left = |state: &State| {
        let beside = setting.nuisance.carried(&state.fit.nuisances, setting.track, &found.coordinates);
        Left::of(&AugmentedModel::new(state.model.clone(), state.terms().into_iter().chain(beside).collect()), held)
    };
    let (with, without) = (left(with), left(&without));
    let value = match (without.is_surely_bettered_by(&with), with.is_surely_bettered_by(&without)) {
        (true, _) => 1.0,
        (false, true) => -1.0,
        (false, false) => return None,
    };
    Some(Share { value, error: 0.0 })
}

/// Whether other recordings can tell of `effect`: an event is none of theirs, and in the place of a smooth static effect the static
/// map would do as well.
fn is_judged(effect: &dyn Effect) -> bool {
    effect.kind() != Kind::Event && (!effect.is_static() || effect.is_local())
}

/// Share of its size with which an effect is there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Share {
    pub(crate) value: f64,
    /// Standard error.
    pub(crate) error: f64,
}

impl Share {
    /// What `shares` of different recordings say together; none where there are none.
    pub(crate) fn pooled(shares: &[Self]) -> Option<Self> {
        let weight: f64 = shares.iter().map(|share| share.error.powi(-2)).sum();
        let value = shares.iter().map(|share| share.value * share.error.powi(-2)).sum::<f64>() / weight;
        (weight > 0.0 && value.is_finite()).then(|| Self { value, error: weight.sqrt().recip() })
    }

    /// Whether it surely shows the effect.
    pub(crate) fn shows(self) -> bool {
        self.least() > SEEN
    }

    /// Whether it surely speaks against `effect`: it is not there, or something larger is.
    pub(crate) fn denies(self, effect: &dyn Effect) -> bool {
        // What is permanent may have come to its end before: only the opposite denies it.
        let least_seen = if effect.is_permanent() { 0.0 } else { SEEN };
        self.is_too_large(effect) || self.most() < least_seen
    }

    /// Whether something is surely there, but more than `effect`.
    fn is_too_large(self, effect: &dyn Effect) -> bool {
        !effect.outlasts() && self.least() > MOST_SEEN
    }

    fn most(self) -> f64 {
        self.value + SURELY * self.error
    }

    fn least(self) -> f64 {
        self.value - SURELY * self.error
    }
}

/// The share of effect `index` on what was held out; none where nothing can be said.
fn share(held: &Setting<'_>, state: &State, index: usize) -> Option<Share> {
    let whole_n = held.track.modelled_n(&AugmentedModel::new(state.model.clone(), state.terms()).elsewhere());
    let mut others = state.terms();
    others.remove(index);
    let rest_n = held.track.modelled_n(&AugmentedModel::new(state.model.clone(), others).elsewhere());
    let base_n = held.track.modelled_n(&AugmentedModel::new(state.model.clone(), Vec::new()));
    // What went before a recording is not known.
    let guess = &state.guesses[index];
    let nuisance = if guess.effect.outlasts() {
        let moments = held.fit(Vec::new(), &state.fit.x[..held.space.free.len()], &state.model)?;
        held.begun(held.nuisance, &moments, guess)
    } else {
        held.nuisance.clone()
    };
    let left_of = |modelled_n: &[f64]| {
        let mut track = held.track.clone();
        for (instant, (modelled, base)) in track.instants.iter_mut().zip(modelled_n.iter().zip(&base_n)) {
            instant.force_n -= modelled - base;
        }
        let setting = Setting { track: &track, nuisance: &nuisance, ..*held };
        let near = &state.fit.x[..held.space.free.len()];
        let fitted = setting.fit(Vec::new(), near, &state.model)?;
        Some(setting.residuals_n(&fitted))
    };
    let (without, with) = (left_of(&rest_n)?, left_of(&whole_n)?);
    let own: Vec<f64> = without.iter().zip(&with).map(|(without, with)| without - with).collect();
    let counted: Vec<usize> = (0..held.track.n()).filter(|&at| held.track.counted[at]).collect();
    let products = |places: &[usize]| {
        let add =
            |(product, square): (f64, f64), &at: &usize| (product + without[at] * own[at], square + own[at] * own[at]);
        places.iter().fold((0.0, 0.0), add)
    };
    let (product, square) = products(&counted);
    let share = product / square;
    // Without one piece of the recordings after the other: what is left is hardly ever white.
    let parts: Vec<f64> = counted
        .chunks(counted.len().div_ceil(PIECES).max(1))
        .map(|piece| {
            let (piece_product, piece_square) = products(piece);
            (product - piece_product) / (square - piece_square)
        })
        .collect();
    let left: Vec<f64> = without.iter().zip(&own).map(|(without, own)| without - share * own).collect();
    let variance = counted.iter().map(|&at| left[at].powi(2)).sum::<f64>() / counted.len().max(1) as f64;
    // No residual is known better than the sensors.
    let plain = correlated_instants(held, &left) * variance.max(held.floor_square) / square;
    let error = jackknife_stderr(parts.iter().copied()).max(plain.sqrt());
    let seen = (share.is_finite() && error.is_finite()).then_some(Share { value: share, error })?;
    // What is less than half as large as the noise of the sensors may be seen all the same, but not be missed: any misfit hides it.
    let is_small = square < 0.25 * held.floor_square * counted.len() as f64;
    (!is_small || seen.shows() && seen.least() <= MOST_SEEN).then_some(seen)
}

#[cfg(test)]
mod tests;
