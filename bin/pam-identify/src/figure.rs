//! The figure of a fit, from what was found.

use pam_artifact::ModelArtifact;
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
        .map(|(index, (trace, name))| {
            // Around reversals noise hides the direction of friction: not counted, and not drawn.
            let counted = |values: &[f64], scale: f64| -> Vec<f64> {
                values
                    .iter()
                    .zip(&trace.settled)
                    .filter(|(_, settled)| **settled)
                    .map(|(value, _)| value * scale)
                    .collect()
            };
            FitRecording {
                name,
                role: if index < n_estimation { Role::Estimation } else { Role::Validation },
                time_s: counted(&trace.time_s, 1.0),
                pressure_kpa: counted(&trace.pressure_pa, 1e-3),
                length_mm: counted(&trace.length_m, 1e3),
                force_n: counted(&trace.force_n, 1.0),
                model_n: counted(&trace.model_n, 1.0),
                direction: counted(&trace.direction, 1.0),
            }
        })
        .collect();
    let starts = found.convergence_n().into_iter().zip(&artifact.search.starts);
    let form = match artifact.form {
        pam_muscle::force::Form::Corrected => "eq. 11 fitted",
        pam_muscle::force::Form::AsPrinted => "eq. 11 as printed, fitted",
    };
    let muscle = artifact.muscle_title();
    let mut letters = muscle.chars();
    let muscle: String = letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect();
    Ok(fit_figure(&FitFigure {
        title: format!("{muscle}: {form}"),
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
