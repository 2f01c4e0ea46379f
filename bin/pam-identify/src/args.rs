//! Command line of `pam-identify`.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use pam_artifact::model::{BladderLaw, FrictionLaw, Loss};
use pam_cli::{ReadArgs, RunArgs};
use pam_muscle::direction::Standstill;
use pam_muscle::force::{Form, Parameter};
use pam_recording::spelling::number;

use crate::shard_args::ShardArgs;

/// Identify a force model of a pneumatic muscle from bench recordings.
///
/// Reads recordings of pressure, length and force, checks what they are good for, fits eq. 11 (gas, rubber,
/// strands, friction) by particle swarm and Levenberg–Marquardt, and writes a model with the uncertainty of
/// every parameter.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Example: fit two recordings, judge the model on a third\n  \
                  pam-identify run1.csv run2.csv --muscle muscle.toml --holdout run3.csv --out model.json --figure \
                  fit.svg\n\n\
                  Example: a commented muscle file to fill in, and a file of channels: columns, units, calibration\n  \
                  pam-identify --example --out muscle.toml\n  \
                  pam-identify --example=channels --out bench.toml\n\n\
                  Example: what is in this log, before anything is fitted?\n  \
                  pam-identify log.lvm --muscle muscle.toml --channels bench.toml --check\n\n\
                  Example: a recording in three files, each on a machine of its own; repeat all four until there is a model\n  \
                  pam-identify part1.csv --muscle muscle.toml --shard run:1/3 --summary-only --agreement a.json --out s1.json\n  \
                  … likewise part2.csv and part3.csv, --shard run:2/3 and run:3/3, s2.json and s3.json\n  \
                  pam-identify --from-summaries s1.json s2.json s3.json --muscle muscle.toml --agreement a.json --out \
                  model.json\n\n\
                  Exit codes: 0 done and accepted; 1 done and rejected (did not converge, above --max-rmse-n, or \
                  parameters that no muscle has, unless with --accept-implausible); 2 input or usage."
)]
pub(crate) struct Args {
    /// Recordings to fit; - is standard input.
    #[arg(value_name = "LOG", required_unless_present_any = ["example", "from_summaries"])]
    pub(crate) logs: Vec<PathBuf>,

    /// Muscle file: dimensions as measured, and which of them to fit; --example writes one.
    #[arg(long, value_name = "M.toml", required_unless_present = "example")]
    pub(crate) muscle: Option<PathBuf>,

    /// Model to write (pam-model/1); - is standard output.
    #[arg(long, value_name = "MODEL.json", required_unless_present_any = ["check", "example"])]
    pub(crate) out: Option<PathBuf>,

    /// Recording to hold out and judge the model on; may be repeated.
    #[arg(long, value_name = "LOG")]
    pub(crate) holdout: Vec<PathBuf>,

    /// Figure to write (SVG, PNG or PDF, by its ending): force, residual and convergence.
    #[arg(long, value_name = "FIT.svg")]
    pub(crate) figure: Option<PathBuf>,

    /// Finish with exit code 1 where the RMSE, on the held-out recordings if there are any, is above X newton.
    #[arg(long, value_name = "X", value_parser = pam_cli::positive, allow_negative_numbers = true)]
    pub(crate) max_rmse_n: Option<f64>,

    /// How eq. 11 is written: corrected, or with the paper's misprints.
    #[arg(long, value_name = "FORM", default_value = "corrected")]
    pub(crate) form: FormArg,

    /// Also fit the other form of eq. 11 and print both beside one another.
    #[arg(long)]
    pub(crate) compare_forms: bool,

    /// What a residual costs: its square, or Huber's loss, which lets outliers count less.
    #[arg(long, value_name = "LOSS", default_value = "square")]
    pub(crate) loss: LossArg,

    /// Stop after the swarm: no Levenberg–Marquardt.
    #[arg(long)]
    pub(crate) no_polish: bool,

    /// Also show what the same columns reach with weights of any sign and size, and which parameters that
    /// would make unphysical.
    #[arg(long)]
    pub(crate) unbounded: bool,

    /// Fit a parameter on its own that otherwise only enters an identifiable combination: c01 or strand_friction.
    #[arg(long, value_name = "NAME", value_parser = freed)]
    pub(crate) free: Vec<Parameter>,

    /// Hold a parameter at a value, as in strand_modulus=3e9 (SI); may be repeated.
    #[arg(long, value_name = "NAME=VALUE", value_parser = fixed)]
    pub(crate) fix: Vec<(Parameter, f64)>,

    /// Fit C01 and C10 each on its own, or their sum; by default each, where the recordings can tell them apart.
    #[arg(long, value_name = "LAW")]
    pub(crate) bladder: Option<BladderArg>,

    /// Which friction to fit: of the bladder, between strands, or both; by default both, where the recordings can tell
    /// them apart.
    #[arg(long, value_name = "LAW")]
    pub(crate) friction: Option<FrictionArg>,

    /// What friction does while the length stands still: held (its sign; its size follows the pressure), sticks (at the
    /// force that it has), relaxes (within so many seconds, to a share that stays: relaxes:3:0.5), follows (the pressure,
    /// at once), or the kPa of pressure over which it turns over, with the share of it that does where that is not all
    /// (40:0.6); by default what fits the recordings best, but for one that relaxes, which a diagnosis judges.
    #[arg(long, value_name = "LAW", value_parser = standstill)]
    pub(crate) standstill: Option<Standstill>,

    /// By how many millimeters the length turns back before the direction of friction flips; by default five
    /// times the noise of the length channel.
    #[arg(long, allow_negative_numbers = true, value_name = "MM")]
    pub(crate) length_play_mm: Option<f64>,

    /// By how many kPa the pressure turns back, while the length stands still, before the direction of friction
    /// flips; by default five times the noise of the pressure channel.
    #[arg(long, allow_negative_numbers = true, value_name = "KPA")]
    pub(crate) pressure_play_kpa: Option<f64>,

    /// Particles of each swarm.
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    pub(crate) particles: u32,

    /// Maximum iterations of a swarm; it stops earlier once it no longer gains, unless with --no-polish.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) iterations: u32,

    /// Swarms, each with its own random streams.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) starts: u32,

    /// Go on where ranges or correlations say that an instrument or the muscle file is wrong, and accept a model with
    /// parameters that no muscle has; the model says so.
    #[arg(long)]
    pub(crate) accept_implausible: bool,

    /// Write a commented file to fill in to --out, or else to standard output, and stop: a muscle file, or with
    /// --example=channels a file for --channels.
    #[arg(
        long,
        value_name = "OF",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "muscle",
        conflicts_with_all = ["logs", "muscle", "holdout", "figure"]
    )]
    pub(crate) example: Option<Example>,

    #[command(flatten)]
    pub(crate) shards: ShardArgs,

    #[command(flatten)]
    pub(crate) read: ReadArgs,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}

impl Args {
    /// Refuses --fix and --free that repeat or contradict one another.
    pub(crate) fn check_parameters(&self) -> anyhow::Result<()> {
        for (index, (parameter, value)) in self.fix.iter().enumerate() {
            let name = parameter.artifact_name();
            if let Some((_, other)) = self.fix[..index].iter().find(|(other, _)| other == parameter) {
                let [first, second] = [other, value].map(|value| number(parameter.from_artifact(*value)));
                anyhow::bail!("--fix holds {name} twice, at {first} and at {second}; leave one of them out");
            }
            anyhow::ensure!(
                !self.free.contains(parameter),
                "--fix holds {name} and --free fits it; leave one of them out"
            );
        }
        for (index, parameter) in self.free.iter().enumerate() {
            let name = parameter.artifact_name();
            anyhow::ensure!(
                !self.free[..index].contains(parameter),
                "--free names {name} twice; leave one of them out"
            );
        }
        Ok(())
    }
}

/// Which commented file to write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Example {
    /// Dimensions of a muscle.
    Muscle,
    /// What the columns of recordings mean.
    Channels,
}

/// How eq. 11 is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FormArg {
    /// Rubber resists contraction; strand tension from equilibrium.
    Corrected,
    /// With the paper's signs and constants.
    AsPrinted,
}

impl FormArg {
    pub(crate) fn form(self) -> Form {
        match self {
            Self::Corrected => Form::Corrected,
            Self::AsPrinted => Form::AsPrinted,
        }
    }
}

/// How the two coefficients of the bladder are fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum BladderArg {
    /// Their sum, at a fixed ratio.
    Shared,
    /// Each on its own.
    Free,
}

impl BladderArg {
    pub(crate) fn law(self) -> BladderLaw {
        match self {
            Self::Shared => BladderLaw::Shared,
            Self::Free => BladderLaw::Free,
        }
    }
}

/// Which friction is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FrictionArg {
    /// Of the bladder on the strands.
    Rubber,
    /// Between strands.
    Strands,
    /// Both.
    Both,
}

impl FrictionArg {
    pub(crate) fn law(self) -> FrictionLaw {
        match self {
            Self::Rubber => FrictionLaw::Rubber,
            Self::Strands => FrictionLaw::Strands,
            Self::Both => FrictionLaw::Both,
        }
    }
}

/// `held`, `sticks`, `follows`, `relaxes` with the seconds and the share that stays after colons, or a pressure in kPa and, after a colon, a
/// share.
fn standstill(text: &str) -> Result<Standstill, String> {
    match text {
        "held" => return Ok(Standstill::Held),
        "sticks" => return Ok(Standstill::Sticks),
        "follows" => return Ok(Standstill::AT_ONCE),
        _ => {}
    }
    // A positive number and, after a colon, a share.
    let with_share = |text: &str, unless_said: &str| -> Option<(f64, f64)> {
        let (number, share) = text.split_once(':').unwrap_or((text, unless_said));
        let number = number.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite())?;
        Some((number, share.parse().ok()?))
    };
    if let Some(text) = text.strip_prefix("relaxes:") {
        return match with_share(text, "0") {
            Some((time_constant_s, to)) if (0.0..1.0).contains(&to) => Ok(Standstill::Relaxes { time_constant_s, to }),
            _ => Err("expected seconds after relaxes:, with the share that stays, less than 1, after a colon \
                      (relaxes:3:0.5)"
                .to_owned()),
        };
    }
    match with_share(text, "1") {
        Some((over_kpa, share)) if share > 0.0 && share <= 1.0 => {
            Ok(Standstill::Slides { over_pa: over_kpa * 1e3, share })
        }
        _ => Err(
            "expected held, sticks, follows, relaxes with seconds after a colon (relaxes:3), or a pressure in kPa, \
                  with a share up to 1 after a colon (40:0.6)"
                .to_owned(),
        ),
    }
}

/// What a residual costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum LossArg {
    /// Its square.
    Square,
    /// Huber's loss.
    Huber,
}

impl LossArg {
    pub(crate) fn loss(self) -> Loss {
        match self {
            Self::Square => Loss::Square,
            Self::Huber => Loss::Huber,
        }
    }
}

fn freed(text: &str) -> Result<Parameter, String> {
    match text {
        "c01" => Ok(Parameter::C01),
        "strand_friction" => Ok(Parameter::StrandFriction),
        _ => Err("expected c01 or strand_friction".to_owned()),
    }
}

/// Between which values a parameter can be held, in the unit of an artifact: wide enough for every experiment in thought,
/// and narrow enough for forces that are numbers.
fn sensible(parameter: Parameter) -> (f64, f64) {
    match parameter {
        Parameter::K1 | Parameter::K2 | Parameter::RubberFriction => (-1e3, 1e3),
        Parameter::K3 | Parameter::StrandFriction => (-1e6, 1e6),
        Parameter::C10 | Parameter::C01 => (-1e12, 1e12),
        Parameter::StrandCompliance => (1e6, 1e18),
    }
}

fn fixed(text: &str) -> Result<(Parameter, f64), String> {
    let names = || Parameter::ALL.map(Parameter::artifact_name);
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE, as in k3=0")?;
    let name = name.trim();
    let parameter =
        Parameter::ALL.into_iter().find(|parameter| parameter.artifact_name() == name).ok_or_else(|| {
            let near =
                pam_cli::nearest(name, names()).map(|near| format!(", did you mean {near}?")).unwrap_or_default();
            format!("no parameter is called \"{name}\"{near}; expected one of {}", names().join(", "))
        })?;
    let value: f64 = value.trim().parse().map_err(|_| format!("\"{value}\" is no number"))?;
    let (lowest, highest) = sensible(parameter);
    if !(lowest..=highest).contains(&value) {
        return Err(format!("{name} cannot be {}; give {lowest:e} to {highest:e}", number(value)));
    }
    Ok((parameter, parameter.from_artifact(value)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_at_standstill_is_a_word_or_a_number_with_a_share() {
        assert_eq!(standstill("sticks"), Ok(Standstill::Sticks));
        assert_eq!(standstill("40:0.6"), Ok(Standstill::Slides { over_pa: 4e4, share: 0.6 }));
        assert_eq!(standstill("relaxes:3"), Ok(Standstill::Relaxes { time_constant_s: 3.0, to: 0.0 }));
        assert_eq!(standstill("relaxes:3:0.5"), Ok(Standstill::Relaxes { time_constant_s: 3.0, to: 0.5 }));
        for wrong in ["relaxes", "relaxes:", "relaxes:0", "relaxes:3:1", "relaxes:inf", "relaxes:3:-0.1", "40:1.5"] {
            assert!(standstill(wrong).is_err(), "{wrong}");
        }
    }
}
