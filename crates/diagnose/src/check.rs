//! Recordings that a diagnosis cannot use are refused before anything is fitted.

use pam_core::artifact::ModelArtifact;
use pam_core::quality::ChannelQuality;
use pam_core::recording::Recording;
use pam_identification::error::IdentifyError;
use pam_identification::faults;
use pam_identification::prepare::{Gated, Prepared, direct, gate};

use crate::error::DiagnoseError;
use crate::track::{FOLDS, Track};

/// Share of the samples at the upper end of a channel's range beyond which it counts as saturated.
const SATURATED: f64 = 0.02;
/// Counted instants that a fold needs, at least.
const PER_FOLD: usize = 30;

/// Recordings with quality gate and direction; estimation first.
pub(crate) fn prepare(
    estimation: Vec<Recording>,
    holdout: Vec<Recording>,
    model: &ModelArtifact,
    accept_implausible: bool,
) -> Result<(Vec<Prepared>, Vec<Prepared>), DiagnoseError> {
    let n_estimation = estimation.len();
    faults::twice::check(&estimation, &holdout)?;
    let mut gates = gate(estimation.into_iter().chain(holdout).collect())?;
    for gated in &gates {
        let path = || gated.recording.path.clone();
        if !gated.recording.samples.has_force() {
            return Err(IdentifyError::NoForce { path: path() }.into());
        }
        channels(gated)?;
    }
    if !accept_implausible {
        let fault = faults::find(&gates, &model.geometry).map_err(|reason| IdentifyError::Samples {
            path: gates.first().map_or_else(String::new, |gated| gated.recording.path.clone()),
            reason,
        })?;
        if let Some(fault) = fault {
            return Err(DiagnoseError::Fault(fault));
        }
    }
    let holdout = gates.split_off(n_estimation);
    Ok((direct(gates, model.direction, model.form)?, direct(holdout, model.direction, model.form)?))
}

fn channels(gated: &Gated) -> Result<(), DiagnoseError> {
    let path = || gated.recording.path.clone();
    let constant = |channel: &ChannelQuality| channel.highest <= channel.lowest;
    if let Some(force) = gated.quality.channel("force")
        && constant(force)
    {
        return Err(DiagnoseError::Constant { path: path(), channel: "force", value: force.lowest, unit: "N" });
    }
    let (pressure, length) = (gated.quality.channel("pressure"), gated.quality.channel("length"));
    if let (Some(pressure), Some(length)) = (pressure, length)
        && constant(pressure)
        && constant(length)
    {
        let value = 1e-3 * pressure.lowest;
        return Err(DiagnoseError::Constant { path: path(), channel: "pressure", value, unit: "kPa" });
    }
    for (name, scale, unit) in [("pressure", 1e-3, "kPa"), ("force", 1.0, "N")] {
        if let Some(channel) = gated.quality.channel(name)
            && channel.clipped_high_share > SATURATED
        {
            return Err(DiagnoseError::Saturated {
                path: path(),
                channel: if name == "force" { "force" } else { "pressure" },
                value: channel.highest * scale,
                unit,
                percent: 100.0 * channel.clipped_high_share,
            });
        }
    }
    Ok(())
}

/// Refuses a track that is too short to hold anything out of.
pub(crate) fn long_enough(track: &Track, prepared: &[Prepared]) -> Result<(), DiagnoseError> {
    let needed = PER_FOLD * FOLDS;
    let have = track.n_counted();
    if have >= needed {
        return Ok(());
    }
    let duration_s: f64 = prepared.iter().map(|prepared| prepared.quality.duration_s).sum();
    let per_instant_s = duration_s / track.n().max(1) as f64;
    Err(DiagnoseError::TooShort {
        path: prepared.first().map_or_else(String::new, |prepared| prepared.recording.path.clone()),
        have_s: have as f64 * per_instant_s,
        more_s: ((needed - have) as f64 * per_instant_s).ceil(),
    })
}
