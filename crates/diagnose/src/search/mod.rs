//! Which effects, if any: forward one at a time, with a second look at each that was taken.
//!
//! [`mod@ends`] is what every muscle has beside eq. 11, [`mod@beside`] what a hypothesis is judged beside, [`mod@forward`] the selection itself, [`mod@look`] a look at the catalogue,
//! [`mod@worth`] what a trial must gain, [`mod@settle`] how what was taken settles with what was there.

mod beside;
pub(crate) mod ends;
mod forward;
mod look;
mod settle;
mod worth;

use pam_muscle::Coordinate;
use pam_muscle::effects::Effect;

use crate::coordinates::Coordinates;
use crate::hypothesis::{CandidateEffect, n_effects};
use crate::joint::HeldOut;
use crate::nameless::{OF_THE_BRAID, Other};
use crate::nuisance::{Group, Nuisance};
use crate::stand_ins;
use crate::state::{Setting, State};
use crate::structure::{Feature, ProjectedResidual, Structure, features, telling_force_n};
use crate::trial::{Shapes, Trial};

use beside::kept_map;
pub(crate) use beside::{Beside, fitting};
use ends::Ends;
use forward::{ForwardSelection, Selected};
use look::{FORM_AT_MOST, Look, OddStatic, form_square};
use settle::{at_rest, polished, unless_suspected, without};
pub use worth::chance;

/// Limits of a search.
#[derive(Debug, Clone)]
pub struct Limits {
    /// Most effects that may be taken.
    pub max_effects: usize,
    /// Catalogue ids that are not considered.
    pub excluded: Vec<String>,
    /// Effects of a user's own that are considered beside those of the catalogue.
    pub own: Vec<&'static dyn Effect>,
    /// Excess over the noise floor that matters, in N; where none is given, a third of what noise leaves is worth a name.
    pub matters_above_n: Option<f64>,
    /// What sensor noise alone leaves at the full rate, in N.
    pub sensor_floor_n: f64,
    /// Whether held-out recordings will confirm or deny what is named.
    pub confirmed: bool,
    /// The one effect that is considered, whatever it would be charged beside others; all of them where there is none.
    pub only: Option<&'static str>,
}

impl Limits {
    /// Whether the effect `id` is considered.
    fn allows(&self, id: &str) -> bool {
        self.only.is_none_or(|only| only == id) && !self.excluded.iter().any(|excluded| excluded == id)
    }
}

#[cfg(test)]
impl Limits {
    /// Of a test: at most `max_effects` of the catalogue, in recordings whose sensors leave `sensor_floor_n`; nothing is held out.
    pub(crate) fn of_test(max_effects: usize, sensor_floor_n: f64) -> Self {
        let (excluded, own) = (Vec::new(), Vec::new());
        Self { max_effects, excluded, own, matters_above_n: None, sensor_floor_n, confirmed: false, only: None }
    }
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
    /// Whether the first look was at all of the catalogue.
    pub looked_at_all: bool,
    /// Structure that is left.
    pub left: Option<Structure>,
    /// What was in beside base and effects.
    pub nuisance: Nuisance,
    /// What a static map takes up in any muscle at most: mean square, in N².
    pub form_square: f64,
    /// Ids of what was taken and let go of again, as more is left than it explains.
    pub stand_ins: Vec<&'static str>,
    /// Ids of what was taken and let go of again, as it fits only with a shape that nothing published has.
    pub unheard_of: Vec<&'static str>,
    /// Ids of what was taken and let go of again, as another effect, which does not stand, explains more.
    pub outdone: Vec<&'static str>,
    /// Ids of what was taken and let go of again, as a force that the catalogue has no name for explains more; each with that force, in words.
    pub nameless: Vec<(&'static str, &'static str)>,
    /// Ids of what was taken and let go of again, as something else may be there as well; each with that.
    pub as_well: Vec<(&'static str, &'static Other)>,
    /// Ids of what was taken and let go of again, as a term without a name takes its place.
    pub replaced: Vec<&'static str>,
    /// Ids of static effects that stand for the static map.
    pub of_the_map: Vec<&'static str>,
    /// Ids of what was taken and let go of again, as recordings that nothing was fitted to do not show it.
    pub denied: Vec<&'static str>,
    /// Ids of what was taken and let go of again, as chance may have given it.
    pub by_chance: Vec<&'static str>,
}

impl Found {
    /// What was left before anything was named: beside a static map, or without it where an effect was named in its place.
    pub(crate) fn before(&self) -> &HeldOut {
        let stands = |guess: &CandidateEffect| self.of_the_map.contains(&guess.id());
        let judged = if self.best.state.guesses.iter().any(stands) { &self.base } else { &self.whole };
        &judged.held_out
    }

    /// Evidence for effect `index` within what was fitted, beside the others.
    pub(crate) fn evidence(&self, index: usize) -> f64 {
        self.taken.get(index).map_or(0.0, |taken| taken.without.log_ratio(&taken.with))
    }

    /// Whether recordings that nothing was fitted to surely show effect `index`, with its size.
    pub(crate) fn is_confirmed(&self, index: usize) -> bool {
        self.taken.get(index).is_some_and(|taken| taken.is_confirmed)
    }

    /// Lets go of effect `index`; `setting` has the nuisances that were in. False where the rest determines no fit.
    pub(crate) fn let_go(&mut self, setting: &Setting<'_>, index: usize) -> bool {
        let rest = setting.fit_without(&self.best.state, index).and_then(|state| judged(setting, state));
        let Some(rest) = rest else { return false };
        self.best = rest;
        if index < self.taken.len() {
            self.taken.remove(index);
        }
        let every: Vec<&Feature> = self.features.iter().collect();
        self.left = ProjectedResidual::of(setting, &self.best.state).structure(&every);
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
    /// Whether recordings that nothing was fitted to surely show it, with its size.
    pub is_confirmed: bool,
}

/// Searches; calls `looked` behind every look at the catalogue. `setting` has no nuisances yet.
///
/// Effects with a memory, of rate, time or instruments, are judged beside a free smooth static map, so that no misfit of
/// eq. 11 can call one up or hide it, and beside other forms of what was named before, so that what is left of an effect is
/// not taken for another one. Static effects are what parsimony says about that map: one that takes up nearly all that the
/// map does, with one or two parameters.
pub fn search(
    setting: &Setting<'_>,
    start: &[f64],
    model: &pam_muscle::force::ForceModel,
    limits: &Limits,
    looked: &dyn Fn(),
) -> Option<Found> {
    let track = setting.track;
    let mut coordinates = Coordinates::of(track);
    let of_recordings =
        Nuisance::of_recordings(track, limits.sensor_floor_n).with_reversals(track, &coordinates, model);
    let bare = setting.beside(&of_recordings);
    let base = judged(&bare, bare.fit(Vec::new(), start, model)?)?;
    let seen = track.seen();
    let ends = Ends::of(&bare, &base, &seen);
    let ends_stretch = matches!(ends, Ends::Stretch(..));
    let (of_recordings, base) = match ends {
        Ends::Stretch(nuisance, stretched) => (nuisance, *stretched),
        Ends::Exceeded | Ends::Unseen => (of_recordings, base),
    };
    let beside = Beside::of(setting, &of_recordings, &coordinates, &base)?;
    let best = again(&setting.beside(&beside.smooth), &base)?;
    let (remainder, telling_n) = {
        let mapped = setting.beside(&beside.smooth);
        let remainder = ProjectedResidual::of(&mapped, &best.state);
        let telling_n = telling_force_n(&mapped, &best.state, &remainder);
        (remainder, telling_n)
    };
    coordinates.replace(Coordinate::Force, telling_n);
    let features = features(setting, &coordinates);
    let every: Vec<&Feature> = features.iter().collect();
    let unnamed = remainder.structure(&every);
    let mut floor_square = best.held_out.mean_square();
    if let Some(unnamed) = &unnamed {
        floor_square = floor_square.min(unnamed.held_out.mean_square());
    }
    let mut whole = best.clone();
    let (promising, known) = (Shapes::new(), Shapes::new());
    let mut start = Selected { best, beside, promising, known, floor_square };
    let selection = ForwardSelection {
        setting,
        of_recordings: &of_recordings,
        coordinates: &coordinates,
        seen: &seen,
        limits,
        base: &base,
        whole: &whole,
        looked,
    };
    let (selected, first) = if limits.max_effects > 0 {
        let trials = selection.look(&mut start)?;
        let first = selection.candidates(&start, &trials)?;
        (selection.select(start, trials)?, first)
    } else {
        (start, Vec::new())
    };
    let Selected { mut best, mut beside, promising, mut floor_square, .. } = selected;
    let odd = {
        let (plain, mapped) = (&setting.beside(&beside.plain), &setting.beside(&beside.smooth));
        let look = Look { plain, mapped, free: &beside.free, coordinates: &coordinates, seen: &seen, limits };
        (n_effects(&best.state.guesses) < limits.max_effects).then(|| look.odd_static(&best)).flatten()
    };
    let mut as_well = Vec::new();
    match odd {
        Some(OddStatic::Named(next)) => {
            // The friction takes the place of the odd part of the map from here on.
            beside.smooth = beside.smooth.without(&[Group::OddMap]);
            whole = again(&setting.beside(&beside.smooth), &whole)?;
            best = *next;
        }
        Some(OddStatic::AsWell(id)) => as_well.push((id, &OF_THE_BRAID)),
        None => {}
    }
    let (plain, mapped) = (&setting.beside(&beside.plain), &setting.beside(&beside.smooth));
    let look = Look { plain, mapped, free: &beside.free, coordinates: &coordinates, seen: &seen, limits };
    let mut parsimonious = Vec::new();
    while n_effects(&best.state.guesses) < limits.max_effects {
        let may_be_fixture = !ends_stretch && parsimonious.is_empty();
        let Some(next) = look.static_effect(&best, &base, floor_square, may_be_fixture) else { break };
        parsimonious.push(next.state.guesses[next.state.guesses.len() - 1].id());
        best = next;
    }
    let mismatch = whole.held_out.mean_square() - floor_square;
    if parsimonious.is_empty() {
        best = stand_ins::without(mapped, best, &features, mismatch, limits.confirmed);
    }
    let best = at_rest(mapped, polished(mapped, best)?)?;
    let best = unless_suspected(mapped, best, &seen, &promising);
    let mut taken: Vec<Taken> = Vec::new();
    for index in 0..best.state.guesses.len() {
        let id = best.state.guesses[index].id();
        // What happened several times is weighed together.
        let again_of = best.state.guesses[..index].iter().position(|guess| guess.id() == id);
        if let Some(same) = again_of.and_then(|first| taken.get(first)).cloned() {
            taken.push(same);
            continue;
        }
        let of_the_map = parsimonious.contains(&id);
        let setting = if of_the_map { plain } else { mapped };
        let found = without(setting, &best, index, &seen, &promising);
        let Some((without, rivals)) = found else { continue };
        let with = if of_the_map { again(plain, &best)? } else { best.clone() };
        taken.push(Taken { without: without.held_out, with: with.held_out, rivals, is_confirmed: false });
    }
    let (best, nuisance) = kept_map(plain, best, beside.smooth.clone())?;
    let mapped = plain.beside(&nuisance);
    let left = ProjectedResidual::of(&mapped, &best.state).structure(&every);
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
        looked_at_all: limits.excluded.is_empty() && limits.only.is_none(),
        left,
        nuisance,
        form_square: form_square(limits.sensor_floor_n, seen.force_n.1 - seen.force_n.0, FORM_AT_MOST),
        stand_ins: Vec::new(),
        outdone: Vec::new(),
        nameless: Vec::new(),
        as_well,
        unheard_of: Vec::new(),
        replaced: Vec::new(),
        of_the_map: parsimonious,
        denied: Vec::new(),
        by_chance: Vec::new(),
    })
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

#[cfg(test)]
mod tests {
    use super::*;

    use pam_muscle::effects::effect;

    use crate::hypothesis::Beginning;
    use crate::rehearsal::tests::Given;

    const PROTOCOLS: [&str; 3] = ["isobaric-triangles", "isometric-ramps", "multisine"];

    /// Names that a search finds in `given`, whose sensors leave 0.3 N.
    fn names(given: &Given) -> Vec<&'static str> {
        let limits = Limits::of_test(3, 0.3);
        let setting = Setting { floor_square: 0.09, ..given.setting() };
        let found = search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search");
        found.best.state.guesses.iter().map(CandidateEffect::id).collect()
    }

    #[test]
    fn what_lacks_nothing_gets_no_name() {
        let mut given = Given::of(&PROTOCOLS, &[]);
        given.disturb();
        assert_eq!(names(&given), Vec::<&str>::new());
    }

    #[test]
    fn a_lag_is_named_and_nothing_beside_it() {
        let mut given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[])]);
        given.disturb();
        assert_eq!(names(&given), ["pressure-lag"]);
    }

    /// What a search finds in `given`, whose sensors leave 0.3 N, if it may take so many effects.
    fn found(given: &Given, max_effects: usize) -> Found {
        let limits = Limits::of_test(max_effects, 0.3);
        let setting = Setting { floor_square: 0.09, ..given.setting() };
        search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search")
    }

    #[test]
    fn no_more_is_taken_than_may_be() {
        let mut given =
            Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[]), ("rubber-hysteresis", &[2e-3], &[20.0])]);
        given.disturb();
        assert_eq!(found(&given, 1).best.state.guesses.len(), 1);
        let none = found(&given, 0);
        assert!(none.best.state.guesses.is_empty() && none.taken.is_empty());
        assert!(none.first.is_empty(), "nobody looked");
    }

    #[test]
    fn the_first_look_has_every_effect_once_and_each_alone() {
        let mut given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[])]);
        given.disturb();
        let found = found(&given, 3);
        let mut first: Vec<&str> = found.first.iter().map(|trial| trial.guess.id()).collect();
        let mut every: Vec<&str> = given.setting().effects.iter().map(|effect| effect.page().id).collect();
        first.sort_unstable();
        every.sort_unstable();
        assert_eq!(first, every);
        // Beside itself, a lag would gain nothing.
        let lag = found.first.iter().find(|trial| trial.guess.id() == "pressure-lag").expect("a trial");
        assert!(lag.log_ratio > 5.0, "{}", lag.log_ratio);
        assert!(found.of_the_map.is_empty() && *found.before() == found.whole.held_out);
        let (without, with) = (found.taken[0].without.mean_square(), found.taken[0].with.mean_square());
        assert!(with < 0.1 * without, "{without} {with}");
    }

    #[test]
    fn a_threshold_is_named_beside_the_map_that_cannot_bend_so_sharply() {
        let mut given = Given::of(&PROTOCOLS, &[("threshold-pressure", &[6e4], &[])]);
        given.disturb();
        let found = found(&given, 3);
        let ids: Vec<&str> = found.best.state.guesses.iter().map(CandidateEffect::id).collect();
        assert_eq!(ids, ["threshold-pressure"]);
        assert!(found.of_the_map.is_empty());
        assert!(*found.before() == found.whole.held_out, "what it is named beside is in before it");
        let (without, with) = (found.taken[0].without.mean_square(), found.taken[0].with.mean_square());
        assert!(with < 0.1 * without, "{without} {with}");
    }

    #[test]
    fn what_the_form_of_a_muscle_leaves_is_a_share_of_the_range_of_the_force() {
        let given = Given::of(&PROTOCOLS, &[]);
        let forces_n = || given.track.instants.iter().zip(&given.track.counted).filter(|(_, counted)| **counted);
        let highest = forces_n().map(|(at, _)| at.force_n).fold(f64::NEG_INFINITY, f64::max);
        let lowest = forces_n().map(|(at, _)| at.force_n).fold(f64::INFINITY, f64::min);
        let expected = (0.015 * (highest - lowest)).powi(2);
        let form_square = found(&given, 0).form_square;
        assert!((form_square - expected).abs() < 1e-9 * expected, "{form_square} {expected}");
    }

    #[test]
    fn rubber_that_stays_soft_from_one_recording_to_the_next_is_named_as_going_on() {
        let mut given = Given::of(&PROTOCOLS, &[]);
        let softening = effect("mullins-softening").expect("an id");
        let beginnings = CandidateEffect::beginnings(softening, &given.track, &given.muscle);
        let goes_on = beginnings.into_iter().find(|one| matches!(one, Beginning::GoesOn(_))).expect("a past");
        let guess = CandidateEffect { beginning: goes_on, ..given.guess("mullins-softening", &[0.03, 0.5]) };
        let sheet = given.setting().ground().sheet(&[guess], &given.model);
        let mut weights = given.columns.weights(given.model.parameters()).to_vec();
        weights.extend([0.3, 0.3]);
        for (at, instant) in given.track.instants.iter_mut().enumerate() {
            instant.force_n = sheet.force_n(at, &weights);
        }
        given.disturb();
        let limits = Limits::of_test(3, 0.3);
        let setting = Setting { floor_square: 0.09, ..given.setting() };
        let found = search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search");
        let guesses = &found.best.state.guesses;
        assert_eq!(guesses.iter().map(CandidateEffect::id).collect::<Vec<_>>(), ["mullins-softening"]);
        assert!(matches!(guesses[0].beginning, Beginning::GoesOn(_)), "{:?}", guesses[0].beginning);
    }

    #[test]
    fn a_smooth_misfit_of_the_base_calls_up_no_effect_with_a_memory() {
        let mut given = Given::of(&PROTOCOLS, &[]);
        given.disturb();
        given.bend(6.0);
        assert!(names(&given).iter().all(|id| effect(id).is_some_and(|effect| effect.is_static())));
    }
}
