//! What a diagnosis lists: effects with their evidence, as a report and as a model have them, and what became of the others.

use pam_artifact::diagnosis::{Candidate, EmpiricalTerm, Evidence, NamedEffect};
use pam_artifact::model::{EffectEntry, ParameterEntry, ParameterStatus};
use pam_muscle::effects::{Effect, Sentence, Term};

use crate::hypothesis::CandidateEffect;
use crate::joint::HeldOut;
use crate::mass::MovingMass;
use crate::own;
use crate::search::{Found, chance};
use crate::state::{Setting, State};
use crate::uncertainty::{Uncertainty, entries, shape_errors};
use crate::verdict::alternatives;

/// A static map or a stretch of the ends as a model artifact has it; they have no standard errors of their own.
pub(crate) fn nameless_entry(term: &Term) -> EffectEntry {
    let shapes = term.effect.shape().iter().map(|shape| (shape.name, shape.unit));
    let amplitudes = term.effect.amplitudes().iter().map(|amplitude| (amplitude.name, amplitude.unit));
    let parameters =
        shapes.chain(amplitudes).zip(term.shape.iter().chain(&term.amplitudes)).map(|((name, unit), &value)| {
            let status = ParameterStatus::Fitted;
            ParameterEntry { name: name.to_owned(), value, unit: unit.to_owned(), stderr: None, status }
        });
    EffectEntry::new(term.effect.page().id, parameters.collect())
}

/// A term without a name as a model artifact has it.
pub(crate) fn term_entry(term: &EmpiricalTerm) -> EffectEntry {
    EffectEntry::empirical(term.sentence.clone(), term.parameters.clone())
}

/// `effect` as it is named besides what the search took: nothing else is like it.
pub(crate) fn named_besides(effect: &dyn Effect, parameters: Vec<ParameterEntry>, evidence: Evidence) -> NamedEffect {
    let page = effect.page();
    NamedEffect {
        id: page.id.to_owned(),
        name: page.name.to_owned(),
        equation: page.equation.to_owned(),
        parameters,
        evidence,
        alternatives: Vec::new(),
        separating_test: page.test.to_owned(),
    }
}

/// A mass that moves.
pub(crate) fn moving(mass: &MovingMass) -> NamedEffect {
    let evidence = evidence(&mass.without, &mass.with, 1);
    named_besides(MovingMass::effect(), mass.entries(), evidence)
}

/// What the muscle has been through when the recordings end, where that goes on in others.
pub(crate) fn past_entries(guess: &CandidateEffect) -> impl Iterator<Item = ParameterEntry> {
    guess.effect.keeps().iter().zip(guess.beginning.past().after).map(|(kept, value)| ParameterEntry {
        name: kept.name.to_owned(),
        value,
        unit: kept.unit.to_owned(),
        stderr: None,
        status: ParameterStatus::Fixed,
    })
}

pub(crate) fn evidence(without: &HeldOut, with: &HeldOut, looks: usize) -> Evidence {
    let improved = without.log_ratios(with).filter(|&ratio| ratio > 0.0).count();
    Evidence {
        log_ratio: without.log_ratio(with),
        rmse_without_n: without.mean_square().sqrt(),
        rmse_with_n: with.mean_square().sqrt(),
        blocks_improved: improved,
        n_blocks: without.blocks.len(),
        p_value: (chance(without, with) * looks.max(1) as f64).min(1.0),
    }
}

/// Evidence for effect `index` of `found` within what was fitted, however often it happened, beside the others.
pub(crate) fn evidence_of(found: &Found, index: usize) -> Evidence {
    let (without, with) = match found.taken.get(index) {
        Some(taken) => (&taken.without, &taken.with),
        None => (&found.base.held_out, &found.best.held_out),
    };
    evidence(without, with, found.first.len())
}

/// The effects that were taken and what was named `besides`, in order of evidence, and in that in which a model has them;
/// `correlated` instants of the residual stand for one; `state` is what was found, with terms without a name beside it.
pub(crate) fn named(
    setting: &Setting<'_>,
    found: &Found,
    state: &State,
    uncertainty: &Uncertainty,
    correlated: f64,
    sentences: &[Option<Sentence>],
    besides: Vec<NamedEffect>,
) -> (Vec<NamedEffect>, Vec<EffectEntry>) {
    let (mut named, mut list) = (Vec::new(), Vec::new());
    let mut first = 0;
    for (index, guess) in state.guesses.iter().enumerate() {
        let page = guess.effect.page();
        let errors = shape_errors(setting, state, index, correlated);
        let mut parameters = entries(state, index, first, &errors, uncertainty);
        parameters.extend(past_entries(guess));
        first += guess.amplitudes().len();
        let alternatives = alternatives(found, index);
        let separating_test =
            alternatives.iter().find_map(|id| page.confusion_with(id)).map_or(page.test, |confusion| confusion.test);
        let evidence = evidence_of(found, index);
        let entry = EffectEntry::new(page.id, parameters.clone());
        list.push(own::entry(entry, &sentences[index], guess.shape.len()));
        named.push(NamedEffect {
            id: page.id.to_owned(),
            name: page.name.to_owned(),
            equation: page.equation.to_owned(),
            parameters,
            evidence,
            alternatives: alternatives.into_iter().map(str::to_owned).collect(),
            separating_test: separating_test.to_owned(),
        });
    }
    for other in besides {
        list.push(EffectEntry::new(&other.id, other.parameters.clone()));
        named.push(other);
    }
    let mut named = each_once(named);
    named.sort_by(|left, right| right.evidence.log_ratio.total_cmp(&left.evidence.log_ratio));
    (named, list)
}

/// `named`, of which what happened several times, with the evidence of all, is one with the parameters of each time in order.
fn each_once(named: Vec<NamedEffect>) -> Vec<NamedEffect> {
    let mut once: Vec<(NamedEffect, Vec<Vec<ParameterEntry>>)> = Vec::new();
    for mut effect in named {
        let parameters = std::mem::take(&mut effect.parameters);
        match once.iter_mut().find(|(first, _)| first.id == effect.id) {
            Some((_, times)) => times.push(parameters),
            None => once.push((effect, vec![parameters])),
        }
    }
    let said = |(mut effect, mut times): (NamedEffect, Vec<Vec<ParameterEntry>>)| {
        if times.len() > 1 {
            effect.name = format!("{} ({} times)", effect.name, times.len());
            // By recording and instant.
            let values = |time: &[ParameterEntry]| time.iter().map(|entry| entry.value).collect::<Vec<f64>>();
            times.sort_by(|one, other| values(one).partial_cmp(&values(other)).unwrap_or(std::cmp::Ordering::Equal));
        }
        NamedEffect { parameters: times.concat(), ..effect }
    };
    once.into_iter().map(said).collect()
}

/// What became of every candidate of the first look; `besides` are ids that were named besides what the search took.
pub(crate) fn candidates(found: &Found, besides: &[&str]) -> Vec<Candidate> {
    let taken: Vec<&str> = found.best.state.guesses.iter().map(CandidateEffect::id).collect();
    let rivals: Vec<&str> = (0..taken.len()).flat_map(|index| alternatives(found, index)).collect();
    found
        .first
        .iter()
        .map(|trial| {
            let id = trial.guess.id();
            let before = trial.before.mean_square().max(f64::MIN_POSITIVE);
            let explains = (1.0 - trial.held_out.mean_square() / before).clamp(0.0, 1.0);
            let outcome = if taken.contains(&id) || besides.contains(&id) {
                "named".to_owned()
            } else if rivals.contains(&id) {
                "cannot be distinguished from one named".to_owned()
            } else if found.denied.contains(&id) {
                "held-out recordings deny it".to_owned()
            } else if found.by_chance.contains(&id) {
                "chance may have given it".to_owned()
            } else if found.stand_ins.contains(&id) {
                "gains something, and leaves far more than it explains".to_owned()
            } else if found.outdone.contains(&id) {
                "another effect, which does not stand, explains more".to_owned()
            } else if let Some((_, force)) = found.nameless.iter().find(|(taken_for, _)| *taken_for == id) {
                format!("{force} explains more, and is none of the catalogue")
            } else if let Some((_, other)) = found.as_well.iter().find(|(taken_for, _)| *taken_for == id) {
                format!("may as well be {}", other.name)
            } else if found.unheard_of.contains(&id) {
                "fits only with a shape that nothing published has".to_owned()
            } else if found.replaced.contains(&id) {
                "an empirical term takes its place".to_owned()
            } else if explains < 0.02 {
                "explains nothing".to_owned()
            } else if taken.is_empty() {
                "gains too little to be named".to_owned()
            } else {
                "redundant given the selected effects".to_owned()
            };
            Candidate {
                id: id.to_owned(),
                evidence: evidence(&trial.before, &trial.held_out, found.first.len()),
                explains,
                outcome,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pam_muscle::effects::effect;

    #[test]
    fn what_happened_several_times_is_named_once_with_all_its_instants() {
        let evidence = Evidence {
            log_ratio: 9.0,
            rmse_without_n: 2.0,
            rmse_with_n: 1.0,
            blocks_improved: 8,
            n_blocks: 8,
            p_value: 0.01,
        };
        let named = |id: &str, instant_s: f64| {
            let instant = ParameterEntry {
                name: "instant_s".to_owned(),
                value: instant_s,
                unit: "s".to_owned(),
                stderr: None,
                status: ParameterStatus::Fitted,
            };
            named_besides(effect(id).expect("an id"), vec![instant], evidence)
        };
        let once = each_once(vec![named("force-step", 31.0), named("pressure-lag", 0.1), named("force-step", 12.0)]);
        let instants_s = |effect: &NamedEffect| effect.parameters.iter().map(|entry| entry.value).collect::<Vec<f64>>();
        assert_eq!(once.iter().map(instants_s).collect::<Vec<_>>(), [vec![12.0, 31.0], vec![0.1]]);
        assert_eq!(once[0].name, "step of the force (2 times)");
        assert_eq!(once[1].name, named("pressure-lag", 0.1).name);
    }
}
