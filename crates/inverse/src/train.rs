//! Weights from points: several starts, each stopped early, the best on the validation points wins.

use pam_core::artifact::inverse::{Activation, Ended, MAX_WIDTH, Method, StartReport, TrainConfig, Update};
use rayon::prelude::*;

use crate::InverseError;
use crate::backpropagation::Backpropagation;
use crate::levenberg_marquardt::{LevenbergMarquardt, Step};
use crate::network::{Network, n_parameters};
use crate::normal_equations::cost;
use crate::samples::Samples;
use crate::stream::Stream;

/// What trains well, by method.
pub fn defaults(method: Method) -> TrainConfig {
    let descent = method == Method::Backpropagation;
    TrainConfig {
        method,
        hidden: vec![20],
        hidden_activation: Activation::Tanh,
        output_activation: Activation::Linear,
        n_design_points: 2000,
        n_recording_rows: 2000,
        validation_share: 0.2,
        n_starts: 3,
        n_epochs: if descent { 1000 } else { 200 },
        patience: if descent { 100 } else { 25 },
        goal: 2e-4,
        learning_rate: 0.05,
        update: Update::Sample,
        n_evaluation_points: 20_000,
        min_slope_share: 0.05,
    }
}

/// What a training found.
#[derive(Debug, Clone)]
pub struct Trained {
    /// The best network.
    pub network: Network,
    /// Every start.
    pub starts: Vec<StartReport>,
    /// The start that the network comes from.
    pub chosen: usize,
    /// Its training error after every epoch, the untrained network first; root mean square, scaled.
    pub training_rmse: Vec<f64>,
    /// Its validation error, likewise.
    pub validation_rmse: Vec<f64>,
}

/// One start under way.
struct Run {
    network: Network,
    report: StartReport,
    training_rmse: Vec<f64>,
    validation_rmse: Vec<f64>,
}

/// Trains a network. `scale_pa` is the pressure that a scaled output of 1 stands for, and `span_pa` the full scale
/// that the goal is a share of. `tick` is called after every epoch of every start, from any thread.
///
/// # Errors
/// [`InverseError`] where the layers cannot be built, the points are too few, or every start runs away.
pub fn train(
    training: &Samples,
    validation: &Samples,
    config: &TrainConfig,
    (scale_pa, span_pa): (f64, f64),
    seed: u64,
    tick: &(dyn Fn() + Sync),
) -> Result<Trained, InverseError> {
    if let Some(&width) = config.hidden.iter().find(|&&width| width == 0 || width > MAX_WIDTH) {
        return Err(InverseError::Width { width, max: MAX_WIDTH });
    }
    let mut layers = vec![3];
    layers.extend(&config.hidden);
    layers.push(1);
    let n_parameters = n_parameters(&layers);
    if training.len() < n_parameters || validation.is_empty() {
        return Err(InverseError::TooFewPoints { n_training: training.len(), n_parameters });
    }
    let goal = config.goal * span_pa / scale_pa;
    let runs: Vec<Run> = (0..config.n_starts as u32)
        .into_par_iter()
        .map(|start| run(training, validation, config, &layers, goal, (seed, start), scale_pa, tick))
        .collect();
    let error = |run: &Run| run.report.validation_rmse_pa;
    let sound = runs.iter().enumerate().filter(|(_, run)| error(run).is_finite());
    let Some(chosen) = sound.min_by(|a, b| error(a.1).total_cmp(&error(b.1))).map(|(index, _)| index) else {
        return Err(InverseError::Diverged);
    };
    let starts = runs.iter().map(|run| run.report.clone()).collect();
    let best = runs.into_iter().nth(chosen).ok_or(InverseError::Diverged)?;
    let Run { network, training_rmse, validation_rmse, .. } = best;
    Ok(Trained { network, starts, chosen, training_rmse, validation_rmse })
}

#[expect(clippy::too_many_arguments, reason = "one call, right above")]
fn run(
    training: &Samples,
    validation: &Samples,
    config: &TrainConfig,
    layers: &[usize],
    goal: f64,
    (seed, start): (u64, u32),
    scale_pa: f64,
    tick: &(dyn Fn() + Sync),
) -> Run {
    let mut activations = vec![config.hidden_activation; config.hidden.len()];
    activations.push(config.output_activation);
    let mut network = Network::initial(layers, &activations, &mut Stream::Weights(start).random(seed));
    let mut descent = LevenbergMarquardt::default();
    let random = Stream::Order(start).random(seed);
    let mut printed = Backpropagation::new(config.learning_rate, config.update, training.len(), random);
    let rmse = |cost: f64, samples: &Samples| (2.0 * cost / samples.len() as f64).sqrt();

    let mut training_rmse = vec![rmse(cost(&network, training), training)];
    let mut validation_rmse = vec![rmse(cost(&network, validation), validation)];
    let mut best = (validation_rmse[0], 0, network.clone());
    let mut ended = Ended::EpochsUsedUp;
    for epoch in 1..=config.n_epochs {
        let (training_cost, stuck) = match config.method {
            Method::LevenbergMarquardt => match descent.epoch(&mut network, training) {
                Step::Lower(cost) => (cost, false),
                Step::Stuck => (f64::NAN, true),
            },
            Method::Backpropagation => (printed.epoch(&mut network, training), false),
        };
        tick();
        if stuck {
            ended = Ended::Converged;
            break;
        }
        let error = rmse(cost(&network, validation), validation);
        if !(training_cost.is_finite() && error.is_finite()) {
            ended = Ended::Diverged;
            break;
        }
        training_rmse.push(rmse(training_cost, training));
        validation_rmse.push(error);
        if error < best.0 {
            best = (error, epoch, network.clone());
        }
        if error <= goal {
            ended = Ended::GoalReached;
            break;
        }
        if epoch >= best.1 + config.patience {
            ended = Ended::NoBetterValidation;
            break;
        }
    }
    let (error, best_epoch, network) = best;
    let n_epochs = training_rmse.len() - 1;
    let report = StartReport { n_epochs, best_epoch, validation_rmse_pa: error * scale_pa, ended };
    Run { network, report, training_rmse, validation_rmse }
}
