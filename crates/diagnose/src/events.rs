//! Whether what happened once, in the last of the recordings, goes on in those after them.

use pam_core::effects::{AugmentedModel, Kind};

use crate::held_error::Left;
use crate::hypothesis::{Beginning, CandidateEffect};
use crate::search::{Found, judged};
use crate::state::{Setting, State};
use crate::track::Track;

/// Lets every event of `found` that only recordings after it can judge go on, where `heldout`, made after all of them, is foretold
/// better so. `setting` has the nuisances that were in.
pub(crate) fn told_by(setting: &Setting<'_>, found: &mut Found, heldout: &Track) {
    let last = setting.track.recordings.len().saturating_sub(1);
    for index in 0..found.best.state.guesses.len() {
        let guess = &found.best.state.guesses[index];
        if guess.effect.kind() != Kind::Event
            || guess.beginning != Beginning::Fresh
            || guess.shape[0].round() as usize != last
        {
            continue;
        }
        let beginnings = CandidateEffect::beginnings(guess.effect, setting.track, setting.muscle);
        let Some(goes_on) = beginnings.into_iter().find(|one| matches!(one, Beginning::GoesOn(_))) else { continue };
        let mut guesses = found.best.state.guesses.clone();
        guesses[index].beginning = goes_on;
        let Some(other) = setting.fit_near(guesses, &found.best.state) else { continue };
        let left = |state: &State| Left::of(&AugmentedModel::new(state.model.clone(), state.terms()), heldout);
        if left(&found.best.state).is_bettered_by(&left(&other))
            && let Some(other) = judged(setting, other)
        {
            found.best = other;
        }
    }
}
