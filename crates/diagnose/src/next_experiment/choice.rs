//! The protocol that tells explanations apart, or confirms one.

use pam_artifact::diagnosis::{NextExperiment, Region, Verdict};
use pam_artifact::model::Domain;
use pam_muscle::effects::{Effect, Kind, Page};

use super::closer::look_closer;
use super::plan::{planned, run_it};
use super::separation::{Explanation, separations};
use super::setpoints::Setpoints;
use crate::protocols::{self, PROTOCOLS, Protocol, Reach};
use crate::search::Found;
use crate::state::{Setting, State};
use crate::verdict::{Sizes, alternatives};

/// Separation as a share of the noise that counts as one.
const LEAST_SHARE_OF_NOISE: f64 = 0.2;
/// Rivals that are weighed against an effect, at most, the best first.
const MOST_RIVALS: usize = 3;
/// Share of the information of the best protocol that a shorter one must bring to be preferred.
const NEARLY: f64 = 0.7;

/// The recording that would tell most, with a path for the rig; none where nothing is in question.
pub(crate) fn next_experiment(
    setting: &Setting<'_>,
    found: &Found,
    verdict: Verdict,
    unexplained: &[Region],
    sizes: &Sizes,
    domain: &Domain,
) -> Option<(NextExperiment, Setpoints)> {
    let best = &found.best.state;
    match verdict {
        Verdict::Consistent => None,
        Verdict::Unexplained => {
            let left_n = if best.guesses.is_empty() { sizes.mismatch_n } else { sizes.left_n };
            look_closer(unexplained.first()?, left_n, best, domain)
        }
        Verdict::Ambiguous => {
            // The first that has rivals; others are settled one after the other.
            let (index, ids) = (0..best.guesses.len())
                .map(|index| (index, alternatives(found, index)))
                .find(|(_, ids)| !ids.is_empty())?;
            let mut explanations = vec![Explanation { id: best.guesses[index].id(), state: best.clone() }];
            let rivals = found.taken[index].rivals.iter().filter(|rival| ids.contains(&rival.guess.id()));
            for rival in rivals.take(MOST_RIVALS) {
                let mut guesses = best.guesses.clone();
                guesses[index] = rival.guess.clone();
                if let Some(state) = setting.fit_near(guesses, best) {
                    explanations.push(Explanation { id: rival.guess.id(), state });
                }
            }
            separate(setting, &explanations, sizes.floor_n, domain)
        }
        Verdict::Explained | Verdict::ExplainedInPart => {
            let evidence = |index: usize| {
                found.taken.get(index).map_or(0.0, |taken| taken.without.log_ratio(&found.best.held_out))
            };
            let index = (0..best.guesses.len()).max_by(|left, right| evidence(*left).total_cmp(&evidence(*right)))?;
            let mut guesses = best.guesses.clone();
            let effect = guesses.remove(index).effect;
            let without = setting.fit_near(guesses, best)?;
            let explanations = [
                Explanation { id: effect.page().id, state: best.clone() },
                Explanation { id: "nothing", state: without },
            ];
            confirm(setting, effect, &explanations, sizes.floor_n, domain)
        }
    }
}

/// The protocol that separates `explanations` best, the first of which is the best one.
fn separate(
    setting: &Setting<'_>,
    explanations: &[Explanation],
    noise_n: f64,
    domain: &Domain,
) -> Option<(NextExperiment, Setpoints)> {
    let first = explanations.first()?;
    let reach = Reach::of(domain, &first.state.model, hangs_slack(explanations));
    let found = separations(setting, &PROTOCOLS, &reach, explanations);
    let most = found.iter().map(|separation| separation.worth(noise_n)).fold(0.0, f64::max);
    // Of those that are nearly as good as the best, the one that the bench is done with first.
    let best = found
        .iter()
        .filter(|separation| separation.worth(noise_n) >= NEARLY * most)
        .min_by(|left, right| left.bench_s.total_cmp(&right.bench_s))?;
    let limit_n = LEAST_SHARE_OF_NOISE * noise_n;
    let mut told_apart = vec![false; explanations.len()];
    let (mut smallest_n, mut at) = (f64::INFINITY, 0);
    for left in 0..explanations.len() {
        for right in left + 1..explanations.len() {
            if best.pairs_n[at] > limit_n {
                (told_apart[left], told_apart[right]) = (true, true);
                smallest_n = smallest_n.min(best.pairs_n[at]);
            }
            at += 1;
        }
    }
    let page = first.state.guesses.iter().find(|guess| guess.id() == first.id).map(|guess| guess.effect.page());
    let test = page
        .and_then(|page| {
            let rivals = &explanations[1..];
            page.confused_with.iter().find(|confusion| rivals.iter().any(|rival| rival.id == confusion.id))
        })
        .map(|confusion| confusion.test)
        .or(page.map(|page| page.test));
    let protocol = protocols::named(best.protocol)?;
    if smallest_n == f64::INFINITY {
        let ids: Vec<&str> = explanations.iter().map(|explanation| explanation.id).collect();
        let largest_n = best.pairs_n.iter().copied().fold(0.0, f64::max);
        let instruction = format!(
            "No recording within the pressures and lengths of the model would tell {} apart: {largest_n:.2} N at most{}",
            ids.join(" and "),
            test.map_or_else(|| ".".to_owned(), |test| format!(". What would: {test}."))
        );
        let ids = ids.into_iter().map(str::to_owned).collect();
        return Some(planned(protocol, &reach, ids, largest_n, instruction));
    }
    let separates = explanations
        .iter()
        .zip(told_apart)
        .filter(|(_, told)| *told)
        .map(|(explanation, _)| explanation.id.to_owned())
        .collect();
    let mut instruction = run_it(protocol, &reach);
    if let Some(test) = test {
        instruction += &format!(" On a bench without a program: {test}.");
    }
    Some(planned(protocol, &reach, separates, smallest_n, instruction))
}

/// The protocol that shows `effect` best, which the first of `explanations` has and the second has not.
fn confirm(
    setting: &Setting<'_>,
    effect: &'static dyn Effect,
    explanations: &[Explanation],
    noise_n: f64,
    domain: &Domain,
) -> Option<(NextExperiment, Setpoints)> {
    let page = effect.page();
    let state = &explanations[0].state;
    let reach = Reach::of(domain, &state.model, hangs_slack(explanations));
    let separates = vec![page.id.to_owned()];
    let own = protocols::named(page.protocol)?;
    if effect.kind() == Kind::Event {
        let instruction = format!("{} What happened once does not come back: {}.", run_it(own, &reach), page.test);
        let step_n = amplitude_of(state, effect).map_or(0.0, f64::abs);
        return Some(planned(own, &reach, separates, step_n, instruction));
    }
    // The protocol of the page was chosen for any muscle; in the reach of this one it may show nothing.
    let of_own = separations(setting, std::slice::from_ref(own), &reach, explanations).pop();
    let best = match of_own.filter(|separation| separation.pairs_n[0] > noise_n) {
        Some(own) => own,
        None => separations(setting, &PROTOCOLS, &reach, explanations)
            .into_iter()
            .max_by(|left, right| left.worth(noise_n).total_cmp(&right.worth(noise_n)))?,
    };
    let protocol = protocols::named(best.protocol)?;
    let instruction = to_confirm(protocol, &reach, page);
    Some(planned(protocol, &reach, separates, best.pairs_n[0], instruction))
}

/// The protocol of the page of `effect`, a mass that was found where a drive starts, stops or turns: one that accelerates it
/// all the time.
pub(crate) fn confirm_mass(
    effect: &'static dyn Effect,
    mass_kg: f64,
    best: &State,
    domain: &Domain,
) -> Option<(NextExperiment, Setpoints)> {
    let page = effect.page();
    let protocol = protocols::named(page.protocol)?;
    let reach = Reach::of(domain, &best.model, best.hangs_slack());
    let instruction = to_confirm(protocol, &reach, page);
    let (mut experiment, setpoints) = planned(protocol, &reach, vec![page.id.to_owned()], 0.0, instruction);
    experiment.separation_n = mass_kg.abs() * setpoints.acceleration_m_per_s2();
    Some((experiment, setpoints))
}

/// How to run a protocol that confirms the effect of `page`, in words.
fn to_confirm(protocol: &Protocol, reach: &Reach<'_>, page: &Page) -> String {
    format!("{} It would confirm {}: {}.", run_it(protocol, reach), page.name, page.test)
}

/// The first amplitude of `effect` in `state`.
fn amplitude_of(state: &State, effect: &'static dyn Effect) -> Option<f64> {
    let position = state.guesses.iter().position(|guess| guess.id() == effect.page().id)?;
    let before: usize = state.guesses[..position].iter().map(|guess| guess.amplitudes().len()).sum();
    state.fit.amplitudes.get(before).copied()
}

fn hangs_slack(explanations: &[Explanation]) -> bool {
    explanations.iter().any(|explanation| explanation.state.hangs_slack())
}

#[cfg(test)]
mod tests;
