//! Samples beside a model, for figures and for what looks at a residual.

use std::ops::Range;

use pam_muscle::direction::Thresholds;
use pam_muscle::effects::AugmentedModel;
use pam_muscle::force::ForceModel;
use pam_recording::CHUNK_ROWS;

use crate::error::IdentifyError;
use crate::predict::walk_augmented;
use crate::prepare::Prepared;

/// Most samples of one recording that a trace keeps.
const TRACE_SAMPLES: usize = 40_000;

/// Samples of one recording beside what the model says, thinned out evenly where there are many.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    /// Time, in s.
    pub time_s: Vec<f64>,
    /// Gauge pressure, in Pa.
    pub pressure_pa: Vec<f64>,
    /// Length, in m.
    pub length_m: Vec<f64>,
    /// Force as measured, in N.
    pub force_n: Vec<f64>,
    /// Force as modelled, in N.
    pub model_n: Vec<f64>,
    /// Direction of motion: +1 contracting, -1 extending.
    pub direction: Vec<f64>,
    /// Whether the direction is certain.
    pub settled: Vec<bool>,
}

impl Trace {
    /// The samples `kept`, in that order.
    #[must_use]
    pub fn only(&self, kept: &[usize]) -> Self {
        let of = |values: &[f64]| kept.iter().map(|&at| values[at]).collect::<Vec<f64>>();
        Self {
            time_s: of(&self.time_s),
            pressure_pa: of(&self.pressure_pa),
            length_m: of(&self.length_m),
            force_n: of(&self.force_n),
            model_n: of(&self.model_n),
            direction: of(&self.direction),
            settled: kept.iter().map(|&at| self.settled[at]).collect(),
        }
    }
}

/// Samples of `prepared` beside what `model` says.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn trace(prepared: &Prepared, model: &ForceModel) -> Result<Trace, IdentifyError> {
    every(prepared, model, trace_stride(prepared), 0..prepared.recording.samples.n_rows())
}

/// Rows from one sample of a trace to the next.
pub(crate) fn trace_stride(prepared: &Prepared) -> usize {
    stride_of(prepared.recording.samples.n_rows())
}

/// The same for a recording of so many rows.
pub(crate) fn stride_of(n_rows: usize) -> usize {
    n_rows.div_ceil(TRACE_SAMPLES).max(1)
}

/// Every `stride`-th of the samples in `rows` of `prepared` beside what `model` says, the first of `rows` being one.
pub(crate) fn every(
    prepared: &Prepared,
    model: &ForceModel,
    stride: usize,
    rows: Range<usize>,
) -> Result<Trace, IdentifyError> {
    let samples = &prepared.recording.samples;
    let mut trace = Trace::default();
    let mut row = rows.start;
    while row < rows.end {
        let chunk = samples
            .chunk(row / CHUNK_ROWS)
            .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
        while row < rows.end.min(chunk.first_row() + chunk.n_rows()) {
            let here = row - chunk.first_row();
            let (pressure_pa, length_m) = (chunk.pressure_pa()[here], chunk.length_m()[here]);
            let direction = prepared.direction.sign(row);
            trace.time_s.push(chunk.time_s()[here]);
            trace.pressure_pa.push(pressure_pa);
            trace.length_m.push(length_m);
            trace.force_n.push(chunk.force_n()[here]);
            trace.model_n.push(model.force_n(pressure_pa, length_m, direction));
            trace.direction.push(direction);
            trace.settled.push(prepared.direction.is_settled(row));
            row += stride;
        }
    }
    Ok(trace)
}

/// Samples of `prepared` beside what an augmented model says; `index` is the number of the recording.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn trace_augmented(
    prepared: &Prepared,
    model: &AugmentedModel,
    thresholds: Thresholds,
    index: usize,
) -> Result<Trace, IdentifyError> {
    let stride = trace_stride(prepared);
    let mut model_n = Vec::new();
    walk_augmented(prepared, model, thresholds, index, &mut |instant, force_n| {
        if instant.row.is_multiple_of(stride) {
            model_n.push(force_n);
        }
    })
    .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
    Ok(Trace { model_n, ..trace(prepared, model.base())? })
}
