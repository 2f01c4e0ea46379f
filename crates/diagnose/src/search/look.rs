//! A look at the catalogue on top of what was taken.

use pam_muscle::Coordinate;
use pam_muscle::effects::{AugmentedModel, Effect, Role, Seen};

use super::ends::{self, Ends};
use super::settle::settle;
use super::worth::LEAST_LOG_RATIO;
use super::{Judged, Limits, again};
use crate::coordinates::Coordinates;
use crate::forms::Forms;
use crate::hypothesis::{Beginning, CandidateEffect};
use crate::nameless::{CLEARLY, friction_by_contraction};
use crate::nuisance::{Group, Nuisance, range};
use crate::plausible::strains;
use crate::state::Setting;
use crate::trial::{self, Shapes, Trial};
use crate::verdict::RIVAL;

/// Share of what the static map takes up that a static effect must take up to be named in its place.
const OF_THE_MAP: f64 = 0.93;

/// Times the sensors' mean square that a static map takes up in any muscle: eq. 11 has the form of none, by some newtons. What
/// is smaller has no name. Of the cases that this was chosen by, wrong static names had 2 to 12 times, right ones 50 to 500.
const FORM: f64 = 25.0;
/// The same as a share of the range of the force, root mean square. Of 70 healthy muscles that this was chosen by, in one half of
/// which eq. 11 holds nowhere, four in five were within it; static effects at their published sizes begin at 0.5 %.
const FORM_SHARE: f64 = 0.0045;
/// The same that no healthy muscle has: the least regular of those 70 had 1.21 %, and of 164 others that were looked at 1.45 %. Of 134
/// nameless mismatches without a name none would be called consistent whatever this is.
pub(super) const FORM_AT_MOST: f64 = 0.015;
/// How much more, in mean squares, the map must take up for an effect that acts through eq. 11: what eq. 11 misses of a muscle looks
/// like another stiffness of its own. Of four such effects that slices called up wrongly, the largest had 1.15 times the limit; of three
/// right ones the smallest had 2.5. Where eq. 11 strains beside the effect, it takes more than any healthy muscle has.
const THROUGH_THE_BASE: f64 = 2.0;

/// Evidence that friction needs beside the even part of the static map, and share of what the odd part takes up: friction has other
/// forms than that of its page. Of 176 cases that these were chosen by, those without such friction gave it 6.0 at most; of seven with it
/// six gave it 27 and more, with shares of 0.7 to 1.
const ODD_LOG_RATIO: f64 = 12.0;
/// See [`ODD_LOG_RATIO`].
const OF_THE_ODD: f64 = 0.5;
/// Evidence that friction of the load must have, where it is all there is, beyond that of friction of the braid whose coefficient changes
/// with the contraction: eq. 11 has one form of that, and muscles have others. Of 22 looked-at names that stand so this is less in seven of
/// nine wrong ones, five of them in healthy muscles, and in one of 13 right ones; with half of it in six and one, with its double in eight
/// and four.
const BEYOND_THE_BRAID: f64 = 0.5;
/// Share of the load that friction has to be to be told from another form of the friction of the braid at all: what all of that is, 3 to
/// 4 % of the load of the nominal muscle. Of 48 looked-at muscles of a stranger whose strands rub as the pressure of their contact has it,
/// 33 that have no such friction are followed better with it, by 0.4 to 2.9 % of the load, with evidence of 12 to 57, and ten were named
/// so. Of 18 others with such a name or doubt two that have such friction lose the name, with 2.2 and 1.7 %.
/// With double of it a third would, with half the ten are named.
const LEAST_OF_THE_LOAD: f64 = 0.03;
/// Share of the load from which on friction that is all there is is none of another form of the friction of the braid: more than all of
/// that is, 3 to 4 % of the load of the nominal muscle (15 to 19 N beside 666, 370 and 167 N at 0, 10 and 20 % contraction and 0.3 MPa, by the
/// same regression). At 3 % a healthy braid whose coefficient falls with the contraction was named. Between this and
/// [`LEAST_OF_THE_LOAD`] the evidence decides.
const NONE_OF_THE_BRAID: f64 = 0.06;

/// What stands for the odd part of the static map.
pub(super) enum OddStatic {
    /// Friction with a name, beside the even part.
    Named(Box<Judged>),
    /// The odd part itself, as another form of the friction of the braid may do as well as the friction with this id.
    AsWell(&'static str),
}

/// What a static map takes up in muscles, in N², where the sensors leave `sensors_n` and the force ranges over `range_n`;
/// `share` of it.
pub(super) fn form_square(sensors_n: f64, range_n: f64, share: f64) -> f64 {
    (FORM * sensors_n.powi(2)).max((share * range_n).powi(2))
}

/// Share of what the static map takes up that a fixture must take up where the muscle grows by more than its ends can: beside the
/// fixture, what eq. 11 misses of any muscle is there as well.
const OF_THE_FIXTURE: f64 = 0.5;
/// Evidence that the same needs.
const FIXTURE_LOG_RATIO: f64 = 8.0;

/// What matters of a static map, in N², where no model gets below `floor_square`.
fn matters(limits: &Limits, floor_square: f64) -> f64 {
    limits.matters_above_n.map_or(floor_square + limits.sensor_floor_n.powi(2), |limit_n| limit_n * limit_n)
}

/// What a static map must take up, in N², before a static effect is named in its place.
#[derive(Debug, Clone, Copy)]
struct Asked {
    /// Of any effect: what matters, and what the form of eq. 11 leaves of any muscle.
    least: f64,
    /// Of one beside which eq. 11 strains: more than any healthy muscle has.
    most: f64,
}

impl Asked {
    /// Where the force ranges over `range_n`, and no model gets below `floor_square`.
    fn of(limits: &Limits, floor_square: f64, range_n: f64) -> Self {
        let matters = matters(limits, floor_square);
        let [form, most] = [FORM_SHARE, FORM_AT_MOST].map(|share| form_square(limits.sensor_floor_n, range_n, share));
        Self { least: matters.max(form), most }
    }

    /// Whether a map that takes up `map` is enough for an effect; `sees` where that acts through eq. 11, `strained` where eq. 11
    /// strains beside it.
    fn is_met(self, map: f64, sees: bool, strained: bool) -> bool {
        let through_base = if sees { THROUGH_THE_BASE * self.least } else { self.least };
        map > if strained { through_base.max(self.most) } else { through_base }
    }
}

/// Whether a static effect that gains `gained` where the map takes up `map`, both in N², stands for it; another one has the evidence
/// `best_ratio` at most. One that is beaten by far is not what it looks like, whatever speaks against the other.
fn stands_for_map(gained: f64, map: f64, log_ratio: f64, best_ratio: f64) -> bool {
    gained > OF_THE_MAP * map && log_ratio > LEAST_LOG_RATIO && log_ratio > RIVAL * best_ratio
}

/// What stands beside forms of what was named.
struct Formed {
    /// The forms, and what is in without a static map.
    nuisance: Nuisance,
    /// The hypothesis beside them.
    bare: Judged,
    /// What a static map takes up there, in N².
    map: f64,
}

/// What every look at the catalogue shares.
pub(super) struct Look<'a> {
    /// Beside the nuisances of the recordings alone.
    pub(super) plain: &'a Setting<'a>,
    /// Beside a smooth static map as well.
    pub(super) mapped: &'a Setting<'a>,
    /// Nuisances with a static map that bends.
    pub(super) free: &'a Nuisance,
    pub(super) coordinates: &'a Coordinates,
    pub(super) seen: &'a Seen,
    pub(super) limits: &'a Limits,
}

impl Look<'_> {
    fn allows(&self, id: &str) -> bool {
        self.limits.allows(id)
    }

    /// Every effect that `best` does not have, on top of it; best first. Beside a map that bends, a static effect is one more
    /// bend; beside a smooth one, one that acts in a part of the range stands out.
    pub(super) fn trials(&self, best: &Judged, known: &Shapes) -> Option<Vec<Trial>> {
        let with_memory = |effect: &dyn Effect| !effect.is_static();
        let local = |effect: &dyn Effect| effect.is_static() && effect.is_local();
        let forms = Forms::of(self.mapped, &best.state, self.coordinates);
        let mut tried = self.beside(best, &forms, self.free, known, &with_memory)?;
        tried.extend(self.beside(best, &forms, self.mapped.nuisance, known, &local)?);
        tried.sort_by(|left, right| right.log_ratio.total_cmp(&left.log_ratio));
        Some(tried)
    }

    fn beside(
        &self,
        best: &Judged,
        forms: &Forms,
        map: &Nuisance,
        known: &Shapes,
        wanted: &(dyn Fn(&dyn Effect) -> bool + Sync),
    ) -> Option<Vec<Trial>> {
        let bare = again(&self.plain.beside(map), best)?;
        let formed = forms.beside(map, &self.plain.track.counted);
        let beside = self.plain.beside(&formed);
        let bent = again(&beside, best)?;
        // Other forms that only follow the noise are no better than none.
        let before = if bent.held_out.mean_square() < bare.held_out.mean_square() { &bent } else { &bare };
        let takes = |effect: &dyn Effect| self.allows(effect.page().id) && wanted(effect);
        let mut tried = trial::among(&beside, &bent.state, &before.held_out, self.seen, known, &takes);
        // Beside what was named before, it may be what is left of that, and what was excluded may come nearer.
        if best.state.guesses.is_empty() && self.limits.excluded.is_empty() {
            trial::restore_leaders(&mut tried);
        }
        if self.limits.only.is_some() {
            tried.iter_mut().for_each(|trial| trial.log_ratio = trial.uncharged());
        }
        Some(tried)
    }

    /// What could not be tried on these recordings at all, as what gains nothing.
    pub(super) fn not_tried(&self, best: &Judged, tried: &[Trial]) -> Vec<Trial> {
        let is_missing = |effect: &&&'static dyn Effect| {
            let id = effect.page().id;
            self.allows(id) && tried.iter().all(|trial| trial.guess.id() != id)
        };
        let nothing = |&effect: &&'static dyn Effect| {
            let shape = effect.shape().iter().map(|parameter| parameter.grid[0]).collect();
            let guess =
                CandidateEffect { effect, shape, sign: CandidateEffect::signs(effect)[0], beginning: Beginning::Fresh };
            Trial::gaining_nothing(guess, best.state.fit.mean_square, &best.held_out)
        };
        self.plain.effects.iter().filter(is_missing).map(nothing).collect()
    }

    /// Smooth static effects on top of `best`, each without the part of the map that stands for it.
    pub(super) fn smooth_statics(&self, best: &Judged) -> Option<Vec<Trial>> {
        let smooth = |effect: &dyn Effect| self.allows(effect.page().id) && effect.is_static() && !effect.is_local();
        let even = self.mapped.nuisance.without(&[Group::OddMap]);
        let mut trials = Vec::new();
        for (setting, odd) in [(self.plain, false), (&self.plain.beside(&even), true)] {
            let bare = again(setting, best)?;
            let takes = |effect: &dyn Effect| smooth(effect) && effect.is_odd() == odd;
            trials.extend(trial::among(setting, &bare.state, &bare.held_out, self.seen, &Shapes::new(), &takes));
        }
        Some(trials)
    }

    /// The friction that stands for the odd part of the static map, if there is one, beside the even part: what eq. 11 misses of a
    /// static force is the same in both directions, and neither calls such friction up nor hides it.
    pub(super) fn odd_static(&self, best: &Judged) -> Option<OddStatic> {
        let forms = Forms::of(self.mapped, &best.state, self.coordinates);
        let even = self.mapped.nuisance.without(&[Group::OddMap]);
        let [formed, formed_map] =
            [&even, self.mapped.nuisance].map(|nuisance| forms.beside(nuisance, &self.plain.track.counted));
        let (beside, beside_map) = (self.plain.beside(&formed), self.plain.beside(&formed_map));
        let (bare, with_map) = (again(&beside, best)?, again(&beside_map, best)?);
        let odd = bare.held_out.mean_square() - with_map.held_out.mean_square();
        let matters = self.limits.matters_above_n.map_or(0.0, |limit_n| limit_n * limit_n);
        let frictions = |effect: &dyn Effect| self.allows(effect.page().id) && effect.is_static() && effect.is_odd();
        let trials = trial::among(&beside, &bare.state, &bare.held_out, self.seen, &Shapes::new(), &frictions);
        let stands = |trial: &&Trial| {
            let gained = bare.held_out.mean_square() - trial.held_out.mean_square();
            gained > matters && gained > OF_THE_ODD * odd && trial.log_ratio > ODD_LOG_RATIO
        };
        let friction = trials.iter().find(stands)?;
        // Beside another effect it is likelier that eq. 11 lacks the shape of the friction than that two effects are there. Of 13 looked-at
        // cases in which it stood so five wrong names and a right one go by that.
        let is_alone = best.state.guesses.is_empty();
        let more = if is_alone { BEYOND_THE_BRAID } else { CLEARLY };
        let named = settle(&beside, &bare, friction)?;
        let of_the_load = self.share_of_the_load(&named);
        let is_beyond_the_braid = || friction.log_ratio > self.friction_by_contraction(&beside, &bare) + more;
        let is_heavy = is_alone && of_the_load >= NONE_OF_THE_BRAID;
        if of_the_load < LEAST_OF_THE_LOAD || !is_heavy && !is_beyond_the_braid() {
            return Some(OddStatic::AsWell(friction.guess.id()));
        }
        again(&self.plain.beside(&even), &named).map(|named| OddStatic::Named(Box::new(named)))
    }

    /// Share of the load that the friction is which was named last: the one with which it leaves least of it where it was seen.
    fn share_of_the_load(&self, named: &Judged) -> f64 {
        let state = &named.state;
        let track = self.plain.track;
        let all = state.terms();
        let others = all[..all.len() - 1].to_vec();
        let [with, without] =
            [all, others].map(|terms| track.modelled_n(&AugmentedModel::new(state.model.clone(), terms)));
        let counted = (0..track.n()).filter(|&at| track.counted[at]);
        let (product, square) = counted.fold((0.0, 0.0), |(product, square), at| {
            let moment = track.instants[at].moment;
            let load_n = state.model.force_n(moment.pressure_pa, moment.length_m, 0.0).max(0.0) * moment.direction;
            (product + (without[at] - with[at]) * load_n, square + load_n * load_n)
        });
        if square > 0.0 { product / square } else { 0.0 }
    }

    /// Evidence for friction whose coefficient changes with the contraction, beside `bare`.
    fn friction_by_contraction(&self, beside: &Setting<'_>, bare: &Judged) -> f64 {
        let (low, high) = range(self.coordinates.of_kind(Coordinate::Contraction), &beside.track.counted);
        let force = [friction_by_contraction([low, high])];
        let setting = Setting { effects: &force, ..*beside };
        let tried = trial::among(&setting, &bare.state, &bare.held_out, self.seen, &Shapes::new(), &|_| true);
        tried.first().map_or(0.0, |trial| trial.log_ratio)
    }

    /// `best` beside other forms of what was named: what is left of an effect is none of the map's.
    fn formed(&self, best: &Judged) -> Option<Formed> {
        let forms = Forms::of(self.mapped, &best.state, self.coordinates);
        let [nuisance, with_map] =
            [self.plain, self.mapped].map(|setting| forms.beside(setting.nuisance, &setting.track.counted));
        let bare = again(&self.plain.beside(&nuisance), best)?;
        let mapped = again(&self.plain.beside(&with_map), best)?;
        let map = bare.held_out.mean_square() - mapped.held_out.mean_square();
        Some(Formed { nuisance, bare, map })
    }

    /// `best` with one more static effect, if there is one: a fixture that gives, if that may be one, or what stands for the static map.
    pub(super) fn static_effect(
        &self,
        best: &Judged,
        base: &Judged,
        floor_square: f64,
        may_be_fixture: bool,
    ) -> Option<Judged> {
        let formed = self.formed(best)?;
        let fixture = may_be_fixture.then(|| self.fixture(&formed, floor_square)).flatten();
        fixture.or_else(|| self.of_the_map(&formed, base, floor_square))
    }

    /// Trials of static effects beside `bare`, the same in both directions; best first.
    fn statics(&self, beside: &Setting<'_>, bare: &Judged) -> Vec<Trial> {
        let takes = |effect: &dyn Effect| self.allows(effect.page().id) && effect.is_static() && !effect.is_odd();
        trial::among(beside, &bare.state, &bare.held_out, self.seen, &Shapes::new(), &takes)
    }

    /// With a fixture that gives, where beside what was named the muscle grows longer under force by more than its ends can.
    fn fixture(&self, Formed { nuisance, bare, map }: &Formed, floor_square: f64) -> Option<Judged> {
        let beside = self.plain.beside(nuisance);
        if *map < matters(self.limits, floor_square) || !matches!(Ends::of(&beside, bare, self.seen), Ends::Exceeded) {
            return None;
        }
        let trials = self.statics(&beside, bare);
        // The ends taper beside a fixture that gives as well.
        let others = trials.iter().filter(|trial| ![ends::FIXTURE_ID, ends::TAPER_ID].contains(&trial.guess.id()));
        let rival_ratio = RIVAL * others.map(|trial| trial.log_ratio).fold(0.0, f64::max);
        let fixture = trials.iter().find(|trial| trial.guess.id() == ends::FIXTURE_ID)?;
        let gained = bare.held_out.mean_square() - fixture.held_out.mean_square();
        let stands = gained > OF_THE_FIXTURE * *map && fixture.log_ratio > FIXTURE_LOG_RATIO.max(rival_ratio);
        stands.then(|| again(self.mapped, &settle(&beside, bare, fixture)?)).flatten()
    }

    /// With the static effect that stands for the static map; no fixture, which gives by more than ends do or not at all.
    fn of_the_map(&self, formed: &Formed, base: &Judged, floor_square: f64) -> Option<Judged> {
        let Formed { nuisance, bare, map } = formed;
        let beside = self.plain.beside(nuisance);
        let (low_n, high_n) = self.seen.force_n;
        let asked = Asked::of(self.limits, floor_square, high_n - low_n);
        if *map < asked.least {
            return None;
        }
        let mut trials = self.statics(&beside, bare);
        trials.retain(|trial| trial.guess.id() != ends::FIXTURE_ID);
        let best_ratio = trials.first().map_or(0.0, |trial| trial.log_ratio);
        let gained = |trial: &Trial| bare.held_out.mean_square() - trial.held_out.mean_square();
        let stands = |trial: &&Trial| stands_for_map(gained(trial), *map, trial.log_ratio, best_ratio);
        let named: Vec<(bool, Judged)> = trials
            .iter()
            .filter(stands)
            .filter_map(|trial| settle(&beside, bare, trial))
            .map(|named| (is_strained(&beside, &named, base), named))
            .filter(|(strained, named)| asked.is_met(*map, sees(named), *strained))
            .collect();
        let at_ease = named.iter().find(|(strained, _)| !strained).or(named.first());
        again(self.mapped, &at_ease?.1)
    }
}

/// Whether the last effect of `named` changes what eq. 11 sees.
fn sees(named: &Judged) -> bool {
    named.state.guesses.last().is_some_and(|guess| guess.effect.role() == Role::Sees)
}

/// Whether the last effect of `next`, a static one, strains the base as nothing did before. What changes the reading of a force
/// alone takes nothing of the base's: where the muscle hangs slack, eq. 11 is asked nothing any more.
pub(super) fn is_strained(setting: &Setting<'_>, next: &Judged, base: &Judged) -> bool {
    let pulls = |guess: &CandidateEffect| guess.effect.is_static() && guess.effect.role() != Role::Reads;
    next.state.guesses.last().is_some_and(pulls) && strains(setting, &next.state, &base.state)
}

/// The trials that come anywhere near the best: what may stand in the place of what was taken.
pub(super) fn promise(tried: &[Trial]) -> impl Iterator<Item = (&'static str, Vec<f64>)> {
    let best = tried.first().map_or(0.0, |trial| trial.log_ratio);
    tried
        .iter()
        .filter(move |trial| trial.log_ratio > (0.15 * best).max(0.3))
        .map(|trial| (trial.guess.id(), trial.guess.shape.clone()))
}

#[cfg(test)]
mod tests;

#[cfg(test)]
mod edges;
