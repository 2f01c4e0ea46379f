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
    /// Where a model of the fitted ones alone typically misses the others: by how much, what noise leaves of these, and what one model
    /// of all leaves, in N.
    pub typically_n: Option<[f64; 3]>,
}

impl Pooled {
    /// Of `estimation` and `holdout` where eq. 11 with `rig`, with other values of what was free in `model`, follows both as what lacks
    /// nothing follows recordings that it was fitted to; none where it does not, or has no force for one of their samples. A model of
    /// `estimation` alone leaves what `alone` says.
    pub(crate) fn of(
        estimation: &[Prepared],
        holdout: &[Prepared],
        model: &ModelArtifact,
        limits: &Limits,
        rig: &[Term],
        alone: &Typical,
    ) -> Option<Self> {
        let recordings: Vec<Prepared> = estimation.iter().chain(holdout).cloned().collect();
        let sensor_floor_n = noise_floor_n(&recordings, &model.force_model()).ok()?;
        let search = Limits { max_effects: 0, sensor_floor_n, ..limits.clone() };
        let question = DiagnosisProblem::new(&recordings, model, search);
        let track = question.without_mistaken(&rig::track(&recordings, model, rig).ok()?);
        let found = question.search_without(&track, &[]).ok()?;
        if verdict(&found, &Sizes::of(&found, &question.limits), false) != Verdict::Consistent {
            return None;
        }
        let setting = question.setting(&track, &found.nuisance);
        let (state, nuisance) = carried::leaves_least(&setting, &found, None)
            .unwrap_or_else(|| (found.best.state.clone(), found.nuisance.clone()));
        let written = rig::beside(rig, &carried::carried(&setting, &found, &state, &nuisance));
        let mut begun = recordings.clone();
        for (index, prepared) in begun.iter_mut().enumerate() {
            prepared.begin_with(&written, model.direction, index).ok()?;
        }
        let along = Along::of(&begun, &written, model.direction).ok()?;
        let traces = along.traces(&begun, &written).ok()?;
        let (begun, traces) = (begun.split_at(estimation.len()), traces.split_at(estimation.len()));
        let typical = Typical::of_all(written.base(), (begun.0, traces.0), (begun.1, traces.1)).ok()?;
        if typical.is_missed(limits.matters_above_n) {
            return None;
        }
        let held = along.evaluation.each[estimation.len()..].to_vec();
        let is_missed = alone.held_is_missed(limits.matters_above_n);
        Some(Self { held, typically_n: is_missed.then_some([alone.held_n, alone.sensors_n.1, typical.held_n]) })
    }

    /// What a person should know of it, where each of `followed` is said to be missed by the model of the fitted recordings alone, and not
    /// by this one; empty where that misses nothing.
    pub(crate) fn statement(&self, followed: &[String]) -> String {
        let typically = self.typically_n.map(|[alone_n, noise_n, together_n]| {
            format!(
                "held-out recordings are typically missed by {alone_n:.2} N, where noise leaves {noise_n:.2} N, and by one model of \
                 these and the fitted ones by {together_n:.2} N"
            )
        });
        let missed: Vec<&str> = typically.iter().chain(followed).map(String::as_str).collect();
        if missed.is_empty() {
            return String::new();
        }
        format!(
            " Yet {}: no physics has to be missing, the fitted recordings leave parameters open. Identify the model from recordings \
             that go where it is to be used.",
            missed.join("; ")
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
        let alone = Typical { fitted_n: 0.3, held_n: 2.0, sensors_n: (0.3, 0.3) };
        Pooled::of(&estimation, &holdout, &artifact(), &Limits::of_test(3, 0.3), &[], &alone)
    }

    #[test]
    fn recordings_of_one_muscle_are_followed_alike_whatever_the_model_was_before() {
        let pooled = pooled(&another(), &another(), 1.0).expect("one muscle");
        assert!(pooled.held.len() == 1 && pooled.held[0].rmse_n < 0.5, "{pooled:?}");
        assert!(
            pooled
                .typically_n
                .is_some_and(|[alone_n, noise_n, together_n]| { (alone_n, noise_n) == (2.0, 0.3) && together_n < 0.5 })
        );
    }

    #[test]
    fn recordings_of_two_muscles_or_with_two_gains_are_not() {
        assert_eq!(pooled(&artifact(), &another(), 1.0), None);
        assert_eq!(pooled(&artifact(), &artifact(), 1.05), None);
    }

    #[test]
    fn what_is_typically_missed_and_what_is_followed_with_the_others_are_said_and_nothing_else() {
        let said = |typically_n, followed: &[String]| Pooled { held: Vec::new(), typically_n }.statement(followed);
        assert_eq!(said(None, &[]), "");
        let typically = said(Some([3.0, 1.0, 1.5]), &[]);
        assert!(
            typically.contains("missed by 3.00 N, where noise leaves 1.00 N") && typically.contains("by 1.50 N: no")
        );
        let both = said(Some([3.0, 1.0, 1.5]), &["h.csv is missed by 9.00 N".to_owned()]);
        assert!(both.contains("ones by 1.50 N; h.csv is missed by 9.00 N: no physics"), "{both}");
    }
}
