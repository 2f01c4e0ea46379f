//! Forward selection of effects with a memory: one after the other is added where it gains most, and those before it are looked at once
//! more.
//!
//! # Design
//! A second selection from the second best first effect, where the first one ended with several, was tried: of 48 cases with two effects
//! it changed one, for the worse.

use pam_muscle::effects::Seen;

use super::beside::Beside;
use super::look::{Look, is_strained, promise};
use super::settle::{second_look, settle};
use super::worth::worth;
use super::{Judged, Limits, again};
use crate::coordinates::Coordinates;
use crate::hypothesis::n_effects;
use crate::nuisance::Nuisance;
use crate::state::Setting;
use crate::trial::{Shapes, Trial};

/// What every step of a selection shares.
pub(super) struct ForwardSelection<'a> {
    pub(super) setting: &'a Setting<'a>,
    /// Nuisances that are in by any means.
    pub(super) of_recordings: &'a Nuisance,
    pub(super) coordinates: &'a Coordinates,
    pub(super) seen: &'a Seen,
    pub(super) limits: &'a Limits,
    /// The base model alone.
    pub(super) base: &'a Judged,
    /// The base model beside a static map.
    pub(super) whole: &'a Judged,
    /// Called after every look at the catalogue.
    pub(super) looked: &'a dyn Fn(),
}

/// What has been selected so far.
pub(super) struct Selected {
    pub(super) best: Judged,
    pub(super) beside: Beside,
    /// Shapes of all that ever came near the best.
    pub(super) promising: Shapes,
    /// Shapes of what came near the best in the last look.
    pub(super) known: Shapes,
    /// What no model gets below, in N².
    pub(super) floor_square: f64,
}

impl ForwardSelection<'_> {
    /// Every effect on top of what is `selected`, best first.
    pub(super) fn look(&self, selected: &mut Selected) -> Option<Vec<Trial>> {
        let Self { setting, coordinates, seen, limits, .. } = self;
        let beside = &selected.beside;
        let (plain, mapped) = (setting.beside(&beside.plain), setting.beside(&beside.smooth));
        let look = Look { plain: &plain, mapped: &mapped, free: &beside.free, coordinates, seen, limits };
        let trials = look.trials(&selected.best, &selected.known)?;
        (self.looked)();
        selected.known = promise(&trials).collect();
        selected.promising.extend(selected.known.clone());
        let left = selected.best.held_out.mean_square();
        for trial in &trials {
            // What a trial gains beside a free map says nothing of what a smooth one leaves.
            let gained = trial.before.mean_square() - trial.held_out.mean_square();
            selected.floor_square = selected.floor_square.min((left - gained).max(trial.held_out.mean_square()));
        }
        Some(trials)
    }

    /// Every candidate alone on top of what is `selected`: `trials` of a look, and what no look tries.
    pub(super) fn candidates(&self, selected: &Selected, trials: &[Trial]) -> Option<Vec<Trial>> {
        let Self { setting, coordinates, seen, limits, .. } = self;
        let beside = &selected.beside;
        let (plain, mapped) = (setting.beside(&beside.plain), setting.beside(&beside.smooth));
        let look = Look { plain: &plain, mapped: &mapped, free: &beside.free, coordinates, seen, limits };
        let mut candidates = trials.to_vec();
        candidates.extend(look.smooth_statics(&selected.best)?);
        candidates.extend(look.not_tried(&selected.best, &candidates));
        Some(candidates)
    }

    /// What is `selected`, with the best of `trials` that is worth it; none where none is.
    fn with_best(&self, selected: &Selected, trials: &[Trial]) -> Option<Selected> {
        let Self { setting, limits, .. } = self;
        let mapped = setting.beside(&selected.beside.smooth);
        let further = !selected.best.state.guesses.is_empty();
        let next = trials
            .iter()
            .filter(|trial| worth(trial, further, &self.whole.held_out, selected.floor_square, limits))
            .filter_map(|trial| settle(&mapped, &selected.best, trial))
            .find(|next| !is_strained(&mapped, next, self.base))?;
        let beside = Beside::of(setting, self.of_recordings, self.coordinates, &next)?;
        let mapped = setting.beside(&beside.smooth);
        let mut best = again(&mapped, &next)?;
        if further {
            best = second_look(&mapped, best, self.seen, &selected.promising);
        }
        let floor_square = selected.floor_square.min(best.held_out.mean_square());
        let (promising, known) = (selected.promising.clone(), selected.known.clone());
        Some(Selected { best, beside, promising, known, floor_square })
    }

    /// What is selected on top of `start`, of which `trials` are the first look.
    pub(super) fn select(&self, start: Selected, trials: Vec<Trial>) -> Option<Selected> {
        let (mut selected, mut trials) = (start, trials);
        while let Some(next) = self.with_best(&selected, &trials) {
            selected = next;
            if n_effects(&selected.best.state.guesses) >= self.limits.max_effects {
                break;
            }
            trials = self.look(&mut selected)?;
        }
        Some(selected)
    }
}
