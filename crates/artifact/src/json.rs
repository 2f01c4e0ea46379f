//! Artifacts as text: written so that every program can read them, and read with the place of what is wrong.

use std::path::Path;

use pam_recording::sha256_hex;
use pam_recording::spelling::suggesting;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::error::ArtifactError;

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
