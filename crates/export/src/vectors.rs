//! Test vectors: instants of a muscle beside the model's force, to compare a translation of the model with.
//!
//! Along a recording they are the moments that `pam-predict` computes its forces at. Without a recording a path through the
//! model's operating range takes their place: strokes, minor loops, a hold in which the pressure moves, a gap, long pauses.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use pam_artifact::model::Domain;
use pam_identification::error::IdentifyError;
use pam_identification::predict::walk_moments;
use pam_identification::prepare::Prepared;
use pam_muscle::Muscle;
use pam_muscle::direction::Thresholds;
use pam_muscle::effects::{AugmentedModel, Moment};

use crate::ExportError;

/// Header of [`csv`], one name per field of a [`Moment`] and the modelled force.
pub const COLUMNS: &str = "time_s,step_s,pressure_pa,pressure_rate_pa_per_s,length_m,contraction_ratio,speed_m_per_s,\
                           slide_speed_m_per_s,acceleration_m_per_s2,direction,came,slide_m,rest_slide_m,force_seen_n,\
                           warmth_k,force_model_n";

/// An instant and the force that the model has there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vector {
    /// What the model saw, in SI.
    pub moment: Moment,
    /// Its force, in N.
    pub force_n: f64,
}

impl Vector {
    /// The values of [`COLUMNS`].
    pub fn values(&self) -> [f64; 16] {
        let Moment { recording: _, time_s, step_s, pressure_pa, pressure_rate_pa_per_s, length_m, .. } = self.moment;
        let Moment { contraction_ratio, speed_m_per_s, slide_speed_m_per_s, acceleration_m_per_s2, .. } = self.moment;
        let Moment { direction, came, slide_m, rest_slide_m, force_n, warmth_k, .. } = self.moment;
        [
            time_s,
            step_s,
            pressure_pa,
            pressure_rate_pa_per_s,
            length_m,
            contraction_ratio,
            speed_m_per_s,
            slide_speed_m_per_s,
            acceleration_m_per_s2,
            direction,
            f64::from(u8::from(came)),
            slide_m,
            rest_slide_m,
            force_n,
            warmth_k,
            self.force_n,
        ]
    }
}

/// Every row of a recording, as `pam-predict` sees it.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn along(
    prepared: &Prepared,
    model: &AugmentedModel,
    thresholds: Thresholds,
) -> Result<Vec<Vector>, IdentifyError> {
    let mut vectors = Vec::with_capacity(prepared.recording.samples.n_rows());
    walk_moments(prepared, model, thresholds, 0, &mut |_, moment, force_n| {
        vectors.push(Vector { moment: *moment, force_n });
    })
    .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
    Ok(vectors)
}

/// A path through the operating range.
///
/// # Errors
/// [`ExportError::WithoutForce`] where the model has no force on it.
pub fn synthetic(model: &AugmentedModel, domain: &Domain) -> Result<Vec<Vector>, ExportError> {
    let mut memory = model.start();
    let mut before_n = None;
    let mut vectors = Vec::new();
    for moment in path(model.base().muscle(), domain) {
        let settled_n = || model.settled_force_n(moment.pressure_pa, moment.length_m, moment.direction);
        let now = Moment { force_n: before_n.unwrap_or_else(settled_n), ..moment };
        let force_n = memory.force_n(model, now);
        if !force_n.is_finite() {
            let Moment { pressure_pa, length_m, .. } = now;
            return Err(ExportError::WithoutForce { pressure_pa, length_m });
        }
        before_n = Some(force_n);
        vectors.push(Vector { moment: now, force_n });
    }
    Ok(vectors)
}

/// Instants of the path.
const N_PATH: u32 = 300;
/// Between instants in motion, in s.
const STEP_S: f64 = 0.02;
/// Every instant of so many comes late, as loggers that pause make them: 10 s, which slow effects show in.
const PAUSE_EVERY: u32 = 40;
/// Where the length rests and the pressure moves, and where a gap lies, as shares of the path.
const REST: (f64, f64) = (0.5, 0.65);
const GAP: u32 = 240;
/// Travel of the braid per pascal at rest, in m: of the order of what strands of nylon give.
const REST_SLIDE_M_PER_PA: f64 = 4e-10;

fn path(muscle: &Muscle, domain: &Domain) -> Vec<Moment> {
    let [low_pa, high_pa] = domain.pressure_pa;
    let [short_m, long_m] = domain.length_m;
    let (middle_m, half_m) = (0.5 * (short_m + long_m), 0.5 * (long_m - short_m));
    let mut moments: Vec<Moment> = Vec::new();
    let (mut time_s, mut rest_slide_m) = (0.0, 0.0);
    for index in 0..N_PATH {
        let share = f64::from(index) / f64::from(N_PATH);
        let rests = (REST.0..REST.1).contains(&share);
        // Strokes of the whole range with minor loops on them; where the length rests its phase stands still.
        let phase = if rests { REST.0 } else { share };
        let along = 0.85 * (TAU * 3.0 * phase).cos() + 0.15 * (TAU * 17.0 * phase).cos();
        let length_m = middle_m + half_m * along;
        let pressure_pa = low_pa + (high_pa - low_pa) * (0.5 - 0.5 * (TAU * 7.3 * share).cos());
        let step_s = match index {
            0 | GAP => 0.0,
            _ if index % PAUSE_EVERY == 0 => 10.0,
            _ => STEP_S,
        };
        time_s += if index == GAP { 30.0 } else { step_s };
        let before = moments.last().copied();
        let rate = |now: f64, before: Option<f64>| before.filter(|_| step_s > 0.0).map_or(0.0, |b| (now - b) / step_s);
        let speed_m_per_s = -rate(length_m, before.map(|before| before.length_m));
        let pressure_rate = rate(pressure_pa, before.map(|before| before.pressure_pa));
        rest_slide_m += if rests { REST_SLIDE_M_PER_PA * pressure_rate * step_s } else { 0.0 };
        let direction = if speed_m_per_s == 0.0 { before.map_or(0.0, |b| b.direction) } else { speed_m_per_s.signum() };
        let settled = Moment::settled(muscle, pressure_pa, length_m, direction);
        moments.push(Moment {
            time_s,
            step_s,
            pressure_rate_pa_per_s: pressure_rate,
            speed_m_per_s,
            slide_speed_m_per_s: if rests { REST_SLIDE_M_PER_PA * pressure_rate } else { speed_m_per_s },
            acceleration_m_per_s2: rate(speed_m_per_s, before.map(|before| before.speed_m_per_s)),
            came: false,
            slide_m: settled.slide_m + rest_slide_m,
            rest_slide_m,
            warmth_k: 3.0 + 5.0 * share,
            ..settled
        });
    }
    moments
}

/// `vectors` as a CSV file with every digit.
pub fn csv(vectors: &[Vector]) -> String {
    let mut text = format!("{COLUMNS}\n");
    for vector in vectors {
        let values = vector.values();
        for (index, value) in values.iter().enumerate() {
            let end = if index + 1 == values.len() { '\n' } else { ',' };
            // Writing to memory cannot fail.
            let _ = write!(text, "{value:?}{end}");
        }
    }
    text
}
