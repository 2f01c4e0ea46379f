//! Whether a muscle grows longer as it pulls, as one does that is clamped at its ends.
//!
//! Eq. 11 is that of a cylinder. Within about a radius of either clamp the strands straighten as they are pulled, and the muscle
//! behaves as with a spring in series. A fixture that gives looks alike: only one that gives by more than ends can has a name
//! (`series-compliance`), and what is within that stays in beside everything, as tares do.

use pam_muscle::effects::{Effect, Moment, Seen};

use super::settle::settle;
use super::{Judged, again};
use crate::hypothesis::CandidateEffect;
use crate::nuisance::Nuisance;
use crate::state::{Setting, State};
use crate::trial::{self, Shapes};

/// Id of a fixture that gives.
pub(super) const FIXTURE_ID: &str = "series-compliance";

/// Id of ends that taper.
pub(super) const TAPER_ID: &str = "end-taper";

/// Share of the mean square over held-out blocks that the ends must take up: what they take less of is not worth another base. Of 116
/// healthy muscles of slices they take more of 78, of 50 without ends they take at most 0.49 but for one, 0.53.
const WORTH_ENDS: f64 = 0.5;

/// What the ends alone may grow by under the largest force, to first order, in radii of the muscle at rest. Of 116 healthy muscles of slices
/// that this was chosen by, which have ends, 114 grow by less, the median by 0.2; of 50 without ends none by more than 0.23.
const OF_ENDS: f64 = 0.6;
/// What a fixture that gives must give by in the place of such ends, in radii as well: about two thirds of one at either end. Those that were
/// concealed beside them gave by 1.1 to 3.1, what looked like one by 0.7 to 1.8.
const OF_A_FIXTURE: f64 = 1.3;

/// Share of the evidence of another static effect below which it is that effect, which the ends would take a part of.
const BY_FAR: f64 = 0.5;

/// What recordings say of the ends of a muscle.
pub(super) enum Ends {
    /// Nothing.
    Unseen,
    /// The muscle grows as much as ends do: nuisances with that, and the base beside them.
    Stretch(Nuisance, Box<Judged>),
    /// It grows by more.
    Exceeded,
}

impl Ends {
    /// Of the recordings of `bare`, which cover what was `seen` and which `base` was fitted to.
    pub(super) fn of(bare: &Setting<'_>, base: &Judged, seen: &Seen) -> Self {
        // Twice, the second time with the force that eq. 11 has beside them.
        let once = stretched(bare, base, base);
        let Some((nuisance, judged)) = once.and_then(|(_, once)| stretched(bare, base, &once)) else {
            return Self::Unseen;
        };
        let Some(stretch_m) = stretch_m(&bare.beside(&nuisance), &judged.state) else { return Self::Unseen };
        if judged.held_out.mean_square() >= (1.0 - WORTH_ENDS) * base.held_out.mean_square() {
            return Self::Unseen;
        }
        let radii = stretch_m / bare.muscle.rest_radius_m;
        if radii < -OF_ENDS {
            return Self::Unseen;
        }
        let log_ratio = base.held_out.log_ratio(&judged.held_out);
        let is_other = |effect: &dyn Effect| effect.is_static() && !effect.is_odd() && effect.page().id != FIXTURE_ID;
        let others = trial::among(bare, &base.state, &base.held_out, seen, &Shapes::new(), &is_other);
        if others.first().is_some_and(|other| log_ratio < BY_FAR * other.log_ratio) {
            return Self::Unseen;
        }
        if radii > OF_ENDS && given_m(bare, base, seen).is_some_and(|m| m > OF_A_FIXTURE * bare.muscle.rest_radius_m) {
            return Self::Exceeded;
        }
        Self::Stretch(nuisance, Box::new(judged))
    }
}

/// What a fixture beside `base` gives by under the largest force, in m, if it went on below half of that as above it: ends give most before
/// they are straight, and a fixture that gives there alone looks like them.
fn given_m(bare: &Setting<'_>, base: &Judged, seen: &Seen) -> Option<f64> {
    let is_fixture = |effect: &dyn Effect| effect.page().id == FIXTURE_ID;
    let trials = trial::among(bare, &base.state, &base.held_out, seen, &Shapes::new(), &is_fixture);
    let named = settle(bare, base, trials.first()?)?;
    let given_m = |force_n: f64| named.state.guesses.last().map(|guess| length_given_m(bare, guess, force_n));
    let highest_n = seen.force_n.1;
    Some(2.0 * (given_m(highest_n)? - given_m(0.5 * highest_n)?))
}

/// By how much longer than the muscle the recorded length is, with `fixture`, under a force.
fn length_given_m(setting: &Setting<'_>, fixture: &CandidateEffect, force_n: f64) -> f64 {
    let recorded = Moment { force_n, ..Moment::settled(setting.muscle, 0.0, setting.muscle.rest_length_m, 0.0) };
    let mut now = recorded;
    fixture.start_in(0, setting.muscle).sees(&mut now);
    recorded.length_m - now.length_m
}

/// `base` beside a stretch of the ends under the force of `pulling`.
fn stretched(bare: &Setting<'_>, base: &Judged, pulling: &Judged) -> Option<(Nuisance, Judged)> {
    let nuisance = bare.nuisance.with_ends(bare.track, &pulling.state.model);
    let stretched = again(&bare.beside(&nuisance), base)?;
    Some((nuisance, stretched))
}

/// By how much the muscle of `state` grows under the largest force of eq. 11, in m; none where `setting` has no stretch of the ends.
fn stretch_m(setting: &Setting<'_>, state: &State) -> Option<f64> {
    let stretch_m_per_n = setting.nuisance.stretch_m_per_n(&state.fit.nuisances)?;
    let counted = setting.track.instants.iter().zip(&setting.track.counted).filter(|(_, counted)| **counted);
    let forces_n =
        counted.map(|(instant, _)| state.model.force_n(instant.moment.pressure_pa, instant.moment.length_m, 0.0));
    Some(stretch_m_per_n * forces_n.fold(0.0, f64::max))
}

/// By how much longer than eq. 11 has it the muscle of `state` is under its largest force, in words, where `setting` has a stretch of the
/// ends.
pub(crate) fn words(setting: &Setting<'_>, state: &State) -> Option<String> {
    let stretch_m = stretch_m(setting, state)?;
    let than = if stretch_m < 0.0 { "shorter" } else { "longer" };
    Some(format!(
        "under its largest force the muscle is {:.1} mm {than} than eq. 11 has it: its ends are no cylinder, or the fixture gives by as \
         little; a rod in the place of the muscle would tell",
        1e3 * stretch_m.abs()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nuisance::NONE;
    use crate::rehearsal::tests::Given;
    use crate::search::judged;

    /// What is made of a muscle whose recorded length has the stretch of a spring, in m/N, and with what the ends grow by, in mm.
    fn ends(compliance_m_per_n: f64) -> (&'static str, f64) {
        let spring = [compliance_m_per_n, 0.0, 0.0];
        let mut given =
            Given::of(&["isobaric-triangles", "isometric-ramps", "multisine"], &[("series-compliance", &spring, &[])]);
        given.disturb();
        let setting = Setting { floor_square: 0.09, nuisance: &NONE, ..given.setting() };
        let fit = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        match Ends::of(&setting, &judged(&setting, fit).expect("folds"), &given.track.seen()) {
            Ends::Unseen => ("unseen", 0.0),
            Ends::Stretch(nuisance, stretched) => {
                ("ends", 1e3 * stretch_m(&setting.beside(&nuisance), &stretched.state).expect("a stretch"))
            }
            Ends::Exceeded => ("more", 0.0),
        }
    }

    #[test]
    fn a_spring_within_what_ends_do_is_theirs_and_a_softer_one_is_none_of_theirs() {
        // The muscle, whose radius is 9 mm, pulls 700 N.
        assert_eq!(ends(0.0).0, "unseen");
        let (whose, longer_mm) = ends(2e-6);
        assert_eq!(whose, "ends");
        assert!((0.7..2.0).contains(&longer_mm), "{longer_mm}");
        assert_eq!(ends(4e-5).0, "more");
    }
}
