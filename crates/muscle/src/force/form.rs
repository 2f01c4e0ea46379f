//! The two ways in which eq. 11 is written.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How eq. 11 is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// Rubber resists contraction, strand tension from equilibrium, friction by the motion of the braid.
    Corrected,
    /// As the paper prints it: rubber helps contraction, strand tension too large by `2 n`, friction by
    /// the sign of the pressure's change.
    AsPrinted,
}

impl Form {
    /// Sign of the bladder term in the sum.
    pub fn bladder_sign(self) -> f64 {
        match self {
            Self::Corrected => 1.0,
            Self::AsPrinted => -1.0,
        }
    }
}
