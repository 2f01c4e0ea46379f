//! Command line of `pam-predict`.

use std::path::PathBuf;

use clap::Parser;
use pam_cli::{ReadArgs, RunArgs};

/// Predict the force of a pneumatic muscle from its model.
///
/// Writes the recording with two more columns: force_model_N, and residual_N where a force was recorded
/// (measured less modelled). Until the muscle first moves nothing tells which way its friction acts: there it is taken from
/// the recorded force, where there is one.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Example: is the muscle still the one that was identified?\n  \
                  pam-predict run3.csv --model model.json --out predicted.csv --max-rmse-n 2\n\n\
                  Example: see it, and hand the figures on\n  \
                  pam-predict run3.csv --model model.json --figure predicted.svg --metrics metrics.json\n\n\
                  Example: a log whose columns, units and calibration are in the file of its bench\n  \
                  pam-predict log.lvm --channels bench.toml --model model.json --out predicted.csv\n\n\
                  Exit codes: 0 done and accepted; 1 done and rejected (above --max-rmse-n or --max-rmse-all-n); 2 input \
                  or usage."
)]
pub(crate) struct Args {
    /// Recording of pressure and length, and of force where there is any; - is standard input.
    #[arg(value_name = "LOG")]
    pub(crate) log: PathBuf,

    /// Model that pam-identify wrote.
    #[arg(long, value_name = "MODEL.json")]
    pub(crate) model: PathBuf,

    /// Recording to write; - is standard output.
    #[arg(long, value_name = "PREDICTED.csv", required_unless_present_any = ["check", "metrics", "figure"])]
    pub(crate) out: Option<PathBuf>,

    /// Errors over counted and over all samples to write, with the predictive band and where the model extrapolates
    /// (pam-prediction/1).
    #[arg(long, value_name = "METRICS.json")]
    pub(crate) metrics: Option<PathBuf>,

    /// Figure to write (SVG, PNG or PDF, by its ending): measured and modelled force with the predictive band, residual, and
    /// where the model extrapolates.
    #[arg(long, value_name = "PREDICTED.svg")]
    pub(crate) figure: Option<PathBuf>,

    /// Finish with exit code 1 where the RMSE is above X newton.
    #[arg(long, value_name = "X", value_parser = pam_cli::positive, allow_negative_numbers = true)]
    pub(crate) max_rmse_n: Option<f64>,

    /// The same for the RMSE over all samples, reversals included.
    #[arg(long, value_name = "X", value_parser = pam_cli::positive, allow_negative_numbers = true)]
    pub(crate) max_rmse_all_n: Option<f64>,

    /// Go on where ranges or correlations say that an instrument is wrong, or that the recording is of another muscle.
    #[arg(long)]
    pub(crate) accept_implausible: bool,

    #[command(flatten)]
    pub(crate) read: ReadArgs,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}
