//! One muscle as a look at its rig sees it: what explains its recordings without the rig, and what the rig adds to that.
//!
//! A single muscle may have found another name for what its rig does, or a friction of its own that a delay would mimic. So an
//! effect of the rig is weighed beside every explanation that the muscle has without it: none, what its own diagnosis named, and
//! the best of the effects of a muscle, named or not. What the rig's effect gains is counted from the best of these.

use pam_muscle::effects::{Kind, Seen, Term};

use crate::coordinates::Coordinates;
use crate::diagnose::Diagnosis;
use crate::error::DiagnoseError;
use crate::hypothesis::{Beginning, CandidateEffect, Sign};
use crate::joint::HeldOut;
use crate::nuisance::Nuisance;
use crate::problem::DiagnosisProblem;
use crate::rig::{self, is_of_the_rig};
use crate::search::{Beside, Judged, again, judged};
use crate::state::{Setting, State};
use crate::track::Track;
use crate::trial::{self, Shapes};
use crate::uncertainty::{Uncertainty, correlated_instants, shape_errors};
use crate::veto::{Share, held_share};

/// Log predictive ratio that every effect of an explanation costs: as much as a name has to gain.
const COST: f64 = 1.5;

/// A muscle of the group, its recordings without what is known of the rig.
pub(super) struct Member<'a> {
    question: &'a DiagnosisProblem<'a>,
    track: Track,
    /// What was held out of it.
    heldout: Option<Track>,
    /// A static map that bends, as all effects with a memory are judged beside.
    nuisance: Nuisance,
    /// What the recordings cover.
    pub(super) seen: Seen,
    /// The base alone, then the others.
    explanations: Vec<Explanation>,
}

/// What may explain the recordings without the rig.
struct Explanation {
    /// On all instants.
    whole: State,
    /// On those that a search for a shape looks at.
    thin: State,
    held_out: HeldOut,
    thin_held_out: HeldOut,
}

impl Explanation {
    fn cost(&self) -> f64 {
        COST * self.whole.guesses.len() as f64
    }

    /// As a search for a shape sees it, or on all instants.
    fn seen(&self, thinly: bool) -> (&State, &HeldOut) {
        if thinly { (&self.thin, &self.thin_held_out) } else { (&self.whole, &self.held_out) }
    }
}

/// What an effect of the rig is worth in a muscle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Worth {
    /// Log predictive ratio beyond the best explanation without it; below zero where it speaks against the effect.
    pub(super) log_ratio: f64,
    /// Mean square over held-out blocks of the best explanation without it, in N².
    pub(super) without: f64,
    /// And with it, in N².
    pub(super) with: f64,
}

/// An effect of the rig fitted to one muscle.
#[derive(Debug, Clone)]
pub(super) struct Fitted {
    pub(super) estimate: Estimate,
    /// With how much of its size it is there on what was held out; none where nothing can be said.
    pub(super) held: Option<Share>,
}

/// An effect of the rig as one muscle has it.
#[derive(Debug, Clone)]
pub(super) struct Estimate {
    /// Values of shapes, then of amplitudes, SI.
    pub(super) values: Vec<f64>,
    /// Standard error of each; none where the recordings do not tell.
    pub(super) errors: Vec<Option<f64>>,
}

impl<'a> Member<'a> {
    /// The muscle of `diagnosis`, without what `known` of the rig does in its recordings; `question` is of the same recordings.
    ///
    /// # Errors
    /// [`DiagnoseError::Undetermined`] where the recordings determine no fit; where they cannot be read back.
    pub(super) fn of(
        question: &'a DiagnosisProblem<'a>,
        diagnosis: &Diagnosis,
        known: &[Term],
    ) -> Result<Self, DiagnoseError> {
        let track = question.without_mistaken(&rig::track(question.estimation, question.model, known)?);
        let Diagnosis { holdout, .. } = diagnosis;
        let held = || rig::track(holdout, question.model, known).map(|held| question.without_mistaken(&held));
        let heldout = (!holdout.is_empty()).then(held).transpose()?;
        let undetermined = || DiagnoseError::Undetermined { path: question.estimation[0].recording.path.clone() };
        Self::explained(question, track, heldout, diagnosis).ok_or_else(undetermined)
    }

    fn explained(
        question: &'a DiagnosisProblem<'a>,
        track: Track,
        heldout: Option<Track>,
        diagnosis: &Diagnosis,
    ) -> Option<Self> {
        let coordinates = Coordinates::of(&track);
        let model = question.model.force_model();
        let of_recordings = Nuisance::of_recordings(&track, question.limits.sensor_floor_n).with_reversals(
            &track,
            &coordinates,
            &model,
        );
        let seen = track.seen();
        let bare = question.setting(&track, &of_recordings);
        let start = crate::base::coordinates(question.model, &question.space);
        let base = judged(&bare, bare.fit(Vec::new(), &start, &model)?)?;
        let nuisance = Beside::of(&bare, &of_recordings, &coordinates, &base)?.free;
        let setting = question.setting(&track, &nuisance);
        let base = again(&setting, &base)?;
        let mut sets = vec![own(diagnosis)];
        let of_a_muscle = |effect: &dyn pam_muscle::effects::Effect| {
            effect.kind() == Kind::Muscle
                && !is_of_the_rig(effect)
                && !question.limits.excluded.iter().any(|id| id == effect.page().id)
        };
        let tried = trial::among(&setting, &base.state, &base.held_out, &seen, &Shapes::new(), &of_a_muscle);
        sets.extend(tried.into_iter().take(1).map(|trial| vec![trial.guess]));
        sets.retain(|guesses| !guesses.is_empty());
        if let [own, best] = &sets[..]
            && own.len() == 1
            && own[0].id() == best[0].id()
        {
            sets.truncate(1);
        }
        let mut explanations = vec![Explanation::of(&setting, base.clone())?];
        for guesses in sets {
            let state = setting.fit_near(guesses, &base.state).and_then(|state| judged(&setting, state));
            explanations.extend(state.and_then(|judged| Explanation::of(&setting, judged)));
        }
        Some(Self { question, track, heldout, nuisance, seen, explanations })
    }

    fn setting(&self) -> Setting<'_> {
        self.question.setting(&self.track, &self.nuisance)
    }

    /// What `guess` is worth here, on the instants that a search for a shape looks at alone, or on all; none where it determines
    /// no fit.
    pub(super) fn worth(&self, guess: &CandidateEffect, thinly: bool) -> Option<Worth> {
        let setting = if thinly { self.setting().sampled_in_blocks() } else { self.setting() };
        let base = self.explanations[0].seen(thinly).1;
        /// What is gained, and what is then left, a mean square in N².
        type Gain = (f64, f64);
        let (mut without, mut with) = (None, None);
        let better = |best: &mut Option<Gain>, held_out: &HeldOut, cost: f64| {
            let gained = base.log_ratio(held_out) - cost;
            if best.is_none_or(|(most, _)| gained > most) {
                *best = Some((gained, held_out.mean_square()));
            }
        };
        for explanation in &self.explanations {
            let (state, held_out) = explanation.seen(thinly);
            better(&mut without, held_out, explanation.cost());
            if let Some((held_out, _)) = trial::weigh(&setting, state, guess, &[]) {
                better(&mut with, &held_out, explanation.cost());
            }
        }
        let ((without, without_square), (with, with_square)) = (without?, with?);
        let gained = with - without;
        let kept = if gained > 0.0 { trial::share_kept(guess, false, 0) } else { 1.0 };
        Some(Worth { log_ratio: kept * gained, without: without_square, with: with_square })
    }

    /// What the sensors leave, in N².
    pub(super) fn floor_square(&self) -> f64 {
        self.question.limits.sensor_floor_n.powi(2)
    }

    /// The values of `guess` with its shapes as they are, beside the explanation that goes best with it, with their standard
    /// errors and what was held out says of it; none where it determines no fit.
    pub(super) fn fitted(&self, guess: &CandidateEffect) -> Option<Fitted> {
        let setting = self.setting();
        let fits = self.explanations.iter().filter_map(|explanation| {
            let state = trial::with(&setting, &explanation.whole, guess, &[])?;
            let gained = self.explanations[0].held_out.log_ratio(&setting.hold_out(&state)?) - explanation.cost();
            Some((gained, state))
        });
        let (_, state) = fits.max_by(|left, right| left.0.total_cmp(&right.0))?;
        let correlated = correlated_instants(&setting, &setting.residuals_n(&state));
        let last = state.guesses.len() - 1;
        let mut errors = shape_errors(&setting, &state, last, correlated);
        let mut values = guess.shape.clone();
        let n_amplitudes = guess.amplitudes().len();
        if n_amplitudes > 0 {
            let uncertainty = Uncertainty::of(&setting.fold_fits(&state)?, &self.question.space);
            let first = state.fit.amplitudes.len() - n_amplitudes;
            values.extend(&state.fit.amplitudes[first..]);
            errors.extend(uncertainty.amplitudes[first..].iter().map(|&error| Some(error)));
        }
        let held = self.heldout.as_ref().and_then(|heldout| held_share(self.question, heldout, &state, last));
        Some(Fitted { estimate: Estimate { values, errors }, held })
    }
}

impl Explanation {
    fn of(setting: &Setting<'_>, judged: Judged) -> Option<Self> {
        let sampled = setting.sampled_in_blocks();
        let thin = sampled.fit_near(judged.state.guesses.clone(), &judged.state)?;
        let thin_held_out = sampled.hold_out(&thin)?;
        Some(Self { whole: judged.state, thin, held_out: judged.held_out, thin_held_out })
    }
}

/// What `diagnosis` named of the muscle itself.
fn own(diagnosis: &Diagnosis) -> Vec<CandidateEffect> {
    let named = |term: &&Term| diagnosis.effects.iter().any(|effect| effect.id == term.effect.page().id);
    let muscles = |term: &&Term| term.effect.kind() == Kind::Muscle && !is_of_the_rig(term.effect);
    let guess = |term: &Term| CandidateEffect {
        effect: term.effect,
        shape: term.shape.clone(),
        sign: if term.effect.has_one_sign() && term.amplitudes.iter().any(|amplitude| *amplitude < 0.0) {
            Sign::Negative
        } else {
            CandidateEffect::signs(term.effect)[0]
        },
        beginning: Beginning::Fresh,
    };
    diagnosis.augmented.terms().iter().filter(named).filter(muscles).map(guess).collect()
}
