//! Command line of `pam-diagnose`.

use std::path::PathBuf;

use clap::Parser;
use pam_artifact::diagnosis::DiagnoseConfig;
use pam_cli::{ReadArgs, RunArgs};
use pam_diagnosis::diagnose::MAX_EFFECTS;

/// Diagnose where a force model and recordings differ, and which physics was left out.
///
/// Compares the model as it is with the recordings, refits the base model to them, looks where and how the residual exceeds the noise, weighs every effect of
/// the catalogue on blocks of recording that it was not fitted to, and names what explains the mismatch; or says that
/// nothing is missing, or that unmodelled structure is left. The diagnosed model works wherever the model did.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Example: diagnose two recordings, judge on a third, read the report\n  \
                  pam-diagnose run1.csv run2.csv --model model.json --holdout run3.csv --out diagnosis.json --out-model \
                  augmented.json --report report.html\n\n\
                  Example: logs whose columns, units and calibration are in the file of their bench\n  \
                  pam-diagnose log1.lvm log2.lvm --channels bench.toml --model model.json --out diagnosis.json\n\n\
                  Example: what could these recordings show, and what to record next\n  \
                  pam-diagnose run1.csv --model model.json --isolability --next-experiment setpoints.csv\n\n\
                  Example: the same muscle a month later; what has changed since\n  \
                  pam-diagnose later1.csv later2.csv --since augmented.json --out change.json --report change.html\n\n\
                  Example: muscles of one rig together; what the rig does to all of them\n  \
                  pam-diagnose --group rig.toml --out group.json\n\n\
                  Example: what an effect is and what it looks like\n  \
                  pam-diagnose --explain stribeck --figure stribeck.svg\n\n\
                  Example: an effect of your own among the candidates\n  \
                  pam-diagnose run1.csv run2.csv --model model.json --effects touching-guard.toml --out diagnosis.json\n\n\
                  Exit codes: 0 done and understood (consistent, explained, ambiguous); 1 done, and unmodelled structure is \
                  left (unexplained, explained in part), or the model as given misses the recordings, or the \
                  diagnosed one what was held out; with --since, something has changed (changed, ambiguous, unexplained); 2 input or usage, another muscle included."
)]
pub(crate) struct Args {
    /// Recordings to diagnose, in the order in which they were made: what one of them softens or wears may stay so in the
    /// next; - is standard input.
    #[arg(value_name = "LOG", required_unless_present_any = ["explain", "group"])]
    pub(crate) logs: Vec<PathBuf>,

    /// Model in question, as pam-identify wrote it.
    #[arg(long, value_name = "MODEL.json", required_unless_present_any = ["explain", "since", "group"])]
    pub(crate) model: Option<PathBuf>,

    /// Compare with an earlier diagnosis of the same muscle instead: the model that its --out-model wrote. Says what has
    /// changed since, with its size; what was missing then is part of the base. With --model, that model must be of the
    /// same muscle.
    #[arg(
        long,
        value_name = "BASELINE.json",
        conflicts_with_all = ["explain", "holdout", "out_model", "next_experiment", "isolability", "matters_above_n"]
    )]
    pub(crate) since: Option<PathBuf>,

    /// Diagnose several muscles of one rig together instead: a file (TOML) with a name, a model, logs and holdout in a table
    /// for each muscle. What the rig does to all of them is shared and adds up; what a muscle does is its own.
    #[arg(
        long,
        value_name = "GROUP.toml",
        conflicts_with_all = [
            "explain", "model", "since", "holdout", "out_model", "report", "next_experiment", "isolability"
        ]
    )]
    pub(crate) group: Option<PathBuf>,

    /// Diagnosis to write (pam-diagnosis/1), with --since what has changed (pam-change/1), or with --group what muscles share
    /// (pam-group/1); - is standard output.
    #[arg(
        long,
        value_name = "DIAGNOSIS.json",
        required_unless_present_any = ["check", "explain", "isolability", "next_experiment"]
    )]
    pub(crate) out: Option<PathBuf>,

    /// Model with what was found to write (pam-model/1), for every program that takes a model.
    #[arg(long, value_name = "AUGMENTED.json")]
    pub(crate) out_model: Option<PathBuf>,

    /// Recording to hold out and judge on; may be repeated.
    #[arg(long, value_name = "LOG")]
    pub(crate) holdout: Vec<PathBuf>,

    /// Report to write (HTML, one self-contained file).
    #[arg(long, value_name = "REPORT.html")]
    pub(crate) report: Option<PathBuf>,

    /// Path of the recording that would tell most to write (CSV: time_s, pressure_kPa, length_mm), for a rig to follow.
    #[arg(long, value_name = "SETPOINTS.csv")]
    pub(crate) next_experiment: Option<PathBuf>,

    /// Print which effects these recordings could tell apart at all, whatever is found in them.
    #[arg(long)]
    pub(crate) isolability: bool,

    /// Excess over the noise floor that matters, in N; by default what makes the residual half as much again as the noise.
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub(crate) matters_above_n: Option<f64>,

    /// Maximum number of effects, or changes, that may be named.
    #[arg(long, value_name = "N", default_value_t = MAX_EFFECTS as u32, value_parser = clap::value_parser!(u32).range(1..=10))]
    pub(crate) max_effects: u32,

    /// Effect that is not considered, by id; may be repeated.
    #[arg(long, value_name = "ID")]
    pub(crate) exclude: Vec<String>,

    /// Effects of your own to consider beside the catalogue: a name, a sentence of the grammar and ranges (TOML, as
    /// configs/effects/touching-guard.toml).
    #[arg(long, value_name = "EFFECTS.toml", conflicts_with = "since")]
    pub(crate) effects: Option<PathBuf>,

    /// Go on where ranges or correlations say that an instrument is wrong or the recording is of another muscle.
    #[arg(long)]
    pub(crate) accept_implausible: bool,

    /// Print what the catalogue says of an effect, and stop; all lists every id.
    #[arg(long, value_name = "ID", conflicts_with_all = ["logs", "model", "out", "out_model", "holdout", "report", "next_experiment", "isolability"])]
    pub(crate) explain: Option<String>,

    /// Figure of the explained effect to write (SVG, PNG or PDF, by its ending): a loop with and without it, and the residual that it leaves.
    #[arg(long, value_name = "SIGNATURE.svg")]
    pub(crate) figure: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) read: ReadArgs,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}

impl Args {
    /// Options as resolved.
    pub(crate) fn config(&self) -> DiagnoseConfig {
        let mut excluded = self.exclude.clone();
        excluded.sort();
        excluded.dedup();
        DiagnoseConfig { matters_above_n: self.matters_above_n, max_effects: self.max_effects as usize, excluded }
    }
}
