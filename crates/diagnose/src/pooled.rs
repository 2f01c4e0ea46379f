//! Held-out recordings fitted together with the others: whether one muscle follows all of them.
//!
//! What was fitted leaves some of a model open: a recording or two say little of where they have not been, and what a fit makes of
//! that misses hold-outs although nothing is missing. As in Chow's test (Econometrica 28, 1960), one model of all recordings tells
//! that from what eq. 11 lacks: where it follows each of them as nothing that is missing would allow, only parameters were open.
//! It is asked, and never written.

use pam_artifact::ModelArtifact;
use pam_artifact::diagnosis::Verdict;
use pam_artifact::model::FitStatistics;
use pam_identification::along::Along;
use pam_identification::evaluate::noise_floor_n;
use pam_identification::prepare::Prepared;
use pam_muscle::effects::Term;

use crate::carried;
use crate::error::DiagnoseError;
use crate::problem::DiagnosisProblem;
use crate::rig;
use crate::search::Limits;
use crate::typical::Typical;
use crate::verdict::{Sizes, verdict};

/// Recordings of one muscle, whatever was open in a model that was fitted to some of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Pooled {
    /// What one model of all of them leaves of each that was held out.
    pub held: Vec<FitStatistics>,
}

impl Pooled {
    /// Of `estimation` and `holdout` where eq. 11 with `rig`, with other values of what was free in `model`, follows both as what lacks
    /// nothing follows recordings that it was fitted to; none where it does not.
    ///
    /// # Errors
    /// [`DiagnoseError::Undetermined`] where the samples do not determine a fit; where they cannot be read back.
    pub(crate) fn of(
        estimation: &[Prepared],
        holdout: &[Prepared],
        model: &ModelArtifact,
        limits: &Limits,
        rig: &[Term],
    ) -> Result<Option<Self>, DiagnoseError> {
        let recordings: Vec<Prepared> = estimation.iter().chain(holdout).cloned().collect();
        let sensor_floor_n = noise_floor_n(&recordings, &model.force_model())?;
        let limits = Limits { max_effects: 0, sensor_floor_n, ..limits.clone() };
        let question = DiagnosisProblem::new(&recordings, model, limits);
        let track = question.without_mistaken(&rig::track(&recordings, model, rig)?);
        let found = question.search_without(&track, &[])?;
        if verdict(&found, &Sizes::of(&found, &question.limits), false) != Verdict::Consistent {
            return Ok(None);
        }
        let setting = question.setting(&track, &found.nuisance);
        let (state, nuisance) = carried::leaves_least(&setting, &found, None)
            .unwrap_or_else(|| (found.best.state.clone(), found.nuisance.clone()));
        let written = rig::beside(rig, &carried::carried(&setting, &found, &state, &nuisance));
        let mut begun = recordings.clone();
        for (index, prepared) in begun.iter_mut().enumerate() {
            prepared.begin_with(&written, model.direction, index)?;
        }
        let along = Along::of(&begun, &written, model.direction)?;
        let traces = along.traces(&begun, &written)?;
        let (begun, traces) = (begun.split_at(estimation.len()), traces.split_at(estimation.len()));
        let typical = Typical::of_all(written.base(), (begun.0, traces.0), (begun.1, traces.1))?;
        let follows = !typical.is_missed(question.limits.matters_above_n);
        Ok(follows.then(|| Self { held: along.evaluation.each[estimation.len()..].to_vec() }))
    }

    /// What a person should know of it where a model of the fitted recordings alone leaves `left_n` of the others, over all samples, in N.
    pub(crate) fn statement(&self, left_n: f64) -> String {
        let n = |each: &FitStatistics| (each.n_samples + each.n_unsettled) as f64;
        let squares: f64 = self.held.iter().map(|each| n(each) * each.rmse_all_n.powi(2)).sum();
        let pooled_n = (squares / self.held.iter().map(n).sum::<f64>()).sqrt();
        format!(
            " Held-out recordings are foretold with an RMSE of {left_n:.2} N over all samples; one model of these and the fitted ones \
             leaves {pooled_n:.2} N of them. So no physics has to be missing: the fitted recordings leave parameters open. Identify \
             the model from recordings that go where it is to be used."
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::given::tests::{RAMPS, STROKES, another, artifact, recorded};

    /// What one model of fitted strokes of one muscle and ramps of another makes of the ramps; their load cell reads `gain` times the
    /// force.
    fn pooled(fitted: &ModelArtifact, held: &ModelArtifact, gain: f64) -> Option<Pooled> {
        let estimation = [recorded("strokes.csv", STROKES, fitted, 1.0)];
        let holdout = [recorded("ramps.csv", RAMPS, held, gain)];
        Pooled::of(&estimation, &holdout, &artifact(), &Limits::of_test(3, 0.3), &[]).expect("a fit")
    }

    #[test]
    fn recordings_of_one_muscle_are_followed_alike_whatever_the_model_was_before() {
        let pooled = pooled(&another(), &another(), 1.0).expect("one muscle");
        assert!(pooled.held.len() == 1 && pooled.held[0].rmse_n < 0.5, "{pooled:?}");
    }

    #[test]
    fn recordings_of_two_muscles_or_with_two_gains_are_not() {
        assert_eq!(pooled(&artifact(), &another(), 1.0), None);
        assert_eq!(pooled(&artifact(), &artifact(), 1.05), None);
    }

    #[test]
    fn the_error_that_is_said_is_over_all_samples_of_what_was_held_out() {
        let each = |rmse_all_n, n_samples| FitStatistics {
            rmse_n: 0.0,
            rmse_all_n,
            max_n: 0.0,
            r2: 1.0,
            fit_percent: 100.0,
            n_samples,
            n_unsettled: 100,
        };
        let said = Pooled { held: vec![each(1.0, 200), each(3.0, 0)] }.statement(9.0);
        // Three hundred samples of 1 N and a hundred of 3 N.
        assert!(said.contains("RMSE of 9.00 N") && said.contains("leaves 1.73 N"), "{said}");
    }
}
