//! Which effects, if any: forward one at a time, with a second look at each that was taken.

use pam_core::artifact::diagnosis::Coordinate;
use pam_core::effects::{Effect, Kind, Role, Seen};
use rayon::prelude::*;

use crate::coordinates::Coordinates;
use crate::forms::Forms;
use crate::hypothesis::Guess;
use crate::joint::HeldOut;
use crate::nuisance::Nuisance;
use crate::plausible::strains;
use crate::stand_ins;
use crate::state::{Setting, State};
use crate::structure::{Feature, Remainder, Structure, features, telling_force_n};
use crate::trial::{self, Shapes, Trial};
use crate::uncertainty::correlated_instants;

/// Limits of a search.
#[derive(Debug, Clone)]
pub struct Limits {
    /// Most effects that may be taken.
    pub max_effects: usize,
    /// Catalogue ids that are not considered.
    pub excluded: Vec<String>,
    /// Effects of a user's own that are considered beside those of the catalogue.
    pub own: Vec<&'static dyn Effect>,
    /// Excess over the noise floor that matters, in N; none for half of the floor.
    pub matters_above_n: Option<f64>,
    /// What sensor noise alone leaves at the full rate, in N.
    pub sensor_floor_n: f64,
    /// Whether held-out recordings will confirm or deny what is named.
    pub confirmed: bool,
}

/// A hypothesis with what it leaves.
#[derive(Debug, Clone)]
pub struct Judged {
    /// The hypothesis, fitted.
    pub state: State,
    /// Mean squares over held-out blocks.
    pub held_out: HeldOut,
}

/// What a search found.
#[derive(Debug)]
pub struct Found {
    /// The base model alone.
    pub base: Judged,
    /// The base model beside a static map.
    pub whole: Judged,
    /// Base and effects; the base alone where nothing was taken.
    pub best: Judged,
    /// What was taken with, for each, what would be left without it (everything else refitted).
    pub taken: Vec<Taken>,
    /// The first look: every candidate alone.
    pub first: Vec<Trial>,
    /// Coordinates of every instant.
    pub coordinates: Coordinates,
    /// Features over them.
    pub features: Vec<Feature>,
    /// What no model, named or not, gets below: mean square over held-out blocks, in N².
    pub floor_square: f64,
    /// Structure that is left.
    pub left: Option<Structure>,
    /// What was in beside base and effects.
    pub nuisance: Nuisance,
    /// What a static map takes up in any muscle at most: mean square, in N².
    pub form_square: f64,
    /// Ids of what was taken and let go of again, as more is left than it explains.
    pub stand_ins: Vec<&'static str>,
}

impl Found {
    /// Lets go of effect `index`; `setting` has the nuisances that were in. False where the rest determines no fit.
    pub(crate) fn let_go(&mut self, setting: &Setting<'_>, index: usize) -> bool {
        let rest = setting.fit_without(&self.best.state, index).and_then(|state| judged(setting, state));
        let Some(rest) = rest else { return false };
        self.best = rest;
        if index < self.taken.len() {
            self.taken.remove(index);
        }
        let every: Vec<&Feature> = self.features.iter().collect();
        self.left = Remainder::of(setting, &self.best.state).structure(&every);
        true
    }
}

/// An effect that was taken.
#[derive(Debug, Clone)]
pub struct Taken {
    /// Mean squares over held-out blocks without it.
    pub without: HeldOut,
    /// And with it.
    pub with: HeldOut,
    /// Other effects in its place, best first.
    pub rivals: Vec<Trial>,
}

/// Share of what is left of the mismatch that an effect must explain to be taken.
const LEAST_SHARE: f64 = 0.1;
/// Share of the whole mismatch that a further effect must explain to be taken, unless its evidence is strong.
const LEAST_OF_ALL: f64 = 0.04;
/// The same where held-out recordings will confirm or deny it.
const LEAST_OF_CONFIRMED: f64 = 0.02;
/// Sum of `ln(without / with)` over held-out blocks that an effect must reach: as if one block were explained and nothing
/// lost elsewhere.
const LEAST_LOG_RATIO: f64 = 1.5;
/// The same for a further effect: what is left of those before it is everywhere.
const FURTHER_LOG_RATIO: f64 = 3.0;
/// The same beyond which a further effect is taken however small its share of the whole mismatch.
const STRONG_LOG_RATIO: f64 = 8.0;
/// Times the mean square that the sensors leave beyond which the floor of a search is not theirs.
const SENSORS: f64 = 4.0;

/// Searches; calls `looked` behind every look at the catalogue. `setting` has no nuisances yet.
///
/// Effects with a memory, of rate, time or instruments, are judged beside a free smooth static map, so that no misfit of
/// eq. 11 can call one up or hide it, and beside other forms of what was named before, so that what is left of an effect is
/// not taken for another one. Static effects are what parsimony says about that map: one that takes up nearly all that the
/// map does, with one or two parameters.
pub fn search(
    setting: &Setting<'_>,
    start: &[f64],
    model: &pam_core::force::ForceModel,
    limits: &Limits,
    looked: &dyn Fn(),
) -> Option<Found> {
    let track = setting.track;
    let mut coordinates = Coordinates::of(track);
    let of_recordings =
        Nuisance::of_recordings(track, limits.sensor_floor_n).with_reversals(track, &coordinates, model);
    let bare = setting.beside(&of_recordings);
    let base = judged(&bare, bare.fit(Vec::new(), start, model)?)?;
    let mut beside = Beside::of(setting, &of_recordings, &coordinates, &base)?;
    let mut best = again(&setting.beside(&beside.smooth), &base)?;
    let (remainder, telling_n) = {
        let mapped = setting.beside(&beside.smooth);
        let remainder = Remainder::of(&mapped, &best.state);
        let telling_n = telling_force_n(&mapped, &best.state, &remainder);
        (remainder, telling_n)
    };
    coordinates.replace(Coordinate::Force, telling_n);
    let features = features(setting, &coordinates);
    let seen = Seen::of(track.instants.iter().zip(&track.counted).filter(|(_, counted)| **counted).map(|(at, _)| at));
    let every: Vec<&Feature> = features.iter().collect();
    let unnamed = remainder.structure(&every);
    let mut floor_square = best.held_out.mean_square();
    if let Some(unnamed) = &unnamed {
        floor_square = floor_square.min(unnamed.held_out.mean_square());
    }
    let whole = best.clone();
    let mut first = Vec::new();
    let mut promising = Shapes::new();
    let mut known = Shapes::new();
    let mut looks = 0;
    while best.state.guesses.len() < limits.max_effects {
        let (plain, mapped) = (setting.beside(&beside.plain), setting.beside(&beside.smooth));
        let look =
            Look { plain: &plain, mapped: &mapped, free: &beside.free, coordinates: &coordinates, seen: &seen, limits };
        let tried = look.trials(&best, &known)?;
        looked();
        if looks == 0 {
            first = tried.iter().map(|tried| tried.trial.clone()).collect();
            first.extend(look.smooth_statics(&best)?);
            first.extend(look.not_tried(&best, &first));
        }
        looks += 1;
        known = promise(&tried).collect();
        promising.extend(known.clone());
        for Tried { trial, before } in &tried {
            // What a trial gains beside a free map says nothing of what a smooth one leaves.
            let gained = before.mean_square() - trial.held_out.mean_square();
            floor_square = floor_square.min((best.held_out.mean_square() - gained).max(trial.held_out.mean_square()));
        }
        let next = tried
            .iter()
            .filter(|tried| worth(tried, &best, &whole, floor_square, limits))
            .filter_map(|chosen| settle(&mapped, &best, &chosen.trial))
            .find(|next| !is_strained(&mapped, next, &base));
        let Some(next) = next else { break };
        beside = Beside::of(setting, &of_recordings, &coordinates, &next)?;
        let mapped = setting.beside(&beside.smooth);
        best = again(&mapped, &next)?;
        if looks > 1 {
            best = second_look(&mapped, best, &seen, &promising);
        }
        floor_square = floor_square.min(best.held_out.mean_square());
    }
    let (plain, mapped) = (&setting.beside(&beside.plain), &setting.beside(&beside.smooth));
    let look = Look { plain, mapped, free: &beside.free, coordinates: &coordinates, seen: &seen, limits };
    let mut parsimonious = Vec::new();
    while best.state.guesses.len() < limits.max_effects {
        let Some(next) = look.static_effect(&best, &base, floor_square) else { break };
        parsimonious.push(next.state.guesses[next.state.guesses.len() - 1].id());
        best = next;
    }
    let mismatch = whole.held_out.mean_square() - floor_square;
    if parsimonious.is_empty() {
        best = stand_ins::without(mapped, best, &features, mismatch, limits.confirmed);
    }
    let best = at_rest(mapped, polished(mapped, best)?)?;
    let mut taken = Vec::new();
    for index in 0..best.state.guesses.len() {
        let of_the_map = parsimonious.contains(&best.state.guesses[index].id());
        let setting = if of_the_map { plain } else { mapped };
        let found = without(setting, &best, index, &seen, &promising);
        let Some((without, rivals)) = found else { continue };
        let with = if of_the_map { again(plain, &best)? } else { best.clone() };
        taken.push(Taken { without: without.held_out, with: with.held_out, rivals });
    }
    let (best, nuisance) = kept_map(plain, best, beside.smooth.clone())?;
    let mapped = plain.beside(&nuisance);
    let left = Remainder::of(&mapped, &best.state).structure(&every);
    if let Some(left) = &left {
        floor_square = floor_square.min(left.held_out.mean_square());
    }
    Some(Found {
        base,
        whole,
        best,
        taken,
        first,
        coordinates,
        features,
        floor_square,
        left,
        nuisance,
        form_square: form_square(limits.sensor_floor_n, seen.force_n.1 - seen.force_n.0, FORM_AT_MOST),
        stand_ins: Vec::new(),
    })
}

/// What a hypothesis is judged beside.
struct Beside {
    /// Nuisances of the recordings alone, and what named effects remember of what went before them.
    plain: Nuisance,
    /// A smooth static map as well.
    smooth: Nuisance,
    /// A static map that bends instead.
    free: Nuisance,
}

impl Beside {
    /// For `best`; `of_recordings` is what is in by any means.
    fn of(setting: &Setting<'_>, of_recordings: &Nuisance, coordinates: &Coordinates, best: &Judged) -> Option<Self> {
        let track = setting.track;
        let carried = best.state.guesses.iter().filter(|guess| guess.carried);
        let plain = carried.fold(of_recordings.clone(), |nuisance, guess| setting.begun(&nuisance, &best.state, guess));
        let bare = setting.beside(&plain);
        let (smooth_square, smooth) = fitting(&bare, best, &plain.with_map(track, coordinates))?;
        let (free_square, free) = fitting(&bare, best, &plain.with_free_map(track, coordinates))?;
        // Where bends foretell nothing, there are none.
        let free = if free_square < smooth_square { free } else { smooth.clone() };
        Some(Self { plain, smooth, free })
    }
}

/// How strongly a static map may be drawn to zero, in units of its loosest prior; the last leaves none of it.
const STRENGTHS: [f64; 5] = [1.0, 10.0, 100.0, 1000.0, 1e7];

/// `map` with the prior under which it foretells held-out blocks best, beside `best`: what a few recordings say of a static
/// force somewhere is no license to bend it elsewhere. With what it leaves, as a mean square.
pub(crate) fn fitting(plain: &Setting<'_>, best: &Judged, map: &Nuisance) -> Option<(f64, Nuisance)> {
    let judge = |factor: f64| {
        let tightened = map.tightened(factor);
        Some((again(&plain.beside(&tightened), best)?.held_out.mean_square(), tightened))
    };
    let tried: Vec<(f64, Nuisance)> = STRENGTHS.into_par_iter().filter_map(judge).collect();
    tried.into_iter().min_by(|left, right| left.0.total_cmp(&right.0))
}

/// Share of the mean square over held-out blocks that the static map must take up to be kept.
const WORTH_A_MAP: f64 = 0.02;

/// `best` with the static map, or without where it gains nothing on held-out blocks.
fn kept_map(plain: &Setting<'_>, best: Judged, map: Nuisance) -> Option<(Judged, Nuisance)> {
    let bare = again(plain, &best)?;
    let keeps = best.held_out.mean_square() < (1.0 - WORTH_A_MAP) * bare.held_out.mean_square();
    Some(if keeps { (best, map) } else { (bare, plain.nuisance.clone()) })
}

/// Share of what the static map takes up that a static effect must take up to be named in its place.
const OF_THE_MAP: f64 = 0.93;

/// Times the sensors' mean square that a static map takes up in any muscle: eq. 11 has the form of none, by some newtons. What
/// is smaller has no name. Of the cases that this was chosen by, wrong static names had 2 to 12 times, right ones 50 to 500.
const FORM: f64 = 25.0;
/// The same as a share of the range of the force, root mean square. Of 70 healthy muscles that this was chosen by, in one half of
/// which eq. 11 holds nowhere, four in five were within it; static effects at their published sizes begin at 0.5 %.
const FORM_SHARE: f64 = 0.0045;
/// The same that no healthy muscle comes near: the least regular of those 70 had 1.21 %.
const FORM_AT_MOST: f64 = 0.0135;

/// What a static map takes up in muscles, in N², where the sensors leave `sensors_n` and the force ranges over `range_n`;
/// `share` of it.
fn form_square(sensors_n: f64, range_n: f64, share: f64) -> f64 {
    (FORM * sensors_n.powi(2)).max((share * range_n).powi(2))
}

/// A trial, and what was left before it.
struct Tried {
    trial: Trial,
    before: HeldOut,
}

/// What every look at the catalogue shares.
struct Look<'a> {
    /// Beside the nuisances of the recordings alone.
    plain: &'a Setting<'a>,
    /// Beside a smooth static map as well.
    mapped: &'a Setting<'a>,
    /// Nuisances with a static map that bends.
    free: &'a Nuisance,
    coordinates: &'a Coordinates,
    seen: &'a Seen,
    limits: &'a Limits,
}

impl Look<'_> {
    fn allows(&self, id: &str) -> bool {
        !self.limits.excluded.iter().any(|excluded| excluded == id)
    }

    /// Every effect that `best` does not have, on top of it; best first. Beside a map that bends, a static effect is one more
    /// bend; beside a smooth one, one that acts in a part of the range stands out.
    fn trials(&self, best: &Judged, known: &Shapes) -> Option<Vec<Tried>> {
        let with_memory = |effect: &dyn Effect| !effect.is_static();
        let local = |effect: &dyn Effect| effect.is_static() && effect.is_local();
        let forms = Forms::of(self.mapped, &best.state, self.coordinates);
        let mut tried = self.beside(best, &forms, self.free, known, &with_memory)?;
        tried.extend(self.beside(best, &forms, self.mapped.nuisance, known, &local)?);
        tried.sort_by(|left, right| right.trial.log_ratio.total_cmp(&left.trial.log_ratio));
        Some(tried)
    }

    fn beside(
        &self,
        best: &Judged,
        forms: &Forms,
        map: &Nuisance,
        known: &Shapes,
        wanted: &(dyn Fn(&dyn Effect) -> bool + Sync),
    ) -> Option<Vec<Tried>> {
        let bare = again(&self.plain.beside(map), best)?;
        let formed = forms.beside(map, &self.plain.track.counted);
        let beside = self.plain.beside(&formed);
        let bent = again(&beside, best)?;
        // Other forms that only follow the noise are no better than none.
        let before = if bent.held_out.mean_square() < bare.held_out.mean_square() { &bent } else { &bare };
        let takes = |effect: &dyn Effect| self.allows(effect.page().id) && wanted(effect);
        let trials = trial::among(&beside, &bent.state, &before.held_out, self.seen, known, &takes);
        Some(trials.into_iter().map(|trial| Tried { trial, before: before.held_out.clone() }).collect())
    }

    /// What could not be tried on these recordings at all, as what gains nothing.
    fn not_tried(&self, best: &Judged, tried: &[Trial]) -> Vec<Trial> {
        let is_missing = |effect: &&&'static dyn Effect| {
            let id = effect.page().id;
            self.allows(id) && tried.iter().all(|trial| trial.guess.id() != id)
        };
        let nothing = |&effect: &&'static dyn Effect| {
            let shape = effect.shape().iter().map(|parameter| parameter.grid[0]).collect();
            let guess = Guess { effect, shape, sign: Guess::signs(effect)[0], carried: false };
            let mean_square = best.state.fit.mean_square;
            Trial { guess, mean_square, held_out: best.held_out.clone(), log_ratio: 0.0 }
        };
        self.plain.effects.iter().filter(is_missing).map(nothing).collect()
    }

    /// Smooth static effects on top of `best` without the map that stands for them all.
    fn smooth_statics(&self, best: &Judged) -> Option<Vec<Trial>> {
        let bare = again(self.plain, best)?;
        let smooth = |effect: &dyn Effect| self.allows(effect.page().id) && effect.is_static() && !effect.is_local();
        Some(trial::among(self.plain, &bare.state, &bare.held_out, self.seen, &Shapes::new(), &smooth))
    }

    /// `best` with the static effect that stands for the static map, if there is one.
    fn static_effect(&self, best: &Judged, base: &Judged, floor_square: f64) -> Option<Judged> {
        // What is left of an effect that was named is none of the map's.
        let forms = Forms::of(self.mapped, &best.state, self.coordinates);
        let [formed, formed_map] =
            [self.plain, self.mapped].map(|setting| forms.beside(setting.nuisance, &setting.track.counted));
        let (beside, beside_map) = (self.plain.beside(&formed), self.plain.beside(&formed_map));
        let (bare, with_map) = (again(&beside, best)?, again(&beside_map, best)?);
        let map = bare.held_out.mean_square() - with_map.held_out.mean_square();
        let full_floor = floor_square + self.limits.sensor_floor_n.powi(2);
        let matters = self.limits.matters_above_n.map_or(full_floor, |limit_n| limit_n * limit_n);
        let (low_n, high_n) = self.seen.force_n;
        if map < matters.max(form_square(self.limits.sensor_floor_n, high_n - low_n, FORM_SHARE)) {
            return None;
        }
        let statics = |effect: &dyn Effect| self.allows(effect.page().id) && effect.is_static();
        let trials = trial::among(&beside, &bare.state, &bare.held_out, self.seen, &Shapes::new(), &statics);
        let stands = |trial: &&Trial| {
            let gained = bare.held_out.mean_square() - trial.held_out.mean_square();
            gained > OF_THE_MAP * map && trial.log_ratio > LEAST_LOG_RATIO
        };
        let mut named = trials.iter().filter(stands).filter_map(|trial| settle(&beside, &bare, trial));
        again(self.mapped, &named.find(|named| !is_strained(&beside, named, base))?)
    }
}

/// Whether the last effect of `next`, a static one, strains the base as nothing did before. What changes the reading of a force
/// alone takes nothing of the base's: where the muscle hangs slack, eq. 11 is asked nothing any more.
fn is_strained(setting: &Setting<'_>, next: &Judged, base: &Judged) -> bool {
    let pulls = |guess: &Guess| guess.effect.is_static() && guess.effect.role() != Role::Reads;
    next.state.guesses.last().is_some_and(pulls) && strains(setting, &next.state, &base.state)
}

/// The trials that come anywhere near the best: what may stand in the place of what was taken.
fn promise(tried: &[Tried]) -> impl Iterator<Item = (&'static str, Vec<f64>)> {
    let best = tried.first().map_or(0.0, |tried| tried.trial.log_ratio);
    tried
        .iter()
        .map(|tried| &tried.trial)
        .filter(move |trial| trial.log_ratio > (0.15 * best).max(0.3))
        .map(|trial| (trial.guess.id(), trial.guess.shape.clone()))
}

/// Whether a trial gains more than chance and more than what does not matter.
fn worth(tried: &Tried, best: &Judged, base: &Judged, floor_square: f64, limits: &Limits) -> bool {
    let Tried { trial, before } = tried;
    let gained = before.mean_square() - trial.held_out.mean_square();
    let mismatch = before.mean_square() - floor_square;
    let full_floor = floor_square + limits.sensor_floor_n.powi(2);
    let whole = base.held_out.mean_square() - floor_square;
    let further = !best.state.guesses.is_empty();
    // What the sensors leave is the measure; what else no model gets below is no license to overlook.
    let measure = full_floor.min(SENSORS * limits.sensor_floor_n.powi(2));
    let matters = limits.matters_above_n.map_or(0.25 * measure, |limit_n| limit_n * limit_n);
    let is_confirmed = limits.confirmed && !trial.guess.effect.is_static();
    let least_of_all = if is_confirmed { LEAST_OF_CONFIRMED } else { LEAST_OF_ALL };
    let least_log_ratio = if further { FURTHER_LOG_RATIO } else { LEAST_LOG_RATIO };
    gained > LEAST_SHARE * mismatch
        && gained > matters
        && trial.log_ratio > least_log_ratio
        && (!further || gained > least_of_all * whole || trial.log_ratio > STRONG_LOG_RATIO)
}

/// Probability that an improvement of held-out blocks is chance: a t-test on the log ratios of the blocks that it touches.
pub fn chance(without: &HeldOut, with: &HeldOut) -> f64 {
    let ratios: Vec<f64> = without.log_ratios(with).filter(|ratio| ratio.abs() > 1e-3).collect();
    let n = ratios.len() as f64;
    if n < 3.0 {
        return 1.0;
    }
    let mean = ratios.iter().sum::<f64>() / n;
    let variance = ratios.iter().map(|ratio| (ratio - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let t = mean / (variance / n).sqrt().max(1e-12);
    upper_tail(t)
}

/// Probability that a standard normal variable exceeds `t` (Abramowitz and Stegun, 7.1.26).
fn upper_tail(t: f64) -> f64 {
    let x = t.abs() / std::f64::consts::SQRT_2;
    let k = 1.0 / (1.0 + 0.327_591_1 * x);
    let series =
        k * (0.254_829_592 + k * (-0.284_496_736 + k * (1.421_413_741 + k * (-1.453_152_027 + k * 1.061_405_429))));
    let half = 0.5 * series * (-x * x).exp();
    if t >= 0.0 { half } else { 1.0 - half }
}

/// A state with what it leaves of held-out blocks.
pub(crate) fn judged(setting: &Setting<'_>, state: State) -> Option<Judged> {
    let held_out = setting.hold_out(&state)?;
    Some(Judged { state, held_out })
}

/// The hypothesis of `best` fitted anew in another setting.
pub(crate) fn again(setting: &Setting<'_>, best: &Judged) -> Option<Judged> {
    judged(setting, setting.fit_near(best.state.guesses.clone(), &best.state)?)
}

/// Takes a trial: joint fit, shapes of everything refined once more.
fn settle(setting: &Setting<'_>, best: &Judged, chosen: &Trial) -> Option<Judged> {
    let sampled = setting.sampled();
    let thin = sampled.fit_near(best.state.guesses.clone(), &best.state)?;
    let (_, guess) = trial::refine(&sampled, &thin, &chosen.guess, chosen.mean_square, 1);
    let begun =
        if guess.carried { setting.begun(setting.nuisance, &best.state, &guess) } else { setting.nuisance.clone() };
    let setting = &setting.beside(&begun);
    let sampled = setting.sampled();
    let mut state = trial::with(&sampled, &thin, &guess)?;
    if state.guesses.len() > 1 {
        state = refine_all(&sampled, state)?;
    }
    // What effects take of the base follows the new parameters.
    judged(setting, setting.fit_near(state.guesses.clone(), &state)?)
}

/// What was taken, its shapes refined on every instant, with such details as held-out blocks confirm.
fn polished(setting: &Setting<'_>, best: Judged) -> Option<Judged> {
    if best.state.guesses.iter().all(|guess| guess.shape.is_empty()) {
        return Some(best);
    }
    let sampled = setting.sampled();
    let refined = refine_all(&sampled, sampled.fit_near(best.state.guesses.clone(), &best.state)?)?;
    let plain = judged(setting, setting.fit_near(refined.guesses, &best.state)?)?;
    let plain = if plain.held_out.mean_square() < best.held_out.mean_square() { plain } else { best };
    let detailed = detailed(setting, &plain.state).and_then(|state| judged(setting, state));
    Some(match detailed {
        Some(detailed) if detailed.held_out.mean_square() < plain.held_out.mean_square() => detailed,
        _ => plain,
    })
}

/// Share of the mean square by which a shape must lower it to differ from zero.
const WORTH_A_SHAPE: f64 = 0.01;

/// What was taken, with those of its shapes at zero that the data do not tell from it: they have followed the noise, and
/// other recordings would show it. A length that is held says nothing of its delay.
fn at_rest(setting: &Setting<'_>, best: Judged) -> Option<Judged> {
    let alike = correlated_instants(setting, &setting.residuals_n(&best.state));
    let rows = setting.track.n_counted() as f64 / alike;
    let lowest = best.state.fit.mean_square;
    let mut rested: Option<State> = None;
    for index in 0..best.state.guesses.len() {
        let guess = &best.state.guesses[index];
        if guess.effect.kind() == Kind::Event {
            continue;
        }
        for (parameter, shape) in guess.effect.shape().iter().enumerate() {
            if guess.shape[parameter] == 0.0 || !(shape.range.0..=shape.range.1).contains(&0.0) {
                continue;
            }
            let state = rested.as_ref().unwrap_or(&best.state);
            let mut guesses = state.guesses.clone();
            guesses[index].shape[parameter] = 0.0;
            let Some(state) = setting.fit_near(guesses, state) else { continue };
            // All that rest together.
            let lost = state.fit.mean_square / lowest - 1.0;
            if rows * lost < 1.0 || lost < WORTH_A_SHAPE {
                rested = Some(state);
            }
        }
    }
    match rested {
        Some(state) => judged(setting, state),
        None => Some(best),
    }
}

/// Rounds in which details and the other shapes settle with one another.
const DETAIL_SWEEPS: usize = 10;

/// `state` with the best details of its effects; none where no effect has any.
fn detailed(setting: &Setting<'_>, state: &State) -> Option<State> {
    let sampled = setting.sampled();
    let mut guesses = state.guesses.clone();
    let mut found = false;
    for (index, guess) in guesses.iter_mut().enumerate() {
        let shapes = guess.effect.details(&guess.shape);
        if shapes.is_empty() {
            continue;
        }
        let rest = sampled.fit_without(state, index)?;
        let costs = shapes.into_iter().filter_map(|shape| {
            let guess = Guess { shape, ..guess.clone() };
            Some((trial::mean_square(&sampled, &rest, &guess)?, guess))
        });
        if let Some((_, detailed)) = costs.min_by(|left, right| left.0.total_cmp(&right.0)) {
            *guess = detailed;
            found = true;
        }
    }
    if !found {
        return None;
    }
    let mut thin = sampled.fit_near(guesses, state)?;
    for _ in 0..DETAIL_SWEEPS {
        thin = refine_all(&sampled, thin)?;
    }
    setting.fit_near(thin.guesses, state)
}

/// Refines the shapes of all effects, each with the others as they are.
fn refine_all(setting: &Setting<'_>, state: State) -> Option<State> {
    let mut state = state;
    for index in 0..state.guesses.len() {
        let guess = state.guesses[index].clone();
        let rest = setting.fit_without(&state, index)?;
        let cost = trial::mean_square(setting, &rest, &guess)?;
        let (_, guess) = trial::refine(setting, &rest, &guess, cost, 1);
        let mut guesses = rest.guesses.clone();
        guesses.insert(index, guess);
        state = setting.fit_near(guesses, &state)?;
    }
    Some(state)
}

/// `best` without effect `index`, and what else could stand in its place.
fn without(
    setting: &Setting<'_>,
    best: &Judged,
    index: usize,
    seen: &Seen,
    promising: &Shapes,
) -> Option<(Judged, Vec<Trial>)> {
    let rest = judged(setting, setting.fit_without(&best.state, index)?)?;
    let rivals = trial::among(setting, &rest.state, &rest.held_out, seen, promising, &|effect| {
        promising.contains_key(effect.page().id)
    });
    Some((rest, rivals))
}

/// Looks at every effect that was taken once more: another one in its place, or none.
fn second_look(setting: &Setting<'_>, best: Judged, seen: &Seen, promising: &Shapes) -> Judged {
    let mut best = best;
    for index in 0..best.state.guesses.len() {
        let Some((rest, rivals)) = without(setting, &best, index, seen, promising) else { continue };
        let Some(rival) = rivals.first() else { continue };
        let own = rest.held_out.log_ratio(&best.held_out);
        // As good is not better.
        if rival.log_ratio > own + 0.02 * own.abs() + 0.1
            && rival.guess.id() != best.state.guesses[index].id()
            && let Some(next) = settle(setting, &rest, rival)
        {
            best = next;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    use pam_core::effects::effect;

    use crate::rehearsal::tests::Given;

    const PROTOCOLS: [&str; 3] = ["isobaric-triangles", "isometric-ramps", "multisine"];

    /// Names that a search finds in `given`, whose sensors leave 0.3 N.
    fn names(given: &Given) -> Vec<&'static str> {
        let limits = Limits {
            max_effects: 3,
            excluded: Vec::new(),
            own: Vec::new(),
            matters_above_n: None,
            sensor_floor_n: 0.3,
            confirmed: false,
        };
        let setting = Setting { floor_square: 0.09, ..given.setting() };
        let found = search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search");
        found.best.state.guesses.iter().map(Guess::id).collect()
    }

    /// Noise that neighbors share, of about 0.2 N.
    fn disturb(given: &mut Given) {
        for (at, instant) in given.track.instants.iter_mut().enumerate() {
            let at = at as f64;
            instant.force_n += 0.2 * ((0.37 * at).sin() + (0.011 * at).sin());
        }
    }

    #[test]
    fn what_lacks_nothing_gets_no_name() {
        let mut given = Given::of(&PROTOCOLS, &[]);
        disturb(&mut given);
        assert_eq!(names(&given), Vec::<&str>::new());
    }

    #[test]
    fn a_lag_is_named_and_nothing_beside_it() {
        let mut given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15], &[])]);
        disturb(&mut given);
        assert_eq!(names(&given), ["pressure-lag"]);
    }

    #[test]
    fn a_smooth_misfit_of_the_base_calls_up_no_effect_with_a_memory() {
        let mut given = Given::of(&PROTOCOLS, &[]);
        disturb(&mut given);
        for instant in &mut given.track.instants {
            let (p, e) = (instant.moment.pressure_pa * 2e-6, instant.moment.contraction_ratio * 5.0);
            instant.force_n += 6.0 * (2.5 * p + 2.0 * e).sin() * p;
        }
        assert!(names(&given).iter().all(|id| effect(id).is_some_and(|effect| effect.is_static())));
    }

    #[test]
    fn chance_is_small_where_every_block_gains_and_one_where_none_does() {
        let held = |blocks: Vec<f64>| HeldOut { counts: vec![10.0; blocks.len()], blocks, floor_square: 0.0 };
        let without = held(vec![4.0, 5.0, 4.5, 5.5, 4.0, 6.0]);
        let with = held(vec![1.0, 1.1, 1.0, 1.3, 0.9, 1.4]);
        assert!(chance(&without, &with) < 1e-3);
        assert!((chance(&without, &without) - 1.0).abs() < f64::EPSILON);
    }

    #[test]
    fn what_is_gained_below_the_sensors_floor_counts_for_nothing() {
        let held = |square: f64| HeldOut { blocks: vec![square; 8], counts: vec![10.0; 8], floor_square: 1.0 };
        assert!(held(0.01).log_ratio(&held(0.001)) < 0.1);
        assert!(held(100.0).log_ratio(&held(1.0)) > 20.0);
    }
}
