//! Many lifts: how much of the tracking survives uncertain load, friction, valve and geometry.
//!
//! Every trial draws load, friction, valve, geometry, noise and the parameters of the force model, and lifts
//! with the same controller. A trial has its own stream of random numbers, so that its result depends neither
//! on the number of threads nor on the number of trials. Of a trial five numbers are kept; errors over time go
//! into histograms of counts, which add up to the same in any order.

use pam_muscle::effects::AugmentedModel;
use rand::RngExt as _;
use rand_pcg::Pcg64;
use rayon::prelude::*;

use crate::config::LiftPlan;
use crate::lift::Outcome;
use crate::simulation::{Deviation, Simulation, stream};
use crate::uncertainty::Uncertainty;

/// What is kept of a trial: the worse of the two arms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trial {
    /// Largest absolute angle error, in rad.
    pub max_rad: f64,
    /// Mean absolute angle error, in rad.
    pub mae_rad: f64,
    /// Root mean square angle error, in rad.
    pub rmse_rad: f64,
    /// Whether slack, saturated, diverged.
    pub troubles: [bool; 3],
}

impl Trial {
    /// A lift that was given up before its start counts with `diverged_rad`, the error at which it was given up.
    fn of(outcomes: &[Outcome; 2], diverged_rad: f64) -> Self {
        let worse = |value: fn(&Outcome) -> f64| {
            let [left, right] =
                [0, 1].map(|arm| if outcomes[arm].began { value(&outcomes[arm]) } else { diverged_rad });
            left.max(right)
        };
        Self {
            max_rad: worse(|outcome| outcome.errors.angle_rad.max),
            mae_rad: worse(|outcome| outcome.errors.angle_rad.mae),
            rmse_rad: worse(|outcome| outcome.errors.angle_rad.rmse),
            troubles: [0, 1, 2].map(|kind| outcomes.iter().any(|outcome| outcome.troubles[kind].is_some())),
        }
    }
}

/// Result of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// Trials, in order.
    pub trials: Vec<Trial>,
    /// Angle errors over time, both arms.
    pub envelope: Envelope,
}

/// Histograms of the angle error at instants of the lift.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Envelope {
    /// Periods of the controller from one instant to the next.
    every: usize,
    counts: Vec<[u32; BINS]>,
}

/// Bins of a histogram; the outermost take in what lies beyond.
const BINS: usize = 600;
/// Width of a bin, in rad.
const BIN_RAD: f64 = 1e-4;
/// Instants at which errors are counted, at most.
const INSTANTS: usize = 126;
/// Trials that share a set of histograms.
const CHUNK: u64 = 32;

impl Envelope {
    fn new(periods: usize) -> Self {
        let every = periods.div_ceil(INSTANTS).max(1);
        Self { every, counts: vec![[0; BINS]; periods / every + 1] }
    }

    fn add(&mut self, period: usize, error_rad: f64) {
        if period.is_multiple_of(self.every)
            && let Some(counts) = self.counts.get_mut(period / self.every)
        {
            let bin = (error_rad / BIN_RAD + 0.5 * BINS as f64).clamp(0.0, (BINS - 1) as f64);
            counts[if bin.is_nan() { BINS - 1 } else { bin as usize }] += 1;
        }
    }

    fn merge(mut self, other: &Self) -> Self {
        for (mine, theirs) in self.counts.iter_mut().zip(&other.counts) {
            for (count, more) in mine.iter_mut().zip(theirs) {
                *count += more;
            }
        }
        self
    }

    /// Errors, in rad, below which each of `shares` lies, at every instant, given the controller's period:
    /// `(time_s, quantiles)`.
    pub fn quantiles_rad<const N: usize>(&self, period_s: f64, shares: [f64; N]) -> Vec<(f64, [f64; N])> {
        let quantile = |counts: &[u32; BINS], share: f64| {
            let total: u64 = counts.iter().map(|&count| u64::from(count)).sum();
            let wanted = share * total as f64;
            let mut below = 0.0;
            for (bin, &count) in counts.iter().enumerate() {
                let count = f64::from(count);
                if count > 0.0 && below + count >= wanted {
                    let inside = ((wanted - below) / count).clamp(0.0, 1.0);
                    return (bin as f64 + inside - 0.5 * BINS as f64) * BIN_RAD;
                }
                below += count;
            }
            f64::NAN
        };
        let times = (0..).map(|index| (index * self.every) as f64 * period_s);
        times.zip(&self.counts).map(|(time_s, counts)| (time_s, shares.map(|share| quantile(counts, share)))).collect()
    }
}

/// Runs `n_trials` lifts; `advance` is told how many more are done, from any thread.
pub fn run_study(
    simulation: &Simulation<'_>,
    uncertainty: Option<&Uncertainty>,
    n_trials: u64,
    seed: u64,
    advance: impl Fn(u64) + Sync,
) -> Study {
    let plan = simulation.plan;
    let periods = ((plan.reference.duration_s + plan.settle_s) / plan.control.period_s).round() as usize;
    let chunks: Vec<u64> = (0..n_trials.div_ceil(CHUNK)).collect();
    let parts: Vec<(Vec<Trial>, Envelope)> = chunks
        .into_par_iter()
        .fold(
            || (Vec::new(), Envelope::new(periods)),
            |(mut trials, mut envelope), chunk| {
                let (first, last) = (chunk * CHUNK, ((chunk + 1) * CHUNK).min(n_trials));
                for trial in first..last {
                    trials.push(one_trial(simulation, uncertainty, seed, trial, &mut envelope));
                }
                advance(last - first);
                (trials, envelope)
            },
        )
        .collect();
    let mut study = Study { trials: Vec::with_capacity(n_trials as usize), envelope: Envelope::new(periods) };
    for (trials, envelope) in parts {
        study.trials.extend(trials);
        study.envelope = study.envelope.merge(&envelope);
    }
    study
}

fn one_trial(
    simulation: &Simulation<'_>,
    uncertainty: Option<&Uncertainty>,
    seed: u64,
    trial: u64,
    envelope: &mut Envelope,
) -> Trial {
    // Stream 0 is the lift as configured.
    let mut rng = stream(seed, trial + 1);
    let deviation = draw(simulation.plan, &mut rng);
    let drawn = uncertainty
        .filter(|_| simulation.plan.spreads.model_parameters)
        .map(|uncertainty| simulation.plant.on(uncertainty.draw(simulation.plant.base(), &mut rng)));
    let force: &AugmentedModel = drawn.as_ref().unwrap_or(simulation.plant);
    let mut period = [0; 2];
    let outcomes = simulation.run(&deviation, force, &mut rng, |arm, instant| {
        envelope.add(period[arm], instant.reference.q_rad - instant.state.q_rad);
        period[arm] += 1;
    });
    Trial::of(&outcomes, simulation.plan.diverged_rad)
}

fn draw(plan: &LiftPlan, rng: &mut Pcg64) -> Deviation {
    let spreads = &plan.spreads;
    let mut around = |spread: f64| spread * rng.random_range(-1.0..=1.0);
    Deviation {
        payload: 1.0 + around(spreads.payload),
        friction: 1.0 + around(spreads.friction),
        lag: 1.0 + around(spreads.lag),
        geometry: [0; 3].map(|_| 1.0 + around(spreads.geometry)),
        mounting_m: around(spreads.mounting_m),
        noise: 1.0 + around(spreads.noise),
        friction_state: [0; 2].map(|_| around(1.0)),
    }
}

/// The value below which a share of `sorted` lies, by linear interpolation (R's type 7); NaN of nothing.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let position = share.clamp(0.0, 1.0) * last as f64;
    let (below, inside) = (position.floor() as usize, position.fract());
    let above = (below + 1).min(last);
    sorted[below] + inside * (sorted[above] - sorted[below])
}
