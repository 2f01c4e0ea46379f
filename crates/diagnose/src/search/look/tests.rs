use super::*;

use pam_muscle::effects::{Moment, effect};

use crate::hypothesis::Sign;
use crate::joint::HeldOut;
use crate::rehearsal::tests::Given;
use crate::search::judged;

const PROTOCOLS: [&str; 3] = ["isobaric-triangles", "isometric-ramps", "multisine"];

const LAG: (&str, &[f64], &[f64]) = ("pressure-lag", &[0.15, 0.0], &[]);

/// What a look needs that stands still, of recordings whose sensors leave 0.3 N.
struct Desk {
    given: Given,
    coordinates: Coordinates,
    seen: Seen,
    limits: Limits,
}

impl Desk {
    fn of(effects: &[(&'static str, &[f64], &[f64])]) -> Self {
        let mut given = Given::of(&PROTOCOLS, effects);
        given.disturb();
        let (coordinates, seen) = (Coordinates::of(&given.track), Seen::of(given.track.instants.iter()));
        Self { given, coordinates, seen, limits: Limits::of_test(3, 0.3) }
    }

    /// What `ask` finds in a look beside the base model.
    fn look<T>(&self, ask: impl FnOnce(&Look<'_>, &Judged) -> T) -> T {
        let given = &self.given;
        let setting = Setting { floor_square: 0.09, ..given.setting() };
        let plain_nuisance = Nuisance::of_recordings(&given.track, 0.3);
        let map = plain_nuisance.with_map(&given.track, &self.coordinates);
        let free = plain_nuisance.with_free_map(&given.track, &self.coordinates);
        let (plain, mapped) = (setting.beside(&plain_nuisance), setting.beside(&map));
        let base = judged(&plain, plain.fit(Vec::new(), &given.start, &given.model).expect("a fit")).expect("folds");
        let (coordinates, seen, limits) = (&self.coordinates, &self.seen, &self.limits);
        ask(&Look { plain: &plain, mapped: &mapped, free: &free, coordinates, seen, limits }, &base)
    }

    /// Ids of the trials on top of the base model, best first.
    fn tried(&self) -> Vec<&'static str> {
        self.look(|look, base| {
            let tried = look.trials(base, &Shapes::new()).expect("a look");
            assert!(tried.is_sorted_by(|left, right| left.log_ratio >= right.log_ratio));
            tried.iter().map(|trial| trial.guess.id()).collect()
        })
    }

    /// What the static map takes up, in N², and what is asked of it.
    fn map_and_asked(&self) -> (f64, Asked) {
        self.look(|look, base| {
            let (bare, mapped) = (again(look.plain, base).expect("a fit"), again(look.mapped, base).expect("a fit"));
            let range_n = look.seen.force_n.1 - look.seen.force_n.0;
            (bare.held_out.mean_square() - mapped.held_out.mean_square(), Asked::of(look.limits, 0.02, range_n))
        })
    }

    /// The friction that stands for the odd part of the map.
    fn odd_of_the_map(&self) -> Option<&'static str> {
        self.look(|look, base| named(look.odd_static(&again(look.mapped, base)?)?))
    }

    /// The friction in whose place other friction of the braid may be as well.
    fn odd_as_well(&self) -> Option<&'static str> {
        self.look(|look, base| match look.odd_static(&again(look.mapped, base)?)? {
            OddStatic::AsWell(id) => Some(id),
            OddStatic::Named(_) => None,
        })
    }

    /// With friction of so many newtons besides.
    fn rub(mut self, friction_n: impl Fn(&Moment) -> f64) -> Self {
        for instant in &mut self.given.track.instants {
            instant.force_n -= instant.moment.direction * friction_n(&instant.moment);
        }
        self
    }

    /// The same beside a lag that was named.
    fn odd_beside_lag(&self) -> Option<&'static str> {
        self.look(|look, base| {
            let lag = self.given.guess(LAG.0, LAG.1);
            let lagging = judged(look.mapped, look.mapped.fit_near(vec![lag], &base.state)?)?;
            named(look.odd_static(&lagging)?)
        })
    }

    /// The effect that stands for the static map.
    fn of_the_map(&self) -> Option<&'static str> {
        self.look(|look, base| Some(look.of_the_map(&look.formed(base)?, base, 0.02)?.state.guesses[0].id()))
    }

    /// The fixture that gives.
    fn fixture(&self) -> Option<&'static str> {
        self.look(|look, base| Some(look.fixture(&look.formed(base)?, 0.02)?.state.guesses[0].id()))
    }
}

/// The name that was given, if one was.
fn named(odd: OddStatic) -> Option<&'static str> {
    match odd {
        OddStatic::Named(named) => Some(named.state.guesses.last()?.id()),
        OddStatic::AsWell(_) => None,
    }
}

/// A trial of an effect, of the evidence given.
fn trial(id: &str, log_ratio: f64) -> Trial {
    let effect = effect(id).expect("an id");
    let shape = effect.shape().iter().map(|parameter| parameter.grid[0]).collect();
    let guess = CandidateEffect { effect, shape, sign: Sign::Any, beginning: Beginning::Fresh };
    let held_out = HeldOut { blocks: vec![1.0], counts: vec![1.0], floor_square: 0.0 };
    Trial { log_ratio, ..Trial::gaining_nothing(guess, 1.0, &held_out) }
}

#[test]
fn what_a_map_takes_up_in_any_muscle_is_of_the_sensors_or_of_the_range_of_the_force() {
    // Five times what the sensors leave, or the share of the range, whichever is more.
    assert!((form_square(1.0, 100.0, 0.0045) - 25.0).abs() < 1e-12);
    assert!((form_square(0.1, 1000.0, 0.0045) - 4.5 * 4.5).abs() < 1e-12);
}

#[test]
fn a_map_is_asked_for_what_matters_and_for_what_no_healthy_muscle_has() {
    // Sensors of 0.3 N leave 25 times 0.09 N² in any muscle, a range of 1000 N 4.5² N², and at most 15² N².
    let asked = |limits: &Limits, floor_square, range_n| {
        let Asked { least, most } = Asked::of(limits, floor_square, range_n);
        (least, most)
    };
    let near = |(least, most): (f64, f64), expected: (f64, f64)| {
        assert!((least - expected.0).abs() < 1e-9 && (most - expected.1).abs() < 1e-9, "{least} {most}");
    };
    let limits = Limits::of_test(3, 0.3);
    near(asked(&limits, 0.02, 1000.0), (20.25, 225.0));
    near(asked(&limits, 0.02, 10.0), (2.25, 2.25));
    near(asked(&limits, 30.0, 1000.0), (30.09, 225.0));
    near(asked(&Limits { matters_above_n: Some(6.0), ..limits }, 40.0, 1000.0), (36.0, 225.0));
}

#[test]
fn what_acts_through_the_base_or_strains_it_needs_more_of_a_map() {
    let asked = Asked { least: 20.0, most: 180.0 };
    // Above what is asked of an effect, and below.
    for (sees, strained, limit) in
        [(false, false, 20.0), (true, false, 40.0), (false, true, 180.0), (true, true, 180.0)]
    {
        assert!(asked.is_met(limit + 0.1, sees, strained) && !asked.is_met(limit - 0.1, sees, strained), "{limit}");
    }
    let quiet = Asked { least: 120.0, most: 180.0 };
    assert!(quiet.is_met(240.1, true, true) && !quiet.is_met(239.9, true, true), "whichever is more");
}

#[test]
fn an_effect_stands_for_a_map_where_it_gains_nearly_all_of_it_with_evidence() {
    assert!(stands_for_map(93.1, 100.0, 1.6, 1.6));
    assert!(!stands_for_map(92.9, 100.0, 9.0, 9.0) && !stands_for_map(99.0, 100.0, 1.5, 1.5));
    assert!(!stands_for_map(93.0, 100.0, 9.0, 9.0), "no more than the share");
}

#[test]
fn friction_under_load_is_found_whatever_eq_11_misses_of_a_static_force() {
    let rubbing: (&'static str, &[f64], &[f64]) = ("load-dependent-friction", &[], &[0.05, 0.0]);
    let found = |effects: &[(&'static str, &[f64], &[f64])], misfit_n: f64| {
        let mut desk = Desk::of(effects);
        desk.given.bend(misfit_n);
        desk.odd_of_the_map()
    };
    assert_eq!(found(&[rubbing], 0.0), Some("load-dependent-friction"));
    assert_eq!(found(&[rubbing], 15.0), Some("load-dependent-friction"));
    assert_eq!(found(&[], 0.0), None);
    assert_eq!(found(&[], 15.0), None);
    // Friction of another shape is none of the load.
    assert_eq!(found(&[("viscous-damping", &[], &[120.0])], 0.0), None);
}

#[test]
fn friction_is_of_the_load_only_where_no_other_coefficient_does_as_well() {
    let rubbing: (&'static str, &[f64], &[f64]) = ("load-dependent-friction", &[], &[0.05, 0.0]);
    assert_eq!(Desk::of(&[LAG, rubbing]).odd_beside_lag(), Some("load-dependent-friction"));
    assert_eq!(Desk::of(&[LAG]).odd_beside_lag(), None);
    let of_the_braid = |now: &Moment| 8e-5 * now.pressure_pa * (1.15 - 4.0 * now.contraction_ratio);
    assert_eq!(Desk::of(&[LAG]).rub(of_the_braid).odd_beside_lag(), None);
    for desk in [Desk::of(&[LAG]), Desk::of(&[])] {
        let bent = desk.rub(of_the_braid);
        assert_eq!((bent.odd_of_the_map(), bent.odd_as_well()), (None, Some("load-dependent-friction")), "alone");
    }
}

#[test]
fn light_friction_is_none_of_the_load() {
    let model = Desk::of(&[]).given.model;
    let of_the_load = |share: f64| {
        let desk = Desk::of(&[]).rub(|now| share * model.force_n(now.pressure_pa, now.length_m, 0.0).max(0.0));
        (desk.odd_of_the_map(), desk.odd_as_well())
    };
    assert_eq!(of_the_load(0.04), (Some("load-dependent-friction"), None));
    assert_eq!(of_the_load(0.02), (None, Some("load-dependent-friction")));
}

#[test]
fn what_is_excluded_stands_for_no_odd_part() {
    let mut desk = Desk::of(&[("load-dependent-friction", &[], &[0.05, 0.0])]);
    desk.limits.excluded.push("load-dependent-friction".to_owned());
    assert_eq!(desk.odd_of_the_map(), None);
    desk.limits.excluded.clear();
    desk.limits.matters_above_n = Some(40.0);
    assert_eq!(desk.odd_of_the_map(), None, "it does not matter");
}

#[test]
fn only_trials_that_come_near_the_best_promise_anything() {
    let look = [trial("pressure-lag", 10.0), trial("channel-delay", 2.0), trial("force-drift", 1.5)];
    let promising: Vec<&str> = promise(&look).map(|(id, _)| id).collect();
    assert_eq!(promising, ["pressure-lag", "channel-delay"]);
    // Where the best is hardly anything, nothing promises.
    assert_eq!(promise(&[trial("pressure-lag", 0.29)]).count(), 0);
    assert_eq!(promise(&[]).count(), 0);
}

#[test]
fn a_look_finds_the_lag_that_is_there_before_everything_else() {
    let ids = Desk::of(&[("pressure-lag", &[0.15, 0.0], &[])]).tried();
    assert_eq!(ids[0], "pressure-lag");
    // Beside a map that bends, a smooth static effect is one more bend.
    assert!(!ids.contains(&"end-taper"), "{ids:?}");
    assert!(ids.contains(&"threshold-pressure"), "{ids:?}");
}

#[test]
fn what_is_excluded_is_neither_tried_nor_said_not_to_have_been() {
    let mut desk = Desk::of(&[("pressure-lag", &[0.15, 0.0], &[])]);
    desk.limits.excluded.push("pressure-lag".to_owned());
    assert!(!desk.tried().contains(&"pressure-lag"));
    let missing = desk.look(|look, base| look.not_tried(base, &[trial("slack", 1.0)]));
    let ids: Vec<&str> = missing.iter().map(|trial| trial.guess.id()).collect();
    assert!(!ids.contains(&"pressure-lag") && !ids.contains(&"slack"), "{ids:?}");
    assert_eq!(ids.len(), desk.given.setting().effects.len() - 2);
    assert!(missing.iter().all(|trial| trial.log_ratio == 0.0));
}

#[test]
fn smooth_static_effects_are_looked_at_without_the_map_that_stands_for_them() {
    let statics = Desk::of(&[]).look(|look, base| look.smooth_statics(base)).expect("a look");
    assert!(!statics.is_empty());
    let is_smooth = |trial: &Trial| trial.guess.effect.is_static() && !trial.guess.effect.is_local();
    assert!(statics.iter().all(is_smooth));
}

#[test]
fn a_map_that_takes_up_no_more_than_any_muscle_asks_for_stands_for_no_effect() {
    assert_eq!(Desk::of(&[]).of_the_map(), None);
}

#[test]
fn a_threshold_that_the_whole_map_follows_is_named_in_its_place() {
    assert_eq!(Desk::of(&[("threshold-pressure", &[6e4], &[])]).of_the_map(), Some("threshold-pressure"));
}

#[test]
fn what_takes_up_less_than_eq_11_misses_of_any_muscle_gets_no_name() {
    let lock_up = Desk::of(&[("braid-lockup", &[0.15, 0.01], &[300.0])]);
    let (map, asked) = lock_up.map_and_asked();
    assert!(map < 0.8 * asked.least, "{map} {asked:?}");
    assert_eq!(lock_up.of_the_map(), None);
}

#[test]
fn a_fixture_is_named_only_where_it_gives_by_more_than_the_ends_of_a_muscle_do() {
    let soft = |compliance_m_per_n| Desk::of(&[("series-compliance", &[compliance_m_per_n, 0.0, 0.0], &[])]);
    assert_eq!((soft(2e-5).fixture(), soft(2e-5).of_the_map()), (Some("series-compliance"), None));
    assert_eq!((soft(4e-6).fixture(), soft(4e-6).of_the_map()), (None, None));
    let mut limited = soft(2e-5);
    limited.limits.matters_above_n = Some(500.0);
    assert_eq!(limited.fixture(), None);
}

#[test]
fn a_limit_of_what_matters_keeps_smaller_maps_without_a_name() {
    let mut desk = Desk::of(&[("threshold-pressure", &[6e4], &[])]);
    desk.limits.matters_above_n = Some(500.0);
    assert_eq!(desk.of_the_map(), None);
}

#[test]
fn only_what_changes_pressure_or_length_acts_as_the_base_does() {
    let desk = Desk::of(&[]);
    let setting = desk.given.setting();
    let of = |id: &str, shape: &[f64]| {
        let guess = desk.given.guess(id, shape);
        judged(&setting, setting.fit(vec![guess], &desk.given.start, &desk.given.model).expect("a fit")).expect("folds")
    };
    assert!(sees(&of("threshold-pressure", &[2e4])));
    assert!(!sees(&of("end-taper", &[])));
    // What reads a force and what has a memory strain nothing, whatever becomes of the base.
    let base = judged(&setting, setting.fit(Vec::new(), &desk.given.start, &desk.given.model).expect("a fit"));
    let base = base.expect("folds");
    assert!(!is_strained(&setting, &of("viscous-damping", &[]), &base));
    assert!(!is_strained(&setting, &base, &base));
    // Beside half as much force again k1 is what no muscle has.
    let mut stronger = Given::of(&PROTOCOLS, &[]);
    stronger.track.instants.iter_mut().for_each(|instant| instant.force_n *= 1.5);
    let strained = |id: &str, shape: &[f64]| {
        let state = stronger.setting().fit(vec![stronger.guess(id, shape)], &stronger.start, &stronger.model);
        is_strained(&setting, &judged(&setting, state.expect("a fit")).expect("folds"), &base)
    };
    assert!(strained("braid-lockup", &[0.15, 0.01]));
    assert!(!strained("slack", &[0.0, 0.0]) && !strained("viscous-damping", &[]));
}
