//! From a model to an artifact: points, training, judgement, in one go.

use pam_artifact::inverse::{InverseArtifact, SCHEMA, TrainConfig, TrainingReport};
use pam_artifact::{Input, ModelArtifact, Tool};
use pam_recording::Recording;

use crate::coverage::coverage;
use crate::design::{self, Draw, Point};
use crate::domain::InverseBox;
use crate::judge::{Judged, judge, report};
use crate::recorded::{self, Recorded};
use crate::samples::{Samples, Scaling, part};
use crate::train::{Trained, train};
use crate::{ExactInverse, InverseError, InverseNetwork};

/// Least share of the operating range that must be invertible, in percent.
const LEAST_INVERTIBLE_PERCENT: f64 = 1.0;

/// A model that can be inverted, and points to train at.
#[derive(Debug)]
pub struct Prepared {
    exact: ExactInverse,
    points: Vec<Point>,
    n_rows_excluded: usize,
    force_rmse_n: Option<f64>,
}

/// A trained network, ready to be used and to be written.
#[derive(Debug)]
pub struct Outcome {
    /// The network.
    pub network: InverseNetwork,
    /// What it was judged on.
    pub judged: Vec<Judged>,
    /// How the training went, errors scaled back to Pa.
    pub training: TrainingReport,
}

impl Prepared {
    /// Checks the model's domain and draws the points.
    ///
    /// # Errors
    /// [`InverseError`] where the domain is degenerate, hardly anything can be inverted, or samples cannot be read.
    pub fn new(
        model: &ModelArtifact,
        recordings: &[Recording],
        config: &TrainConfig,
        seed: u64,
    ) -> Result<Self, InverseError> {
        let frictions = model.parameters.iter().filter(|entry| entry.name.ends_with("_friction"));
        if let Some(entry) = frictions.into_iter().find(|entry| entry.value < 0.0) {
            return Err(InverseError::Drives { name: entry.name.clone(), value: entry.value });
        }
        let inverse_box = InverseBox::of(&model.domain)?;
        let exact = ExactInverse::new(model.augmented_model(), inverse_box, config.min_slope_share);
        let shares = coverage(&exact);
        if shares.invertible_percent < LEAST_INVERTIBLE_PERCENT {
            return Err(InverseError::HardlyInvertible {
                percent: shares.invertible_percent,
                slack: shares.slack_percent,
                flat: shares.flat_percent,
            });
        }
        let mut points = design::points(&exact, config.n_design_points, Draw::Design, seed);
        let recorded = recorded::points(recordings, model, &exact, config.n_recording_rows)?;
        points.extend(&recorded.points);
        let Recorded { n_excluded: n_rows_excluded, force_rmse_n, .. } = recorded;
        Ok(Self { exact, points, n_rows_excluded, force_rmse_n })
    }

    /// The exact inverse that points and errors come from.
    pub fn exact(&self) -> &ExactInverse {
        &self.exact
    }

    /// Points to train at, those that validate among them.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Rows of the recordings that were left out.
    pub fn n_rows_excluded(&self) -> usize {
        self.n_rows_excluded
    }

    /// Recorded forces less the model's, root mean square in N; none without recorded forces.
    pub fn force_rmse_n(&self) -> Option<f64> {
        self.force_rmse_n
    }

    /// Trains and judges; `tick` is called after every epoch of every start, from any thread.
    ///
    /// # Errors
    /// See [`train`].
    pub fn train(&self, config: &TrainConfig, seed: u64, tick: &(dyn Fn() + Sync)) -> Result<Outcome, InverseError> {
        let inverse_box = self.exact.inverse_box();
        let scaling = Scaling::of(inverse_box, config.output_activation);
        let (training, validation) = part(&self.points, config.validation_share, seed);
        let (training, validation) = (Samples::of(&training, &scaling), Samples::of(&validation, &scaling));
        let scale_pa = scaling.output.scale;
        let scales = (scale_pa, inverse_box.pressure_span_pa());
        let trained = train(&training, &validation, config, scales, seed, tick)?;
        let Trained { network, starts, chosen, training_rmse, validation_rmse } = trained;
        let network = InverseNetwork::new(network, scaling, self.exact.domain());
        let judged = judge(&network, &self.exact, config.n_evaluation_points, seed);
        let in_pa = |curve: Vec<f64>| curve.into_iter().map(|rmse| rmse * scale_pa).collect();
        let training = TrainingReport {
            n_training: training.len(),
            n_validation: validation.len(),
            n_rows_excluded: self.n_rows_excluded,
            starts,
            chosen,
            training_rmse_pa: in_pa(training_rmse),
            validation_rmse_pa: in_pa(validation_rmse),
        };
        Ok(Outcome { network, judged, training })
    }
}

impl Outcome {
    /// The artifact; none where no point was judged.
    pub fn artifact(
        &self,
        prepared: &Prepared,
        tool: Tool,
        inputs: Vec<Input>,
        config: TrainConfig,
        seed: u64,
    ) -> Option<InverseArtifact> {
        let network = self.network.network();
        let n_layers = network.activations().len();
        let rows = |layer: usize| {
            let (weights, _) = network.layer(layer);
            weights.chunks_exact(network.layers()[layer]).map(<[f64]>::to_vec).collect()
        };
        let errors = report(&self.judged, prepared.exact())?;
        let mut warnings = Vec::new();
        if errors.coverage.flat_percent > 0.0 || errors.coverage.ambiguous_percent > 0.0 {
            warnings.push(format!(
                "{:.1} % of the operating range has no inverse: force grows too little with pressure there, or falls",
                errors.coverage.flat_percent + errors.coverage.ambiguous_percent
            ));
        }
        let n_outside = self.judged.iter().filter(|judged| judged.outside).count();
        if n_outside > 0 {
            warnings.push(format!(
                "{n_outside} of {} points that have a pressure are flagged as outside the domain",
                self.judged.len()
            ));
        }
        Some(InverseArtifact {
            schema: SCHEMA.to_owned(),
            tool,
            inputs,
            config,
            seed,
            layers: network.layers().to_vec(),
            activations: network.activations().to_vec(),
            weights: (0..n_layers).map(rows).collect(),
            biases: (0..n_layers).map(|layer| network.layer(layer).1.to_vec()).collect(),
            input_scaling: self.network.scaling().inputs.to_vec(),
            output_scaling: self.network.scaling().output.clone(),
            domain: self.network.domain().clone(),
            training: self.training.clone(),
            errors,
            warnings,
        })
    }
}
