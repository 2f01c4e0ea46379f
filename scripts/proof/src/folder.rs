//! Files of a case: what the programs are given in one folder, what only the score may see in another.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result};
use serde::{Deserialize, Serialize};

use crate::case::{Case, Log, Noise};
use crate::rig::{Hidden, Rig, hidden_of};

/// Muscle file of a case.
pub const MUSCLE: &str = "muscle.toml";
/// Model of a case, by `pam-identify`.
pub const MODEL: &str = "model.json";
/// Diagnosis of a case.
pub const DIAGNOSIS: &str = "diagnosis.json";
/// Augmented model of a case.
pub const AUGMENTED: &str = "augmented.json";
/// Which recording is which.
const RECORDINGS: &str = "recordings.json";

/// Makes a folder for results, and those above it, where there is none.
///
/// # Errors
/// Where it cannot be made.
pub fn make(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).with_context(|| format!("{}: cannot be made", folder.display()))
}

/// Which recordings of a folder are fitted and which are held out; no truth.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recordings {
    /// Fitted.
    pub estimation: Vec<String>,
    /// Held out.
    pub holdout: Vec<String>,
}

impl Recordings {
    /// Those of `case`.
    pub fn of(case: &Case) -> Self {
        let files = |logs: &[Log]| logs.iter().map(|log| log.file.clone()).collect();
        Self { estimation: files(&case.estimation), holdout: files(&case.holdout) }
    }

    /// Reads those of a folder.
    ///
    /// # Errors
    /// Where the file cannot be read.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join(RECORDINGS);
        let text = std::fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
        serde_json::from_slice(&text).with_context(|| path.display().to_string())
    }

    /// Every file.
    pub fn all(&self) -> impl Iterator<Item = &String> {
        self.estimation.iter().chain(&self.holdout)
    }
}

/// Writes what the programs are given of `case` into `folder`.
///
/// # Errors
/// Where a recording cannot be made or written.
pub fn write(case: &Case, folder: &Path) -> Result<Recordings> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    let rig = Rig::of(case);
    std::fs::write(folder.join(MUSCLE), rig.muscle_file())?;
    let recordings = Recordings::of(case);
    std::fs::write(folder.join(RECORDINGS), serde_json::to_vec_pretty(&recordings)?)?;
    for log in case.estimation.iter().chain(&case.holdout) {
        record(case, &rig, log, Some(&case.noise), &folder.join(&log.file))?;
    }
    Ok(recordings)
}

/// Writes the held-out recordings of `case` without noise into `folder`; gives their paths.
///
/// # Errors
/// Where a recording cannot be made or written.
pub fn write_noise_free(case: &Case, folder: &Path) -> Result<Vec<PathBuf>> {
    let rig = Rig::of(case);
    let mut paths = Vec::new();
    for log in &case.holdout {
        let path = folder.join(format!("noise-free-{}", log.file));
        record(case, &rig, log, None, &path)?;
        paths.push(path);
    }
    Ok(paths)
}

fn record(case: &Case, rig: &Rig, log: &Log, noise: Option<&Noise>, path: &Path) -> Result<()> {
    let effects = hidden_of(case);
    let hidden = Hidden { effects: &effects, seed: case.effect_seed, misfit_n: case.noise.misfit_n };
    let recording = rig.record(log, &hidden, noise)?;
    let file = File::create(path).with_context(|| format!("cannot write {}", path.display()))?;
    recording.write_csv(&mut BufWriter::new(file)).with_context(|| format!("cannot write {}", path.display()))
}
