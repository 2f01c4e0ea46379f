//! Command line of `pam-compare`.

use std::path::PathBuf;

use clap::Parser;
use pam_cli::{ReadArgs, RunArgs};

/// Compare two models of a pneumatic muscle on the same recordings.
///
/// Both models predict every recording; the difference of their squared errors is judged by a bootstrap over blocks that are
/// longer than its autocorrelation, so that many samples are not taken for much evidence. Compare on recordings that neither
/// model was fitted to.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Example: is the augmented model better than the one it came from, on a recording that neither saw?\n  \
                  pam-compare model.json augmented.json run3.csv --out compare.json\n\n\
                  Example: columns, units and calibration from the file of this bench\n  \
                  pam-compare model.json augmented.json run3.csv --channels bench.toml\n\n\
                  Exit codes: 0 done, and B is as good as A or better; 1 done, and B is worse than A beyond chance; 2 input \
                  or usage."
)]
pub(crate) struct Args {
    /// Model in use, as pam-identify or pam-diagnose wrote it.
    #[arg(value_name = "A.json")]
    pub(crate) a: PathBuf,

    /// Model that would take its place.
    #[arg(value_name = "B.json")]
    pub(crate) b: PathBuf,

    /// Recordings to compare on; - is standard input.
    #[arg(value_name = "LOG", required = true)]
    pub(crate) logs: Vec<PathBuf>,

    /// Comparison to write (pam-comparison/1); - is standard output.
    #[arg(long, value_name = "COMPARE.json")]
    pub(crate) out: Option<PathBuf>,

    /// Resamples of the bootstrap.
    #[arg(long, value_name = "N", default_value_t = 4000, value_parser = clap::value_parser!(u32).range(200..=1_000_000))]
    pub(crate) resamples: u32,

    /// Go on where ranges or correlations say that an instrument is wrong, or that a recording is of another muscle.
    #[arg(long)]
    pub(crate) accept_implausible: bool,

    #[command(flatten)]
    pub(crate) read: ReadArgs,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}
