//! What drives a sentence.
//!
//! | driver                      | value                                                              | unit |
//! |-----------------------------|--------------------------------------------------------------------|------|
//! | `pressure`                  | gauge pressure                                                     | Pa   |
//! | `contraction`               | contraction ratio                                                  | 1    |
//! | `speed`                     | speed of contraction, positive when shortening                     | m/s  |
//! | `force`                     | force of eq. 11 without friction                                   | N    |
//! | `time`                      | time since the recording began                                     | s    |
//! | `travel-since-reversal`     | travel of the braid since it last turned                           | m    |
//! | `time-since-last-move`      | time since length or pressure changed faster than the two limits   | s    |
//! | `time-since-pressure-moved` | time since the pressure changed faster than its limit              | s    |
//! | `cycle`                     | cycles of motion, from 1                                           | 1    |
//!
//! The force is that of the model: the measured one holds what is to be explained.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::coordinate::Coordinate;

/// What drives a sentence; see the [module](self) for values and units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Driver {
    /// Gauge pressure, in Pa.
    Pressure,
    /// Contraction ratio.
    Contraction,
    /// Speed of contraction, in m/s.
    Speed,
    /// Force of eq. 11 without friction, in N.
    Force,
    /// Time since the recording began, in s.
    Time,
    /// Travel of the braid since it last turned, in m.
    TravelSinceReversal,
    /// Time since length or pressure moved, in s.
    TimeSinceLastMove {
        /// Speed above which the length moves, in m/s.
        above_m_per_s: f64,
        /// Rate above which the pressure moves, in Pa/s.
        above_pa_per_s: f64,
    },
    /// Time since the pressure moved, in s.
    TimeSincePressureMoved {
        /// Rate above which the pressure moves, in Pa/s.
        above_pa_per_s: f64,
    },
    /// Cycle of motion, counted from 1.
    Cycle,
}

impl Driver {
    /// Unit of its value.
    pub fn unit(&self) -> &'static str {
        match self {
            Self::Pressure => "Pa",
            Self::Contraction | Self::Cycle => "1",
            Self::Speed => "m/s",
            Self::Force => "N",
            Self::TravelSinceReversal => "m",
            Self::Time | Self::TimeSinceLastMove { .. } | Self::TimeSincePressureMoved { .. } => "s",
        }
    }

    /// Name as in files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Pressure => "pressure",
            Self::Contraction => "contraction",
            Self::Speed => "speed",
            Self::Force => "force",
            Self::Time => "time",
            Self::TravelSinceReversal => "travel-since-reversal",
            Self::TimeSinceLastMove { .. } => "time-since-last-move",
            Self::TimeSincePressureMoved { .. } => "time-since-pressure-moved",
            Self::Cycle => "cycle",
        }
    }

    /// Coordinate over which a residual shows what it drives.
    pub fn coordinate(&self) -> Coordinate {
        match self {
            Self::Pressure => Coordinate::Pressure,
            Self::Contraction => Coordinate::Contraction,
            Self::Speed => Coordinate::Speed,
            Self::Force => Coordinate::Force,
            Self::Time => Coordinate::Time,
            Self::TravelSinceReversal => Coordinate::TravelSinceReversal,
            Self::TimeSinceLastMove { .. } | Self::TimeSincePressureMoved { .. } => Coordinate::TimeSinceLastMove,
            Self::Cycle => Coordinate::Cycle,
        }
    }

    pub(super) fn check(&self) -> Result<(), String> {
        let limits = match *self {
            Self::TimeSinceLastMove { above_m_per_s, above_pa_per_s } => [above_m_per_s, above_pa_per_s],
            Self::TimeSincePressureMoved { above_pa_per_s } => [above_pa_per_s; 2],
            _ => return Ok(()),
        };
        match limits.iter().find(|limit| !(limit.is_finite() && **limit > 0.0)) {
            Some(limit) => {
                Err(format!("the limit above which the {} begins is {limit}; it has to be positive", self.name()))
            }
            None => Ok(()),
        }
    }
}
