//! Which names are borne out: by recordings that nothing was fitted to or, where these cannot tell, by the fitted ones far beyond
//! chance.
//!
//! A name that foretells nothing is no physics that was missing, whatever it gained where it was fitted: what is left of something else
//! and resembles it gains there, too.

use pam_muscle::effects::{AugmentedModel, Effect, Kind};

use crate::carried;
use crate::held_error::Left;
use crate::hypothesis::CandidateEffect;
use crate::named::evidence_of;
use crate::search::Found;
use crate::state::Setting;
use crate::track::Track;
use crate::veto::{UNLIKELY, stands_on_evidence};

/// Share of what is left of held-out recordings beyond the sensors, mean square, that a name must take away to be borne out by them; where
/// its own force is less than that, they cannot tell. Of 180 names that were looked at, 104 of them right, 97 right and 34 wrong ones
/// stand (counted over shares of the first form of the rule); with half of it 99 and 36, with its double 96 and 30.
const LEAST_SHARE: f64 = 0.2;
/// Probability of as much evidence within what was fitted by chance, corrected for multiple comparisons, from which on it is none, whatever
/// held-out recordings say. It was 0.5. Of 180 names that were looked at, a right one and two wrong ones went by half of that; of 244 others,
/// 208 of them right, three wrong ones and no right one lie between this and 0.5, one wrong one between half of this and this.
const LIKELY: f64 = 0.2;

/// Evidence within what was fitted that is strong: a name with less, which held-out recordings do not show, stands on nothing, and one
/// with as much, which is surely there in them, is no chance. Of 374 names in 798 cases that were looked at, 320 of them right, the
/// former takes nine wrong ones and a right one, and the latter gives back three right ones; with half of it these are none and one, and
/// six right and three wrong ones; with its double 14 and 18, and none.
const STRONG: f64 = 8.0;
/// Evidence within what was fitted that is faint, less than odds of twenty to one against chance for any of the 22 effects of the
/// catalogue, `ln(20 * 22)`: that held-out recordings show a name with its size is no proof then, since they may have the same misfit of
/// the base; that they lose half of what is left is. Of 1170 cases that were looked at four wrong names go by it and two right ones; where
/// not even half is enough, seven and five. A step of the force is told by the rows of a recording.
const FAINT: f64 = 6.1;
/// Share of what is left of held-out recordings beyond the sensors with which a name that takes it away is shown, though its own share
/// of size is not sure: half of it. Of the same names six wrong ones and a right one go with half of this, ten and two with all that is
/// left.
const SHOWN: f64 = 0.5;

/// Evidence within what was fitted that no chance gives, together with [`NO_CHANCE`]: hold-outs that are followed worse with a name then
/// say that something is wrong there, and not that it is no name. Of 1,000 cases that were looked at, twelve right names have it that were
/// denied so, and no wrong one.
pub(crate) const OVERWHELMING: f64 = 16.0;
/// See [`OVERWHELMING`].
pub(crate) const NO_CHANCE: f64 = 1e-3;
/// The same of a static effect, since a misfit of eq. 11 is there in every block: of the same cases three right names and none that is
/// wrong.
const NO_CHANCE_OF_STATIC: f64 = 1e-9;

/// What speaks against a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Against {
    /// Held-out recordings, which would show it.
    HeldOut,
    /// That it may be chance.
    Chance,
}

/// Lets go of names of `found` that nothing bears out, those first that take away least of what is left of `held`. Whether it let go of
/// any.
pub(crate) fn let_go_of_others(setting: &Setting<'_>, found: &mut Found, held: &Track) -> bool {
    let mut any = false;
    loop {
        let guesses = &found.best.state.guesses;
        let not_borne_out = (0..guesses.len()).filter_map(|index| {
            let mut others = guesses.clone();
            let effect = others.remove(index).effect;
            // In the place of a static effect the map would do as well.
            let left = |guesses: &[CandidateEffect]| least(setting, found, held, guesses, !effect.is_static());
            let (without, with) = (left(&others), left(guesses));
            let shown = Shown {
                share: share(without, with, setting.floor_square),
                own: own_square(setting, found, held, index)? / beyond(without[0], setting.floor_square),
                is_surely_there: found.is_confirmed(index),
            };
            let against = shown.against(effect, found.evidence(index), evidence_of(found, index).p_value)?;
            Some((index, shown.share, against))
        });
        let first = not_borne_out.min_by(|one, other| one.1.total_cmp(&other.1));
        let Some((index, _, against)) = first else { return any };
        let id = found.best.state.guesses[index].id();
        if !found.let_go(setting, index) {
            return any;
        }
        match against {
            Against::HeldOut => found.denied.push(id),
            Against::Chance => found.by_chance.push(id),
        }
        any = true;
    }
}

/// What held-out recordings show of a name, as shares of what is left of them without it beyond the sensors, mean square.
#[derive(Debug, Clone, Copy)]
struct Shown {
    /// What it takes away.
    share: f64,
    /// Its own force: what it would take away where it is exactly right.
    own: f64,
    /// Whether it is surely there with its size, beside whatever else is missing.
    is_surely_there: bool,
}

impl Shown {
    /// What speaks against `effect`, with so much `evidence` within what was fitted, as chance gives with the probability `chance`; nothing
    /// where it is borne out.
    fn against(self, effect: &dyn Effect, evidence: f64, chance: f64) -> Option<Against> {
        let is_event = effect.kind() == Kind::Event;
        // Where what outlasts a recording begins in them is not known, and its size there no measure.
        let is_there = self.is_surely_there && !effect.outlasts();
        let limit = if self.share >= LEAST_SHARE || is_there { LIKELY } else { UNLIKELY };
        // An event is in one block or two, whatever all of them say.
        let is_sure = self.is_surely_there || is_event && stands_on_evidence(effect, evidence, chance);
        let stands = if evidence >= STRONG {
            is_sure || chance < limit
        } else {
            let is_shown = self.is_surely_there && (evidence >= FAINT || is_event) || self.share >= SHOWN;
            is_shown && chance < limit
        };
        let no_chance = if effect.is_static() { NO_CHANCE_OF_STATIC } else { NO_CHANCE };
        let is_beyond_doubt = evidence >= OVERWHELMING && chance < no_chance;
        if !is_beyond_doubt && self.share < self.least_share(effect, evidence) {
            Some(Against::HeldOut)
        } else {
            (!stands).then_some(Against::Chance)
        }
    }

    /// What `effect` must take away at least. What happened once did not happen there, and where what outlasts a recording begins in them
    /// is not known; where a static effect acts they may not have been, and what has next to no force there may be there. What is surely
    /// there with its size must do no harm: what else is missed there may hide what it takes away.
    fn least_share(self, effect: &dyn Effect, evidence: f64) -> f64 {
        if effect.kind() == Kind::Event || effect.outlasts() {
            f64::NEG_INFINITY
        } else if effect.is_static() || self.own < LEAST_SHARE {
            -LEAST_SHARE
        } else if self.is_surely_there && evidence >= STRONG {
            0.0
        } else {
            LEAST_SHARE
        }
    }
}

/// Mean square of the force that effect `index` of `found` has in `held`, beside the rest as it would be fitted without, in N².
fn own_square(setting: &Setting<'_>, found: &Found, held: &Track, index: usize) -> Option<f64> {
    let best = &found.best.state;
    let [with, without] = [best, &setting.fit_without(best, index)?]
        .map(|state| held.modelled_n(&carried::carried(setting, found, state, &found.nuisance).elsewhere()));
    let squares = with.iter().zip(&without).map(|(with, without)| (with - without).powi(2));
    Some(squares.sum::<f64>() / held.n().max(1) as f64)
}

/// Mean squares of what a model with `guesses` leaves of `held`, in N²: over all instants, and over the counted ones, each beside those
/// of the nuisances with which it leaves least, the static map among them `by_map` alone.
fn least(setting: &Setting<'_>, found: &Found, held: &Track, guesses: &[CandidateEffect], by_map: bool) -> [f64; 2] {
    let least_of = |least: [f64; 2], model: AugmentedModel| {
        let left = Left::of(&model, held).mean_squares();
        [least[0].min(left[0]), least[1].min(left[1])]
    };
    carried::models(setting, found, guesses, by_map).fold([f64::INFINITY; 2], least_of)
}

/// Whether what is left of held-out recordings is so much less `after` than `before`, beyond what sensors leave, `floor_square` in N²,
/// that it bears out what has been added.
pub(crate) fn bears_out(before: &Left, after: &Left, floor_square: f64) -> bool {
    share(before.mean_squares(), after.mean_squares(), floor_square) >= LEAST_SHARE
}

/// Share of what is left `before`, mean squares in N² beyond `floor_square`, that is no longer left `after`: over all instants or the
/// counted ones, whichever shows more. What is taken of the noise itself, as a lag of a noisy pressure does, is none, and what is added
/// within it is no harm.
fn share(before: [f64; 2], after: [f64; 2], floor_square: f64) -> f64 {
    let share =
        |at: usize| (before[at].max(floor_square) - after[at].max(floor_square)) / beyond(before[at], floor_square);
    share(0).max(share(1))
}

/// What is `left` beyond `floor_square`, in N², and as much as that at least: shares of less would be shares of the noise.
fn beyond(left: f64, floor_square: f64) -> f64 {
    (left - floor_square).max(floor_square)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::HeldOut;
    use crate::rehearsal::tests::Given;
    use crate::search::{Limits, Taken, judged, search};

    use pam_muscle::effects::effect;

    /// What speaks against the effect `id`, which has the force `own` in held-out recordings, with strong evidence.
    fn against(id: &str, share: f64, own: f64, chance: f64) -> Option<Against> {
        Shown { share, own, is_surely_there: false }.against(effect(id).expect("an id"), 15.0, chance)
    }

    #[test]
    fn what_others_would_show_is_asked_of_them() {
        for id in ["pressure-lag", "stribeck", "viscoelastic-relaxation"] {
            assert_eq!(against(id, 0.21, 0.5, 0.19), None);
            assert_eq!(against(id, 0.19, 0.5, 1e-9), Some(Against::HeldOut));
        }
    }

    #[test]
    fn what_is_beyond_doubt_is_a_name_whatever_others_lose_by_it() {
        let against = |id: &str, evidence: f64, chance: f64| {
            let shown = Shown { share: -1.0, own: 0.5, is_surely_there: false };
            shown.against(effect(id).expect("an id"), evidence, chance)
        };
        assert_eq!(against("pressure-lag", 16.1, 9e-4), None);
        assert_eq!(against("pressure-lag", 15.9, 9e-4), Some(Against::HeldOut));
        assert_eq!(against("pressure-lag", 60.0, 2e-3), Some(Against::HeldOut));
        assert_eq!(against("slack", 60.0, 1e-8), Some(Against::HeldOut));
        assert_eq!(against("slack", 60.0, 1e-10), None);
    }

    #[test]
    fn what_others_cannot_show_is_asked_of_the_evidence() {
        let cannot = [("force-drift", 0.5), ("slack", 0.5), ("pressure-lag", 0.19)];
        for (id, own) in cannot {
            assert_eq!(against(id, -0.1, own, 9e-3), None);
            assert_eq!(against(id, 0.0, own, 0.011), Some(Against::Chance));
            assert_eq!(against(id, 0.3, own, 0.19), None, "others show it");
        }
        assert_eq!(against("slack", -0.3, 0.5, 1e-9), Some(Against::HeldOut), "it acts there, and is another");
        assert_eq!(against("force-drift", -2.0, 0.5, 1e-9), None, "it begins there anew");
    }

    #[test]
    fn what_others_show_with_its_size_they_deny_only_where_it_does_harm() {
        let lag = effect("pressure-lag").expect("an id");
        let there =
            |share: f64, evidence: f64| Shown { share, own: 0.5, is_surely_there: true }.against(lag, evidence, 1e-9);
        assert_eq!((there(0.01, 8.0), there(-0.01, 8.0)), (None, Some(Against::HeldOut)));
        assert_eq!(there(0.01, 7.9), Some(Against::HeldOut), "and weak evidence needs more");
    }

    #[test]
    fn an_event_is_in_few_blocks_and_stands_on_strong_evidence() {
        let step = effect("force-step").expect("an id");
        let happened =
            |evidence: f64| Shown { share: 0.0, own: 0.5, is_surely_there: false }.against(step, evidence, 0.9);
        assert_eq!((happened(10.1), happened(10.0)), (None, Some(Against::Chance)));
        assert_eq!(against("force-step", -0.1, 0.5, 9e-3), None, "it did not happen there");
        assert_eq!(against("force-step", 0.3, 0.5, 0.19), None, "others show it");
    }

    #[test]
    fn what_chance_gives_often_is_no_evidence_whatever_others_show() {
        assert_eq!(against("pressure-lag", 0.9, 0.9, 0.2), Some(Against::Chance));
    }

    #[test]
    fn a_name_stands_on_evidence_or_on_what_others_show() {
        let lag = effect("pressure-lag").expect("an id");
        let weak =
            |share: f64, is_surely_there: bool| Shown { share, own: 0.1, is_surely_there }.against(lag, 7.9, 1e-9);
        assert_eq!(weak(0.4, false), Some(Against::Chance));
        assert_eq!((weak(0.6, false), weak(0.4, true)), (None, None), "others show it");
        assert_eq!(against("pressure-lag", 0.4, 0.1, 1e-9), None, "evidence is enough");
        let there = |evidence: f64| Shown { share: 0.3, own: 0.3, is_surely_there: true }.against(lag, evidence, 0.6);
        assert_eq!((there(8.0), there(7.9)), (None, Some(Against::Chance)), "both say so");
        let little = |id: &str, evidence: f64, chance: f64| {
            Shown { share: 0.1, own: 0.1, is_surely_there: true }.against(effect(id).expect("an id"), evidence, chance)
        };
        assert_eq!(little("pressure-lag", FAINT, 0.19), None, "what is small may be surely there");
        assert_eq!(
            little("pressure-lag", 6.0, 1e-9),
            Some(Against::Chance),
            "and may be the same misfit where it is faint"
        );
        assert_eq!(little("force-step", 6.0, 1e-9), None, "which a step is not");
        assert_eq!(little("force-drift", FAINT, 0.02), Some(Against::Chance), "and where its beginnings are not known");
    }

    #[test]
    fn a_share_is_of_what_lies_beyond_the_sensors_and_over_the_samples_that_show_more() {
        assert!((share([5.0, 3.0], [3.0, 2.9], 1.0) - 0.5).abs() < 1e-12);
        assert!((share([5.0, 3.0], [4.9, 2.0], 1.0) - 0.5).abs() < 1e-12);
        assert!((share([1.1, 1.1], [1.0, 1.0], 1.0) - 0.1).abs() < 1e-12, "within the noise");
        assert!((share([1.1, 1.1], [0.5, 0.5], 1.0) - 0.1).abs() < 1e-12, "of the noise itself");
        assert!((share([5.0, 3.0], [6.0, 4.0], 1.0) + 0.25).abs() < 1e-12, "harm");
        assert!(share([0.8, 0.5], [0.9, 0.6], 1.0).abs() < 1e-12, "what is within the noise before and after");
    }

    /// Names that stay, and those that held-out recordings deny, of a muscle with so much damping in the fitted recordings and in the
    /// others, where `with` is what was found.
    fn names(damping_n_s_per_m: [f64; 2], with: (&'static str, &[f64])) -> (Vec<&'static str>, Vec<&'static str>) {
        let protocols = ["isobaric-triangles", "multisine"].into_iter().zip(damping_n_s_per_m);
        let [fitted, held] = [0, 1].map(|at| {
            let (protocol, damping) = protocols.clone().nth(at).expect("two");
            let mut given = Given::of(&[protocol], &[("viscous-damping", &[], &[damping, 0.0])]);
            given.disturb();
            given
        });
        let limits = Limits { confirmed: true, ..Limits::of_test(0, 0.3) };
        let plain = Setting { floor_square: 0.09, ..fitted.setting() };
        let mut found = search(&plain, &fitted.start, &fitted.model, &limits, &|| {}).expect("a search");
        let nuisance = found.nuisance.clone();
        let setting = plain.beside(&nuisance);
        let state = setting.fit_near(vec![fitted.guess(with.0, with.1)], &found.best.state);
        found.best = judged(&setting, state.expect("a fit")).expect("a fit of every fold");
        // Strong evidence, and none that is beyond doubt.
        let with = HeldOut { floor_square: 0.0, ..found.best.held_out.clone() };
        let each = (12.0 / with.blocks.len() as f64).exp();
        let without = HeldOut { blocks: with.blocks.iter().map(|square| square * each).collect(), ..with.clone() };
        found.taken = vec![Taken { without, with, rivals: Vec::new(), is_confirmed: false }];
        let did = let_go_of_others(&setting, &mut found, &held.track);
        assert_eq!(did, !found.denied.is_empty() || !found.by_chance.is_empty());
        (found.best.state.guesses.iter().map(CandidateEffect::id).collect(), found.denied)
    }

    #[test]
    fn damping_stays_where_others_have_it_and_goes_where_they_have_none() {
        let damping: (&'static str, &[f64]) = ("viscous-damping", &[]);
        assert_eq!(names([600.0, 600.0], damping), (vec!["viscous-damping"], vec![]));
        assert_eq!(names([600.0, 0.0], damping), (vec![], vec!["viscous-damping"]));
    }
}
