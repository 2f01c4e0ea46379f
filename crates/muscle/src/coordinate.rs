//! Coordinates of a muscle at work, over which a residual is laid out and effects are concentrated.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a residual is laid out over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Coordinate {
    /// Time since the recording began, in s.
    Time,
    /// Gauge pressure, in Pa.
    Pressure,
    /// Contraction ratio.
    Contraction,
    /// Size of the speed, in m/s.
    Speed,
    /// Travel of the braid since the last reversal, in m.
    TravelSinceReversal,
    /// Time since the last move, in s.
    TimeSinceLastMove,
    /// Cycle of motion, counted from 1.
    Cycle,
    /// Force as measured, in N.
    Force,
}

impl Coordinate {
    /// Every coordinate.
    pub const ALL: [Self; 8] = [
        Self::Time,
        Self::Pressure,
        Self::Contraction,
        Self::Speed,
        Self::TravelSinceReversal,
        Self::TimeSinceLastMove,
        Self::Cycle,
        Self::Force,
    ];

    /// Name as in the artifact.
    pub fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Pressure => "pressure",
            Self::Contraction => "contraction",
            Self::Speed => "speed",
            Self::TravelSinceReversal => "travel_since_reversal",
            Self::TimeSinceLastMove => "time_since_last_move",
            Self::Cycle => "cycle",
            Self::Force => "force",
        }
    }

    /// Unit as in the artifact.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Time | Self::TimeSinceLastMove => "s",
            Self::Pressure => "Pa",
            Self::Contraction | Self::Cycle => "1",
            Self::Speed => "m/s",
            Self::TravelSinceReversal => "m",
            Self::Force => "N",
        }
    }
}
