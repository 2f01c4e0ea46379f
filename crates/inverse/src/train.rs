//! Weights from points: several starts, each stopped early, the best on the validation points wins.

use pam_artifact::inverse::{Activation, Ended, MAX_WIDTH, Method, StartReport, TrainConfig, Update};
use rayon::prelude::*;

use crate::InverseError;
use crate::backpropagation::Backpropagation;
use crate::levenberg_marquardt::{LevenbergMarquardt, Step};
use crate::network::{Network, n_parameters};
use crate::normal_equations::cost;
use crate::samples::Samples;
use crate::stream::Stream;

/// Points that a descent begins with, for each parameter of the network: the first of a sequence that leaves no gaps leave
/// none themselves, and an epoch takes as long as it has points.
const FIRST_PER_PARAMETER: usize = 2;
/// But so many at least: fewer are as fast, and a small network would have learnt them by heart.
const FIRST_AT_LEAST: usize = 400;

/// Error of other points over that of those that a descent goes by, above which it is given twice as many: they are being
/// learnt by heart.
const BY_HEART: f64 = 1.25;

/// Share of the error that an epoch has to take off, or the descent is given twice as many: it is no longer finding its way.
const SLOW: f64 = 0.025;

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
    /// Its training error after every epoch, the untrained network first, over the points that the epoch went by; root mean
    /// square, scaled.
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

/// A descent that begins with a few of the points.
struct Growing<'a> {
    descent: LevenbergMarquardt,
    training: &'a Samples,
    few: Samples,
    /// Error of the few after the epoch before, root mean square.
    error: f64,
}

impl<'a> Growing<'a> {
    fn new(training: &'a Samples, n_parameters: usize) -> Self {
        let few = training.first((FIRST_PER_PARAMETER * n_parameters).max(FIRST_AT_LEAST));
        Self { descent: LevenbergMarquardt::default(), training, few, error: f64::INFINITY }
    }

    /// One epoch; the error that it leaves of the points that it went by, none where no step lowers that of all.
    fn epoch(&mut self, network: &mut Network) -> Option<f64> {
        loop {
            match self.descent.epoch(network, &self.few) {
                Step::Lower(cost) => return Some(rmse(cost, &self.few)),
                Step::Stuck if self.few.len() == self.training.len() => return None,
                Step::Stuck => {
                    self.descent = LevenbergMarquardt::default();
                    self.grow();
                }
            }
        }
    }

    /// Takes more points where an epoch that left `error` of the few and `of_others` of points that it did not go by says so.
    fn judge(&mut self, error: f64, of_others: f64) {
        let slow = error > (1.0 - SLOW) * self.error;
        self.error = error;
        if slow || of_others > BY_HEART * error {
            self.grow();
        }
    }

    fn grow(&mut self) {
        if self.few.len() < self.training.len() {
            self.few = self.training.first(2 * self.few.len());
            self.error = f64::INFINITY;
        }
    }
}

/// Root mean square of the residuals whose [`cost`] is known.
fn rmse(cost: f64, samples: &Samples) -> f64 {
    (2.0 * cost / samples.len() as f64).sqrt()
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
    let mut descent = Growing::new(training, network.parameters().len());
    let random = Stream::Order(start).random(seed);
    let mut printed = Backpropagation::new(config.learning_rate, config.update, training.len(), random);

    let mut training_rmse = vec![rmse(cost(&network, training), training)];
    let mut validation_rmse = vec![rmse(cost(&network, validation), validation)];
    let mut best = (validation_rmse[0], 0, network.clone());
    let mut ended = Ended::EpochsUsedUp;
    for epoch in 1..=config.n_epochs {
        let trained = match config.method {
            Method::LevenbergMarquardt => descent.epoch(&mut network),
            Method::Backpropagation => Some(rmse(printed.epoch(&mut network, training), training)),
        };
        tick();
        let Some(trained) = trained else {
            ended = Ended::Converged;
            break;
        };
        let error = rmse(cost(&network, validation), validation);
        if !(trained.is_finite() && error.is_finite()) {
            ended = Ended::Diverged;
            break;
        }
        if config.method == Method::LevenbergMarquardt {
            descent.judge(trained, error);
        }
        training_rmse.push(trained);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backpropagation::tests::{network, saddle};

    #[test]
    fn a_descent_that_begins_with_a_few_points_ends_with_all_and_as_low() {
        // More than a network of this size can follow: the first points could only be learnt by heart.
        let mut samples = saddle(1000);
        for (index, target) in samples.targets.iter_mut().enumerate() {
            *target += 0.05 * (1e3 * index as f64).sin();
        }
        let begin = network(Activation::Tanh, Activation::Linear);
        let mut growing = Growing::new(&samples, begin.parameters().len());
        assert_eq!(growing.few.len(), FIRST_AT_LEAST);
        let (mut few, mut all) = (begin.clone(), begin);
        let mut whole = LevenbergMarquardt::default();
        for _ in 0..100 {
            whole.epoch(&mut all, &samples);
            if let Some(error) = growing.epoch(&mut few) {
                growing.judge(error, rmse(cost(&few, &samples), &samples));
            }
        }
        assert_eq!(growing.few.len(), samples.len());
        let (few, all) = (cost(&few, &samples), cost(&all, &samples));
        assert!(few < 1.05 * all, "{few} {all}");
    }
}
