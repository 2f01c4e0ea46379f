//! Parts of the header: C with the prefix `pam_` for names and `PAM_` for constants.

use std::borrow::Cow;

use pam_core::effects::Role;

pub(super) const MOMENT: &str = include_str!("templates/moment.h");
pub(super) const EQ11: &str = include_str!("templates/eq11.h");
pub(super) const SLOPES: &str = include_str!("templates/slopes.h");
pub(super) const OBSERVER: &str = include_str!("templates/observer.h");
pub(super) const INVERSE: &str = include_str!("templates/inverse.h");
pub(super) const CHECK: &str = include_str!("templates/check.c");
pub(super) const CHECK_INVERSE: &str = include_str!("templates/inverse_check.c");

/// Memories that several effects have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shared {
    /// Maxwell slip.
    Slip,
    /// Overstress of three time constants.
    Overstress,
    /// Slope of eq. 11 over the pressure.
    Slopes,
    /// Slope of eq. 11 over the length.
    LengthSlope,
    /// Drivers, memories and curves of empirical terms.
    Sentence,
}

impl Shared {
    pub(super) const ALL: [Self; 5] = [Self::Slip, Self::Overstress, Self::Slopes, Self::LengthSlope, Self::Sentence];

    pub(super) fn text(self) -> &'static str {
        match self {
            Self::Slip => include_str!("templates/slip.h"),
            Self::Overstress => include_str!("templates/prony.h"),
            Self::Slopes => SLOPES,
            Self::LengthSlope => include_str!("templates/length_slope.h"),
            Self::Sentence => include_str!("templates/sentence.h"),
        }
    }
}

/// An effect in C.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// Id in the catalogue; `empirical-1` and so on for terms without a name.
    pub(super) id: Cow<'static, str>,
    /// Its functions, and its memory where it has one.
    pub(super) text: Cow<'static, str>,
    /// Arguments of its function.
    pub(super) arguments: &'static [Argument],
    /// What it rests on.
    pub(super) needs: &'static [Shared],
}

/// What the function of an effect is handed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Argument {
    /// Its memory.
    Memory,
    /// The instant.
    Now,
    /// Eq. 11 there.
    Base,
    /// The force so far.
    Force,
}

use Argument::{Base, Force, Memory, Now};

macro_rules! part {
    ($id:literal, $file:literal, [$($argument:expr),*], [$($shared:expr),*]) => {
        Part {
            id: Cow::Borrowed($id),
            text: Cow::Borrowed(include_str!(concat!("templates/effects/", $file, ".h"))),
            arguments: &[$($argument),*],
            needs: &[$($shared),*],
        }
    };
}

/// Every effect that is a force in C. A delay of a channel belongs to recordings, and an event to one of them.
const PARTS: &[Part] = &[
    part!(
        "pressure-gauge-hysteresis",
        "pressure_gauge_hysteresis",
        [Memory, Now, Base],
        [Shared::Slip, Shared::Slopes]
    ),
    part!("force-drift", "force_drift", [Now], []),
    part!("series-compliance", "series_compliance", [Memory, Now], []),
    part!("inertia", "inertia", [Memory, Now], []),
    part!("slack", "slack", [Force], []),
    part!("pressure-lag", "pressure_lag", [Memory, Now], []),
    part!("threshold-pressure", "threshold_pressure", [Now], []),
    part!("end-taper", "end_taper", [Now], []),
    part!("braid-lockup", "braid_lockup", [Now], []),
    part!("presliding-hysteresis", "presliding_hysteresis", [Memory, Now], [Shared::Slip]),
    part!("rubber-hysteresis", "rubber_hysteresis", [Memory, Now], [Shared::Slip]),
    part!("stribeck", "stribeck", [Memory, Now, Base], []),
    part!("rate-dependent-hysteresis", "rate_dependent_hysteresis", [Now, Base], []),
    part!("load-dependent-friction", "load_dependent_friction", [Now, Base], []),
    part!("viscous-damping", "viscous_damping", [Now], []),
    part!("viscoelastic-relaxation", "viscoelastic_relaxation", [Memory, Now, Base], [Shared::Overstress]),
    part!("pressure-creep", "pressure_creep", [Memory, Now, Base], [Shared::Overstress]),
    part!("mullins-softening", "mullins_softening", [Memory, Now, Base], []),
    part!("thermal-softening", "thermal_softening", [Memory, Now, Base], []),
    part!("fatigue-wear", "fatigue_wear", [Memory, Now, Base], []),
    part!("static-map", "static_map", [Now], []),
];

impl Part {
    /// The part of an effect; none where it is no force.
    pub(super) fn of(id: &str) -> Option<&'static Self> {
        PARTS.iter().find(|part| part.id == id)
    }

    /// The id as a name in C.
    pub(super) fn name(&self) -> String {
        self.id.replace('-', "_")
    }

    pub(super) fn has_memory(&self) -> bool {
        self.arguments.contains(&Memory)
    }

    /// The call of its function in the step.
    pub(super) fn call(&self, role: Role) -> String {
        let name = self.name();
        let arguments: Vec<String> = self
            .arguments
            .iter()
            .map(|argument| match argument {
                Memory => format!("&state->{name}"),
                Now => "&now".to_owned(),
                Base => "&base".to_owned(),
                Force => "force_n".to_owned(),
            })
            .collect();
        let arguments = arguments.join(", ");
        match role {
            Role::Shift => String::new(),
            Role::Sees => format!("    pam_{name}_sees({arguments});\n"),
            Role::Slides => format!("    slide = pam_{name}_slides({arguments});\n"),
            Role::Pulls => format!("    force_n += pam_{name}_pulls({arguments});\n"),
            Role::Reads => format!("    force_n = pam_{name}_reads({arguments});\n"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pam_core::effects::{CATALOGUE, Kind, NAMELESS};

    #[test]
    fn every_effect_that_is_a_force_has_a_part() {
        for effect in CATALOGUE.iter().chain(NAMELESS) {
            let is_force = effect.role() != Role::Shift && effect.kind() != Kind::Event;
            assert_eq!(Part::of(effect.page().id).is_some(), is_force, "{}", effect.page().id);
        }
    }

    #[test]
    fn memories_and_functions_are_named_after_their_effect() {
        for part in PARTS {
            let name = part.name();
            assert_eq!(part.text.contains(&format!("}} pam_{name};")), part.has_memory(), "{name}");
            assert!(part.text.contains(&format!("pam_{name}_")), "{name}");
        }
    }
}
