//! Artifacts: the JSON files that programs hand to one another.
//!
//! Every artifact begins with `schema`, `tool`, `inputs`, `config` and `seed`. Equal inputs give equal bytes on
//! any thread count; time stamps stay out.

pub mod agreement;
pub mod change;
pub mod comparison;
pub mod diagnosis;
mod effect_entry;
mod empirical;
pub mod estimates;
mod fit_report;
pub mod group;
mod identify_config;
pub mod inverse;
pub mod model;
pub mod prediction;
pub mod schemas;
pub mod summary;

pub use agreement::AgreementArtifact;
pub use change::ChangeArtifact;
pub use comparison::ComparisonArtifact;
pub use diagnosis::DiagnosisArtifact;
pub use estimates::Estimates;
pub use group::GroupArtifact;
pub use inverse::InverseArtifact;
pub use model::ModelArtifact;
pub use prediction::PredictionArtifact;
pub use summary::SummaryArtifact;

use std::path::{Path, PathBuf};

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::recording::Recording;
use crate::spelling::{suggesting, unreadable};

/// Program that wrote an artifact.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Tool {
    /// Name of the program.
    pub name: String,
    /// Its version.
    pub version: String,
}

/// A file that went into an artifact.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// Path as given on the command line.
    pub path: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
    /// What it served as.
    pub role: InputRole,
}

impl Input {
    /// A recording and what it served as.
    pub fn recording(recording: &Recording, role: InputRole) -> Self {
        Self { path: recording.path.clone(), sha256: recording.sha256.clone(), role }
    }
}

/// What a file served as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum InputRole {
    /// Dimensions of the muscle.
    Muscle,
    /// Recording that parameters were fitted to.
    Estimation,
    /// Recording that was held out.
    Validation,
    /// Recording whose pressures, lengths and directions a network was trained at.
    Training,
    /// Force model.
    Model,
    /// Force model of a simulated plant, other than the controller's.
    Plant,
    /// Inverse of a force model.
    Inverse,
    /// Configuration.
    Configuration,
}

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

/// An artifact as people and programs read it, with a line break at its end, once it has been read back.
///
/// # Errors
/// [`ArtifactError::Unreadable`], most likely where a number is none.
pub fn readable_json<T: Serialize + DeserializeOwned>(artifact: &T) -> Result<Vec<u8>, ArtifactError> {
    let unreadable = |what: String| ArtifactError::Unreadable { what };
    let mut bytes = serde_json::to_vec_pretty(artifact).map_err(|error| unreadable(error.to_string()))?;
    bytes.push(b'\n');
    if let Err(error) = serde_json::from_slice::<T>(&bytes) {
        let line = bytes.split(|byte| *byte == b'\n').nth(error.line().saturating_sub(1)).unwrap_or_default();
        let line = String::from_utf8_lossy(line);
        let line = line.trim().trim_end_matches(',');
        // What is not finite has no place in JSON.
        return Err(unreadable(match line.strip_suffix(": null") {
            Some(key) => format!("{} is no finite number", key.trim_matches('"')),
            None => format!("{line}: {}", without_position(&error.to_string())),
        }));
    }
    Ok(bytes)
}

/// An artifact of many numbers on one line, with a line break at its end.
///
/// # Errors
/// [`ArtifactError::Unreadable`] where it is no JSON.
pub(crate) fn line_json(artifact: &impl Serialize) -> Result<Vec<u8>, ArtifactError> {
    let mut bytes =
        serde_json::to_vec(artifact).map_err(|error| ArtifactError::Unreadable { what: error.to_string() })?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// SHA-256 of `bytes`, hexadecimal.
pub fn sha256_hex(bytes: &[u8]) -> String {
    let digest: [u8; 32] = Sha256::digest(bytes).into();
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Reads an artifact of schema `expected`, which `program` writes; gives its SHA-256 as well.
///
/// # Errors
/// [`ArtifactError`] names the file and the place.
pub(crate) fn read<T: DeserializeOwned>(
    path: &Path,
    expected: &'static str,
    program: &'static str,
) -> Result<(T, String), ArtifactError> {
    #[derive(Deserialize)]
    #[serde(expecting = "an object with a schema")]
    struct Head {
        schema: String,
    }
    let bytes = std::fs::read(path).map_err(|reason| ArtifactError::Read { path: path.to_owned(), reason })?;
    let parse = |error: &serde_json::Error| ArtifactError::Parse {
        path: path.to_owned(),
        line: error.line(),
        column: error.column(),
        // A recording begins with a word, an image with anything.
        reason: if error.is_syntax() && error.line() == 1 && error.column() <= 2 {
            "this is no JSON".to_owned()
        } else {
            suggesting(&in_words(&without_position(&error.to_string())))
        },
        expected,
    };
    let head: Head = serde_json::from_slice(&bytes).map_err(|error| parse(&error))?;
    if head.schema != expected {
        let remedy = remedy(&head.schema, expected, program);
        return Err(ArtifactError::Schema { path: path.to_owned(), found: head.schema, expected, remedy });
    }
    let artifact = serde_json::from_slice(&bytes).map_err(|error| parse(&error))?;
    Ok((artifact, sha256_hex(&bytes)))
}

/// What to do about an artifact of schema `found` where one of schema `expected` is needed, which `program` writes.
fn remedy(found: &str, expected: &str, program: &str) -> String {
    let version = |schema: &str| schema.rsplit_once('/').and_then(|(_, version)| version.parse::<u64>().ok());
    let same_kind = found.rsplit_once('/').map(|(kind, _)| kind) == expected.rsplit_once('/').map(|(kind, _)| kind);
    match (version(found), version(expected)) {
        (Some(found), Some(expected)) if same_kind && found < expected => {
            format!("an older version wrote it; write it anew with {program}")
        }
        (Some(_), Some(_)) if same_kind => {
            format!("a newer version wrote it; update the programs, or write it anew with {program}")
        }
        _ => format!("write it with {program}"),
    }
}

/// The message of a JSON error without names of types, which nobody outside this program knows.
fn in_words(message: &str) -> String {
    match message.split_once("expected struct ") {
        Some((before, _)) => format!("{before}expected an object"),
        None => message.to_owned(),
    }
}

/// The message of a JSON error without the position that it ends with.
fn without_position(message: &str) -> String {
    message.split(" at line ").next().unwrap_or(message).to_owned()
}
