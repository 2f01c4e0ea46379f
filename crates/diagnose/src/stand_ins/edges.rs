//! What stands in for something without a name, to the edge of every limit.

use super::*;
use crate::coordinates::Coordinates;
use crate::nuisance::Nuisance;
use crate::rehearsal::tests::Given;
use crate::search::search;
use crate::structure::features;

const PROTOCOLS: [&str; 2] = ["isobaric-triangles", "multisine"];

/// One name beside recordings, and the one coordinate over which structure is looked for.
struct Desk {
    given: Given,
    guess: CandidateEffect,
    coordinate: Coordinate,
    odd: bool,
}

/// Mean squares that a name is judged by, in N².
#[derive(Debug)]
struct Weighed {
    /// What is gained by it.
    gained: f64,
    /// What a function of the coordinate takes up of the rest.
    structure: f64,
}

impl Desk {
    fn ask<T>(&self, ask: impl FnOnce(&Setting<'_>, &Judged, &[Feature]) -> T) -> T {
        let nuisance = Nuisance::of_recordings(&self.given.track, 0.1);
        let plain = Setting { floor_square: 0.01, ..self.given.setting() };
        let setting = plain.beside(&nuisance);
        let state = setting.fit(vec![self.guess.clone()], &self.given.start, &self.given.model).expect("a fit");
        let mut over = features(&setting, &Coordinates::of(&self.given.track));
        over.retain(|feature| !feature.plane && feature.coordinate == self.coordinate && feature.odd == self.odd);
        assert_eq!(over.len(), 1);
        ask(&setting, &judged(&setting, state).expect("folds"), &over)
    }

    fn weighed(&self) -> Weighed {
        self.ask(|setting, best, over| {
            let rest = judged(setting, setting.fit_without(&best.state, 0).expect("a fit")).expect("folds");
            let remainder = ProjectedResidual::of(setting, &best.state);
            let left = |over: &[&Feature]| remainder.structure(over).expect("structure").held_out.mean_square();
            Weighed {
                gained: rest.held_out.mean_square() - best.held_out.mean_square(),
                structure: left(&[]) - left(&[&over[0]]),
            }
        })
    }

    /// Whether the name stays where the whole mismatch is `whole`.
    fn stays(&self, whole: f64, confirmed: bool) -> bool {
        self.ask(|setting, best, over| {
            let left = without(setting, best.clone(), over, whole, confirmed);
            !left.state.guesses.is_empty()
        })
    }
}

/// A desk of which `made` adds something of so many newtons, sized so that its structure is about `share` of what the name gains.
fn sized(share: f64, made: impl Fn(f64) -> Desk) -> (Desk, Weighed) {
    let mut size_n = 20.0;
    for _ in 0..3 {
        let Weighed { gained, structure } = made(size_n).weighed();
        size_n *= (share * gained / structure).sqrt();
    }
    let desk = made(size_n);
    let weighed = desk.weighed();
    let have = weighed.structure / weighed.gained;
    assert!(weighed.gained > 0.0 && (have / share - 1.0).abs() < 0.1, "{size_n} {weighed:?}");
    (desk, weighed)
}

/// A muscle that lags and touches a guard of `size_n`, with the lag named.
fn touching(size_n: f64) -> Desk {
    let mut given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[])]);
    for instant in &mut given.track.instants {
        instant.force_n += size_n * (-((instant.moment.contraction_ratio - 0.05) / 0.012).powi(2)).exp();
    }
    given.disturb();
    let guess = given.guess("pressure-lag", &[0.15, 0.0]);
    Desk { given, guess, coordinate: Coordinate::Contraction, odd: false }
}

/// A muscle with damping and with friction of `size_n` that rises and falls with the speed, with the damping named.
fn sliding(size_n: f64) -> Desk {
    let mut given = Given::of(&PROTOCOLS, &[("viscous-damping", &[], &[600.0, 0.0])]);
    let speed = |at: usize, given: &Given| given.track.instants[at].moment.speed_m_per_s.abs();
    let highest = (0..given.track.n()).map(|at| speed(at, &given)).fold(0.0, f64::max);
    for at in 0..given.track.n() {
        let turns = 3.0 * std::f64::consts::PI * speed(at, &given) / highest;
        given.track.instants[at].force_n += size_n * given.track.instants[at].moment.direction * turns.sin();
    }
    given.disturb();
    let guess = given.guess("viscous-damping", &[]);
    Desk { given, guess, coordinate: Coordinate::Speed, odd: true }
}

/// A muscle with a static force over the contraction that is no lock-up, with a lock-up named.
fn misshapen(coordinate: Coordinate) -> Desk {
    let mut given = Given::of(&PROTOCOLS, &[]);
    for instant in &mut given.track.instants {
        let ratio = instant.moment.contraction_ratio;
        instant.force_n += 3.0 * (60.0 * ratio).sin() - 600.0 * (ratio - 0.12).max(0.0);
    }
    let guess = given.guess("braid-lockup", &[0.12, 0.015]);
    Desk { given, guess, coordinate, odd: false }
}

#[test]
fn a_name_that_gains_less_than_structure_holds_goes_where_both_are_to_be_asked() {
    let (desk, Weighed { gained, structure }) = sized(1.5, touching);
    // Structure of a fifth of the mismatch asks who stands in for it.
    let whole = structure / STRUCTURED;
    assert!(desk.stays(1.02 * whole, false) && !desk.stays(0.98 * whole, false));
    // What explains half of the mismatch does not only stand in.
    let whole = gained / STANDS_FOR_ITSELF;
    assert!(desk.stays(0.98 * whole, false) && !desk.stays(1.02 * whole, false));
    assert!(desk.stays(1.02 * whole, true), "held-out recordings say it better");
}

#[test]
fn a_name_that_gains_more_than_structure_holds_stays_where_no_function_replaces_it() {
    let (desk, Weighed { gained, .. }) = sized(0.7, touching);
    // A little less than half of the mismatch.
    assert!(desk.stays(1.1 * gained / STANDS_FOR_ITSELF, false));
}

#[test]
fn where_an_effect_lives_a_function_of_that_coordinate_does_not_replace_it() {
    let (desk, Weighed { gained, .. }) = sized(0.7, sliding);
    assert!(desk.stays(1.1 * gained / STANDS_FOR_ITSELF, false));
}

#[test]
fn a_static_effect_goes_where_structure_is_left_over_its_own_coordinate_however_much_it_explains() {
    let own = misshapen(Coordinate::Contraction);
    let Weighed { gained, structure } = own.weighed();
    let whole = 0.98 * (structure / STRUCTURED).min(gained / STANDS_FOR_ITSELF);
    assert!(whole > 0.0);
    assert!(!own.stays(whole, false) && !own.stays(whole, true), "nothing that is held out says it better");
    assert!(misshapen(Coordinate::Pressure).stays(whole, false));
    assert!(Desk { odd: true, ..own }.stays(whole, false));
}

#[test]
fn a_name_that_leaves_as_much_as_the_sensors_do_is_not_judged_by_it() {
    let given = Given::of(&["multisine"], &[("pressure-lag", &[0.15, 0.0], &[])]);
    let limits = Limits::of_test(0, 0.1);
    let plain = Setting { floor_square: 0.01, ..given.setting() };
    let mut found = search(&plain, &given.start, &given.model, &limits, &|| {}).expect("a search");
    found.best.state.guesses = vec![given.guess("pressure-lag", &[0.15, 0.0])];
    let sizes = Sizes::of(&found, &limits);
    let sizes = Sizes { floor_square: 0.01, mismatch_n: 10.0, best_n: 9.0, left_n: 0.1, sensors_n: 0.1, ..sizes };
    assert!(!leaves_too_much(&found, &sizes));
    assert!(leaves_too_much(&found, &Sizes { left_n: 0.1 + 1e-9, ..sizes }));
}
