//! Recordings: what a bench wrote, repaired where that is unambiguous, in SI.
//!
//! A recording is four columns (time, pressure, length, force) and, where logged, temperature. The columns
//! live in [`Samples`], in chunks, so that a recording may be larger than memory; everything that walks
//! over it takes one chunk at a time. A gap in time splits a recording into [segments](Recording::segments):
//! no filter, derivative or memory runs across one.
//!
//! In the order in which bytes pass: `source` opens, decompresses and hashes; `lines` cuts; `sniff` finds the
//! separator; `lvm` passes over the header of a LabVIEW file; `opening` and `header` give the columns a meaning, with what `options` and
//! `channels` say; `rows` reads numbers, and `date` stamps; `matlab` takes columns of a MATLAB file; `clock` drops rows that
//! contradict their neighbors; `stamps` spreads equal stamps and finds gaps; `samples` keeps. [`quality`] then says what a
//! recording is good for, and [`spelling`] the word that was probably meant, in any file that people write.
//!
//! Conventions: SI inside; pressure is gauge; force is tension, positive when the muscle pulls. Nothing here prints, reads a
//! clock or draws random numbers, and nothing knows a muscle: `pam-muscle` does.

mod body;
mod channels;
mod clock;
mod date;
mod digest;
mod error;
mod expression;
mod fields;
mod header;
mod lines;
mod lvm;
mod matlab;
mod opening;
mod options;
pub mod quality;
mod read;
mod repair;
mod row_fault;
mod rows;
mod sameness;
mod samples;
mod sniff;
mod source;
pub mod spelling;
mod spill;
mod stamps;
pub mod toml_file;
mod units;
mod wording;

pub use channels::{ChannelFault, Channels, ChannelsError, ChannelsFile};
pub use digest::sha256_hex;
pub use error::{Place, ReadError, ReadErrorKind};
pub use expression::ExpressionFault;
pub use options::{Calibration, ColumnMap, Columns, FixedChannel, OptionSyntaxError, ReadOptions};
pub use read::{read_recording, read_recording_observed};
pub use repair::{Repairs, SkippedRow};
pub use row_fault::RowFault;
pub use sameness::{Repeated, first_shared, repeats_itself, share_samples};
pub use samples::{CHUNK_ROWS, Chunk, MEMORY_ROWS, Samples};
pub use units::Quantity;

use std::ops::Range;

/// One recording as read.
#[derive(Debug, Clone)]
pub struct Recording {
    /// Path as given on the command line; `-` for standard input.
    pub path: String,
    /// SHA-256 of the file's bytes as they lie on the disk (compressed where it is compressed), hexadecimal.
    pub sha256: String,
    /// The columns, in SI.
    pub samples: Samples,
    /// Stretches without a gap in time, as ranges of rows; together they cover all rows.
    pub segments: Vec<Range<usize>>,
    /// Repairs and exclusions while reading.
    pub repairs: Repairs,
    /// Names of the columns that are kept out of the way.
    pub ignored_columns: Vec<String>,
}
