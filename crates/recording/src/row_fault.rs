//! Faults of one row.

use super::wording::counted;

/// Fault of one row.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RowFault {
    /// Not as many fields as the header.
    #[error("{} where the header has {expected}", counted(*found, "field"))]
    FieldCount {
        /// Fields in the row.
        found: usize,
        /// Fields in the header.
        expected: usize,
    },
    /// Nothing in a field that is used.
    #[error("column \"{column}\" is empty")]
    EmptyField {
        /// Name of the column.
        column: String,
    },
    /// Text in a number.
    #[error("\"{text}\" in column \"{column}\" is not a number")]
    NotANumber {
        /// Name of the column.
        column: String,
        /// The text, shortened.
        text: String,
    },
    /// Text that is no time stamp.
    #[error("\"{text}\" in column \"{column}\" is no time stamp as 2026-11-23T10:15:02.125")]
    NotADate {
        /// Name of the column.
        column: String,
        /// The text, shortened.
        text: String,
    },
    /// NaN or infinite.
    #[error("\"{text}\" in column \"{column}\" is not finite")]
    NotFinite {
        /// Name of the column.
        column: String,
        /// The text, shortened.
        text: String,
    },
    /// A number that no bench measures.
    #[error("{text} in column \"{column}\" is beyond anything a bench measures")]
    Absurd {
        /// Name of the column.
        column: String,
        /// The text, shortened.
        text: String,
    },
    /// A quote that is not closed.
    #[error("a quote is not closed on its line")]
    OpenQuote,
    /// A line of absurd length.
    #[error("the line is longer than {limit} bytes")]
    TooLong {
        /// Longest line that is read, in bytes.
        limit: usize,
    },
    /// A stamp before the one above.
    #[error("the clock runs back from {before_s} s to {time_s} s")]
    ClockRunsBack {
        /// Stamp of the row above, in s.
        before_s: f64,
        /// Stamp of this row, in s.
        time_s: f64,
    },
    /// A stamp after which the clock runs back to where it was.
    #[error("the clock jumps ahead to {time_s} s and back again")]
    ClockJumpsAhead {
        /// Stamp of this row, in s.
        time_s: f64,
    },
}

impl RowFault {
    /// Its remedy.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::ClockRunsBack { .. } => {
                "cut the file there if the logger started anew, or drop such rows with --skip-bad-rows"
            }
            Self::FieldCount { found, expected } if *found == 2 * expected => {
                "decimal commas need semicolons or tabs between columns; drop such rows with --skip-bad-rows"
            }
            _ => "correct the row, or drop such rows with --skip-bad-rows",
        }
    }
}
