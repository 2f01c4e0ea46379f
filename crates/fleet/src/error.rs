//! Why a fleet cannot be planned or reported.

use std::path::PathBuf;

/// Why a table of recordings is refused. Displays as `path:line:column: reason`.
#[derive(Debug, thiserror::Error)]
#[error("{}", place(path, *line, *column, kind))]
pub struct TableError {
    /// Table being read.
    pub path: PathBuf,
    /// Line, counted from 1; 0 where the table as a whole is meant.
    pub line: u64,
    /// Field within the line, counted from 1.
    pub column: u64,
    /// The fault there.
    pub kind: TableErrorKind,
}

fn place(path: &std::path::Path, line: u64, column: u64, kind: &TableErrorKind) -> String {
    match line {
        0 => format!("cannot read {}: {kind}", path.display()),
        _ => format!("{}:{line}:{column}: {kind}", path.display()),
    }
}

/// What is wrong at a place of a table.
#[derive(Debug, thiserror::Error)]
pub enum TableErrorKind {
    /// The system does not give the file.
    #[error("{reason}")]
    Unreadable {
        /// Why, with the way out.
        reason: String,
    },
    /// The file is no CSV.
    #[error("this is no CSV in UTF-8; save the table as comma-separated text")]
    NotText,
    /// A column has a name that no table has.
    #[error("column \"{found}\" is unknown; {}", match near {
        Some(near) => format!("did you mean {near}?"),
        None => "a table has path, muscle, rig, date, role and may have make, dimensions".to_owned(),
    })]
    UnknownColumn {
        /// Name found.
        found: String,
        /// Name that was probably meant.
        near: Option<String>,
    },
    /// A column stands there twice.
    #[error("column {name} stands there twice")]
    ColumnTwice {
        /// Its name.
        name: String,
    },
    /// A column is missing.
    #[error("column {name} is missing; a table has path, muscle, rig, date, role and may have make, dimensions")]
    NoColumn {
        /// Its name.
        name: &'static str,
    },
    /// There is a header alone.
    #[error("the table has no rows; give one for each recording")]
    NoRows,
    /// A field is empty that must not be.
    #[error("{name} is empty; name it")]
    Empty {
        /// Name of the column.
        name: &'static str,
    },
    /// A role that there is not.
    #[error("role is \"{found}\", expected estimation or holdout")]
    UnknownRole {
        /// What stands there.
        found: String,
    },
    /// A date that does not sort as text.
    #[error("\"{found}\" is no date; write it as 2026-03-01")]
    NoDate {
        /// What stands there.
        found: String,
    },
    /// The same file again.
    #[error("the same recording stands in line {first}; keep one of the two")]
    Twice {
        /// Line where it stands first.
        first: u64,
    },
    /// Nothing says what the muscle's dimensions are.
    #[error("no dimensions are known; name a muscle file with --muscle, or in a column dimensions")]
    NoDimensions,
    /// A campaign that nothing can be fitted to.
    #[error("{muscle} on {rig} at {date} has no recording for estimation; give one of its rows the role estimation")]
    NoEstimation {
        /// Muscle.
        muscle: String,
        /// Rig.
        rig: String,
        /// Date.
        date: String,
    },
    /// Rows of one campaign contradict one another.
    #[error("{what} differs from that of the same muscle in line {first}; a muscle has one")]
    Contradiction {
        /// What differs.
        what: &'static str,
        /// Line of the other row.
        first: u64,
    },
}
