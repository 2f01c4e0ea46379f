//! The truth is written, and its SHA-256 made known, before anything is diagnosed.

use std::path::Path;

use anyhow::{Context as _, Result, ensure};
use pam_recording::sha256_hex;
use serde::{Deserialize, Serialize};

use crate::case::Case;

/// Name of the file with the truth.
pub const TRUTH: &str = "truth.json";
/// Name of the file with its hash, as `sha256sum -c` reads it.
pub const HASH: &str = "truth.json.sha256";

/// The truth of all cases.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Truth {
    /// Seed of the whole proof.
    pub seed: u64,
    /// Every case.
    pub cases: Vec<Case>,
}

/// Writes the truth into `folder` and its hash beside it; gives the hash.
///
/// # Errors
/// Where a file cannot be written.
pub fn close(folder: &Path, truth: &Truth) -> Result<String> {
    let mut json = serde_json::to_vec_pretty(truth)?;
    json.push(b'\n');
    let hash = sha256_hex(&json);
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))
    };
    write(TRUTH, &json)?;
    write(HASH, format!("{hash}  {TRUTH}\n").as_bytes())?;
    Ok(hash)
}

/// Reads the truth in `folder`, after its hash has been checked against the file beside it, and against
/// `announced`, where that is known.
///
/// # Errors
/// Where a file cannot be read or the truth is not the one that was sealed.
pub fn open(folder: &Path, announced: Option<&str>) -> Result<(Truth, String)> {
    let read = |name: &str| {
        let path = folder.join(name);
        std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))
    };
    let json = read(TRUTH)?;
    let sealed = String::from_utf8(read(HASH)?)?;
    let hash = sha256_hex(&json);
    let is_same =
        sealed.split_whitespace().next() == Some(hash.as_str()) && announced.is_none_or(|known| known == hash);
    ensure!(is_same, "{}: the truth was changed after it was sealed", folder.join(TRUTH).display());
    Ok((serde_json::from_slice(&json)?, hash))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_truth_that_was_changed_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let truth = Truth { seed: 3, cases: Vec::new() };
        let hash = close(folder.path(), &truth).unwrap();
        assert_eq!(open(folder.path(), Some(&hash)).unwrap().0, truth);
        std::fs::write(folder.path().join(TRUTH), "{\"seed\": 4, \"cases\": []}\n").unwrap();
        let said = open(folder.path(), Some(&hash)).unwrap_err().to_string();
        assert!(said.contains("changed after it was sealed"), "{said}");
    }
}
