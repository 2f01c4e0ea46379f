//! The figure of a fit, from what was found.

use pam_core::artifact::ModelArtifact;
use pam_identification::identify::Identified;
use pam_report::{FitFigure, FitRecording, Role, SwarmStart, fit_figure};

/// The figure as SVG.
pub(crate) fn svg(found: &Identified, artifact: &ModelArtifact) -> anyhow::Result<String> {
    let n_estimation = found.estimation.len();
    let names = artifact.fit.recordings.iter().map(|recording| name(&recording.path));
    let recordings = found
        .traces()?
        .into_iter()
        .zip(names)
        .enumerate()
        .map(|(index, (trace, name))| FitRecording {
            name,
            role: if index < n_estimation { Role::Estimation } else { Role::Validation },
            pressure_kpa: trace.pressure_pa.iter().map(|pressure_pa| pressure_pa * 1e-3).collect(),
            length_mm: trace.length_m.iter().map(|length_m| length_m * 1e3).collect(),
            time_s: trace.time_s,
            force_n: trace.force_n,
            model_n: trace.model_n,
            direction: trace.direction,
        })
        .collect();
    let starts = found.convergence_n().into_iter().zip(&artifact.search.starts);
    let title = match artifact.form {
        pam_core::force::Form::Corrected => "Eq. 11 fitted",
        pam_core::force::Form::AsPrinted => "Eq. 11 as printed, fitted",
    };
    Ok(fit_figure(&FitFigure {
        title: title.to_owned(),
        recordings,
        noise_floor_n: Some(artifact.fit.noise_floor_n),
        rmse_estimation_n: Some(artifact.fit.estimation.rmse_n),
        rmse_validation_n: artifact.fit.validation.map(|statistics| statistics.rmse_n),
        starts: starts
            .map(|(best_rmse_n, start)| SwarmStart { best_rmse_n, polished_rmse_n: start.polished_rmse_n })
            .collect(),
    })?)
}

/// File name without folders and ending.
fn name(path: &str) -> String {
    let file = path.rsplit('/').next().unwrap_or(path);
    file.strip_suffix(".gz").unwrap_or(file).trim_end_matches(".csv").to_owned()
}
