//! Which of the names that the search took stand: what was held out is asked, and what stands in for something else, or needs
//! longer recordings, or models nothing, is let go of.

use pam_artifact::diagnosis::{Region, Verdict};

use crate::besides::Besides;
use crate::borne_out;
use crate::error::DiagnoseError;
use crate::events;
use crate::leader::leader;
use crate::mass::MovingMass;
use crate::nameless;
use crate::places::{structured, telling};
use crate::problem::{DiagnosisProblem, SearchOutcome};
use crate::search::Found;
use crate::short;
use crate::stand_ins;
use crate::state::Setting;
use crate::track::Track;
use crate::verdict::{Sizes, verdict};
use crate::veto;

/// What stands of what was found.
#[derive(Debug)]
pub(crate) struct Standing {
    /// The recordings, as they were searched.
    pub(crate) track: Track,
    /// What was found, without what was let go of.
    pub(crate) found: Found,
    /// What was found beside that; beside a mass that knocks nothing is let go of, as it has sizes of its own.
    pub(crate) besides: Besides,
    /// Sizes that a verdict rests on.
    pub(crate) sizes: Sizes,
    /// What recordings were too short for, in words.
    pub(crate) too_short: Vec<String>,
}

impl Standing {
    /// What stands of `outcome`, where `held` is what was held out, without the pull of a mass that swings; where nothing does, of the
    /// effect that explained most.
    ///
    /// # Errors
    /// [`DiagnoseError::Undetermined`] where the samples do not determine a fit.
    pub(crate) fn of(
        question: &DiagnosisProblem<'_>,
        outcome: SearchOutcome,
        held: Option<&Track>,
    ) -> Result<Self, DiagnoseError> {
        let standing = Self::of_taken(question, outcome, held)?;
        let leads = if standing.besides.is_empty() { leader(&standing.found) } else { None };
        let (Some(leads), Some(held)) = (leads, held) else { return Ok(standing) };
        let question = question.of_one(leads.guess.id());
        let mut outcome = question.answer_alone(&standing.track)?;
        // Its evidence is that of the look at all of the catalogue.
        for taken in &mut outcome.found.taken {
            (taken.without, taken.with) = (leads.before.clone(), leads.held_out.clone());
        }
        outcome.found.first.clone_from(&standing.found.first);
        let alone = Self::of_taken(&question, outcome, Some(held))?;
        Ok(if alone.found.best.state.guesses.is_empty() { standing } else { alone })
    }

    /// What stands of `outcome` as it is.
    fn of_taken(
        question: &DiagnosisProblem<'_>,
        outcome: SearchOutcome,
        held: Option<&Track>,
    ) -> Result<Self, DiagnoseError> {
        let SearchOutcome { track, mut found, besides, mut sizes } = outcome;
        let besides_n = besides.size_n();
        let question = &question.without(besides.ids());
        let limits = &question.limits;
        let lasts_s = question.estimation.iter().map(|prepared| prepared.quality.duration_s).sum();
        if besides.mass.as_ref().is_some_and(MovingMass::knocks) {
            let nuisance = found.nuisance.clone();
            let too_short = short::let_go(&question.setting(&track, &nuisance), &mut found, limits, lasts_s);
            return Ok(Self { track, found, besides, sizes, too_short });
        }
        if let Some(held) = held {
            found = veto::confirmed(question, &track, found, held)?;
            sizes = Sizes::of(&found, limits).with(besides_n);
        }
        let nuisance = found.nuisance.clone();
        let setting = question.setting(&track, &nuisance);
        if stand_ins::let_go_of_ends(&setting, &mut found) {
            sizes = Sizes::of(&found, limits).with(besides_n);
        }
        if verdict(&found, &sizes, false) == Verdict::Unexplained || stand_ins::leaves_too_much(&found, &sizes) {
            let left_over = unexplained(question, &setting, &found).first().map(|region| region.coordinate);
            sizes = stand_ins::let_go(&setting, &mut found, &sizes, limits, left_over);
        }
        let too_short = short::let_go(&setting, &mut found, limits, lasts_s);
        let is_not_borne_out = held.is_some_and(|held| borne_out::let_go_of_others(&setting, &mut found, held));
        let is_outdone = besides.is_empty() && stand_ins::let_go_of_outdone(&setting, &mut found);
        let is_nameless = nameless::let_go(&setting, &mut found);
        let is_of_turns = stand_ins::let_go_of_turns(&setting, &mut found);
        let given = question.model.force_model();
        let is_unseen = besides.is_empty() && events::let_go_of_unseen(&setting, &mut found, &given);
        if is_unseen || !too_short.is_empty() || is_not_borne_out || is_outdone || is_nameless || is_of_turns {
            sizes = Sizes::of(&found, limits).with(besides_n);
        }
        Ok(Self { track, found, besides, sizes, too_short })
    }
}

/// Where what `found` leaves is structured.
pub(crate) fn unexplained(question: &DiagnosisProblem<'_>, setting: &Setting<'_>, found: &Found) -> Vec<Region> {
    telling(structured(setting, &found.best.state, found, &question.paths()), &[])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::given::tests::{RAMPS, STROKES, artifact, recorded};
    use crate::hypothesis::{Beginning, CandidateEffect};
    use crate::rig;
    use crate::search::{Limits, judged};

    use pam_muscle::effects::effect;

    #[test]
    fn a_name_that_the_recordings_do_not_show_stands_only_where_nothing_is_held_out() {
        let model = artifact();
        let [fitted, held] = [("strokes.csv", STROKES), ("ramps.csv", RAMPS)].map(|(name, path)| {
            let prepared = [recorded(name, path, &model, 1.0)];
            let track = rig::track(&prepared, &model, &[]).expect("a track");
            (prepared, track)
        });
        let question = DiagnosisProblem::new(&fitted.0, &model, Limits::of_test(0, 0.3));
        let names = |held: Option<&Track>| {
            let mut outcome = question.answer(&fitted.1, &|| {}).expect("a search");
            let nuisance = outcome.found.nuisance.clone();
            let setting = question.setting(&outcome.track, &nuisance);
            let effect = effect("viscous-damping").expect("an id");
            let damping = CandidateEffect {
                effect,
                shape: Vec::new(),
                sign: CandidateEffect::signs(effect)[0],
                beginning: Beginning::Fresh,
            };
            let state = setting.fit_near(vec![damping], &outcome.found.best.state).expect("a fit");
            outcome.found.best = judged(&setting, state).expect("a fit of every fold");
            outcome.sizes = Sizes::of(&outcome.found, &question.limits);
            let standing = Standing::of(&question, outcome, held).expect("a decision");
            assert_eq!(standing.sizes, Sizes::of(&standing.found, &question.limits));
            standing.found.best.state.guesses.iter().map(CandidateEffect::id).collect::<Vec<_>>()
        };
        assert_eq!(names(None), ["viscous-damping"]);
        assert_eq!(names(Some(&held.1)), Vec::<&str>::new());
    }
}
