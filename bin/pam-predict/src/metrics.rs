//! Metrics of a prediction, for other programs.

use pam_artifact::prediction::{PredictConfig, PredictionArtifact, SCHEMA};
use pam_artifact::{Input, Tool};
use pam_identification::prediction::Prediction;
use pam_identification::prepare::Prepared;

use crate::args::Args;

/// The artifact; `floor_n` is what noise leaves of a perfect model, `accepted` whether the limits are met.
pub(crate) fn metrics(
    args: &Args,
    inputs: Vec<Input>,
    followed: &Prediction,
    (floor_n, accepted): (Option<f64>, bool),
    prepared: &Prepared,
) -> PredictionArtifact {
    PredictionArtifact {
        schema: SCHEMA.to_owned(),
        tool: Tool { name: "pam-predict".to_owned(), version: env!("CARGO_PKG_VERSION").to_owned() },
        inputs,
        config: PredictConfig {
            max_rmse_n: args.max_rmse_n,
            max_rmse_all_n: args.max_rmse_all_n,
            accept_implausible: args.accept_implausible,
        },
        seed: args.run.seed,
        n_rows: prepared.recording.samples.n_rows(),
        counted: followed.counted,
        all: followed.all,
        noise_floor_n: floor_n,
        band: followed.band,
        extrapolation: followed.extrapolation.clone(),
        accepted,
    }
}
