//! How what was taken settles with what was there: shapes refined, details confirmed, each looked at once more.

use pam_muscle::effects::{Kind, Seen};

use super::{Judged, judged};
use crate::hypothesis::CandidateEffect;
use crate::joint::HeldOut;
use crate::state::{Setting, State};
use crate::trial::{self, Shapes, Trial};
use crate::uncertainty::correlated_instants;
use crate::verdict::RIVAL;

/// Takes a trial: joint fit, shapes of everything refined once more.
pub(super) fn settle(setting: &Setting<'_>, best: &Judged, chosen: &Trial) -> Option<Judged> {
    let sampled = setting.sampled();
    let thin = sampled.fit_near(best.state.guesses.clone(), &best.state)?;
    let (_, guess) = trial::refine(&sampled, &thin, &chosen.guess, chosen.mean_square, 1);
    let begun = if guess.has_own_beginnings() {
        setting.begun(setting.nuisance, &best.state, &guess)
    } else {
        setting.nuisance.clone()
    };
    let setting = &setting.beside(&begun);
    let sampled = setting.sampled();
    let mut state = trial::with(&sampled, &thin, &guess, &chosen.further)?;
    if state.guesses.len() > 1 {
        state = refine_all(&sampled, state)?;
    }
    // What effects take of the base follows the new parameters.
    judged(setting, setting.fit_near(state.guesses.clone(), &state)?)
}

/// What was taken, its shapes refined on every instant, with such details as held-out blocks confirm.
pub(super) fn polished(setting: &Setting<'_>, best: Judged) -> Option<Judged> {
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

/// Whether a shape says nothing without which the share `lost` of the mean square over so many independent rows is lost.
fn is_nothing(rows: f64, lost: f64) -> bool {
    rows * lost < 1.0 || lost < WORTH_A_SHAPE
}

/// What was taken, with those of its shapes at zero that the data do not tell from it: they have followed the noise, and
/// other recordings would show it. A length that is held says nothing of its delay.
pub(super) fn at_rest(setting: &Setting<'_>, best: Judged) -> Option<Judged> {
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
            if is_nothing(rows, lost) {
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
            let guess = CandidateEffect { shape, ..guess.clone() };
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

/// `best` without effect `index`, however often that happened, and what else could stand in its place.
pub(super) fn without(
    setting: &Setting<'_>,
    best: &Judged,
    index: usize,
    seen: &Seen,
    promising: &Shapes,
) -> Option<(Judged, Vec<Trial>)> {
    let id = best.state.guesses[index].id();
    let others = best.state.guesses.iter().filter(|guess| guess.id() != id).cloned().collect();
    let rest = judged(setting, setting.fit_near(others, &best.state)?)?;
    let rivals = trial::among(setting, &rest.state, &rest.held_out, seen, promising, &|effect| {
        promising.contains_key(effect.page().id)
    });
    Some((rest, rivals))
}

/// Whether a rival of so much evidence is better than what was taken, whose own is `own`: as good is not better.
fn is_better(rival: f64, own: f64) -> bool {
    rival > own + 0.02 * own.abs() + 0.1
}

/// Looks at every effect that was taken once more: another one in its place, or none.
pub(super) fn second_look(setting: &Setting<'_>, best: Judged, seen: &Seen, promising: &Shapes) -> Judged {
    let (mut best, mut index) = (best, 0);
    while index < best.state.guesses.len() {
        if let Some((rest, rivals)) = without(setting, &best, index, seen, promising)
            && let Some(rival) = rivals.first()
            && is_better(rival.log_ratio, rest.held_out.log_ratio(&best.held_out))
            && rival.guess.id() != best.state.guesses[index].id()
            && let Some(next) = settle(setting, &rest, rival)
        {
            best = next;
        }
        index += 1;
    }
    best
}

/// Evidence by which a fault of an instrument must exceed that of what the catalogue says it is confused with and no instrument is at
/// fault for, odds of seven to one: tube, rubber and braid are there in every rig. Of 38 named faults with such a rival that were looked
/// at 27 were right: one of these had 1.2 more evidence than its rival, all others 2.3 to 19; of the eleven wrong ones nine had 1.8 at most.
const SUSPECTED: f64 = 2.0;

/// `best` with what no instrument is at fault for in place of each fault of an instrument that hardly more speaks for.
pub(super) fn unless_suspected(setting: &Setting<'_>, best: Judged, seen: &Seen, promising: &Shapes) -> Judged {
    let (mut best, mut index) = (best, 0);
    while index < best.state.guesses.len() {
        match likelier(setting, &best, index, seen, promising) {
            // It stands behind those that are still to be looked at.
            Some(next) => best = next,
            None => index += 1,
        }
    }
    best
}

/// `best` with what is as likely in place of effect `index`, if that is a fault of an instrument.
fn likelier(setting: &Setting<'_>, best: &Judged, index: usize, seen: &Seen, promising: &Shapes) -> Option<Judged> {
    let fault = best.state.guesses[index].effect;
    if fault.kind() != Kind::Instrument {
        return None;
    }
    let (rest, rivals) = without(setting, best, index, seen, promising)?;
    let gain = |with: &HeldOut| rest.held_out.mean_square() - with.mean_square();
    let own = (rest.held_out.log_ratio(&best.held_out), gain(&best.held_out));
    let is_as_likely = |with: &HeldOut, log_ratio: f64| log_ratio > own.0 - SUSPECTED && gain(with) > RIVAL * own.1;
    let other = rivals.iter().find(|rival| {
        rival.guess.effect.kind() != Kind::Instrument
            && fault.page().confusion_with(rival.guess.id()).is_some()
            && is_as_likely(&rival.held_out, rival.log_ratio)
    })?;
    let next = at_rest(setting, polished(setting, settle(setting, &rest, other)?)?)?;
    is_as_likely(&next.held_out, rest.held_out.log_ratio(&next.held_out)).then_some(next)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    const PROTOCOLS: [&str; 3] = ["isobaric-triangles", "isometric-ramps", "multisine"];

    fn of(given: &Given, id: &str, shape: &[f64]) -> Judged {
        let setting = given.setting();
        let state = setting.fit(vec![given.guess(id, shape)], &given.start, &given.model).expect("a fit");
        judged(&setting, state).expect("a fit of every fold")
    }

    #[test]
    fn a_rival_is_better_by_a_fiftieth_and_a_tenth_whatever_the_sign_of_the_evidence() {
        assert!(is_better(10.31, 10.0) && !is_better(10.29, 10.0));
        assert!(is_better(-9.69, -10.0) && !is_better(-9.71, -10.0));
        assert!(is_better(0.11, 0.0) && !is_better(0.09, 0.0));
    }

    #[test]
    fn a_shape_says_nothing_where_it_loses_less_than_noise_would_or_less_than_a_hundredth() {
        // A fiftieth of fifty rows is what noise loses.
        assert!(is_nothing(49.0, 0.02) && !is_nothing(51.0, 0.02));
        assert!(is_nothing(1e6, 0.0099) && !is_nothing(1e6, 0.0101));
    }

    #[test]
    fn what_was_taken_gives_way_to_what_explains_more_and_to_nothing_else() {
        let mut given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[])]);
        given.disturb();
        let (setting, seen) = (given.setting(), Seen::of(given.track.instants.iter()));
        let promising = Shapes::from([("pressure-lag", vec![0.15, 0.0]), ("channel-delay", vec![0.12, 0.0])]);
        let after = |id: &str, shape: &[f64]| {
            let looked = second_look(&setting, of(&given, id, shape), &seen, &promising);
            looked.state.guesses.iter().map(CandidateEffect::id).collect::<Vec<_>>()
        };
        assert_eq!(after("channel-delay", &[0.12, 0.0]), ["pressure-lag"]);
        assert_eq!(after("pressure-lag", &[0.15, 0.0]), ["pressure-lag"]);
    }

    #[test]
    fn a_fault_of_an_instrument_gives_way_to_what_is_as_likely_without_one_and_stays_where_far_more_speaks_for_it() {
        let after = |truth: &'static str, shape_s: f64, own_s: f64| {
            let mut given = Given::of(&["isometric-ramps"], &[(truth, &[shape_s, 0.0], &[])]);
            given.disturb();
            let (setting, seen) = (given.setting(), Seen::of(given.track.instants.iter()));
            let promising = Shapes::from([("pressure-lag", vec![-own_s, 0.0]), ("channel-delay", vec![own_s, 0.0])]);
            let best = of(&given, "channel-delay", &[own_s, 0.0]);
            let left = unless_suspected(&setting, best, &seen, &promising);
            left.state.guesses.iter().map(CandidateEffect::id).collect::<Vec<_>>()
        };
        // In 3 ms a lag and a delay are the same.
        assert_eq!(after("channel-delay", -0.003, -0.003), ["pressure-lag"]);
        assert_eq!(after("pressure-lag", 0.003, -0.003), ["pressure-lag"]);
        assert_eq!(after("channel-delay", -0.15, -0.15), ["channel-delay"]);
    }

    #[test]
    fn a_lag_that_was_taken_at_a_point_of_its_grid_ends_at_its_own_time() {
        let mut given = Given::of(&PROTOCOLS, &[("pressure-lag", &[0.15, 0.0], &[])]);
        given.disturb();
        let mut best = of(&given, "pressure-lag", &[0.1, 0.0]);
        for _ in 0..3 {
            let before = best.held_out.mean_square();
            best = polished(&given.setting(), best).expect("a fit");
            assert!(best.held_out.mean_square() <= before, "{:?}", best.state.guesses);
        }
        let time_s = best.state.guesses[0].shape[0];
        assert!((time_s - 0.15).abs() < 2e-3, "{time_s}");
    }

    #[test]
    fn a_delay_of_a_channel_that_the_recordings_do_not_tell_rests_at_zero_and_the_other_stays() {
        let mut given = Given::of(&["isometric-ramps"], &[("channel-delay", &[0.06, 0.0], &[])]);
        given.disturb();
        // The length is held: its delay shows in nothing.
        let rested = at_rest(&given.setting(), of(&given, "channel-delay", &[0.06, 0.01])).expect("a fit");
        let shape = &rested.state.guesses[0].shape;
        assert!(shape[1] == 0.0 && (shape[0] - 0.06).abs() < 1e-12, "{shape:?}");
    }
}

#[cfg(test)]
mod cases;
