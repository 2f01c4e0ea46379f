//! A recording reduced to the samples that can be shown.

use super::{FitRecording, Role};
use crate::FigureError;
pub(super) use crate::residual_cells::{mean, quantile};

/// Finite samples of one recording, and what several panels need of them.
#[derive(Debug)]
pub(super) struct Clean {
    pub(super) name: String,
    pub(super) role: Role,
    pub(super) time_s: Vec<f64>,
    pub(super) pressure_kpa: Vec<f64>,
    pub(super) length_mm: Vec<f64>,
    pub(super) force_n: Vec<f64>,
    pub(super) model_n: Vec<f64>,
    /// Measured less modelled force.
    pub(super) residual_n: Vec<f64>,
    pub(super) contracting: Vec<bool>,
}

impl Clean {
    pub(super) fn new(recording: &FitRecording) -> Result<Self, FigureError> {
        let expected = recording.time_s.len();
        let columns = [
            ("pressure_kpa", &recording.pressure_kpa),
            ("length_mm", &recording.length_mm),
            ("force_n", &recording.force_n),
            ("model_n", &recording.model_n),
            ("direction", &recording.direction),
        ];
        for (column, values) in columns {
            if values.len() != expected {
                let recording = recording.name.clone();
                return Err(FigureError::UnequalColumns { recording, column, expected, found: values.len() });
            }
        }
        let shown: Vec<usize> = (0..expected)
            .filter(|&row| {
                let modelled = recording.force_n[row] - recording.model_n[row];
                // A finite sum means finite terms, but for values beyond any muscle.
                (recording.time_s[row] + recording.pressure_kpa[row] + recording.length_mm[row] + modelled).is_finite()
            })
            .collect();
        let pick = |values: &[f64]| -> Vec<f64> { shown.iter().map(|&row| values[row]).collect() };
        Ok(Self {
            name: recording.name.clone(),
            role: recording.role,
            time_s: pick(&recording.time_s),
            pressure_kpa: pick(&recording.pressure_kpa),
            length_mm: pick(&recording.length_mm),
            force_n: pick(&recording.force_n),
            model_n: pick(&recording.model_n),
            residual_n: shown.iter().map(|&row| recording.force_n[row] - recording.model_n[row]).collect(),
            contracting: shown.iter().map(|&row| recording.direction[row] >= 0.0).collect(),
        })
    }
}

/// Lowest and highest of finite `values`; NaN both where there is none.
pub(super) fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    values.into_iter().fold((f64::NAN, f64::NAN), |(lowest, highest), value| (lowest.min(value), highest.max(value)))
}
