//! Command line of `pam-train-inverse`.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use pam_artifact::inverse::{Activation, Method, TrainConfig, Update};
use pam_cli::{ReadArgs, RunArgs};
use pam_inverse_model::train::defaults;

/// Train the inverse of an identified muscle: force, length and direction to pressure.
///
/// Draws points from the model where its inverse exists, trains a small network on them (eqs 13-19, corrected),
/// and judges it on points that it never saw, beside the exact inverse by root finding.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Example: train, look at the errors, keep the weights\n  \
                  pam-train-inverse --model model.json --out inverse.json --figure inverse.svg\n\n\
                  Example: train at the pressures and lengths of a log as well\n  \
                  pam-train-inverse log.lvm --channels bench.toml --model model.json --out inverse.json\n\n\
                  Exit codes: 0 done and accepted; 1 done and rejected (above --max-error-percent); 2 input or usage."
)]
pub(crate) struct Args {
    /// Recordings to train at as well: their pressures, lengths and directions, with the model's forces.
    #[arg(value_name = "LOG")]
    pub(crate) logs: Vec<PathBuf>,

    /// Model that pam-identify wrote.
    #[arg(long, value_name = "MODEL.json")]
    pub(crate) model: PathBuf,

    /// Network to write (pam-inverse/1); - is standard output.
    #[arg(long, value_name = "INVERSE.json", required_unless_present = "check")]
    pub(crate) out: Option<PathBuf>,

    /// Figure to write (SVG, PNG or PDF, by its ending): map, errors, training.
    #[arg(long, value_name = "INVERSE.svg")]
    pub(crate) figure: Option<PathBuf>,

    /// Finish with exit code 1 where the RMSE on unseen points is above X percent of the range of pressure.
    #[arg(long, value_name = "X", default_value_t = 0.3)]
    pub(crate) max_error_percent: f64,

    /// How the weights are found: levenberg-marquardt, or backpropagation as the paper prints it.
    #[arg(long, value_name = "METHOD", default_value = "levenberg-marquardt")]
    pub(crate) method: MethodArg,

    /// Neurons of the hidden layers, as in 20 or 12,12.
    #[arg(long, value_name = "N", value_delimiter = ',', default_value = "20",
          value_parser = clap::value_parser!(u32).range(1..=64))]
    pub(crate) hidden: Vec<u32>,

    /// Activation of the hidden layers.
    #[arg(long, value_name = "NAME", default_value = "tanh")]
    pub(crate) activation: ActivationArg,

    /// Activation of the output; sigmoid is the paper's.
    #[arg(long, value_name = "NAME", default_value = "linear")]
    pub(crate) output_activation: ActivationArg,

    /// Points drawn from the model to train at; 0 trains at the recordings alone.
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    pub(crate) points: u32,

    /// Rows taken from the recordings, evenly spaced.
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub(crate) rows: u32,

    /// Share of the points that decides when to stop.
    #[arg(long, value_name = "SHARE", default_value_t = 0.2)]
    pub(crate) validation_share: f64,

    /// Starts, each with weights of its own.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) starts: u32,

    /// Maximum epochs of a start; by default 200, and 1000 for backpropagation.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub(crate) epochs: Option<u32>,

    /// Epochs without a better validation error after which a start ends; by default 25, and 100 for
    /// backpropagation.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub(crate) patience: Option<u32>,

    /// Validation error at which a start ends, in percent of the range of pressure.
    #[arg(long, value_name = "X", default_value_t = 0.02)]
    pub(crate) goal_percent: f64,

    /// Step along the gradient; backpropagation only.
    #[arg(long, value_name = "ETA", default_value_t = 0.05)]
    pub(crate) learning_rate: f64,

    /// After what backpropagation changes the weights.
    #[arg(long, value_name = "WHEN", default_value = "sample")]
    pub(crate) update: UpdateArg,

    /// Unseen points to judge the network on.
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = clap::value_parser!(u32).range(100..=10_000_000))]
    pub(crate) judge_points: u32,

    #[command(flatten)]
    pub(crate) read: ReadArgs,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}

impl Args {
    /// Options as resolved.
    pub(crate) fn config(&self) -> TrainConfig {
        let method = self.method.method();
        let standard = defaults(method);
        TrainConfig {
            method,
            hidden: self.hidden.iter().map(|&width| width as usize).collect(),
            hidden_activation: self.activation.activation(),
            output_activation: self.output_activation.activation(),
            n_design_points: self.points as usize,
            n_recording_rows: if self.logs.is_empty() { 0 } else { self.rows as usize },
            validation_share: self.validation_share,
            n_starts: self.starts as usize,
            n_epochs: self.epochs.map_or(standard.n_epochs, |epochs| epochs as usize),
            patience: self.patience.map_or(standard.patience, |patience| patience as usize),
            goal: self.goal_percent * 1e-2,
            learning_rate: self.learning_rate,
            update: self.update.update(),
            n_evaluation_points: self.judge_points as usize,
            min_slope_share: standard.min_slope_share,
        }
    }
}

/// How the weights are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodArg {
    /// Damped Gauss–Newton steps over all samples.
    LevenbergMarquardt,
    /// Steps along the gradient, eqs 16-19.
    Backpropagation,
}

impl MethodArg {
    fn method(self) -> Method {
        match self {
            Self::LevenbergMarquardt => Method::LevenbergMarquardt,
            Self::Backpropagation => Method::Backpropagation,
        }
    }
}

/// How a neuron answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ActivationArg {
    /// Hyperbolic tangent.
    Tanh,
    /// Logistic function.
    Sigmoid,
    /// The sum itself; for the output only.
    Linear,
}

impl ActivationArg {
    fn activation(self) -> Activation {
        match self {
            Self::Tanh => Activation::Tanh,
            Self::Sigmoid => Activation::Sigmoid,
            Self::Linear => Activation::Linear,
        }
    }
}

/// After what backpropagation changes the weights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum UpdateArg {
    /// Every sample, as the paper prints it.
    Sample,
    /// Every epoch, by the mean gradient.
    Epoch,
}

impl UpdateArg {
    fn update(self) -> Update {
        match self {
            Self::Sample => Update::Sample,
            Self::Epoch => Update::Epoch,
        }
    }
}
