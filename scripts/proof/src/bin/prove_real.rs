//! Diagnose two real muscles.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result};
use clap::Parser;
use pam_cli::{RunArgs, Verdict};
use pam_proof::real::{self, MUSCLES};

/// Diagnose the recordings of two real muscles, beside eq. 11 alone and a black box.
#[derive(Debug, Parser)]
#[command(version, after_help = "Exit codes: 0 both targets reached, 1 one missed, 2 input or usage.")]
struct Args {
    /// Folder with the recordings; make recordings fetches them.
    #[arg(long, value_name = "DIR", default_value = "recordings")]
    recordings: PathBuf,

    /// Write RESULTS-REAL.md into a folder.
    #[arg(long, value_name = "DIR")]
    record: Option<PathBuf>,

    #[command(flatten)]
    run: RunArgs,
}

fn main() -> std::process::ExitCode {
    pam_cli::main(run)
}

fn run(args: &Args) -> Result<Verdict> {
    let console = args.run.start()?;
    let own = std::env::current_exe()?;
    let bin = own.parent().context("the running program has no folder")?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    if let Some(folder) = &args.record {
        pam_proof::folder::make(folder)?;
    }
    let mut results = Vec::new();
    for muscle in MUSCLES {
        console.note(format!("diagnosing the muscle cut to {}", muscle.cut));
        results.push(real::prove(muscle, &args.recordings, bin, &root)?);
    }
    pam_cli::write_file("-", real::table(&results).to_terminal())?;
    if let Some(folder) = &args.record {
        std::fs::write(folder.join("RESULTS-REAL.md"), real::markdown(&results))?;
    }
    let all = results.iter().all(|result| result.diagnosed_n <= result.muscle.target_n);
    Ok(if all { Verdict::Accepted } else { Verdict::Rejected })
}
