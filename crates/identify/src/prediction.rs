//! A model along a recording, judged: errors over counted and over all samples, the interval around the prediction, and
//! where the model extrapolates.

use pam_artifact::ModelArtifact;
use pam_artifact::prediction::{Band, Extrapolation, PredictionErrors};
use pam_muscle::effects::AugmentedModel;

use crate::band::{LEVEL, PredictiveBand};
use crate::error::IdentifyError;
use crate::evaluate::{NoForceAt, Tally};
use crate::predict::{trusted, walk_augmented};
use crate::prepare::Prepared;

/// What a prediction is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// Errors over the samples that count; none where no force was recorded.
    pub counted: Option<PredictionErrors>,
    /// Errors over all samples.
    pub all: Option<PredictionErrors>,
    /// The interval.
    pub band: Band,
    /// Where the model extrapolates.
    pub extrapolation: Extrapolation,
    /// Samples for a figure.
    pub track: Track,
}

/// Samples of a recording beside the prediction, evenly thinned; all columns are as long, but for `force_n` where no force
/// was recorded, which is then empty.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Track {
    /// Time, in s.
    pub time_s: Vec<f64>,
    /// Gauge pressure, in Pa.
    pub pressure_pa: Vec<f64>,
    /// Length, in m.
    pub length_m: Vec<f64>,
    /// Measured force, in N.
    pub force_n: Vec<f64>,
    /// Modelled force, in N.
    pub model_n: Vec<f64>,
    /// Half of the interval, in N.
    pub half_width_n: Vec<f64>,
    /// Whether the sample counts.
    pub counted: Vec<bool>,
    /// Whether the model extrapolates.
    pub extrapolated: Vec<bool>,
}

/// Walks over `prepared` with `model`, which is that of `artifact`; the track has at most `most` samples.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn predict(
    prepared: &Prepared,
    model: &AugmentedModel,
    artifact: &ModelArtifact,
    band: &PredictiveBand,
    most: usize,
) -> Result<Prediction, IdentifyError> {
    let samples = &prepared.recording.samples;
    let has_force = samples.has_force();
    let stride = samples.n_rows().div_ceil(most.max(1)).max(1);
    let trusted = trusted(prepared, &artifact.domain);
    let (mut counted, mut all) = (Covered::default(), Covered::default());
    let (mut squares, mut beyond) = (0.0, [0_usize; 3]);
    let mut track = Track::default();
    let outside = |value: f64, [low, high]: [f64; 2]| !(low..=high).contains(&value);
    walk_augmented(prepared, model, artifact.direction, 0, &mut |instant, model_n| {
        let moment = &instant.moment;
        let half_width_n = band.half_width_n(moment.pressure_pa, moment.length_m, moment.direction);
        squares += half_width_n * half_width_n;
        let is_beyond = [outside(moment.pressure_pa, trusted.pressure_pa), outside(moment.length_m, trusted.length_m)];
        let either = is_beyond[0] || is_beyond[1];
        for (count, is_beyond) in beyond.iter_mut().zip([is_beyond[0], is_beyond[1], either]) {
            *count += usize::from(is_beyond);
        }
        if has_force {
            let at = || NoForceAt { time_s: moment.time_s, pressure_pa: moment.pressure_pa, length_m: moment.length_m };
            all.push(instant.force_n, model_n, half_width_n, at());
            if instant.settled {
                counted.push(instant.force_n, model_n, half_width_n, at());
            }
        }
        if instant.row.is_multiple_of(stride) {
            track.time_s.push(moment.time_s);
            track.pressure_pa.push(moment.pressure_pa);
            track.length_m.push(moment.length_m);
            if has_force {
                track.force_n.push(instant.force_n);
            }
            track.model_n.push(model_n);
            track.half_width_n.push(half_width_n);
            track.counted.push(instant.settled);
            track.extrapolated.push(either);
        }
    })
    .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
    let n = samples.n_rows().max(1) as f64;
    let [pressure_share, length_share, share] = beyond.map(|count| count as f64 / n);
    Ok(Prediction {
        counted: has_force.then(|| counted.errors()),
        all: has_force.then(|| all.errors()),
        band: Band {
            level: LEVEL,
            residual_n: band.residual_n,
            residual_is_held_out: band.residual_is_held_out,
            half_width_n: (squares / n).sqrt(),
        },
        extrapolation: Extrapolation { domain: artifact.domain.clone(), pressure_share, length_share, share },
        track,
    })
}

/// Errors, and how many of them the interval holds.
#[derive(Debug, Default)]
struct Covered {
    tally: Tally,
    inside: usize,
}

impl Covered {
    fn push(&mut self, force_n: f64, model_n: f64, half_width_n: f64, at: NoForceAt) {
        self.tally.push(force_n, model_n, || at);
        self.inside += usize::from((force_n - model_n).abs() <= half_width_n);
    }

    fn errors(&self) -> PredictionErrors {
        let statistics = self.tally.statistics();
        PredictionErrors {
            rmse_n: statistics.rmse_n,
            mean_n: self.tally.mean_n(),
            max_n: statistics.max_n,
            r2: statistics.r2,
            fit_percent: statistics.fit_percent,
            inside_band: self.inside as f64 / statistics.n_samples.max(1) as f64,
            n_samples: statistics.n_samples,
        }
    }
}
