//! Why an artifact is refused.

use std::path::PathBuf;

use pam_recording::spelling::unreadable;

/// Why an artifact is refused.
#[derive(Debug, thiserror::Error)]
pub enum ArtifactError {
    /// The file cannot be read.
    #[error("cannot read {}: {}", path.display(), unreadable(path, reason))]
    Read {
        /// File asked for.
        path: PathBuf,
        /// What the system said.
        reason: std::io::Error,
    },
    /// The file is no JSON, or lacks what an artifact must have.
    #[error("{}:{line}:{column}: {reason}; expected a {expected} artifact", path.display())]
    Parse {
        /// File being read.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What the parser found.
        reason: String,
        /// Schema that was expected.
        expected: &'static str,
    },
    /// The artifact is of another kind or version.
    #[error("{}: schema is \"{found}\", expected \"{expected}\"; {remedy}", path.display())]
    Schema {
        /// File being read.
        path: PathBuf,
        /// Schema found.
        found: String,
        /// Schema that was expected.
        expected: &'static str,
        /// What to do.
        remedy: String,
    },
    /// A value that no artifact of this kind has.
    #[error("{}: {what}; write the artifact anew with its program", path.display())]
    Implausible {
        /// File being read.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// A result that no program could read, were it written.
    #[error("nothing is written, since no program could read it: {what}")]
    Unreadable {
        /// What is wrong.
        what: String,
    },
}
