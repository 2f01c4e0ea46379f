//! Command line of `exo-track`.

use std::path::PathBuf;

use clap::Parser;
use pam_cli::RunArgs;

/// Simulate a lift with an elbow exoskeleton.
///
/// Two arms, each with a muscle on the elbow, follow a quintic with half the load each: computed torque, torque to
/// force by the moment arm, force to pressure by the inverse of the muscle's model, 100 times a second from
/// sensors alone. Valve, air, friction and sensors are simulated in steps of a millisecond.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Example: the paper's lift and a robustness study\n  \
                  exo-track --config configs/lift.toml --model model.json --inverse inverse.json --out track.csv \
                  --metrics metrics.json --figure lift.svg --trials 10000 --trials-figure envelope.svg\n\n\
                  Example: a commented configuration to change\n  \
                  exo-track --example --out lift.toml\n\n\
                  Exit codes: 0 done and clean; 1 done, but the lift saturated, went slack or was given up; 2 input or \
                  usage."
)]
pub(crate) struct Args {
    /// Configuration of the lift; --example writes one.
    #[arg(long, value_name = "LIFT.toml", required_unless_present = "example")]
    pub(crate) config: Option<PathBuf>,

    /// Force model that the controller knows (pam-model/1).
    #[arg(long, value_name = "MODEL.json", required_unless_present = "example")]
    pub(crate) model: Option<PathBuf>,

    /// Inverse of the force model (pam-inverse/1); without it, the model is inverted by root finding.
    #[arg(long, value_name = "INVERSE.json")]
    pub(crate) inverse: Option<PathBuf>,

    /// Force model of the plant (pam-model/1), where it is another than the controller knows.
    #[arg(long, value_name = "MODEL.json")]
    pub(crate) plant: Option<PathBuf>,

    /// Every signal of the lift to write (CSV); - is standard output.
    #[arg(long, value_name = "TRACK.csv", required_unless_present_any = ["check", "example"])]
    pub(crate) out: Option<PathBuf>,

    /// Tracking errors of the lift to write (exo-metrics/1).
    #[arg(long, value_name = "METRICS.json")]
    pub(crate) metrics: Option<PathBuf>,

    /// Figure to write (SVG, PNG or PDF, by its ending): angle and its errors, acceleration, pressure and tension, as in Figs 12, 14 and 15.
    #[arg(long, value_name = "LIFT.svg")]
    pub(crate) figure: Option<PathBuf>,

    /// Robustness study: lifts with load, friction, valve, geometry, noise and model drawn anew each time.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000_000))]
    pub(crate) trials: Option<u64>,

    /// Figure of the study to write (SVG, PNG or PDF, by its ending): errors over time and how they are distributed.
    #[arg(long, value_name = "ENVELOPE.svg", requires = "trials")]
    pub(crate) trials_figure: Option<PathBuf>,

    /// Also lift without each of the controller's options, and print what each is worth.
    #[arg(long)]
    pub(crate) compare_options: bool,

    /// Write a commented configuration to --out, or else to standard output, and stop.
    #[arg(long, conflicts_with_all = ["config", "model", "inverse", "plant", "metrics", "figure", "trials", "compare_options"])]
    pub(crate) example: bool,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}
