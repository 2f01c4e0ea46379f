//! `exo-metrics/1`: how well a lift followed its reference.

use pam_artifact::{Input, Tool};
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::Serialize;

use crate::config::{LiftConfig, LiftPlan};
use crate::lift::Outcome;
use crate::metrics::{SignalErrors, TrackingErrors};
use crate::study::{Study, quantile};
use crate::trouble::Trouble;

/// Schema name and version.
pub const SCHEMA: &str = "exo-metrics/1";

/// Errors of a lift and of its trials.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct MetricsArtifact {
    /// `exo-metrics/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Files that went into it.
    pub inputs: Vec<Input>,
    /// Configuration.
    pub config: LiftConfig,
    /// Seed of every random draw.
    pub seed: u64,
    /// Left arm.
    pub left: ArmMetrics,
    /// Right arm.
    pub right: ArmMetrics,
    /// What the paper's Table 2 states.
    pub paper: TrackingErrors,
    /// Robustness study, where one was asked for.
    pub trials: Option<TrialMetrics>,
}

/// One arm.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ArmMetrics {
    /// Errors.
    pub errors: TrackingErrors,
    /// Load that the controller believed in at the end, in kg.
    pub payload_kg: f64,
    /// Whether the inverse was asked outside what it knows.
    pub outside_inverse: bool,
    /// What went wrong, in words; empty for a clean lift.
    pub troubles: Vec<String>,
}

/// A robustness study; of each trial the worse arm counts.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TrialMetrics {
    /// Trials run.
    pub n_trials: u64,
    /// Largest absolute angle error, in rad.
    pub max_rad: Quantiles,
    /// Mean absolute angle error, in rad.
    pub mae_rad: Quantiles,
    /// Root mean square angle error, in rad.
    pub rmse_rad: Quantiles,
    /// Trials in which a cable went slack.
    pub n_slack: u64,
    /// Trials in which the pressure stayed at a limit.
    pub n_saturated: u64,
    /// Trials that were given up because the error grew beyond the limit.
    pub n_diverged: u64,
}

/// Quantiles over trials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Quantiles {
    /// Median.
    pub p50: f64,
    /// 90 %.
    pub p90: f64,
    /// 95 %.
    pub p95: f64,
    /// 99 %.
    pub p99: f64,
    /// Largest.
    pub largest: f64,
}

impl ArmMetrics {
    /// What is known of one arm.
    pub fn of(outcome: &Outcome) -> Self {
        Self {
            errors: outcome.errors,
            payload_kg: outcome.payload_kg,
            outside_inverse: outcome.outside,
            troubles: outcome.troubles.iter().flatten().map(Trouble::to_string).collect(),
        }
    }
}

impl TrialMetrics {
    /// Quantiles and counts of a study.
    pub fn of(study: &Study) -> Self {
        let quantiles = |value: fn(&crate::study::Trial) -> f64| {
            let mut values: Vec<f64> = study.trials.iter().map(value).collect();
            values.sort_by(f64::total_cmp);
            let at = |share| quantile(&values, share);
            Quantiles { p50: at(0.5), p90: at(0.9), p95: at(0.95), p99: at(0.99), largest: at(1.0) }
        };
        let count = |kind: usize| study.trials.iter().filter(|trial| trial.troubles[kind]).count() as u64;
        Self {
            n_trials: study.trials.len() as u64,
            max_rad: quantiles(|trial| trial.max_rad),
            mae_rad: quantiles(|trial| trial.mae_rad),
            rmse_rad: quantiles(|trial| trial.rmse_rad),
            n_slack: count(0),
            n_saturated: count(1),
            n_diverged: count(2),
        }
    }
}

/// Table 2 of the paper. Its ITAE is the plain sum; the integral follows with its period of 0.01 s.
pub fn paper() -> TrackingErrors {
    let row = |max, mae, rmse, itae_sum| SignalErrors { max, mae, rmse, itae: 0.01 * itae_sum, itae_sum };
    TrackingErrors {
        angle_rad: row(0.0175, 0.0038, 0.0048, 4.6426),
        velocity_rad_per_s: row(0.0031, 0.0012, 0.0013, 1.4645),
        acceleration_rad_per_s2: row(0.0049, 0.0018, 0.0021, 2.2687),
    }
}

/// Whether a lift is the paper's: its reference, its load and its arm, so that its errors can stand beside Table 2.
pub fn is_the_papers(plan: &LiftPlan) -> bool {
    let lift = [
        plan.reference.from_rad,
        plan.reference.to_rad,
        plan.reference.duration_s,
        plan.upper_m,
        plan.lower_m,
        plan.load.mass_kg,
        plan.load.inertia_kg_m2,
    ];
    let papers = [0.0, 0.3, 5.0, 0.165, 0.21, 5.0, 0.05];
    lift.iter().zip(papers).all(|(value, papers)| (value - papers).abs() < 1e-9)
}
