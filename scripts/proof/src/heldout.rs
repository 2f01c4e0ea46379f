//! Error on held-out recordings against the noise-free truth, of the base model and of the diagnosed one.
//!
//! Both models get pressure and length without noise: what a sensor's noise does on its way through a model is no
//! error of the model. Samples whose direction is unsettled do not count, as nowhere in the toolchain, nor do those at the end
//! of a sensor's range as the recordings show it: what it reads there is no truth.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, ensure};
use pam_artifact::ModelArtifact;
use pam_identification::predict::prepare;
use pam_identification::prepare::gate;
use pam_recording::quality::SensorEnds;
use pam_recording::{ReadOptions, Recording, read_recording};
use serde::{Deserialize, Serialize};

use crate::folder::{AUGMENTED, MODEL, Recordings};
use crate::programs::Programs;

/// Root mean square errors, in N.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HeldOut {
    /// Base model.
    pub base_n: f64,
    /// Diagnosed model; the base model's where there is none.
    pub diagnosed_n: f64,
}

impl HeldOut {
    /// Diagnosed over base.
    pub fn ratio(&self) -> f64 {
        self.diagnosed_n / self.base_n.max(1e-9)
    }
}

/// Errors of the models in `folder` on noise-free `logs`.
///
/// # Errors
/// Where a program fails or a file cannot be read.
pub fn errors(programs: &Programs, folder: &Path, logs: &[PathBuf]) -> Result<HeldOut> {
    let settled = settled(folder, logs)?;
    let of = |model: &str| error_n(programs, folder, logs, &settled, model);
    let base_n = of(MODEL)?;
    let diagnosed_n = if folder.join(AUGMENTED).is_file() { of(AUGMENTED)? } else { base_n };
    Ok(HeldOut { base_n, diagnosed_n })
}

/// Which samples of each log count.
fn settled(folder: &Path, logs: &[PathBuf]) -> Result<Vec<Vec<bool>>> {
    let (model, _) = ModelArtifact::read(&folder.join(MODEL))?;
    let noisy: Result<Vec<Recording>, _> = Recordings::read(folder)?
        .all()
        .map(|file| read_recording(&folder.join(file), &ReadOptions::default()))
        .collect();
    let noisy = gate(noisy?)?;
    let ends = SensorEnds::of(noisy.iter().map(|gated| &gated.quality));
    logs.iter()
        .map(|log| {
            let mut prepared = prepare(read_recording(log, &ReadOptions::default())?, &model)?;
            for rows in ends.reached(&prepared.recording, &prepared.quality)? {
                prepared.direction.leave_out(rows);
            }
            Ok((0..prepared.recording.samples.n_rows()).map(|row| prepared.direction.is_settled(row)).collect())
        })
        .collect()
}

fn error_n(programs: &Programs, folder: &Path, logs: &[PathBuf], settled: &[Vec<bool>], model: &str) -> Result<f64> {
    let out = folder.join("predicted.csv");
    let (mut squares, mut count) = (0.0, 0.0);
    for (log, settled) in logs.iter().zip(settled) {
        programs.predict(folder, log, model, &out)?;
        let residual_n = column(&out, "residual_N")?;
        ensure!(residual_n.len() == settled.len(), "{}: rows are missing", out.display());
        for (residual_n, _) in residual_n.iter().zip(settled).filter(|(_, settled)| **settled) {
            squares += residual_n * residual_n;
            count += 1.0;
        }
    }
    std::fs::remove_file(&out)?;
    Ok((squares / f64::max(count, 1.0)).sqrt())
}

/// One column of a table by name.
fn column(path: &Path, name: &str) -> Result<Vec<f64>> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    let mut lines = text.lines();
    let header = lines.next().unwrap_or_default();
    let index = header.split(',').position(|title| title == name).with_context(|| format!("no column {name}"))?;
    lines
        .map(|line| {
            let cell = line.split(',').nth(index).unwrap_or_default();
            cell.parse().with_context(|| format!("{}: \"{cell}\" is no number", path.display()))
        })
        .collect()
}
