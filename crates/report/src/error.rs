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
    /// No viewer shows a sheet of this size.
    #[error("a figure of {width} × {height} pixels is larger than a viewer shows; draw fewer recordings")]
    TooLarge {
        /// Width, in pixels.
        width: u32,
        /// Height, in pixels.
        height: u32,
    },
    /// No font on this machine.
    #[error(
        "letters of a PNG or PDF need a font and none is installed; install one, such as DejaVu Sans, or write SVG"
    )]
    NoFont,
    /// A library that turns SVG into something else gave up.
    #[error("cannot turn the figure into {format}: {reason}; write SVG")]
    Conversion {
        /// The format asked for.
        format: &'static str,
        /// Message of the library.
        reason: String,
    },
}
