//! Where an artifact comes from: the program that wrote it and the files that went into it.

use pam_recording::Recording;
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
