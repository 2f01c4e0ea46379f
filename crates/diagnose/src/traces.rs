//! Recordings along a diagnosis: what was measured, what base and augmented model say, and the coordinates that a residual
//! is laid out over.

use pam_identification::error::IdentifyError;
use pam_identification::predict::walk_augmented;
use pam_identification::prepare::Prepared;
use pam_muscle::effects::{AugmentedModel, Moment};
use pam_muscle::motion::Instant;
use rayon::prelude::*;

use crate::coordinates::{History, moving_limits};
use crate::diagnose::Diagnosis;

/// One recording, thinned evenly; all columns are as long.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    /// Path as given.
    pub path: String,
    /// Whether nothing was fitted to it.
    pub held_out: bool,
    /// Time since the recording began, in s.
    pub time_s: Vec<f64>,
    /// Gauge pressure, in Pa.
    pub pressure_pa: Vec<f64>,
    /// Contraction ratio.
    pub contraction_ratio: Vec<f64>,
    /// Size of the speed, in m/s.
    pub speed_m_per_s: Vec<f64>,
    /// Travel of the braid since the last reversal, in m.
    pub travel_m: Vec<f64>,
    /// Time since the last move, in s.
    pub rest_s: Vec<f64>,
    /// Cycle of motion, counted from 1.
    pub cycle: Vec<f64>,
    /// Measured force, in N.
    pub force_n: Vec<f64>,
    /// Force of the refitted base model, in N.
    pub base_n: Vec<f64>,
    /// Force of base model and effects, in N.
    pub augmented_n: Vec<f64>,
    /// Whether the direction is certain.
    pub settled: Vec<bool>,
}

/// Every recording of `diagnosis`, estimation first, in at most `most` samples each.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn traces(diagnosis: &Diagnosis, most: usize) -> Result<Vec<Trace>, IdentifyError> {
    let elsewhere = diagnosis.augmented.elsewhere();
    let walk = |model: &AugmentedModel, recordings: &[Prepared]| -> Result<Vec<Walked>, IdentifyError> {
        recordings
            .par_iter()
            .enumerate()
            .map(|(index, prepared)| walked(diagnosis, prepared, model, index, most))
            .collect()
    };
    let estimation = walk(&diagnosis.augmented, &diagnosis.estimation)?;
    let holdout = walk(&elsewhere, &diagnosis.holdout)?;
    let limits = moving_limits(moments(&estimation));
    let held_limits = moving_limits(moments(&holdout));
    let trace = |(prepared, walked): (&Prepared, &Walked), held_out, limits| Trace {
        path: prepared.recording.path.clone(),
        held_out,
        ..laid_out(diagnosis, walked, limits)
    };
    let fitted = diagnosis.estimation.iter().zip(&estimation).map(|pair| trace(pair, false, limits));
    let held = diagnosis.holdout.iter().zip(&holdout).map(|pair| trace(pair, true, held_limits));
    Ok(fitted.chain(held).collect())
}

/// Instants with the force of base model and effects.
type Walked = Vec<(Instant, f64)>;

fn moments(walked: &[Walked]) -> impl Iterator<Item = &Moment> + Clone {
    walked.iter().flat_map(|walked| walked.iter().map(|(instant, _)| &instant.moment))
}

fn walked(
    diagnosis: &Diagnosis,
    prepared: &Prepared,
    model: &AugmentedModel,
    index: usize,
    most: usize,
) -> Result<Walked, IdentifyError> {
    let stride = prepared.recording.samples.n_rows().div_ceil(most.max(1)).max(1);
    let mut walked = Vec::with_capacity(prepared.recording.samples.n_rows() / stride + 1);
    // The first row behind a gap says so, whether its turn has come or not.
    let mut gap = false;
    walk_augmented(prepared, model, diagnosis.model.direction, index, &mut |instant, model_n| {
        gap |= instant.moment.step_s == 0.0;
        if instant.row.is_multiple_of(stride) {
            let mut instant = *instant;
            if gap {
                instant.moment.step_s = 0.0;
            }
            gap = false;
            walked.push((instant, model_n));
        }
    })
    .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
    Ok(walked)
}

fn laid_out(diagnosis: &Diagnosis, walked: &Walked, limits: [f64; 2]) -> Trace {
    let mut trace = Trace::default();
    let mut history = History::new(limits);
    for (instant, augmented_n) in walked {
        let moment = &instant.moment;
        history.push(moment);
        trace.time_s.push(moment.time_s);
        trace.pressure_pa.push(moment.pressure_pa);
        trace.contraction_ratio.push(moment.contraction_ratio);
        trace.speed_m_per_s.push(moment.speed_m_per_s.abs());
        trace.travel_m.push(history.travel_m);
        trace.rest_s.push(history.rest_s);
        trace.cycle.push(history.cycle);
        trace.force_n.push(instant.force_n);
        trace.base_n.push(diagnosis.base.force_n(moment.pressure_pa, moment.length_m, moment.direction));
        trace.augmented_n.push(*augmented_n);
        trace.settled.push(instant.settled);
    }
    trace
}
