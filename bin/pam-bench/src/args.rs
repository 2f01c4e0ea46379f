//! Command line of `pam-bench`.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use pam_cli::RunArgs;
use pam_virtual_bench::Concealed;

/// Record a protocol on a virtual bench.
///
/// The bench holds a muscle whose parameters are known, takes it through a protocol, and logs pressure,
/// length and force with the noise of real sensors. A fit that finds the parameters again can be trusted with
/// a recording of a real muscle.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Example: forty seconds of isometric ramps, and the truth about them\n  \
                  pam-bench --muscle configs/muscle-nominal.toml --protocol isometric-ramps --duration-scale 0.1 \
                  --out ramps.csv --truth ramps.json\n\n\
                  Example: a muscle at random, with two effects that the log does not tell\n  \
                  pam-bench --random-muscle 7 --write-muscle m.toml --protocol rate-ladder --effect stribeck \
                  --effect inertia:0.5 --out log.csv\n\n\
                  Exit codes: 0 done, 2 input or usage."
)]
pub(crate) struct Args {
    /// Muscle file: dimensions as measured, see configs/muscle-nominal.toml.
    #[arg(
        long,
        value_name = "M.toml",
        required_unless_present_any = ["list_protocols", "list_effects", "random_muscle"]
    )]
    pub(crate) muscle: Option<PathBuf>,

    /// Draw the muscle at random instead: dimensions and parameters, from a seed of their own.
    #[arg(long, value_name = "SEED", conflicts_with = "muscle")]
    pub(crate) random_muscle: Option<u64>,

    /// Write the muscle's dimensions as measured, for a fit; without --protocol nothing else is done.
    #[arg(long, value_name = "M.toml")]
    pub(crate) write_muscle: Option<PathBuf>,

    /// What the rig does, by name; --list-protocols shows all.
    #[arg(long, value_name = "NAME", required_unless_present_any = ["list_protocols", "list_effects", "write_muscle"])]
    pub(crate) protocol: Option<String>,

    /// Log to write, with the columns time_s, pressure_kPa, length_mm and force_N; - is standard output.
    #[arg(
        long,
        value_name = "LOG.csv",
        required_unless_present_any = ["list_protocols", "list_effects", "write_muscle", "check"]
    )]
    pub(crate) out: Option<PathBuf>,

    /// Also write what no logger sees: parameters, sensors and command, as JSON; - is standard output.
    #[arg(long, value_name = "TRUTH.json")]
    pub(crate) truth: Option<PathBuf>,

    /// Give the muscle another parameter than the nominal one, in SI; may be repeated. Parameters: k1, k2,
    /// k3 (N), c10 and c01 (Pa), strand_modulus (Pa), rubber_friction, strand_friction.
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub(crate) set: Vec<(String, f64)>,

    /// Conceal an effect in the muscle or the rig, by id; 1 is its typical severity; may be repeated. --list-effects
    /// shows all.
    #[arg(long, value_name = "ID[:SEVERITY]")]
    pub(crate) effect: Vec<Concealed>,

    /// Seed of the inner parameters of effects and misfit; the same for all recordings of one muscle. Unless given,
    /// that of the run.
    #[arg(long, value_name = "N")]
    pub(crate) effect_seed: Option<u64>,

    /// Add a smooth error of form that no effect of the catalogue has, of so many newtons root mean square over all pressures
    /// and contractions of the protocols.
    #[arg(long, value_name = "X", default_value_t = 0.0, value_parser = pam_cli::number, allow_negative_numbers = true)]
    pub(crate) smooth_misfit_n: f64,

    /// Sampling rate of the logger, in Hz.
    #[arg(long, value_name = "HZ", value_parser = pam_cli::number, default_value_t = 200.0)]
    pub(crate) rate: f64,

    /// Duration relative to the catalogue: shortens holds and sweeps and leaves out cycles; where one cycle
    /// is left, it runs faster.
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = pam_cli::number, allow_negative_numbers = true)]
    pub(crate) duration_scale: f64,

    /// Highest pressure, in kPa; the pressures of a protocol are scaled to it.
    #[arg(long, value_name = "KPA", default_value_t = 500.0, value_parser = pam_cli::number, allow_negative_numbers = true)]
    pub(crate) highest_pressure: f64,

    /// Lowest tension that a contracting muscle is taken to, in N; -inf lets it hang slack.
    #[arg(long, value_name = "N", default_value_t = 5.0, allow_hyphen_values = true)]
    pub(crate) lowest_tension: f64,

    /// Noise of every channel relative to that of the sensors, which is 0.5 kPa, 0.03 mm and 0.2 N; 0 leaves
    /// only quantization.
    #[arg(long, value_name = "X", default_value_t = 1.0, value_parser = pam_cli::number, allow_negative_numbers = true)]
    pub(crate) noise: f64,

    /// Standard deviation of the force noise, in N, instead of that of the load cell; --noise has no part in it.
    #[arg(long, value_name = "X", value_parser = pam_cli::number, allow_negative_numbers = true)]
    pub(crate) force_noise_n: Option<f64>,

    /// Share of the colored force noise that remains after 5 ms, from 0 (white) to below 1.
    #[arg(long, value_name = "RHO", default_value_t = 0.0, value_parser = pam_cli::number, allow_negative_numbers = true)]
    pub(crate) force_noise_correlation: f64,

    /// Clock of the logger: ideal, or cut to whole milliseconds, so that stamps repeat above 1 kHz.
    #[arg(long, value_name = "CLOCK", default_value = "ideal")]
    pub(crate) clock: Clock,

    /// Show every protocol with its number in the catalogue, and stop.
    #[arg(long)]
    pub(crate) list_protocols: bool,

    /// Show every effect that can be concealed, and stop.
    #[arg(long)]
    pub(crate) list_effects: bool,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}

/// Clock of the logger.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum Clock {
    /// The time of the sample.
    Ideal,
    /// Whole milliseconds.
    Ms,
}

/// Reads `name=value`.
fn setting(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE, as in k1=0.9")?;
    let value = value.trim().parse().map_err(|_| format!("\"{value}\" is no number"))?;
    Ok((name.trim().to_owned(), value))
}
