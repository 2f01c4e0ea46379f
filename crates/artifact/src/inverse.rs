//! `pam-inverse/1`: a network that gives the pressure for a force, a length and a direction.
//!
//! Everything that another language needs to evaluate it is here:
//!
//! ```text
//! x_i = (input_i - offset_i) / scale_i
//! h = f(W x + b)   for every layer, W being weights[layer] (outputs × inputs) and b biases[layer]
//! pressure = offset + scale h
//! ```
//!
//! The paper writes `W x - b`; its biases are these with the other sign. `domain` says where the network may
//! be asked at all.

use std::path::Path;

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::ArtifactError;
use super::origin::{Input, Tool};

/// Schema name and version.
pub const SCHEMA: &str = "pam-inverse/1";

/// Most neurons in a layer, which lets the network be evaluated without allocating.
pub const MAX_WIDTH: usize = 64;

/// An inverse network with everything that later programs need.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct InverseArtifact {
    /// `pam-inverse/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Files that went into it.
    pub inputs: Vec<Input>,
    /// Options as resolved.
    pub config: TrainConfig,
    /// Seed of every random draw.
    pub seed: u64,
    /// Neurons of every layer: three inputs, hidden ones, one output.
    pub layers: Vec<usize>,
    /// Activation of every layer after the input.
    pub activations: Vec<Activation>,
    /// Weights of every layer after the input: a row per neuron, an entry per neuron of the layer before.
    pub weights: Vec<Vec<Vec<f64>>>,
    /// Biases of every layer after the input; they are added.
    pub biases: Vec<Vec<f64>>,
    /// Scaling of force, length and direction, in this order.
    pub input_scaling: Vec<ChannelScaling>,
    /// Scaling of the pressure.
    pub output_scaling: ChannelScaling,
    /// Where the network may be asked.
    pub domain: InverseDomain,
    /// How the training went.
    pub training: TrainingReport,
    /// Errors on points that the training never saw.
    pub errors: ErrorReport,
    /// What a person should know before using the network.
    pub warnings: Vec<String>,
}

/// How a neuron answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Activation {
    /// `tanh z`.
    Tanh,
    /// `1 / (1 + e⁻ᶻ)`.
    Sigmoid,
    /// `z`.
    Linear,
}

/// How a network is trained.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Descent along the gradient, eqs 16–19 with their misprints corrected.
    Backpropagation,
    /// Levenberg–Marquardt on all samples at once.
    LevenbergMarquardt,
}

/// After what plain backpropagation changes the weights.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Update {
    /// Every sample, in an order drawn anew for every epoch; as the paper prints it.
    Sample,
    /// Every epoch, by the mean gradient.
    Epoch,
}

/// Options that a training was run with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TrainConfig {
    /// How the network is trained.
    pub method: Method,
    /// Neurons of the hidden layers.
    pub hidden: Vec<usize>,
    /// Activation of the hidden layers.
    pub hidden_activation: Activation,
    /// Activation of the output.
    pub output_activation: Activation,
    /// Design points drawn from the model.
    pub n_design_points: usize,
    /// Most rows taken from the recordings.
    pub n_recording_rows: usize,
    /// Share of the points that decides when to stop and which start wins.
    pub validation_share: f64,
    /// Starts with weights of their own.
    pub n_starts: usize,
    /// Most epochs of a start.
    pub n_epochs: usize,
    /// Epochs without a better validation error after which a start ends.
    pub patience: usize,
    /// Validation error at which a start ends, as a share of the full scale.
    pub goal: f64,
    /// Step along the gradient; backpropagation only.
    pub learning_rate: f64,
    /// When the weights change; backpropagation only.
    pub update: Update,
    /// Points that the finished network is judged on.
    pub n_evaluation_points: usize,
    /// Slope `dF/dp` below which the inverse does not exist, as a share of the range of force over the range of
    /// pressure.
    pub min_slope_share: f64,
}

/// `scaled = (value - offset) / scale`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ChannelScaling {
    /// `force`, `length`, `direction` or `pressure`.
    pub name: String,
    /// Unit of the value; `1` where it has none.
    pub unit: String,
    /// Value that becomes 0.
    pub offset: f64,
    /// Difference that becomes 1.
    pub scale: f64,
}

/// Where the network may be asked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct InverseDomain {
    /// Lowest and highest pressure, in Pa.
    pub pressure_pa: [f64; 2],
    /// Shortest and longest length, in m.
    pub length_m: [f64; 2],
    /// Lowest and highest force, in N.
    pub force_n: [f64; 2],
    /// Slope `dF/dp` below which the inverse counts as missing, in N/Pa.
    pub min_slope_n_per_pa: f64,
    /// Forces that have a pressure, over equal steps of length; between them and between the directions they are
    /// interpolated linearly.
    pub reach: Vec<Reach>,
}

/// Forces that have a pressure at one length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Reach {
    /// Length, in m.
    pub length_m: f64,
    /// Lowest and highest force while contracting (direction +1), in N; none where no force has a pressure.
    pub contracting_force_n: Option<[f64; 2]>,
    /// Likewise while extending (direction -1).
    pub extending_force_n: Option<[f64; 2]>,
}

/// How the training went.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TrainingReport {
    /// Points that the weights were fitted to.
    pub n_training: usize,
    /// Points that decided when to stop.
    pub n_validation: usize,
    /// Rows of recordings that were left out, because no pressure of the domain belongs to them alone.
    pub n_rows_excluded: usize,
    /// Every start.
    pub starts: Vec<StartReport>,
    /// The start whose weights are written, counted from 0.
    pub chosen: usize,
    /// Its training error after every epoch, root mean square, in Pa.
    pub training_rmse_pa: Vec<f64>,
    /// Its validation error after every epoch, root mean square, in Pa.
    pub validation_rmse_pa: Vec<f64>,
}

/// One start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct StartReport {
    /// Epochs run.
    pub n_epochs: usize,
    /// Epoch whose weights were kept, counted from 0, the weights before the first.
    pub best_epoch: usize,
    /// Validation error of these weights, root mean square, in Pa.
    pub validation_rmse_pa: f64,
    /// Why it ended.
    pub ended: Ended,
}

/// Why a start ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Ended {
    /// The validation error fell below the goal.
    GoalReached,
    /// No step lowers the training error any further.
    Converged,
    /// The validation error did not fall any more.
    NoBetterValidation,
    /// The epochs were used up.
    EpochsUsedUp,
    /// The weights ran away.
    Diverged,
}

/// Errors on points that the training never saw, drawn evenly where the inverse exists.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ErrorReport {
    /// What the box of pressures and lengths consists of.
    pub coverage: Coverage,
    /// Pressure → force (model) → pressure (network), in Pa.
    pub pressure_pa: ErrorStatistics,
    /// Force → pressure (network) → force (model), in N.
    pub force_n: ErrorStatistics,
    /// RMSE of the pressure over the range of pressure, in percent.
    pub pressure_rmse_percent: f64,
    /// RMSE of the force over the range of force, in percent.
    pub force_rmse_percent: f64,
    /// Pressure errors by pressure (Pa), length (m) and direction.
    pub regions: Vec<RegionErrors>,
}

/// Shares of the box of pressures, lengths and directions, in percent; they add up to 100.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Coverage {
    /// Cells counted.
    pub n_cells: usize,
    /// The inverse exists.
    pub invertible_percent: f64,
    /// The force is below the domain: the muscle is slack or nearly so.
    pub slack_percent: f64,
    /// The force is above the domain.
    pub beyond_percent: f64,
    /// The force grows too little with the pressure, or falls.
    pub flat_percent: f64,
    /// The force belongs to a lower or a longer range of pressures as well, which is the one inverted.
    pub ambiguous_percent: f64,
}

/// Size of errors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ErrorStatistics {
    /// Points.
    pub n: usize,
    /// Root mean square.
    pub rmse: f64,
    /// Median of the absolute values.
    pub median: f64,
    /// Absolute value that 95 % of the points stay below.
    pub p95: f64,
    /// Largest absolute value.
    pub max: f64,
    /// Mean, sign kept.
    pub mean: f64,
}

/// Pressure errors in one region.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct RegionErrors {
    /// Coordinate that is cut: `pressure_pa`, `length_m` or `direction`.
    pub coordinate: String,
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Errors there, in Pa; none where no point lies there.
    pub pressure_pa: Option<ErrorStatistics>,
}

impl InverseArtifact {
    /// Reads and checks an artifact; gives its SHA-256 as well.
    ///
    /// # Errors
    /// [`ArtifactError`] names the file, the place and what to do.
    pub fn read(path: &Path) -> Result<(Self, String), ArtifactError> {
        let (artifact, sha256): (Self, String) = super::json::read(path, SCHEMA, "pam-train-inverse")?;
        artifact.check().map_err(|what| ArtifactError::Implausible { path: path.to_owned(), what })?;
        Ok((artifact, sha256))
    }

    /// Whether layers, weights, scaling and domain fit together.
    ///
    /// # Errors
    /// What does not, in words.
    pub fn check(&self) -> Result<(), String> {
        self.check_shape()?;
        let scalings = self.input_scaling.iter().chain([&self.output_scaling]);
        let names = ["force", "length", "direction", "pressure"];
        if self.input_scaling.len() != 3 || scalings.clone().zip(names).any(|(scaling, name)| scaling.name != name) {
            return Err("the scaling is not that of force, length and direction to pressure".to_owned());
        }
        if let Some(bad) = scalings.into_iter().find(|scaling| scaling.scale <= 0.0) {
            return Err(format!("the scale of {} is {}, expected a positive number", bad.name, bad.scale));
        }
        let domain = &self.domain;
        for (name, [from, to]) in
            [("pressure", domain.pressure_pa), ("length", domain.length_m), ("force", domain.force_n)]
        {
            if from >= to {
                return Err(format!("the domain's {name} runs from {from} to {to}"));
            }
        }
        let n_steps = domain.reach.len().saturating_sub(1);
        if n_steps == 0 {
            return Err(format!("the domain's reach has {} lengths, expected two or more", domain.reach.len()));
        }
        let [shortest, longest] = domain.length_m;
        let step_m = (longest - shortest) / n_steps as f64;
        for (index, reach) in domain.reach.iter().enumerate() {
            let expected_m = shortest + step_m * index as f64;
            if (reach.length_m - expected_m).abs() > 1e-6 * step_m {
                return Err(format!(
                    "length {index} of the domain's reach is {} m, expected {expected_m}",
                    reach.length_m
                ));
            }
        }
        Ok(())
    }

    fn check_shape(&self) -> Result<(), String> {
        let layers = &self.layers;
        if layers.len() < 3 || layers[0] != 3 || layers[layers.len() - 1] != 1 {
            return Err(format!("layers are {layers:?}, expected three inputs, hidden layers and one output"));
        }
        if let Some(width) = layers.iter().find(|&&width| width == 0 || width > MAX_WIDTH) {
            return Err(format!("a layer has {width} neurons, expected 1 to {MAX_WIDTH}"));
        }
        let n = layers.len() - 1;
        for (name, found) in
            [("activations", self.activations.len()), ("weights", self.weights.len()), ("biases", self.biases.len())]
        {
            if found != n {
                return Err(format!("{name} has {found} layers, expected {n} as in layers"));
            }
        }
        for layer in 0..n {
            let (inputs, outputs) = (layers[layer], layers[layer + 1]);
            let rows = &self.weights[layer];
            let wrong = rows.iter().find(|row| row.len() != inputs);
            if rows.len() != outputs || wrong.is_some() {
                let found = format!("{} × {}", rows.len(), wrong.map_or(inputs, Vec::len));
                return Err(format!("weights of layer {} are {found}, expected {outputs} × {inputs}", layer + 1));
            }
            if self.biases[layer].len() != outputs {
                let found = self.biases[layer].len();
                return Err(format!("biases of layer {} are {found}, expected {outputs}", layer + 1));
            }
        }
        Ok(())
    }
}
