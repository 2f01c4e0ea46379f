//! All of it in order: muscles in, what their rig does and what is left for each of them out.

use pam_artifact::group::RigCandidate;
use pam_muscle::effects::{CATALOGUE, Effect, Term};

use super::look::{TELLS, Taken, look, own_gains, taken};
use super::member::Member;
use super::shared::Shared;
use crate::artifact::{Agreement, together};
use crate::diagnose::{Diagnosis, Request, diagnose, limits};
use crate::error::DiagnoseError;
use crate::problem::DiagnosisProblem;
use crate::rig::is_of_the_rig;

/// Effects of a rig that may be named.
const MOST: usize = 3;

/// Muscles of one rig, diagnosed together.
#[derive(Debug)]
pub struct Group {
    /// What the rig does.
    pub(super) rig: Vec<Taken>,
    /// The muscles, in the order in which they were given.
    pub muscles: Vec<Muscle>,
    /// Everything that was weighed of the rig, the best first.
    pub(super) candidates: Vec<RigCandidate>,
    /// Ids of effects of the rig that would explain what was fitted, and that what was held out denies.
    pub(super) denied: Vec<&'static str>,
    /// Ids of effects of the rig that have a value of their own in nearly every muscle.
    pub(super) apart: Vec<&'static str>,
}

/// A muscle of a group.
#[derive(Debug)]
pub struct Muscle {
    /// Name.
    pub name: String,
    /// Ids that its diagnosis alone names.
    pub alone: Vec<String>,
    /// What that leaves.
    pub alone_agreement: Agreement,
    /// Its diagnosis beside what the rig does.
    pub together: Diagnosis,
    /// What that leaves.
    pub agreement: Agreement,
}

/// Diagnoses the muscles of one rig, each with its name, together; calls `observer` with how many steps of how many are done.
///
/// # Errors
/// [`DiagnoseError`] names the recording and the remedy.
pub fn diagnose_group(requests: Vec<(String, Request)>, observer: &dyn Fn(u64, u64)) -> Result<Group, DiagnoseError> {
    let (n, mut done) = (requests.len() as u64, 0);
    let steps = 2 * n + 1;
    let mut advance = || {
        done += 1;
        observer(done, steps);
    };
    let mut alone = Vec::new();
    for (name, request) in requests {
        let own = request.effects.clone();
        let accept_implausible = request.accept_implausible;
        alone.push(Alone { name, own, accept_implausible, diagnosis: diagnose(request)? });
        advance();
    }
    let of_the_rig = of_the_rig(&alone)?;
    advance();
    let mut muscles = Vec::new();
    for (index, one) in alone.into_iter().enumerate() {
        muscles.push(one.beside(index, &of_the_rig)?);
        advance();
    }
    let OfTheRig { rig, candidates, denied, apart } = of_the_rig;
    Ok(Group { rig, muscles, candidates, denied, apart })
}

/// A muscle with its diagnosis alone.
struct Alone {
    name: String,
    own: Vec<&'static dyn Effect>,
    accept_implausible: bool,
    diagnosis: Diagnosis,
}

/// What was found of a rig.
struct OfTheRig {
    /// What it does.
    rig: Vec<Taken>,
    /// Everything that was weighed before any was taken.
    candidates: Vec<RigCandidate>,
    /// Ids that what was held out denies.
    denied: Vec<&'static str>,
    /// Ids with a value of their own in nearly every muscle.
    apart: Vec<&'static str>,
}

/// What the rig does to all of `alone`.
fn of_the_rig(alone: &[Alone]) -> Result<OfTheRig, DiagnoseError> {
    let mut questions = Vec::new();
    for one in alone {
        let Diagnosis { estimation, holdout, model, config, .. } = &one.diagnosis;
        let limits = limits(config, one.own.clone(), model, estimation, !holdout.is_empty())?;
        questions.push(DiagnosisProblem::new(estimation, model, limits));
    }
    let mut rig: Vec<Taken> = Vec::new();
    let (mut candidates, mut denied, mut apart) = (Vec::new(), Vec::new(), Vec::new());
    while rig.len() < MOST {
        let mut members = Vec::new();
        for (index, (one, question)) in alone.iter().zip(&questions).enumerate() {
            members.push(Member::of(question, &one.diagnosis, &terms(&rig, index))?);
        }
        let allowed = |effect: &&&'static dyn Effect| {
            let id = effect.page().id;
            let excluded = |one: &Alone| one.diagnosis.config.excluded.iter().any(|excluded| excluded == id);
            is_of_the_rig(**effect)
                && !alone.iter().any(excluded)
                && rig.iter().all(|taken| taken.guess.id() != id)
                && (rig.is_empty() || own_gains(&candidates).contains(&id))
        };
        let effects: Vec<&'static dyn Effect> = CATALOGUE.iter().filter(allowed).copied().collect();
        let found = look(&members, &effects);
        if rig.is_empty() {
            candidates = found.iter().map(candidate).collect();
        }
        let outcome = taken(&members, &found);
        denied.extend(outcome.denied);
        apart.extend(outcome.apart);
        let Some(next) = outcome.taken else { break };
        rig.push(next);
    }
    for ids in [&mut denied, &mut apart] {
        ids.sort_unstable();
        ids.dedup();
        ids.retain(|id| rig.iter().all(|taken| taken.guess.id() != *id));
    }
    Ok(OfTheRig { rig, candidates, denied, apart })
}

fn candidate(shared: &Shared) -> RigCandidate {
    RigCandidate {
        id: shared.guess.id().to_owned(),
        log_ratio: shared.log_ratio(),
        each: shared.each.iter().map(|worth| worth.log_ratio).collect(),
    }
}

/// What is taken off the recordings of muscle `index`.
fn terms(rig: &[Taken], index: usize) -> Vec<Term> {
    rig.iter().filter_map(|taken| taken.each[index].term.clone()).collect()
}

impl Alone {
    /// The muscle, which is number `index`, beside what its rig does.
    fn beside(self, index: usize, of_the_rig: &OfTheRig) -> Result<Muscle, DiagnoseError> {
        let Self { name, own, accept_implausible, diagnosis: mut alone } = self;
        let alone_agreement = Agreement::of(&alone)?;
        let ids: Vec<String> = alone.effects.iter().map(|effect| effect.id.clone()).collect();
        let rig_terms = terms(&of_the_rig.rig, index);
        let excluded: Vec<&str> = CATALOGUE
            .iter()
            .filter(|effect| is_of_the_rig(**effect))
            .map(|effect| effect.page().id)
            .filter(|id| !of_the_rig.apart.contains(id) && !is_its_own(id, index, &ids, of_the_rig))
            .collect();
        if rig_terms.is_empty() && !ids.iter().any(|id| excluded.contains(&id.as_str())) {
            alone.weigh(&alone_agreement)?;
            let agreement = alone_agreement.clone();
            return Ok(Muscle { name, alone: ids, alone_agreement, together: alone, agreement });
        }
        let named_of_the_rig = ids.iter().any(|id| excluded.contains(&id.as_str()));
        let mut config = alone.config.clone();
        config.excluded.extend(excluded.into_iter().map(str::to_owned));
        config.excluded.sort();
        config.excluded.dedup();
        let recordings = |prepared: &[pam_identification::prepare::Prepared]| {
            prepared.iter().map(|prepared| prepared.recording.clone()).collect()
        };
        let (estimation, holdout) = (recordings(&alone.estimation), recordings(&alone.holdout));
        let model = alone.model.clone();
        let request = Request { estimation, holdout, model, config, effects: own, rig: rig_terms, accept_implausible };
        let mut together = diagnose(request)?;
        let mut agreement = Agreement::of(&together)?;
        // What is right on the grid may leave more at the full rate, as a mass makes of a noisy length.
        if !named_of_the_rig && left_n(&agreement) > left_n(&alone_agreement) {
            (together, agreement) = (alone, alone_agreement.clone());
        }
        together.weigh(&agreement)?;
        Ok(Muscle { name, alone: ids, alone_agreement, together, agreement })
    }
}

/// What `agreement` leaves of what was fitted, in N.
fn left_n(agreement: &Agreement) -> f64 {
    together(&agreement.estimation).rmse_n
}

/// Whether the effect of a rig called `id`, which muscle `index` alone names, is its own: other muscles speak against it, and
/// none for it.
fn is_its_own(id: &str, index: usize, named: &[String], of_the_rig: &OfTheRig) -> bool {
    let OfTheRig { rig, candidates, .. } = of_the_rig;
    let is_taken = rig.iter().any(|taken| taken.guess.id() == id);
    let each = candidates.iter().find(|candidate| candidate.id == id).map_or(&[][..], |candidate| &candidate.each);
    let others = || each.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, log_ratio)| *log_ratio);
    named.iter().any(|named| named == id)
        && !is_taken
        && others().any(|log_ratio| log_ratio < -TELLS)
        && !others().any(|log_ratio| log_ratio > TELLS)
}
