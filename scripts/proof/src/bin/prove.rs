//! Conceal physics, diagnose it, score the diagnosis.

use std::path::PathBuf;

use anyhow::{Result, bail, ensure};
use clap::Parser;
use pam_cli::{Console, RunArgs, Verdict};
use pam_proof::programs::Programs;
use pam_proof::run::Sealed;

/// Conceal physics in fresh recordings, diagnose them without the truth, open the seal and score.
///
/// Every case is a random muscle taken through a standard set of protocols, with one effect of the catalogue
/// concealed, or two, three, none, or one that no catalogue has. The truth is written and its SHA-256 printed before
/// anything is diagnosed.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Examples:\n  \
                  prove --cases 24 --seed 7\n  \
                  prove --cases 44 --seed 7 --generate-only out/cases; prove --score-only out/cases\n\n\
                  Exit codes: 0 every target reached, 1 a target missed, 2 input, usage or a program that failed."
)]
struct Args {
    /// Cases to draw.
    #[arg(long, value_name = "N", default_value_t = 400)]
    cases: usize,

    /// Write the cases (recordings, muscle, model; the truth apart) into a folder, and stop.
    #[arg(long, value_name = "DIR", conflicts_with = "score_only")]
    generate_only: Option<PathBuf>,

    /// Diagnose and score the cases that --generate-only has left in a folder.
    #[arg(long, value_name = "DIR")]
    score_only: Option<PathBuf>,

    /// Write RESULTS.md, results.json and confusion.svg into a folder.
    #[arg(long, value_name = "DIR")]
    record: Option<PathBuf>,

    /// Diagnose with this program instead of the pam-diagnose beside this one.
    #[arg(long, value_name = "PROGRAM")]
    diagnose: Option<PathBuf>,

    #[command(flatten)]
    run: RunArgs,
}

fn main() -> std::process::ExitCode {
    pam_cli::main(run)
}

fn run(args: &Args) -> Result<Verdict> {
    let console = args.run.start()?;
    ensure!(args.cases > 0, "--cases 0 proves nothing");
    // Before an hour of work, not after it.
    if let Some(folder) = &args.record {
        pam_proof::folder::make(folder)?;
    }
    if let Some(folder) = &args.generate_only {
        let sealed = draw(args, folder, &console)?;
        sealed.generate(&Programs::without_diagnosis()?, &console)?;
        return Ok(Verdict::Accepted);
    }
    let programs = Programs::beside(args.diagnose.clone())?;
    let results = if let Some(folder) = &args.score_only {
        Sealed::found(folder)?.diagnose(&programs, false, &console)?
    } else {
        let scratch = tempfile::tempdir()?;
        draw(args, scratch.path(), &console)?.diagnose(&programs, true, &console)?
    };
    pam_cli::write_file("-", results.to_terminal())?;
    if let Some(folder) = &args.record {
        results.record(folder)?;
    }
    if let Some(failures) = results.failures() {
        bail!("{failures}");
    }
    Ok(if results.passes() { Verdict::Accepted } else { Verdict::Rejected })
}

/// Draws the cases and makes the hash of their truth known.
fn draw(args: &Args, folder: &std::path::Path, console: &Console) -> Result<Sealed> {
    let sealed = Sealed::draw(args.cases, args.run.seed, folder, console)?;
    pam_cli::write_file("-", format!("Sealed: SHA-256 of the truth {}\n", sealed.hash()))?;
    for dropped in sealed.dropped() {
        console.warn(dropped);
    }
    Ok(sealed)
}
