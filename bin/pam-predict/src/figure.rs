//! The figure of a prediction.

use pam_identification::prediction::Prediction;
use pam_identification::prepare::Prepared;
use pam_report::number::significant;
use pam_report::{PredictionFigure, prediction_figure};

/// The figure as SVG.
pub(crate) fn svg(followed: &Prediction, prepared: &Prepared) -> anyhow::Result<String> {
    let track = &followed.track;
    let scaled = |values: &[f64], scale: f64| -> Vec<f64> { values.iter().map(|value| value * scale).collect() };
    let domain = &followed.extrapolation.domain;
    let name = prepared.recording.path.rsplit('/').next().unwrap_or(&prepared.recording.path);
    Ok(prediction_figure(&PredictionFigure {
        title: format!("{name}: measured and modelled"),
        facts: facts(followed),
        time_s: track.time_s.clone(),
        pressure_kpa: scaled(&track.pressure_pa, 1e-3),
        length_mm: scaled(&track.length_m, 1e3),
        force_n: track.force_n.clone(),
        model_n: track.model_n.clone(),
        half_width_n: track.half_width_n.clone(),
        level: followed.band.level,
        counted: track.counted.clone(),
        extrapolated: track.extrapolated.clone(),
        identified_kpa: domain.pressure_pa.map(|pressure_pa| 1e-3 * pressure_pa),
        identified_mm: domain.length_m.map(|length_m| 1e3 * length_m),
    })?)
}

/// The figure's statement in numbers.
fn facts(followed: &Prediction) -> Vec<String> {
    let mut facts = Vec::new();
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    if let (Some(counted), Some(all)) = (followed.counted, followed.all) {
        facts.push(format!(
            "RMSE {} N counted, {} N all samples",
            significant(counted.rmse_n, 3),
            significant(all.rmse_n, 3)
        ));
    }
    let band = &followed.band;
    let held = followed.all.map_or(String::new(), |all| format!(" holds {} of them", percent(all.inside_band)));
    facts.push(format!("{} band ±{} N{held}", percent(band.level), significant(band.half_width_n, 3)));
    let extrapolation = &followed.extrapolation;
    if extrapolation.share > 0.0 {
        let parts = [("pressure", extrapolation.pressure_share), ("length", extrapolation.length_share)];
        let parts: Vec<&str> = parts.iter().filter(|(_, share)| *share > 0.0).map(|(name, _)| *name).collect();
        let share = if extrapolation.share < 0.01 { "under 1 %".to_owned() } else { percent(extrapolation.share) };
        facts.push(format!("{share} extrapolated in {}", parts.join(" and ")));
    }
    facts
}
