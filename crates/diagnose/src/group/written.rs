//! A group as an artifact has it.

use pam_core::artifact::diagnosis::{DiagnoseConfig, Verdict};
use pam_core::artifact::group::{
    GroupArtifact, GroupMuscle, GroupResidual, HeldOutShare, InMuscle, RigEffect, SCHEMA, Says,
};
use pam_core::artifact::model::ParameterEntry;

use super::look::{Has, Taken};
use super::member::Estimate;
use super::together::{Group, Muscle};
use super::words;
use crate::artifact::{Agreement, Head};
use crate::hypothesis::Guess;
use crate::uncertainty::entry;
use crate::veto::Share;

impl Group {
    /// For other programs and for people; `config` is what was asked for.
    pub fn artifact(&self, head: Head, config: DiagnoseConfig) -> GroupArtifact {
        let names: Vec<&str> = self.muscles.iter().map(|muscle| muscle.name.as_str()).collect();
        let rig: Vec<RigEffect> = self.rig.iter().map(|taken| effect(taken, &names)).collect();
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

fn effect(taken: &Taken, names: &[&str]) -> RigEffect {
    let page = taken.guess.effect.page();
    let confusion = |id: &&str| page.confused_with.iter().find(|confusion| confusion.id == *id);
    let confused = taken.rivals.iter().find_map(confusion);
    RigEffect {
        id: page.id.to_owned(),
        name: page.name.to_owned(),
        equation: page.equation.to_owned(),
        parameters: entries(&taken.guess, &taken.shared),
        log_ratio: taken.each.iter().map(|has| has.worth.log_ratio).sum(),
        muscles: taken.each.iter().zip(names).map(|(has, name)| in_muscle(has, name)).collect(),
        held_out: taken.held.map(held_out),
        alternatives: taken.rivals.iter().map(|&id| id.to_owned()).collect(),
        separating_test: confused.map_or(page.test, |confusion| confusion.test).to_owned(),
    }
}

fn in_muscle(has: &Has, name: &str) -> InMuscle {
    let told = has.estimate().filter(|_| has.says == Says::Differs || has.says == Says::Shows);
    let own = told.map_or_else(Vec::new, |own| entries(&has.guess, own));
    let held_out = has.own.as_ref().and_then(|own| own.held).map(held_out);
    InMuscle { muscle: name.to_owned(), says: has.says, log_ratio: has.worth.log_ratio, held_out, own }
}

fn held_out(share: Share) -> HeldOutShare {
    HeldOutShare { share: share.value, stderr: share.error }
}

/// Shapes, then amplitudes.
fn entries(guess: &Guess, estimate: &Estimate) -> Vec<ParameterEntry> {
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
        estimation: residual(muscle, |agreement| (agreement.base_estimation.together, agreement.estimation.together))
            .unwrap_or(GroupResidual { base_n: 0.0, alone_n: 0.0, together_n: 0.0, noise_floor_n: 0.0 }),
        holdout: residual(muscle, |agreement| (agreement.base_holdout.together, agreement.holdout.together)),
    }
}

/// Residuals of base and model that `of` picks.
fn residual(
    muscle: &Muscle,
    of: impl Fn(
        &Agreement,
    ) -> (Option<pam_core::artifact::model::FitStatistics>, Option<pam_core::artifact::model::FitStatistics>),
) -> Option<GroupResidual> {
    let (base, alone) = of(&muscle.alone_agreement);
    let (_, together) = of(&muscle.agreement);
    Some(GroupResidual {
        base_n: base?.rmse_n,
        alone_n: alone?.rmse_n,
        together_n: together?.rmse_n,
        noise_floor_n: muscle.agreement.noise_floor_n,
    })
}
