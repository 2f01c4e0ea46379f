//! The model as it was given, before anything is refitted.
//!
//! A refit follows a recording of another muscle, or one whose load cell reads 1.15 times too much, as well as its own: its
//! parameters take in what is different. So the model is compared as it is, and each free parameter with its refitted value.
//! The model misses the recordings where it leaves half as much again as the refit does; not where the effects that are found
//! beside the parameters as given explain that.

use pam_artifact::diagnosis::{AsGiven, Residual, Shift};
use pam_artifact::model::{FitStatistics, ModelArtifact};
use pam_identification::condense::condense;
use pam_identification::evaluate::{Evaluation, evaluate_augmented};
use pam_identification::faults::reading::{self, MISSES};
use pam_identification::prepare::Prepared;
use pam_identification::problem::ForceProblem;
use pam_identification::search_space::{Free, SearchSpace};
use pam_identification::trace::trace_augmented;
use pam_identification::uncertainty::jackknife;
use pam_muscle::effects::{AugmentedModel, Kind};
use pam_muscle::force::{ForceModel, Parameter};
use pam_optim::polish::descend;

use crate::artifact::together;
use crate::base;
use crate::error::DiagnoseError;
use crate::nuisance;
use crate::problem::DiagnosisProblem;
use crate::search::Found;
use crate::state::Setting;
use crate::track::Track;

/// Share of the variance of the force that a model of this muscle explains at least, gains and zeros of instruments included. Of
/// 56 pairs of muscles drawn at random 54 are refused; at 0.75 it is 50, and the others are said to be missed.
const OF_THIS_MUSCLE: f64 = 0.9;
/// Share of the residual that a refit leaves where it is the parameters that are another muscle's.
const REFIT_LEAVES: f64 = 0.5;
/// Parameters that the statement names.
const NAMED: usize = 3;

/// The model as given against recordings.
#[derive(Debug, Clone)]
pub struct Given {
    /// Residuals on the estimation recordings.
    pub estimation: Evaluation,
    /// Residuals on what was held out.
    pub holdout: Evaluation,
    /// Residuals of the refitted model on the estimation recordings.
    pub refitted: FitStatistics,
    /// Free base parameters, the one that moved most first.
    pub shifts: Vec<Shift>,
    /// Whether it misses the estimation recordings.
    pub misses: bool,
    /// Faults of an instrument that would explain what it misses.
    pub instrument: Option<String>,
    /// Held-out recordings that the diagnosed model misses, with the reason.
    pub holdout_missed: Vec<String>,
}

impl Given {
    /// The model of `question` against its recordings and those held out.
    ///
    /// # Errors
    /// [`DiagnoseError::Recording`] where samples cannot be read back, or the model has no force for one.
    pub(crate) fn of(question: &DiagnosisProblem<'_>, holdout: &[Prepared]) -> Result<Self, DiagnoseError> {
        let DiagnosisProblem { estimation, model, .. } = question;
        // Events belong to the recordings of another diagnosis.
        let given = model.augmented_model().elsewhere();
        let on_estimation = evaluate_augmented(estimation, &given, model.direction)?;
        let on_holdout = evaluate_augmented(holdout, &given, model.direction)?;
        let (refit, shifts) = refitted(question, &given)?;
        let refitted = together(&evaluate_augmented(estimation, &refit, model.direction)?);
        let before = together(&on_estimation);
        Ok(Self {
            misses: before.rmse_n > MISSES * refitted.rmse_n.max(model.fit.noise_floor_n),
            instrument: instrument(estimation, model, &given, &on_estimation)?,
            estimation: on_estimation,
            holdout: on_holdout,
            refitted,
            shifts,
            holdout_missed: Vec::new(),
        })
    }

    /// Refuses recordings of clearly another muscle.
    ///
    /// # Errors
    /// [`DiagnoseError::AnotherMuscle`] says what the model as given misses, what a refit does, and what to do.
    pub(crate) fn refuse_another_muscle(&self, estimation: &[Prepared]) -> Result<(), DiagnoseError> {
        let before = together(&self.estimation);
        if !self.misses || before.r2 >= OF_THIS_MUSCLE || self.refitted.rmse_n > REFIT_LEAVES * before.rmse_n {
            return Ok(());
        }
        let shifted = self.shifted().map_or(String::new(), |shifted| format!(" ({shifted})"));
        let reason = match &self.instrument {
            Some(instrument) => format!("{instrument}, or they are of another muscle"),
            None => "they are of another muscle".to_owned(),
        };
        Err(DiagnoseError::AnotherMuscle {
            path: estimation[0].recording.path.clone(),
            given_n: before.rmse_n,
            refitted_n: self.refitted.rmse_n,
            shifted,
            reason,
        })
    }

    /// Takes back that the model misses the recordings where it follows them with the effects that were found beside it, its
    /// own parameters held, nearly as well as with parameters that are free.
    /// `knows_rig` says whether `track` is without effects of the rig that are known.
    pub(crate) fn beside_effects(
        &mut self,
        question: &DiagnosisProblem<'_>,
        track: &Track,
        found: &Found,
        knows_rig: bool,
    ) {
        let state = &found.best.state;
        if !self.misses || state.guesses.is_empty() && !knows_rig {
            return;
        }
        let given = question.model.force_model();
        let held =
            SearchSpace { free: Vec::new(), ranges: Vec::new(), held: *given.parameters(), ..question.space.clone() };
        let free = question.setting(track, &nuisance::NONE);
        let fixed = Setting { space: &held, ..question.setting(track, &nuisance::NONE) };
        let with_free = free.fit_near(state.guesses.clone(), state);
        let with_fixed = fixed.fit(state.guesses.clone(), &[], &given);
        if let (Some(free), Some(fixed)) = (with_free, with_fixed) {
            let limit = free.fit.mean_square.max(question.model.fit.noise_floor_n.powi(2));
            self.misses = fixed.fit.mean_square > MISSES * MISSES * limit;
        }
    }

    /// The parameters that moved by most standard errors, in words; none where nothing is known of any.
    pub(crate) fn shifted(&self) -> Option<String> {
        let moved = self.shifts.iter().filter_map(|shift| Some((&shift.parameter, shift.standard_errors?.abs())));
        let words: Vec<String> = moved
            .filter(|(_, errors)| *errors >= 2.0)
            .take(NAMED)
            .enumerate()
            .map(|(index, (name, errors))| {
                if index == 0 {
                    format!("{name} shifted by {errors:.0} standard errors")
                } else {
                    format!("{name} by {errors:.0}")
                }
            })
            .collect();
        (!words.is_empty()).then(|| words.join(", "))
    }

    /// As the artifact has it.
    pub(crate) fn artifact(&self) -> AsGiven {
        let residual = |fit: &FitStatistics| Residual { rmse_n: fit.rmse_n, rmse_all_n: fit.rmse_all_n };
        AsGiven {
            estimation: residual(&together(&self.estimation)),
            holdout: self.holdout.together.as_ref().map(residual),
            refitted: residual(&self.refitted),
            shifts: self.shifts.clone(),
            misses: self.misses,
            instrument: self.instrument.clone(),
            holdout_missed: self.holdout_missed.clone(),
        }
    }
}

/// The model with its free base parameters refitted to all samples that count, beside its effects as they are, and how far
/// each of them moved.
fn refitted(
    question: &DiagnosisProblem<'_>,
    given: &AugmentedModel,
) -> Result<(AugmentedModel, Vec<Shift>), DiagnoseError> {
    let DiagnosisProblem { estimation, model, space, columns, .. } = question;
    let condensed = condense(estimation, columns, 1, None)?;
    let problem = ForceProblem { summary: &condensed.total, columns, space, steps: &[] };
    let nominal: Vec<f64> =
        (0..space.free.len()).map(|index| space.nominal_coordinate(index, model.strand_modulus_pa)).collect();
    let [near, far] = [base::coordinates(model, space), nominal].map(|start| descend(&problem, &start));
    let fit = if far.cost < near.cost { far } else { near };
    let known = jackknife(&problem, &condensed, &fit.x, &fit.at_bound);
    let parameters = space.parameters(&fit.x);
    let refit = ForceModel::new(&model.geometry, model.strand_modulus_pa, model.form, parameters);
    let mut shifts: Vec<Shift> = space
        .free
        .iter()
        .enumerate()
        .map(|(index, &free)| {
            let (low, high) = space.ranges[index];
            let stderr = known.stderr[index].map(|stderr| stderr * (high - low));
            shift(model, free, space.value(index, fit.x[index]), stderr)
        })
        .collect();
    shifts.sort_by(|left, right| {
        let size = |shift: &Shift| shift.standard_errors.map_or(-1.0, f64::abs);
        size(right).total_cmp(&size(left))
    });
    // What a model remembers was found beside its own parameters, and is not refitted: the better of the two is what a refit
    // reaches.
    let plain = AugmentedModel::from(refit);
    if given.terms().iter().all(|term| term.effect.kind() == Kind::Event) {
        return Ok((plain, shifts));
    }
    let beside = |refit: &AugmentedModel| -> Result<f64, DiagnoseError> {
        Ok(together(&evaluate_augmented(estimation, refit, model.direction)?).rmse_n)
    };
    Ok(if beside(given)? <= beside(&plain)? { (given.clone(), Vec::new()) } else { (plain, shifts) })
}

/// From the value of `model` to `refitted` (SI), which has the standard error `stderr`.
fn shift(model: &ModelArtifact, free: Free, refitted: f64, stderr: Option<f64>) -> Shift {
    let theta = *model.force_model().parameters();
    let composite = || model.composites.iter().find(|entry| entry.name == free.name()).and_then(|entry| entry.stderr);
    let own = |parameter: Parameter| {
        let entry = model.parameters.iter().find(|entry| entry.name == parameter.artifact_name())?;
        // The modulus is the inverse of what is fitted: δ(1/E) = δE / E².
        let scale = if parameter == Parameter::StrandCompliance { entry.value.powi(-2) } else { 1.0 };
        entry.stderr.map(|stderr| stderr * scale)
    };
    let (given, known, parameter) = match free {
        Free::One(parameter) => (theta.of(parameter), own(parameter), parameter),
        Free::BladderSum => (theta.of(Parameter::C10) + theta.of(Parameter::C01), composite(), Parameter::C10),
    };
    let errors = [known, stderr].into_iter().flatten().filter(|stderr| stderr.is_finite() && *stderr > 0.0);
    let square: f64 = errors.map(|stderr| stderr * stderr).sum();
    let written = |value: f64| parameter.from_artifact(value);
    let stderr = (square > 0.0).then(|| square.sqrt());
    let scale = if parameter == Parameter::StrandCompliance { (written(given) * written(refitted)).abs() } else { 1.0 };
    Shift {
        parameter: free.name().to_owned(),
        given: written(given),
        refitted: written(refitted),
        unit: parameter.unit().to_owned(),
        stderr: stderr.map(|stderr| scale * stderr),
        standard_errors: stderr.map(|stderr| (written(refitted) - written(given)) / (scale * stderr)),
    }
}

/// What an instrument would have to read wrong in the recordings that the model as given misses.
fn instrument(
    estimation: &[Prepared],
    model: &ModelArtifact,
    given: &AugmentedModel,
    on_estimation: &Evaluation,
) -> Result<Option<String>, DiagnoseError> {
    let own_n = reading::own_n(model);
    let is_missed = |index: &usize| reading::is_missed(model, on_estimation.each[*index].rmse_n, own_n);
    let missed: Vec<usize> = (0..estimation.len()).filter(is_missed).collect();
    let traces: Result<Vec<_>, _> =
        missed.iter().map(|&index| trace_augmented(&estimation[index], given, model.direction, index)).collect();
    let Some(words) = reading::said(&reading::explain(&traces?, given.base(), own_n)) else { return Ok(None) };
    Ok(Some(if missed.len() == estimation.len() {
        words
    } else {
        let paths: Vec<&str> = missed.iter().map(|&index| estimation[index].recording.path.as_str()).collect();
        format!("in {} {words}", paths.join(", "))
    }))
}

#[cfg(test)]
pub(crate) mod tests;
