//! A mass between muscle and load cell, which takes force to accelerate.
//!
//! The grid of a [`crate::track`] smooths and samples what a mass does too coarsely, and what eq. 11 misses is many times larger over
//! all. So it is looked for in the samples as recorded, in what the model leaves there: where a drive starts, stops or turns at once and
//! the mass knocks ([`mod@knocks`]), and in what swings within half a second ([`mod@swings`]).

mod knocks;
mod swings;

use std::ops::Range;

use pam_artifact::ModelArtifact;
use pam_artifact::diagnosis::Region;
use pam_artifact::model::{ParameterEntry, ParameterStatus};
use pam_identification::error::IdentifyError;
use pam_identification::predict::walk_augmented;
use pam_identification::prepare::Prepared;
use pam_muscle::Coordinate;
use pam_muscle::direction::Thresholds;
use pam_muscle::effects::{AugmentedModel, Effect, Mount, Term, effect};
use rayon::prelude::*;

use crate::joint::HeldOut;
use crate::search::{Limits, chance};
use crate::uncertainty::entry;
use crate::verdict::Sizes;

use knocks::{Knock, Line, Residual};
use swings::Stretch;

/// Catalogue id of what a mass does.
pub const ID: &str = "inertia";

/// How a mass moves.
#[derive(Debug, Clone)]
enum Motion {
    /// Where a drive starts, stops or turns.
    Knocks {
        /// Rows around every knock, with the number of the recording.
        touched: Vec<(usize, Range<usize>)>,
        /// Lowest and highest speed that is come from or gone to, in m/s.
        speeds_m_per_s: (f64, f64),
    },
    /// In all that changes fast.
    Swings,
}

/// A mass that moves.
#[derive(Debug, Clone)]
pub struct MovingMass {
    mass_kg: f64,
    mass_stderr_kg: f64,
    mount_hz: f64,
    /// Mean squares of every knock, or of what is fast in every piece, without the mass and with it, each with the mass of the other
    /// folds.
    pub without: HeldOut,
    /// With it.
    pub with: HeldOut,
    /// What the mass explains, root mean square over all rows, in N.
    pub all_rows_n: f64,
    motion: Motion,
}

/// What the samples show of a mass.
struct Shown {
    knocks: Vec<Knock>,
    stretches: Vec<Stretch>,
}

impl MovingMass {
    /// The one in what `explained` leaves, where it matters and may be named beside what that has.
    ///
    /// # Errors
    /// [`IdentifyError::Samples`] where samples cannot be read back.
    pub fn that_matters(
        recordings: &[Prepared],
        explained: &AugmentedModel,
        model: &ModelArtifact,
        limits: &Limits,
        sizes: &Sizes,
    ) -> Result<Option<Self>, IdentifyError> {
        if explained.terms().len() >= limits.max_effects || limits.excluded.iter().any(|id| id == ID) {
            return Ok(None);
        }
        let shown = Self::shown(recordings, explained, model.direction, Residual::WithSpeed)?;
        let knocking = knocks::mass(&shown.knocks, n_rows(recordings), sizes, Residual::WithSpeed);
        Ok(knocking.or_else(|| swings::mass(&shown.stretches, sizes)))
    }

    /// The same mass in what `explained` leaves now that everything else has been looked for without it.
    ///
    /// # Errors
    /// As [`MovingMass::that_matters`].
    pub fn again(
        self,
        recordings: &[Prepared],
        explained: &AugmentedModel,
        model: &ModelArtifact,
        sizes: &Sizes,
    ) -> Result<Self, IdentifyError> {
        let shown = Self::shown(recordings, explained, model.direction, Residual::Explained)?;
        let other = match self.motion {
            Motion::Knocks { .. } => knocks::mass(&shown.knocks, n_rows(recordings), sizes, Residual::Explained),
            Motion::Swings => swings::mass(&shown.stretches, sizes),
        };
        Ok(other.unwrap_or_else(|| self.within_range()))
    }

    /// What `model` leaves of the rows of `recordings`. `thresholds` are those of the direction.
    fn shown(
        recordings: &[Prepared],
        model: &AugmentedModel,
        thresholds: Thresholds,
        residual: Residual,
    ) -> Result<Shown, IdentifyError> {
        let of_one = |(index, prepared): (usize, &Prepared)| {
            let mut lines: Vec<Line> = Vec::new();
            let mut stretches: Vec<Stretch> = Vec::new();
            walk_augmented(prepared, model, thresholds, index, &mut |instant, model_n| {
                if instant.moment.step_s == 0.0 || lines.is_empty() {
                    let n_rows = prepared.recording.segments.get(lines.len()).map_or(0, ExactSizeIterator::len);
                    lines.push(Line::of_rows(n_rows, index, instant));
                    stretches.push(Stretch::every(prepared.quality.period_s));
                }
                if let (Some(line), Some(stretch)) = (lines.last_mut(), stretches.last_mut()) {
                    line.push(instant, model_n);
                    stretch.push(instant, model_n);
                }
            })
            .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
            Ok(Shown { knocks: lines.iter().flat_map(|line| line.knocks(residual)).collect(), stretches })
        };
        let found: Result<Vec<Shown>, IdentifyError> = recordings.par_iter().enumerate().map(of_one).collect();
        let mut shown = Shown { knocks: Vec::new(), stretches: Vec::new() };
        for of_one in found? {
            shown.knocks.extend(of_one.knocks);
            shown.stretches.extend(of_one.stretches);
        }
        Ok(shown)
    }

    /// Whether it was seen where a drive starts, stops or turns, and not in all that changes fast.
    pub(crate) fn knocks(&self) -> bool {
        matches!(self.motion, Motion::Knocks { .. })
    }

    /// Rows around every knock, with the number of the recording.
    pub(crate) fn touched(&self) -> &[(usize, Range<usize>)] {
        match &self.motion {
            Motion::Knocks { touched, .. } => touched,
            Motion::Swings => &[],
        }
    }

    /// The effect.
    ///
    /// # Panics
    /// Never: the catalogue has it.
    #[expect(clippy::expect_used, reason = "the catalogue is fixed")]
    pub fn effect() -> &'static dyn Effect {
        effect(ID).expect("the catalogue has inertia")
    }

    /// The same with a mass that physics has.
    #[must_use]
    pub fn within_range(mut self) -> Self {
        let (lightest_kg, heaviest_kg) = Self::effect().amplitudes()[0].range;
        self.mass_kg = self.mass_kg.clamp(lightest_kg, heaviest_kg);
        self
    }

    /// The mass, in kg.
    pub fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// What it hangs on, at rest.
    pub fn mount(&self) -> Mount {
        Mount::new(self.mount_hz)
    }

    /// The effect with its values.
    pub fn term(&self) -> Term {
        Term::new(Self::effect(), vec![self.mount_hz], vec![self.mass_kg])
    }

    /// Its parameters, as an artifact has them.
    pub fn entries(&self) -> Vec<ParameterEntry> {
        let (shape, amplitude) = (&Self::effect().shape()[0], &Self::effect().amplitudes()[0]);
        let mount = entry(shape.name, shape.unit, self.mount_hz, shape.range, None);
        vec![
            // What swings says nothing of the mount, which is taken to be rigid.
            if self.knocks() { mount } else { ParameterEntry { status: ParameterStatus::Fixed, ..mount } },
            entry(amplitude.name, amplitude.unit, self.mass_kg, amplitude.range, Some(self.mass_stderr_kg)),
        ]
    }

    /// Where it shows, if at some speeds alone: those that are come from or gone to at once; `mismatch_n` is the whole mismatch.
    pub fn region(&self, mismatch_n: f64) -> Option<Region> {
        let Motion::Knocks { speeds_m_per_s: (from, to), .. } = self.motion else { return None };
        Some(Region {
            coordinate: Coordinate::Speed,
            from,
            to,
            unit: Coordinate::Speed.unit().to_owned(),
            share_of_excess: (self.all_rows_n / mismatch_n).powi(2).min(1.0),
            p_value: chance(&self.without, &self.with),
            recording: None,
        })
    }
}

/// Rows of all `recordings`.
fn n_rows(recordings: &[Prepared]) -> usize {
    recordings.iter().map(|prepared| prepared.recording.samples.n_rows()).sum()
}
