//! What a stretch of rows hands on to the next one: all that the direction remembers across their border.

use std::ops::Range;

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::states::Bounds;

/// Between what the state of friction lies at the end of a stretch: -1 after extending, +1 after contracting.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Carried {
    /// Lowest state.
    pub low: f64,
    /// Highest state.
    pub high: f64,
}

impl Carried {
    /// Nothing is known, as at the beginning of every segment.
    pub const UNKNOWN: Self = Self { low: -1.0, high: 1.0 };

    pub(super) fn of(bounds: Bounds) -> Self {
        let (low, high) = bounds.ends();
        Self { low, high }
    }

    pub(super) fn bounds(self) -> Bounds {
        Bounds::between(self.low, self.high)
    }
}

/// Rows of one segment whose directions are found, and what comes before them.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// The rows.
    pub rows: Range<usize>,
    /// State at the row before the first one.
    pub carried: Carried,
}
