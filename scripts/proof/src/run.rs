//! All of it in order: draw, seal, diagnose, open, score.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result};
use pam_artifact::DiagnosisArtifact;
use pam_cli::{Console, Progress};
use rayon::prelude::*;

use crate::case::Case;
use crate::draw::{self, plan};
use crate::folder::{self, DIAGNOSIS, Recordings};
use crate::heldout;
use crate::programs::{Programs, Took};
use crate::results::Results;
use crate::score::{Diagnosed, Outcome, Score};
use crate::seal::{self, Truth};

/// Folder of what the programs see.
const CASES: &str = "cases";
/// Folder of what they do not.
const TRUTH: &str = "truth";

/// Cases on the disk, the truth sealed.
#[derive(Debug)]
pub struct Sealed {
    folder: PathBuf,
    hash: String,
    cases: Vec<Case>,
    dropped: Vec<String>,
}

impl Sealed {
    /// Draws `count` cases and seals their truth in `folder`.
    ///
    /// # Errors
    /// Where a file cannot be written.
    pub fn draw(count: usize, seed: u64, folder: &Path, console: &Console) -> Result<Self> {
        let progress = console.progress("drawing and calibrating", count as u64);
        let drawn: Vec<Result<Case>> =
            plan(count, seed).par_iter().map(|plan| counted(&progress, || draw::case(plan, seed))).collect();
        let (mut cases, mut dropped) = (Vec::new(), Vec::new());
        for case in drawn {
            match case {
                Ok(case) => cases.push(case),
                Err(reason) => dropped.push(format!("{reason:#}")),
            }
        }
        let folder = &std::path::absolute(folder)?;
        let truth = folder.join(TRUTH);
        std::fs::create_dir_all(&truth).with_context(|| format!("cannot make {}", truth.display()))?;
        let truth_of = Truth { seed, cases };
        let hash = seal::close(&truth, &truth_of)?;
        Ok(Self { folder: folder.to_owned(), hash, cases: truth_of.cases, dropped })
    }

    /// Cases that were drawn before, in `folder`.
    ///
    /// # Errors
    /// Where a file is missing or the truth is not the one that was sealed.
    pub fn found(folder: &Path) -> Result<Self> {
        let folder = &std::path::absolute(folder)?;
        let (truth, hash) = seal::open(&folder.join(TRUTH), None)?;
        Ok(Self { folder: folder.to_owned(), hash, cases: truth.cases, dropped: Vec::new() })
    }

    /// SHA-256 of the truth.
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Cases that could not be drawn, in words.
    pub fn dropped(&self) -> &[String] {
        &self.dropped
    }

    fn folder_of(&self, case: &Case) -> PathBuf {
        self.folder.join(CASES).join(&case.name)
    }

    /// Records every case and identifies its model.
    ///
    /// # Errors
    /// Where a recording cannot be made or `pam-identify` refuses it.
    pub fn generate(&self, programs: &Programs, console: &Console) -> Result<()> {
        let progress = console.progress("recording", self.cases.len() as u64);
        self.cases.par_iter().try_for_each(|case| {
            counted(&progress, || {
                let folder = self.folder_of(case);
                let recordings = folder::write(case, &folder)?;
                programs.identify(&folder, &recordings).map(|_| ()).with_context(|| case.name.clone())
            })
        })
    }

    /// Diagnoses every case that has a folder; records and identifies before where `fresh`. Then opens the seal and scores.
    ///
    /// # Errors
    /// Where a file cannot be read or the truth is not the one that was sealed.
    pub fn diagnose(&self, programs: &Programs, fresh: bool, console: &Console) -> Result<Results> {
        let progress = console.progress("diagnosing", self.cases.len() as u64);
        let diagnosed: Vec<Result<Took>> = self
            .cases
            .par_iter()
            .map(|case| counted(&progress, || diagnose(case, &self.folder_of(case), programs, fresh)))
            .collect();
        let (truth, hash) = seal::open(&self.folder.join(TRUTH), Some(&self.hash))?;
        let progress = console.progress("scoring", self.cases.len() as u64);
        let scores: Result<Vec<Score>> = truth
            .cases
            .into_par_iter()
            .zip(diagnosed)
            .map(|(case, took)| counted(&progress, || score(case, took, &self.folder, programs)))
            .collect();
        Ok(Results { seed: truth.seed, hash, scores: scores?, dropped: self.dropped.clone() })
    }
}

fn counted<T>(progress: &Progress, work: impl FnOnce() -> T) -> T {
    let done = work();
    progress.advance(1);
    done
}

fn diagnose(case: &Case, folder: &Path, programs: &Programs, fresh: bool) -> Result<Took> {
    if !fresh {
        let recordings = Recordings::read(folder)?;
        return Ok(Took { identify_s: 0.0, diagnose_s: programs.diagnose(folder, &recordings)? });
    }
    let recordings = folder::write(case, folder)?;
    let identify_s = programs.identify(folder, &recordings)?;
    Ok(Took { identify_s, diagnose_s: programs.diagnose(folder, &recordings)? })
}

/// Scores a case. A program that failed is a miss of the case, not of the proof.
fn score(case: Case, took: Result<Took>, root: &Path, programs: &Programs) -> Result<Score> {
    let folder = root.join(CASES).join(&case.name);
    let hidden = root.join(TRUTH).join(&case.name);
    let judged = took.and_then(|took| {
        let (artifact, _) = DiagnosisArtifact::read(&folder.join(DIAGNOSIS))?;
        std::fs::create_dir_all(&hidden)?;
        let logs = folder::write_noise_free(&case, &hidden)?;
        let heldout = heldout::errors(programs, &folder, &logs);
        std::fs::remove_dir_all(&hidden)?;
        Ok((Diagnosed::from(&artifact), heldout?, took))
    });
    let (outcome, heldout, Took { identify_s, diagnose_s }) = match judged {
        Ok((diagnosed, heldout, took)) => (Outcome::Diagnosed(diagnosed), Some(heldout), took),
        Err(reason) => (Outcome::Failed(format!("{reason:#}")), None, Took::default()),
    };
    Ok(Score { case, outcome, heldout, identify_s, diagnose_s })
}
