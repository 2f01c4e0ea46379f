//! A recording reduced to the samples that can be shown.

use pam_muscle::Coordinate;

use super::PageRecording;
use crate::FigureError;

/// Samples of one recording with finite forces.
#[derive(Debug)]
pub(crate) struct Samples {
    pub(crate) name: String,
    pub(crate) held_out: bool,
    pub(crate) stretches: Vec<(f64, f64)>,
    pub(crate) settled: Vec<bool>,
    pub(crate) force_n: Vec<f64>,
    pub(crate) base_n: Vec<f64>,
    pub(crate) model_n: Option<Vec<f64>>,
    /// Measured less base force.
    pub(crate) before_n: Vec<f64>,
    /// Measured force less that of base and effects.
    pub(crate) after_n: Option<Vec<f64>>,
    /// In the order of [`Coordinate::ALL`].
    columns: [Vec<f64>; 8],
}

impl Samples {
    pub(crate) fn new(recording: &PageRecording) -> Result<Self, FigureError> {
        check_columns(recording)?;
        let model = recording.model_force_n.as_deref();
        let shown: Vec<usize> = (0..recording.time_s.len())
            .filter(|&row| {
                let forces = recording.force_n[row] - recording.base_force_n[row];
                (recording.time_s[row] + forces + model.map_or(0.0, |model| model[row])).is_finite()
            })
            .collect();
        let pick = |values: &[f64]| -> Vec<f64> { shown.iter().map(|&row| values[row]).collect() };
        let less =
            |model: &[f64]| -> Vec<f64> { shown.iter().map(|&row| recording.force_n[row] - model[row]).collect() };
        Ok(Self {
            name: recording.name.clone(),
            held_out: recording.held_out,
            stretches: recording.stretches.clone(),
            settled: shown.iter().map(|&row| recording.settled[row]).collect(),
            force_n: pick(&recording.force_n),
            base_n: pick(&recording.base_force_n),
            model_n: model.map(pick),
            before_n: less(&recording.base_force_n),
            after_n: model.map(less),
            columns: Coordinate::ALL.map(|coordinate| pick(column_of(recording, coordinate))),
        })
    }

    pub(crate) fn column(&self, coordinate: Coordinate) -> &[f64] {
        let at = Coordinate::ALL.iter().position(|other| *other == coordinate);
        &self.columns[at.unwrap_or(0)]
    }

    /// Time, in s.
    pub(crate) fn time_s(&self) -> &[f64] {
        self.column(Coordinate::Time)
    }

    /// Root mean square of `residual_n` over all samples.
    pub(crate) fn rms_all(&self, residual_n: &[f64]) -> f64 {
        (residual_n.iter().map(|residual_n| residual_n * residual_n).sum::<f64>() / residual_n.len() as f64).sqrt()
    }

    /// Residuals after, or before where there is no after.
    pub(crate) fn last_n(&self) -> &[f64] {
        self.after_n.as_deref().unwrap_or(&self.before_n)
    }

    /// Root mean square of `residual_n` where the direction is settled, or over all samples where it nowhere is.
    pub(crate) fn rms(&self, residual_n: &[f64]) -> f64 {
        let all = !self.settled.contains(&true);
        let chosen = residual_n.iter().zip(&self.settled).filter(|(_, settled)| all || **settled);
        let (n, sum) = chosen.fold((0.0, 0.0), |(n, sum), (residual, _)| (n + 1.0, sum + residual * residual));
        if n > 0.0 { f64::sqrt(sum / n) } else { f64::NAN }
    }
}

fn column_of(recording: &PageRecording, coordinate: Coordinate) -> &[f64] {
    match coordinate {
        Coordinate::Time => &recording.time_s,
        Coordinate::Pressure => &recording.pressure_kpa,
        Coordinate::Contraction => &recording.contraction_percent,
        Coordinate::Speed => &recording.speed_mm_per_s,
        Coordinate::TravelSinceReversal => &recording.travel_mm,
        Coordinate::TimeSinceLastMove => &recording.rest_s,
        Coordinate::Cycle => &recording.cycle,
        Coordinate::Force => &recording.base_force_n,
    }
}

fn check_columns(recording: &PageRecording) -> Result<(), FigureError> {
    let expected = recording.time_s.len();
    let columns = [
        ("pressure_kpa", recording.pressure_kpa.len()),
        ("contraction_percent", recording.contraction_percent.len()),
        ("speed_mm_per_s", recording.speed_mm_per_s.len()),
        ("travel_mm", recording.travel_mm.len()),
        ("rest_s", recording.rest_s.len()),
        ("cycle", recording.cycle.len()),
        ("force_n", recording.force_n.len()),
        ("base_force_n", recording.base_force_n.len()),
        ("model_force_n", recording.model_force_n.as_ref().map_or(expected, Vec::len)),
        ("settled", recording.settled.len()),
    ];
    match columns.into_iter().find(|(_, found)| *found != expected) {
        Some((column, found)) => {
            Err(FigureError::UnequalColumns { recording: recording.name.clone(), column, expected, found })
        }
        None => Ok(()),
    }
}

/// Lowest and highest of finite `values`; NaN both where there is none.
pub(crate) fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold((f64::NAN, f64::NAN), |(lowest, highest), value| (lowest.min(value), highest.max(value)))
}
