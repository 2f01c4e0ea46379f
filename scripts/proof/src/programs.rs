//! The programs, run as a user runs them: as processes, over files.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::{Context as _, Result, bail, ensure};

use crate::folder::{AUGMENTED, DIAGNOSIS, MODEL, MUSCLE, Recordings};

/// Where the programs are.
#[derive(Debug, Clone)]
pub struct Programs {
    folder: PathBuf,
    diagnose: PathBuf,
}

/// How long the programs took, in s.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Took {
    /// `pam-identify`.
    pub identify_s: f64,
    /// `pam-diagnose`.
    pub diagnose_s: f64,
}

impl Programs {
    /// Programs beside the running one (or one folder above, where tests run), `pam-diagnose` from elsewhere if wanted.
    ///
    /// # Errors
    /// Where a program is missing.
    pub fn beside(diagnose: Option<PathBuf>) -> Result<Self> {
        let own = std::env::current_exe().context("cannot find the running program")?;
        let folder =
            own.ancestors().skip(1).take(2).find(|folder| folder.join("pam-identify").is_file()).with_context(
                || format!("{}: pam-identify is not beside it; build the workspace first", own.display()),
            )?;
        let diagnose = match diagnose {
            Some(diagnose) => diagnose.canonicalize().with_context(|| diagnose.display().to_string())?,
            None => folder.join("pam-diagnose"),
        };
        ensure!(diagnose.is_file(), "{} is missing; build the workspace first", diagnose.display());
        Ok(Self { folder: folder.to_owned(), diagnose })
    }

    /// Programs beside the running one without `pam-diagnose`, to generate cases with.
    ///
    /// # Errors
    /// Where `pam-identify` is missing.
    pub fn without_diagnosis() -> Result<Self> {
        Self::beside(Some(std::env::current_exe()?))
    }

    /// `pam-identify` in a folder; gives its time.
    ///
    /// # Errors
    /// Where it wrote no model.
    pub fn identify(&self, folder: &Path, recordings: &Recordings) -> Result<f64> {
        let mut command = Command::new(self.folder.join("pam-identify"));
        command.args(&recordings.estimation).args(["--muscle", MUSCLE, "--out", MODEL, "--accept-implausible"]);
        run(&mut command, folder, &folder.join(MODEL))
    }

    /// `pam-diagnose` in a folder that has a model; gives its time.
    ///
    /// # Errors
    /// Where it wrote no diagnosis.
    pub fn diagnose(&self, folder: &Path, recordings: &Recordings) -> Result<f64> {
        let mut command = Command::new(&self.diagnose);
        command.args(&recordings.estimation);
        for file in &recordings.holdout {
            command.arg("--holdout").arg(file);
        }
        command.args(["--model", MODEL, "--out", DIAGNOSIS, "--out-model", AUGMENTED]);
        let _ = std::fs::remove_file(folder.join(AUGMENTED));
        run(&mut command, folder, &folder.join(DIAGNOSIS))
    }

    /// `pam-predict`: `log` with the force of `model`, in `out`.
    ///
    /// # Errors
    /// Where it wrote nothing.
    pub fn predict(&self, folder: &Path, log: &Path, model: &str, out: &Path) -> Result<()> {
        let mut command = Command::new(self.folder.join("pam-predict"));
        command.arg(log).args(["--model", model, "--accept-implausible", "--out"]).arg(out);
        run(&mut command, folder, out).map(|_| ())
    }
}

/// Runs a program on one thread; it must write `out`, whether it is content with the result or not.
fn run(command: &mut Command, folder: &Path, out: &Path) -> Result<f64> {
    let _ = std::fs::remove_file(out);
    command.args(["--threads", "1", "--quiet"]).current_dir(folder);
    let name = Path::new(command.get_program()).file_name().unwrap_or(OsStr::new("program")).display().to_string();
    let start = Instant::now();
    let output = command.output().with_context(|| format!("cannot run {name}"))?;
    let took_s = start.elapsed().as_secs_f64();
    if !matches!(output.status.code(), Some(0 | 1)) || !out.is_file() {
        let said = String::from_utf8_lossy(&output.stderr);
        bail!("{name} ended with {}: {}", output.status, said.lines().last().unwrap_or("it said nothing"));
    }
    Ok(took_s)
}
