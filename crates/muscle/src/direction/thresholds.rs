//! How the direction is found, and what friction does where the length stands still.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What friction does while the length stands still.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Standstill {
    /// It keeps the sign of the last motion, whatever the pressure does, and has the size that the pressure gives it.
    Held,
    /// It sticks: its force stays what the last motion left, whatever the pressure does.
    Sticks,
    /// It relaxes, whatever the pressure does: a share of what the last motion left is forgotten with a time constant.
    Relaxes {
        /// In s.
        time_constant_s: f64,
        /// Share that stays, from 0 on and below 1.
        to: f64,
    },
    /// It follows the pressure, and has turned over once the pressure has turned back by so much.
    Slides {
        /// From one sign to the other, in Pa.
        over_pa: f64,
        /// Share of the friction that the pressure brings about at most; models that do not say have all of it.
        #[serde(default = "all", skip_serializing_if = "is_all")]
        share: f64,
    },
}

impl Standstill {
    /// Turned over by any change of the pressure that is not noise.
    pub const AT_ONCE: Self = Self::Slides { over_pa: 0.0, share: 1.0 };

    /// Whether the state of friction moves little by little at a standstill; of a pressure that it follows at once the sign is enough.
    pub(super) fn is_moved(self) -> bool {
        match self {
            Self::Held => false,
            Self::Sticks | Self::Relaxes { .. } => true,
            Self::Slides { over_pa, share } => over_pa > 0.0 || share < 1.0,
        }
    }

    /// In words.
    pub fn words(self) -> String {
        match self {
            Self::Held => "friction is held at standstill".to_owned(),
            Self::Sticks => "friction sticks at standstill, at the force that the last motion left".to_owned(),
            Self::Relaxes { time_constant_s, to } => {
                let relaxes = format!("friction relaxes at standstill within {time_constant_s:.1} s");
                if to > 0.0 { format!("{relaxes}, to {:.0} %", 100.0 * to) } else { relaxes }
            }
            Self::Slides { over_pa, share } => {
                let turns = if over_pa > 0.0 {
                    format!("friction at standstill turns over with {:.1} kPa of pressure", over_pa * 1e-3)
                } else {
                    "friction at standstill follows the pressure".to_owned()
                };
                if share < 1.0 { format!("{turns}, {:.0} % of it", 100.0 * share) } else { turns }
            }
        }
    }
}

fn all() -> f64 {
    1.0
}

/// What serde asks for is a reference.
#[expect(clippy::trivially_copy_pass_by_ref)]
fn is_all(share: &f64) -> bool {
    *share >= 1.0
}

/// How the direction is found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Thresholds {
    /// By how much the length turns back before the direction flips, in m.
    pub length_m: f64,
    /// Likewise for the pressure, where the length stands still, in Pa.
    pub pressure_pa: f64,
    /// Travel back from a reversal over which friction keeps its sign, in m; models that do not say keep it over none.
    #[serde(default)]
    pub held_m: f64,
    /// Travel after that in which friction turns over, in m; models that do not say turn over at once.
    #[serde(default)]
    pub turn_m: f64,
    /// What friction does while the length stands still; models that do not say follow the pressure at once.
    #[serde(default = "at_once")]
    pub standstill: Standstill,
}

fn at_once() -> Standstill {
    Standstill::AT_ONCE
}

/// What friction does at a standstill and after a reversal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// At a standstill.
    pub standstill: Standstill,
    /// Travel back from a reversal over which it keeps its sign, in m.
    pub held_m: f64,
    /// Travel after that in which it turns over, in m.
    pub turn_m: f64,
}

impl Law {
    /// That of `thresholds`.
    pub fn of(thresholds: Thresholds) -> Self {
        let Thresholds { standstill, held_m, turn_m, .. } = thresholds;
        Self { standstill, held_m, turn_m }
    }

    /// `thresholds` with this law in place of theirs.
    #[must_use]
    pub fn within(self, thresholds: Thresholds) -> Thresholds {
        let Self { standstill, held_m, turn_m } = self;
        Thresholds { standstill, held_m, turn_m, ..thresholds }
    }
}

/// What the direction follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driver {
    /// The length, and the pressure where the length stands still.
    Motion,
    /// The pressure alone: "inflation" and "deflation" as the paper prints them.
    Pressure,
}
