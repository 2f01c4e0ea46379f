//! Which names are borne out: by recordings that nothing was fitted to or, where these cannot tell, by the fitted ones far beyond chance.
//!
//! A name that foretells nothing is no physics that was missing, whatever it gained where it was fitted: what is left of something else
//! and resembles it gains there, too.

use pam_muscle::effects::{AugmentedModel, Effect, Kind};

use crate::carried;
use crate::hypothesis::CandidateEffect;
use crate::named::evidence_of;
use crate::search::Found;
use crate::state::Setting;
use crate::track::Track;

/// Share of what is left of held-out recordings beyond the sensors, mean square, that a name must take away to be borne out by them.
/// Of 180 names that this and the next two were chosen by, 104 of them right, 98 right and 27 wrong ones stand; with half of it 98 and 32, with
/// its double 89 and 14.
const LEAST_SHARE: f64 = 0.25;
/// Probability of as much evidence within what was fitted by chance, corrected for multiple comparisons, from which on it is none, whatever
/// held-out recordings say. With half of it 97 right and 25 wrong ones stand, without it 99 and 32.
const AS_LIKELY: f64 = 0.5;
/// The same beyond which what held-out recordings cannot tell does not stand on it. Half of it changes nothing, its double lets a wrong one more stand.
const UNLIKELY: f64 = 0.005;

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
        let with = least(setting, found, held, guesses);
        let not_borne_out = (0..guesses.len()).filter_map(|index| {
            let mut others = guesses.clone();
            let effect = others.remove(index).effect;
            let share = share(least(setting, found, held, &others), with, setting.floor_square);
            Some((index, share, against(effect, share, evidence_of(found, index).p_value)?))
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

/// What speaks against `effect`, which takes away `share` of what is left of held-out recordings, with evidence that chance gives with the
/// probability `chance`; nothing where it is borne out.
fn against(effect: &dyn Effect, share: f64, chance: f64) -> Option<Against> {
    let limit = if share >= LEAST_SHARE { AS_LIKELY } else { UNLIKELY };
    if share < least_share(effect) { Some(Against::HeldOut) } else { (chance >= limit).then_some(Against::Chance) }
}

/// Share of what is left of held-out recordings that `effect` takes away at least. What happened once did not happen there, and where
/// what outlasts a recording begins in them is not known; where a static effect acts they may not have been.
fn least_share(effect: &dyn Effect) -> f64 {
    if effect.kind() == Kind::Event || effect.outlasts() {
        f64::NEG_INFINITY
    } else if effect.is_static() {
        -LEAST_SHARE
    } else {
        LEAST_SHARE
    }
}

/// Mean squares of what a model with `guesses` leaves of `track`, in N²: over all instants, and over the counted ones, each beside those
/// of the nuisances with which it leaves least.
fn least(setting: &Setting<'_>, found: &Found, track: &Track, guesses: &[CandidateEffect]) -> [f64; 2] {
    let least_of = |least: [f64; 2], model| {
        let left = mean_squares(track, &model);
        [least[0].min(left[0]), least[1].min(left[1])]
    };
    carried::models(setting, found, guesses).fold([f64::INFINITY; 2], least_of)
}

/// Share of what is left `before`, mean squares in N² beyond `floor_square`, that is no longer left `after`: over all instants or the
/// counted ones, whichever shows more.
fn share(before: [f64; 2], after: [f64; 2], floor_square: f64) -> f64 {
    let share = |at: usize| (before[at] - after[at]) / (before[at] - floor_square).max(f64::MIN_POSITIVE);
    share(0).max(share(1))
}

/// Mean squares of what `model` leaves, in N²: over all instants with a force, and over the counted ones.
fn mean_squares(track: &Track, model: &AugmentedModel) -> [f64; 2] {
    let modelled_n = track.modelled_n(&model.elsewhere());
    let mean_square = |takes: &dyn Fn(usize) -> bool| {
        let taken = (0..track.n()).filter(|&at| track.instants[at].force_n.is_finite() && takes(at));
        let squares = taken.map(|at| (track.instants[at].force_n - modelled_n[at]).powi(2));
        let (sum, n) = squares.fold((0.0, 0_u32), |(sum, n), square| (sum + square, n + 1));
        sum / f64::from(n.max(1))
    };
    [mean_square(&|_| true), mean_square(&|at| track.counted[at])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;
    use crate::search::{Limits, judged, search};

    use pam_muscle::effects::effect;

    /// What speaks against the effect `id`.
    fn against_it(id: &str, share: f64, chance: f64) -> Option<Against> {
        against(effect(id).expect("an id"), share, chance)
    }

    #[test]
    fn what_others_would_show_is_asked_of_them_and_what_they_cannot_show_of_the_evidence() {
        for id in ["pressure-lag", "stribeck", "viscoelastic-relaxation"] {
            assert_eq!(against_it(id, 0.26, 0.4), None);
            assert_eq!(against_it(id, 0.24, 1e-9), Some(Against::HeldOut));
        }
        for id in ["force-step", "force-drift", "thermal-softening", "slack"] {
            assert_eq!(against_it(id, -0.1, 1e-3), None);
            assert_eq!(against_it(id, 0.0, 0.01), Some(Against::Chance));
            assert_eq!(against_it(id, 0.3, 0.4), None, "others show it");
        }
        assert_eq!(against_it("slack", -0.3, 1e-9), Some(Against::HeldOut), "it acts there, and is another");
        assert_eq!(against_it("force-drift", -2.0, 1e-9), None, "it begins there anew");
    }

    #[test]
    fn what_chance_gives_as_often_is_no_evidence_whatever_others_show() {
        assert_eq!(against_it("pressure-lag", 0.9, 0.5), Some(Against::Chance));
    }

    #[test]
    fn a_share_is_of_what_lies_beyond_the_sensors_and_over_the_samples_that_show_more() {
        assert!((share([5.0, 3.0], [3.0, 2.9], 1.0) - 0.5).abs() < 1e-12);
        assert!((share([5.0, 3.0], [4.9, 2.0], 1.0) - 0.5).abs() < 1e-12);
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
