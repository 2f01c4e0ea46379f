//! A group as an artifact has it.

use pam_artifact::diagnosis::{DiagnoseConfig, Verdict};
use pam_artifact::group::{GroupArtifact, GroupMuscle, GroupResidual, HeldOutShare, InMuscle, RigEffect, SCHEMA, Says};
use pam_artifact::model::ParameterEntry;

use pam_identification::evaluate::Evaluation;

use super::look::{Has, Taken};
use super::member::Estimate;
use super::together::{Group, Muscle};
use super::words;
use crate::artifact::{Agreement, Head, together};
use crate::hypothesis::CandidateEffect;
use crate::uncertainty::entry;
use crate::veto::Share;

impl Group {
    /// For other programs and for people; `config` is what was asked for.
    pub fn artifact(&self, head: Head, config: DiagnoseConfig) -> GroupArtifact {
        let rig: Vec<RigEffect> = self.rig.iter().map(|taken| effect(taken, &self.muscles)).collect();
        let muscles: Vec<GroupMuscle> = self.muscles.iter().map(muscle).collect();
        GroupArtifact {
            schema: SCHEMA.to_owned(),
            tool: head.tool,
            inputs: head.inputs,
            config,
            seed: head.seed,
            statement: words::statement(&rig, &muscles, self),
            warnings: words::warnings(&rig, &muscles),
            rig,
            muscles,
            candidates: self.candidates.clone(),
            denied: self.denied.iter().map(|&id| id.to_owned()).collect(),
            apart: self.apart.iter().map(|&id| id.to_owned()).collect(),
        }
    }

    /// Whether nothing is left in any muscle that has no name.
    pub fn is_explained(&self) -> bool {
        let verdicts = self.muscles.iter().map(|muscle| muscle.together.verdict);
        verdicts
            .into_iter()
            .all(|verdict| matches!(verdict, Verdict::Consistent | Verdict::Explained | Verdict::Ambiguous))
    }
}

fn effect(taken: &Taken, muscles: &[Muscle]) -> RigEffect {
    let page = taken.guess.effect.page();
    let confused = taken.rivals.iter().find_map(|id| page.confusion_with(id));
    RigEffect {
        id: page.id.to_owned(),
        name: page.name.to_owned(),
        equation: page.equation.to_owned(),
        parameters: entries(&taken.guess, &taken.shared),
        log_ratio: taken.each.iter().map(|has| has.worth.log_ratio).sum(),
        muscles: taken.each.iter().zip(muscles).map(|(has, muscle)| in_muscle(has, muscle)).collect(),
        held_out: taken.held.map(held_out),
        alternatives: taken.rivals.iter().map(|&id| id.to_owned()).collect(),
        separating_test: confused.map_or(page.test, |confusion| confusion.test).to_owned(),
    }
}

fn in_muscle(has: &Has, muscle: &Muscle) -> InMuscle {
    let told = has.estimate().filter(|_| has.says == Says::Differs || has.says == Says::Shows);
    let own = told.map_or_else(Vec::new, |own| entries(&has.guess, own));
    let held_out = has.own.as_ref().and_then(|own| own.held).map(held_out);
    let terms = muscle.together.augmented.terms();
    InMuscle {
        muscle: muscle.name.clone(),
        says: has.says,
        log_ratio: has.worth.log_ratio,
        held_out,
        own,
        in_model: terms.iter().any(|term| term.effect.page().id == has.guess.id()),
    }
}

fn held_out(share: Share) -> HeldOutShare {
    HeldOutShare { share: share.value, stderr: share.error }
}

/// Shapes, then amplitudes.
fn entries(guess: &CandidateEffect, estimate: &Estimate) -> Vec<ParameterEntry> {
    let shapes = guess.effect.shape().iter().map(|shape| (shape.name, shape.unit, shape.range));
    let amplitudes = guess.amplitudes().iter().map(|amplitude| (amplitude.name, amplitude.unit, amplitude.range));
    let values = estimate.values.iter().zip(&estimate.errors);
    shapes
        .chain(amplitudes)
        .zip(values)
        .map(|((name, unit, range), (&value, &error))| entry(name, unit, value.clamp(range.0, range.1), range, error))
        .collect()
}

fn muscle(muscle: &Muscle) -> GroupMuscle {
    let together = &muscle.together;
    GroupMuscle {
        name: muscle.name.clone(),
        verdict: together.verdict,
        statement: together.statement.clone(),
        effects: together.effects.clone(),
        alone: muscle.alone.clone(),
        estimation: residual(muscle, |agreement| (&agreement.base_estimation, &agreement.estimation)),
        holdout: (!together.holdout.is_empty())
            .then(|| residual(muscle, |agreement| (&agreement.base_holdout, &agreement.holdout))),
    }
}

/// Residuals of base and model that `of` picks.
fn residual(muscle: &Muscle, of: impl Fn(&Agreement) -> (&Evaluation, &Evaluation)) -> GroupResidual {
    let (base, alone) = of(&muscle.alone_agreement);
    let (base, alone, both) = (together(base), together(alone), together(of(&muscle.agreement).1));
    GroupResidual {
        base_n: base.rmse_n,
        base_all_n: base.rmse_all_n,
        alone_n: alone.rmse_n,
        alone_all_n: alone.rmse_all_n,
        together_n: both.rmse_n,
        together_all_n: both.rmse_all_n,
        noise_floor_n: muscle.agreement.noise_floor_n,
    }
}
