//! Files that people write in TOML: why one cannot be read, with its place.

use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use crate::spelling::{toml_fault, unreadable};

/// Why a file of TOML is refused before anything in it is looked at.
#[derive(Debug, thiserror::Error)]
pub enum TomlFileError {
    /// The file cannot be read.
    #[error("cannot read {what} {}: {}", path.display(), unreadable(path, reason))]
    Read {
        /// What it was to be.
        what: &'static str,
        /// File asked for.
        path: PathBuf,
        /// What the system said.
        reason: std::io::Error,
    },
    /// The text is none of its kind.
    #[error("{}:{line}:{column}: {reason}", path.display())]
    Parse {
        /// File being read.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What the parser found.
        reason: String,
    },
}

/// The text of `path`, which is to be `what`.
///
/// # Errors
/// [`TomlFileError::Read`].
pub fn read_text(path: &Path, what: &'static str) -> Result<String, TomlFileError> {
    std::fs::read_to_string(path).map_err(|reason| TomlFileError::Read { what, path: path.to_owned(), reason })
}

/// What `text` says; `path` is for messages.
///
/// # Errors
/// [`TomlFileError::Parse`].
pub fn parse<T: DeserializeOwned>(text: &str, path: &Path) -> Result<T, TomlFileError> {
    toml::from_str(text).map_err(|error| {
        let (line, column, reason) = toml_fault(text, &error);
        TomlFileError::Parse { path: path.to_owned(), line, column, reason }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Arm {
        #[serde(rename = "length_mm")]
        _length_mm: f64,
    }

    #[test]
    fn a_slip_in_a_key_is_told_with_its_place_and_the_key_that_was_meant() {
        let error = parse::<Arm>("# an arm\nlenght_mm = 3", Path::new("arm.toml")).expect_err("a slip");
        assert_eq!(error.to_string(), "arm.toml:2:1: unknown field `lenght_mm`; did you mean `length_mm`?");
    }

    #[test]
    fn a_missing_file_is_told_by_what_it_was_to_be() {
        let error = read_text(Path::new("no/such.toml"), "muscle file").expect_err("no file");
        assert_eq!(error.to_string(), "cannot read muscle file no/such.toml: no such file; check the path");
    }
}
