//! Recordings that a diagnosis cannot use are refused before anything is fitted.

use pam_artifact::ModelArtifact;
use pam_identification::error::IdentifyError;
use pam_identification::faults;
use pam_identification::prepare::{Gated, Prepared, begin_at_rest, direct, gate};
use pam_identification::report::out_of_range;
use pam_muscle::force::ForceModel;
use pam_recording::Recording;
use pam_recording::quality::ChannelQuality;

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
    let found = |gates: Vec<Gated>| -> Result<Vec<Prepared>, IdentifyError> {
        let mut recordings = direct(gates, model.direction, model.form)?;
        begin_at_rest(&mut recordings, &model.force_model(), model.direction.standstill)?;
        Ok(recordings)
    };
    Ok((found(gates)?, found(holdout)?))
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
            // Where its steps are as coarse as its noise, a channel that rests shows one value as well.
            && channel.ends_high()
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

/// What there is to say of the recordings themselves, whatever the diagnosis is.
pub(crate) fn noticed(
    estimation: &[Prepared],
    holdout: &[Prepared],
    base: &ForceModel,
    model: &ModelArtifact,
) -> Result<Vec<String>, DiagnoseError> {
    let all = || estimation.iter().chain(holdout);
    let mut words = out_of_range(all);
    words.extend(faults::noise::words(all(), base, Some(faults::reading::own_n(model)))?);
    words.extend(faults::dead_band::words(all().map(|prepared| (&prepared.recording, &prepared.quality))));
    let recordings: Vec<&Recording> = all().map(|prepared| &prepared.recording).collect();
    words.extend(faults::twice::repeated(&recordings)?);
    Ok(words)
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

#[cfg(test)]
mod tests {
    use super::*;

    use pam_recording::{Repairs, Samples};

    /// A load that is lifted and then rests, on a load cell with steps of so many newtons.
    fn rests(step_n: f64) -> Gated {
        let time_s: Vec<f64> = (0..1000).map(|row| 0.01 * f64::from(row)).collect();
        let (pressure_pa, length_m): (Vec<f64>, Vec<f64>) =
            time_s.iter().map(|t| (3e5 + 1e3 * t, 0.24 + 1e-3 * (5.0 - t).max(0.0))).unzip();
        let noisy_n = |row: usize| 60.0 * time_s[row].min(5.0) + 0.4 * (row * 7919 % 101) as f64 / 101.0;
        let force_n: Vec<f64> = (0..1000).map(|row| (noisy_n(row).min(300.0) / step_n).round() * step_n).collect();
        let samples = Samples::from_columns(&time_s, &pressure_pa, &length_m, &force_n);
        let segments = vec![0..samples.n_rows(); 1];
        let (sha256, repairs) = (String::new(), Repairs::default());
        let path = "rests.csv".to_owned();
        let recording = Recording { path, sha256, samples, segments, repairs, ignored_columns: Vec::new() };
        gate(vec![recording]).unwrap().remove(0)
    }

    #[test]
    fn a_force_that_rests_between_coarse_steps_is_not_saturated_and_one_that_should_flicker_is() {
        assert!(channels(&rests(4.0)).is_ok());
        assert!(matches!(channels(&rests(0.01)), Err(DiagnoseError::Saturated { .. })));
    }
}
