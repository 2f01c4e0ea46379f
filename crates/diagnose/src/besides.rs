//! What is found in the samples as recorded beside what the search finds on the grid: a mass that moves, and a step of the force at rest.

use pam_artifact::diagnosis::NamedEffect;
use pam_muscle::effects::Term;

use crate::mass::{self, MovingMass};
use crate::named::moving;
use crate::resting_step::{self, RestingStep};

/// Both, where they are there.
#[derive(Debug, Clone, Default)]
pub struct Besides {
    /// A mass that moves.
    pub mass: Option<MovingMass>,
    /// A step of the force at rest.
    pub(crate) step: Option<RestingStep>,
}

impl Besides {
    /// Catalogue ids of what is there.
    pub fn ids(&self) -> impl Iterator<Item = &'static str> {
        let of_mass = self.mass.iter().map(|_| mass::ID);
        of_mass.chain(self.step.iter().map(|_| resting_step::ID))
    }

    /// Whether there is neither.
    pub fn is_empty(&self) -> bool {
        self.ids().next().is_none()
    }

    /// What they explain together, root mean square, in N.
    pub(crate) fn size_n(&self) -> f64 {
        let of_mass_n = self.mass.as_ref().map_or(0.0, |mass| mass.all_rows_n);
        self.step.as_ref().map_or(0.0, |step| step.all_instants_n).hypot(of_mass_n)
    }

    /// As a diagnosis names them.
    pub(crate) fn named(&self) -> Vec<NamedEffect> {
        self.mass.iter().map(moving).chain(self.step.iter().map(RestingStep::named)).collect()
    }

    /// As a model has them.
    pub(crate) fn terms(&self) -> impl Iterator<Item = Term> {
        self.mass.iter().map(MovingMass::term).chain(self.step.iter().map(RestingStep::term))
    }
}
