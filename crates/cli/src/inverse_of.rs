//! An inverse beside the model that it belongs to.

use std::path::Path;

use anyhow::{bail, ensure};
use pam_artifact::{Input, InputRole, InverseArtifact};

/// Refuses an inverse of another model than `known`: its pressures would be right for another muscle. `path` is that of the
/// inverse.
///
/// # Errors
/// One line that names both models and how to get a pair.
pub fn ensure_inverse_of(path: &Path, inverse: &InverseArtifact, known: &Input) -> anyhow::Result<()> {
    let path = path.display();
    let remedy = format!("train it anew with pam-train-inverse --model {} --out {path}", known.path);
    let Some(trained) = inverse.inputs.iter().find(|input| input.role == InputRole::Model) else {
        bail!("{path}: it does not say which model it is the inverse of; {remedy}");
    };
    let short = |sha256: &str| sha256.chars().take(8).collect::<String>();
    ensure!(
        trained.sha256 == known.sha256,
        "{path}: it is the inverse of another model ({}, SHA-256 {}…) than --model {} ({}…); {remedy}, or name the model \
         that it belongs to",
        trained.path,
        short(&trained.sha256),
        known.path,
        short(&known.sha256)
    );
    Ok(())
}
