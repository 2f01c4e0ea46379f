//! Recordings along a diagnosis: what was measured, what base and augmented model say, and the coordinates that a residual
//! is laid out over.

use pam_identification::along::Along;
use pam_identification::prepare::Prepared;
use pam_muscle::motion::Instant;

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
pub fn traces(diagnosis: &Diagnosis, most: usize) -> Vec<Trace> {
    let of_all = |recordings: &[Prepared], along: &Along, held_out: bool| -> Vec<Trace> {
        let thinned = along.thinned(most);
        let limits = moving_limits(thinned.iter().flatten().map(|(instant, _)| &instant.moment));
        let each = recordings.iter().zip(&thinned);
        each.map(|(prepared, samples)| Trace {
            path: prepared.recording.path.clone(),
            held_out,
            ..laid_out(diagnosis, samples, limits)
        })
        .collect()
    };
    let mut all = of_all(&diagnosis.estimation, &diagnosis.fitted, false);
    all.extend(of_all(&diagnosis.holdout, &diagnosis.held, true));
    all
}

/// `samples`, each an instant with the force of base model and effects.
fn laid_out(diagnosis: &Diagnosis, samples: &[(Instant, f64)], limits: [f64; 2]) -> Trace {
    let mut trace = Trace::default();
    let mut history = History::new(limits);
    for (instant, augmented_n) in samples {
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
