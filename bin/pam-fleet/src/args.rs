//! Command line of `pam-fleet`.

use std::path::PathBuf;

use clap::Parser;
use pam_cli::RunArgs;

/// Put many muscles beside one another: which of them, which rig and which date differs.
///
/// Reads a table of recordings with the columns path, muscle, rig, date and role (estimation or holdout), and make or
/// dimensions (a muscle file) where there are several; then what the other programs left of each campaign, everything
/// recorded of one muscle on one rig at one date.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Example: the page of a fleet whose results are in out/fleet\n  \
                  pam-fleet recordings.csv --muscle muscle.toml --results out/fleet --out fleet.csv --report fleet.html\n\n\
                  Exit codes: 0 done and accepted; 1 a campaign was refused or rejected, or is missing; 2 input or usage."
)]
pub(crate) struct Args {
    /// Table of recordings.
    #[arg(value_name = "TABLE.csv")]
    pub(crate) table: PathBuf,

    /// Muscle file of the muscles for which the table names none.
    #[arg(long, value_name = "MUSCLE.toml")]
    pub(crate) muscle: Option<PathBuf>,

    /// Write what is to be done, one campaign after another (pam-fleet-plan/1), for whatever runs the programs; - is
    /// standard output.
    #[arg(long, value_name = "PLAN.json")]
    pub(crate) plan: Option<PathBuf>,

    /// Folder with the results, one folder per campaign, named as in the plan.
    #[arg(long, value_name = "DIR", required_unless_present_any = ["plan", "check"])]
    pub(crate) results: Option<PathBuf>,

    /// One row per campaign (CSV): outcomes, verdict, effects, parameters, why it stands out; - is standard output.
    #[arg(long, value_name = "FLEET.csv", requires = "results", required_unless_present_any = ["plan", "check"])]
    pub(crate) out: Option<PathBuf>,

    /// Page to write (HTML): who stands out and why, rigs, changes, control charts, effects, refusals.
    #[arg(long, value_name = "FLEET.html", requires = "results")]
    pub(crate) report: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}
