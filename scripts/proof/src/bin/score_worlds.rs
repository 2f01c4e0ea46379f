//! Run the programs over cases of the independent bench and score what they say.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Parser;
use pam_proof::worlds::ask::{Cases, Layout};
use pam_proof::worlds::score::{Score, score};
use pam_proof::worlds::table::report;
use pam_proof::worlds::truth::truths;
use rayon::prelude::*;

/// Run identification, diagnosis and prediction over every case of a folder, and score strictly.
///
/// The programs see the recordings and the muscle file with default options; the truth is read afterwards. The error of
/// a model is measured against the force without noise, over all samples of every hold-out.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Examples:\n  score-worlds out/worlds --bin target/release --json out/worlds/scores.json\n  \
                  score-worlds out/worlds --trees scripts/proof/boosted-trees.py --leave-out"
)]
struct Args {
    /// Folder of cases with truth.json.
    #[arg(value_name = "DIR")]
    folder: PathBuf,

    /// Folder of the programs.
    #[arg(long, value_name = "DIR", default_value = "target/release")]
    bin: PathBuf,

    /// How the folder is laid out.
    #[arg(long, default_value = "worlds")]
    layout: Layout,

    /// Scores to write (JSON).
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,

    /// Score only the first cases.
    #[arg(long, value_name = "N")]
    first: Option<usize>,

    /// Keep models and diagnoses in this folder.
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,

    /// Take the models that were kept in this folder rather than identify them.
    #[arg(long, value_name = "DIR", conflicts_with = "keep")]
    models: Option<PathBuf>,

    /// Fit boosted trees to every case by this script, too (python3 with numpy and scikit-learn).
    #[arg(long, value_name = "SCRIPT")]
    trees: Option<PathBuf>,

    /// Diagnose every case with one effect once more, without that effect in the catalogue.
    #[arg(long)]
    leave_out: bool,

    /// Cases at a time; 0 is one a core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    jobs: usize,
}

fn main() -> Result<()> {
    let Args { folder, bin, layout, json, first, keep, models, trees, leave_out, jobs } = Args::parse();
    let truths = truths(&folder, layout, first)?;
    if layout == Layout::Outside && !folder.join("truth").exists() {
        writeln!(
            std::io::stdout(),
            "no force without noise in {}: errors are against the recorded force",
            folder.display()
        )?;
    }
    for program in ["pam-identify", "pam-diagnose", "pam-predict"] {
        if !bin.join(program).exists() {
            bail!("no {program} in {}", bin.display());
        }
    }
    if let Some(script) = trees.as_ref().filter(|script| !script.exists()) {
        bail!("no {}", script.display());
    }
    let cases = Cases { folder, layout, bin, keep, models, trees, leave_out };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).build()?;
    let scores: Vec<Score> = pool.install(|| {
        truths
            .into_par_iter()
            .map(|truth| -> Result<Score> {
                let answer = cases.ask(&truth)?;
                Ok(score(truth, answer))
            })
            .collect::<Result<_>>()
    })?;
    let value = report(&scores, &mut std::io::stdout().lock())?;
    if let Some(path) = &json {
        let mut text = serde_json::to_string_pretty(&value)?;
        text.push('\n');
        fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}
