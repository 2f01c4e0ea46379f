//! Effects that act in secret on top of the muscle's own tension.

use std::str::FromStr;

use crate::catalogue::{Effect, Made};
use crate::draw::{Draw, DrawnParameter, Place};
use crate::path::Command;
use crate::true_muscle::TrueMuscle;

/// Severity beyond which a muscle would be scrap.
const HIGHEST_SEVERITY: f64 = 100.0;

/// An effect to conceal.
#[derive(Debug, Clone, PartialEq)]
pub struct Concealed {
    /// Id in the catalogue.
    pub id: String,
    /// How strong: 0 not at all, 1 as is typical.
    pub severity: f64,
}

impl Concealed {
    /// An effect by id.
    pub fn new(id: &str, severity: f64) -> Self {
        Self { id: id.to_owned(), severity }
    }
}

/// Reads `id` or `id:severity`.
impl FromStr for Concealed {
    type Err = ConcealedError;

    fn from_str(text: &str) -> Result<Self, ConcealedError> {
        let Some((id, severity)) = text.split_once(':') else { return Ok(Self::new(text.trim(), 1.0)) };
        let severity = severity
            .trim()
            .parse()
            .map_err(|_| ConcealedError::NoNumber { id: id.to_owned(), text: severity.to_owned() })?;
        Ok(Self::new(id.trim(), severity))
    }
}

/// Why an effect cannot be concealed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConcealedError {
    /// No effect has this id.
    #[error("there is no effect \"{id}\"")]
    Unknown {
        /// Id asked for.
        id: String,
    },
    /// A severity that is no number.
    #[error("severity \"{text}\" of {id} is no number; write {id}:1 or leave it out")]
    NoNumber {
        /// Effect.
        id: String,
        /// What was written.
        text: String,
    },
    /// A severity that cannot be.
    #[error("severity {severity} of {id} is outside 0 to {HIGHEST_SEVERITY}; 1 is typical")]
    Severity {
        /// Effect.
        id: String,
        /// Severity asked for.
        severity: f64,
    },
    /// The same effect twice.
    #[error("effect \"{id}\" is given twice; give it once, with the sum as its severity")]
    Twice {
        /// Effect.
        id: String,
    },
    /// A smooth misfit that cannot be.
    #[error("smooth misfit {value} N is outside 0 to 1000 N")]
    Misfit {
        /// Value asked for.
        value: f64,
    },
}

/// A concealed effect as drawn: what a diagnosis is to find.
#[derive(Debug, Clone, PartialEq)]
pub struct ConcealedEffect {
    /// Id in the catalogue.
    pub id: &'static str,
    /// How strong.
    pub severity: f64,
    /// Drawn parameters.
    pub parameters: Vec<DrawnParameter>,
    /// Where it shows, if it lives in a region.
    pub place: Option<Place>,
}

/// Draws an effect for a muscle: the truth about it, and what acts.
pub(crate) fn draw(
    effect: &Effect,
    severity: f64,
    seed: u64,
    muscle: &TrueMuscle,
    command: &Command,
) -> (ConcealedEffect, Made) {
    let mut draw = Draw::new(effect.id, severity, seed, muscle, command);
    let made = effect.make(&mut draw);
    (ConcealedEffect { id: effect.id, severity, parameters: draw.parameters, place: draw.place }, made)
}

/// Checks effects against the catalogue and draws them.
pub(crate) fn draw_all(
    concealed: &[Concealed],
    seed: u64,
    muscle: &TrueMuscle,
    command: &Command,
) -> Result<Vec<ConcealedEffect>, ConcealedError> {
    let mut drawn: Vec<ConcealedEffect> = Vec::with_capacity(concealed.len());
    for Concealed { id, severity } in concealed {
        let effect = Effect::with_id(id).ok_or_else(|| ConcealedError::Unknown { id: id.clone() })?;
        if !(0.0..=HIGHEST_SEVERITY).contains(severity) {
            return Err(ConcealedError::Severity { id: id.clone(), severity: *severity });
        }
        if drawn.iter().any(|before| before.id == effect.id) {
            return Err(ConcealedError::Twice { id: id.clone() });
        }
        drawn.push(draw(effect, *severity, seed, muscle, command).0);
    }
    Ok(drawn)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn severity_follows_a_colon_and_is_one_without() {
        assert_eq!("stribeck".parse(), Ok(Concealed::new("stribeck", 1.0)));
        assert_eq!("stribeck:0.5".parse(), Ok(Concealed::new("stribeck", 0.5)));
        let error = "stribeck:much".parse::<Concealed>().unwrap_err().to_string();
        assert_eq!(error, "severity \"much\" of stribeck is no number; write stribeck:1 or leave it out");
    }
}
