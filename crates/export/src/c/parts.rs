//! Parts of the header: C with the prefix `pam_` for names and `PAM_` for constants.

use std::borrow::Cow;

use pam_muscle::effects::Role;

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

/// Effects in C by the names of their files, every one that is a force. A delay of a channel belongs to recordings, and an event to
/// one of them.
const EFFECTS: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/effects.rs"));

/// An effect in C.
///
/// # Design
/// What its function is handed and what it rests on is read from the C itself, so that a part is its text and nothing beside it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Part {
    /// Id in the catalogue; `empirical-1` and so on for terms without a name.
    pub(super) id: String,
    /// Its functions, and its memory where it has one.
    pub(super) text: Cow<'static, str>,
    /// Arguments of its function.
    arguments: Vec<Argument>,
}

/// What the function of an effect is handed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Argument {
    /// Its memory.
    Memory,
    /// The instant, as the muscle sees it.
    Now,
    /// The instant, as it is recorded.
    Moment,
    /// Eq. 11 there.
    Base,
    /// The force so far.
    Force,
}

impl Argument {
    /// The one that a parameter of a function takes, by its name.
    fn of(parameter: &str) -> Option<Self> {
        let name = parameter.trim_end().rsplit([' ', '*']).next()?;
        Some(match name {
            "memory" => Self::Memory,
            "now" => Self::Now,
            "moment" => Self::Moment,
            "base" => Self::Base,
            "force_n" => Self::Force,
            _ => return None,
        })
    }
}

impl Part {
    /// The part of an effect of the catalogue; none where it is no force.
    pub(super) fn of(id: &str) -> Option<Self> {
        let file = id.replace('-', "_");
        let (_, text) = EFFECTS.iter().find(|(name, _)| *name == file)?;
        Some(Self::new(id, *text))
    }

    /// The part of effect `id` whose functions and memory are `text`.
    pub(super) fn new(id: &str, text: impl Into<Cow<'static, str>>) -> Self {
        let text = text.into();
        let name = id.replace('-', "_");
        let function = ["sees", "slides", "pulls", "reads"]
            .iter()
            .find_map(|verb| text.split_once(&format!(" pam_{name}_{verb}(")))
            .and_then(|(_, rest)| rest.split_once(')'));
        let parameters = function.map_or("", |(parameters, _)| parameters);
        let arguments = parameters.split(',').filter_map(Argument::of).collect();
        Self { id: id.to_owned(), text, arguments }
    }

    /// Whether it rests on a shared memory.
    pub(super) fn needs(&self, shared: Shared) -> bool {
        self.text.contains(match shared {
            Shared::Slip => "pam_slip",
            Shared::Overstress => "pam_overstress",
            Shared::Slopes => "->slope_n_per_pa",
            Shared::LengthSlope => "->slope_n_per_m",
            Shared::Sentence => "pam_sentence",
        })
    }

    /// The id as a name in C.
    pub(super) fn name(&self) -> String {
        self.id.replace('-', "_")
    }

    pub(super) fn has_memory(&self) -> bool {
        self.arguments.contains(&Argument::Memory)
    }

    /// The call of its function in the step.
    pub(super) fn call(&self, role: Role) -> String {
        let name = self.name();
        let arguments: Vec<String> = self
            .arguments
            .iter()
            .map(|argument| match argument {
                Argument::Memory => format!("&state->{name}"),
                Argument::Now => "&now".to_owned(),
                Argument::Moment => "moment".to_owned(),
                Argument::Base => "&base".to_owned(),
                Argument::Force => "force_n".to_owned(),
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
    use pam_muscle::effects::{CATALOGUE, Kind, NAMELESS, effect};

    #[test]
    fn every_effect_that_is_a_force_has_a_part() {
        for effect in CATALOGUE.iter().chain(NAMELESS) {
            let is_force = effect.role() != Role::Shift && effect.kind() != Kind::Event;
            assert_eq!(Part::of(effect.page().id).is_some(), is_force, "{}", effect.page().id);
        }
    }

    #[test]
    fn memories_and_functions_are_named_after_their_effect() {
        for (file, text) in EFFECTS {
            let part = Part::new(&file.replace('_', "-"), *text);
            let name = part.name();
            assert!(!part.arguments.is_empty() && name == *file, "{name}");
            assert!(effect(&part.id).is_some(), "{name} is no effect");
            assert_eq!(part.text.contains(&format!("}} pam_{name};")), part.has_memory(), "{name}");
            assert!(part.text.contains(&format!("pam_{name}_")), "{name}");
        }
    }
}
