//! Why a recording is refused; every message ends with what to do about it.

use std::fmt;
use std::io;
use std::path::PathBuf;

use super::repair::SkippedRow;
use super::row_fault::RowFault;
use super::units::Quantity;
use super::wording::{
    counted, counted_rows, listed, lvm_as_csv, missing_remedy, nearest_remedy, shell_quoted, shown_path,
    too_few_remedy, twice_remedy,
};

/// Displays as `path:line:column: reason`, which editors turn into a link; trouble with the file as a whole
/// is `path: reason`.
#[derive(Debug, thiserror::Error)]
#[error("{}{}: {kind}", shown_path(path), shown_place(*place))]
pub struct ReadError {
    /// File being read; `-` is standard input.
    pub path: PathBuf,
    /// Where in the file, unless it concerns the whole.
    pub place: Option<Place>,
    /// The fault there.
    pub kind: Box<ReadErrorKind>,
}

/// A reason and, unless it concerns the whole file, its place.
pub(super) type Refusal = (Option<Place>, ReadErrorKind);

/// Concerns the whole file.
pub(super) fn whole(kind: ReadErrorKind) -> Refusal {
    (None, kind)
}

/// A place in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Line, counted from 1; comments and blank lines count.
    pub line: u64,
    /// Field within the line, counted from 1.
    pub column: u64,
}

/// Faults of a recording.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadErrorKind {
    /// There is no such file.
    #[error("{remedy}")]
    NotFound {
        /// The remedy: the name that was probably meant, if there is one.
        remedy: String,
    },
    /// The file may not be read.
    #[error("permission denied; make the file readable")]
    PermissionDenied,
    /// The path is a directory.
    #[error("is a directory; name the recordings in it")]
    Directory,
    /// The system failed to read on.
    #[error("cannot be read: {source}; check the disk or copy the file anew")]
    Unreadable {
        /// Message of the system.
        source: io::Error,
    },
    /// Compressed data that ends early or is damaged.
    #[error("the compressed data is damaged or cut off ({source}); copy the file anew, or test it with gzip -t")]
    DamagedGzip {
        /// Message of the decompressor.
        source: io::Error,
    },
    /// The temporary file for large recordings cannot be written.
    #[error(
        "the recording is larger than memory and the temporary file in {} cannot be written: {source}; \
         set TMPDIR to a directory with space",
        directory.display()
    )]
    Spill {
        /// Where the file should have gone.
        directory: PathBuf,
        /// Message of the system.
        source: io::Error,
    },
    /// Text in UTF-16.
    #[error("the text is UTF-16; save it as UTF-8 (iconv -f UTF-16 -t UTF-8)")]
    Utf16,
    /// Not text.
    #[error("this is {found}, not text; {remedy}")]
    Binary {
        /// The format that it seems to have.
        found: &'static str,
        /// The remedy.
        remedy: &'static str,
    },
    /// A format of recordings that is known, and not read.
    #[error("this is {found}, which is not read; {remedy}")]
    NotRead {
        /// Its kind.
        found: &'static str,
        /// The remedy.
        remedy: String,
    },
    /// A file of LabVIEW whose header does not end.
    #[error("the header of the LabVIEW file does not end (***End_of_Header*** twice); copy the file anew")]
    LvmHeader,
    /// A file of LabVIEW without one column of time for all channels.
    #[error(
        "the LabVIEW file has no single column of time (X_Columns {found}); choose one column for X values in Write To \
         Measurement File{}",
        lvm_as_csv(found)
    )]
    LvmTime {
        /// The file's own statement about it.
        found: String,
    },
    /// A MATLAB file that contradicts itself or ends early.
    #[error("the MATLAB file is damaged or cut off ({reason}); copy it anew, or save it anew with save -v7")]
    DamagedMat {
        /// The fault.
        reason: &'static str,
    },
    /// Compressed data that grows beyond what a recording can be.
    #[error("the compressed data grows beyond {limit} bytes, which no recording of this size does; save it anew")]
    ExpandsTooFar {
        /// Bytes that it may grow to.
        limit: u64,
    },
    /// A channel is missing, and a variable is an object that only MATLAB understands.
    #[error(
        "variable \"{name}\" is a {class} object, which only MATLAB reads; save its numbers, for a timeseries: \
         t = {name}.Time; x = {name}.Data; save('log.mat', 't', 'x', '-v7')"
    )]
    MatObject {
        /// Name of the variable.
        name: String,
        /// Its class.
        class: String,
    },
    /// Variables of different lengths.
    #[error(
        "\"{first}\" has {n_first} samples and \"{second}\" {n_second}; save signals of one rate (in MATLAB: interp1), \
         or name others with --map"
    )]
    LengthsDiffer {
        /// A variable.
        first: String,
        /// Its length.
        n_first: usize,
        /// Another.
        second: String,
        /// Its length.
        n_second: usize,
    },
    /// Lines that end as on a Macintosh before 2001.
    #[error("lines end with a carriage return alone; convert the file (tr '\\r' '\\n')")]
    CarriageReturns,
    /// Nothing but blank lines and comments.
    #[error("the file holds no rows; record again, or check that the logger closed the file")]
    Empty,
    /// A header, a row or a comment of absurd length.
    #[error("the line is longer than {limit} bytes; check that lines end with a line feed")]
    LineTooLong {
        /// Longest line that is read, in bytes.
        limit: usize,
    },
    /// The first row is numbers and nobody named the columns.
    #[error("the file has no header; name its columns in their order, for example --columns {example} (- skips one)")]
    NoHeader {
        /// Names for as many columns as the file has.
        example: String,
    },
    /// Columns separated by blanks.
    #[error("the columns are separated by spaces; separate them by comma, semicolon or tab")]
    SpaceSeparated,
    /// A quote in the header that is not closed.
    #[error("a quote is not closed on its line; close it or remove it")]
    OpenQuote,
    /// A column whose name nearly is a quantity that the file lacks.
    #[error("unknown column \"{name}\"; did you mean {suggestion}?")]
    UnknownColumn {
        /// Name found.
        name: String,
        /// The right name that is nearest.
        suggestion: String,
    },
    /// A quantity whose unit is not known.
    #[error(
        "unknown unit \"{unit}\" of column \"{name}\"; {quantity} can be in {}, for example {} \
         (for other units see --calibrate)",
        quantity.unit_list(),
        quantity.example()
    )]
    UnknownUnit {
        /// Name found.
        name: String,
        /// Text after the quantity.
        unit: String,
        /// The quantity.
        quantity: Quantity,
    },
    /// A quantity without a unit.
    #[error(
        "column \"{name}\" has no unit; add it to the name ({}) or give it on the command line, \
         for example --map {}={}",
        quantity.unit_list(),
        quantity.example(),
        shell_quoted(name)
    )]
    UnitMissing {
        /// Name found.
        name: String,
        /// The quantity.
        quantity: Quantity,
    },
    /// Two columns for one quantity.
    #[error("column \"{second}\" gives {quantity} again after \"{first}\"; {}", twice_remedy(first, second))]
    Twice {
        /// The quantity.
        quantity: Quantity,
        /// The column that came first.
        first: String,
        /// The column that came again.
        second: String,
    },
    /// A quantity that no column gives.
    #[error("no column gives {quantity}; {} (the file has {})", missing_remedy(*quantity, hint.as_deref()), listed(columns))]
    Missing {
        /// The quantity.
        quantity: Quantity,
        /// Columns that the file has.
        columns: Vec<String>,
        /// Command-line option that would probably do.
        hint: Option<String>,
    },
    /// `--map` or `--calibrate` names a column that the file lacks.
    #[error("{option} names column \"{original}\", which the file lacks; {}", nearest_remedy(nearest.as_deref(), columns))]
    NoSuchColumn {
        /// The option, or the file and the table in it.
        option: String,
        /// The name in the option.
        original: String,
        /// The nearest name in the file.
        nearest: Option<String>,
        /// Columns that the file has.
        columns: Vec<String>,
    },
    /// `--map` or `--calibrate` names a column that the file has twice.
    #[error(
        "{option} names column \"{original}\", which the file has more than once; rename one of them in the header"
    )]
    AmbiguousColumn {
        /// The option, or the file and the table in it.
        option: String,
        /// The name in the option.
        original: String,
    },
    /// Two options supply one quantity.
    #[error("{first} and {second} both supply {quantity}; leave one away")]
    OptionTwice {
        /// The quantity.
        quantity: Quantity,
        /// The option that came first.
        first: String,
        /// The other one.
        second: String,
    },
    /// A constant for a channel that the file has.
    #[error("{option} contradicts column \"{column}\", which gives {quantity} too; leave it away")]
    FixedClash {
        /// The option, or the file and the table in it.
        option: String,
        /// Name in the file.
        column: String,
        /// The quantity.
        quantity: Quantity,
    },
    /// `--columns` names more or fewer columns than the file has.
    #[error("--columns names {} but the file has {}; name each of them in its order, - skips one", counted(*given, "column"), counted(*found, "column"))]
    ColumnsCount {
        /// Names given.
        given: usize,
        /// Columns found.
        found: usize,
    },
    /// `--columns` for a file with a header.
    #[error("the file has a header of its own; leave --columns away and rename its columns with --map")]
    HeaderPresent,
    /// A row that cannot be used.
    #[error("{fault}; {}", fault.remedy())]
    Row {
        /// Its fault.
        fault: RowFault,
    },
    /// Fewer rows than are needed.
    #[error("{}{}; {}", counted_rows(*found), skipped_clause(*skipped, first_skipped.as_ref()), too_few_remedy(*found, *needed, *skipped))]
    TooFewRows {
        /// Rows that could be used.
        found: usize,
        /// Rows that are needed.
        needed: usize,
        /// Rows that were skipped.
        skipped: u64,
        /// The first of them.
        first_skipped: Option<SkippedRow>,
    },
    /// A clock that stands still.
    #[error("time never varies (it is {time_s} s in every row); check the logger's clock and the column that holds it")]
    TimeNeverVaries {
        /// Where the clock stands.
        time_s: f64,
    },
    /// A clock that stands still for very long.
    #[error(
        "time stands at {time_s} s for more than {rows} rows; \
         check the logger's clock, or cut the file where it stopped"
    )]
    ClockStands {
        /// Where the clock stands.
        time_s: f64,
        /// For how long at least.
        rows: usize,
    },
    /// Stamps so large that the time between rows is lost in their rounding.
    #[error("the stamps around {time_s} s are too large to tell rows apart; subtract the start from the time column")]
    StampsTooLarge {
        /// One of them.
        time_s: f64,
    },
    /// A load cell that shows one value.
    #[error(
        "force never varies (it is {force_n} N in every row); check the load cell and the column that holds it, \
         or for a dead weight leave the column out and give --fixed force_N={force_n}"
    )]
    ForceNeverVaries {
        /// The value.
        force_n: f64,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:{}", self.line, self.column)
    }
}

fn shown_place(place: Option<Place>) -> String {
    place.map_or_else(String::new, |place| format!(":{}:{}", place.line, place.column))
}

fn skipped_clause(skipped: u64, first: Option<&SkippedRow>) -> String {
    match first {
        Some(first) => {
            format!(" that can be used ({skipped} skipped, the first at line {}: {})", first.line, first.reason)
        }
        None => String::new(),
    }
}
