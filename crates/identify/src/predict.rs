//! A model along a recording, row by row.

use pam_core::artifact::ModelArtifact;
use pam_core::artifact::model::Domain;
use pam_core::force::ForceModel;
use pam_core::recording::Chunk;

use crate::error::IdentifyError;
use crate::prepare::{Prepared, direct, gate};

/// A recording with the direction that the model's thresholds give it.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn prepare(recording: pam_core::recording::Recording, artifact: &ModelArtifact) -> Result<Prepared, IdentifyError> {
    let gates = gate(vec![recording])?;
    let mut prepared = direct(gates, artifact.direction, artifact.form)?;
    Ok(prepared.remove(0))
}

/// Modelled force of every row of `chunk`, in N.
pub fn forces_n(prepared: &Prepared, model: &ForceModel, chunk: &Chunk) -> Vec<f64> {
    chunk
        .rows()
        .zip(chunk.pressure_pa())
        .zip(chunk.length_m())
        .map(|((row, &pressure_pa), &length_m)| model.force_n(pressure_pa, length_m, prepared.direction.sign(row)))
        .collect()
}

/// How far a recording leaves what the model was identified on, in words; empty where it stays inside.
pub fn outside(prepared: &Prepared, domain: &Domain) -> Vec<String> {
    let mut words = Vec::new();
    for (name, [low, high], scale, unit) in
        [("pressure", domain.pressure_pa, 1e-3, "kPa"), ("length", domain.length_m, 1e3, "mm")]
    {
        let Some(channel) = prepared.quality.channel(name) else { continue };
        // Beyond the range by more than noise and a percent of the range.
        let margin = 6.0 * channel.noise + 0.01 * (high - low);
        if channel.lowest < low - margin || channel.highest > high + margin {
            words.push(format!(
                "{}: {name} runs from {:.1} to {:.1} {unit}, but the model was identified on {:.1} to {:.1} {unit}: the \
                 force is extrapolated",
                prepared.recording.path,
                channel.lowest * scale,
                channel.highest * scale,
                low * scale,
                high * scale
            ));
        }
    }
    words
}
