//! Why a figure cannot be drawn.

/// Why a figure cannot be drawn.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FigureError {
    /// No sample has a finite value in every column.
    #[error("no recording has a sample with finite pressure, length, force and model")]
    NothingToDraw,
    /// No cell of an inverse has a pressure.
    #[error("nowhere does a pressure belong to a force")]
    NothingToInvert,
    /// Columns of one recording differ in length.
    #[error("recording {recording}: column {column} has {found} samples, expected {expected} as in time_s")]
    UnequalColumns {
        /// Name of the recording.
        recording: String,
        /// Column that differs.
        column: &'static str,
        /// Samples in `time_s`.
        expected: usize,
        /// Samples in the column.
        found: usize,
    },
    /// The drawing library gave up.
    #[error("cannot draw: {reason}")]
    Backend {
        /// What it said.
        reason: String,
    },
}
