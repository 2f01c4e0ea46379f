//! How strong a concealed effect is: by what refitting eq. 11 leaves of the noise-free force.

use anyhow::{Context as _, Result};
use pam_artifact::model::Loss;
use pam_identification::fit::FitOptions;
use pam_identification::identify::{Identified, Request, check};
use pam_muscle::MuscleFile;
use pam_muscle::force::{ForceModel, Form};

use crate::case::{Log, Noise};
use crate::rig::{Hidden, Rig, recording, sensor_noise};

/// Range of severities that are tried; 1 is typical.
const SEVERITY: (f64, f64) = (0.01, 20.0);

/// How near to the drawn residual the reached one must be.
const TOLERANCE: f64 = 0.03;

/// Most fits for one severity.
const MOST_FITS: usize = 14;

/// A set of recordings of one muscle, for fits without noise.
#[derive(Debug)]
pub struct Calibration<'a> {
    /// The rig.
    pub rig: &'a Rig,
    /// The muscle as measured.
    pub muscle: &'a MuscleFile,
    /// Recordings that are fitted.
    pub logs: &'a [Log],
    /// White noise relative to that of the sensors.
    pub white_factor: f64,
}

impl Calibration<'_> {
    /// Eq. 11 refitted, as a user would, to the noise-free recordings.
    ///
    /// # Errors
    /// Where a recording cannot be made or fitted.
    pub fn refit(&self, hidden: &Hidden<'_>) -> Result<Identified> {
        let mut estimation = Vec::new();
        for log in self.logs {
            estimation.push(recording(&log.file, &self.rig.record(log, hidden, None)?));
        }
        let (pressure_pa, length_m, _) = sensor_noise(self.rig);
        let request = Request {
            estimation,
            validation: Vec::new(),
            muscle: self.muscle.clone(),
            form: Form::Corrected,
            options: FitOptions { n_particles: 24, n_iterations: 30, n_starts: 2, seed: 1, polish: true },
            loss: Loss::Square,
            free: Vec::new(),
            fix: Vec::new(),
            // Those that a recording with noise has.
            length_play_m: Some(5.0 * self.white_factor * length_m),
            pressure_play_pa: Some(5.0 * self.white_factor * pressure_pa),
            assumed: pam_artifact::model::Assumed::default(),
            accept_implausible: true,
            unbounded: false,
        };
        Ok(check(request)?.identify()?)
    }

    /// Root mean square of what the refit leaves, in N.
    ///
    /// # Errors
    /// See [`refit`](Self::refit).
    pub fn leaves_n(&self, hidden: &Hidden<'_>) -> Result<f64> {
        let fitted = self.refit(hidden)?.estimation_fit.together.context("nothing was fitted")?;
        Ok(fitted.rmse_n)
    }

    /// What noise leaves of a perfect model: that of the force, and those of pressure and length as they reach it
    /// through `model`. Colored noise is as strong as everything that is white, so that it cannot be overlooked.
    ///
    /// # Errors
    /// Where a recording cannot be made.
    pub fn noise(&self, model: &ForceModel, colored: bool) -> Result<Noise> {
        const STRIDE: usize = 20;
        let (pressure_pa, length_m, force_n) = sensor_noise(self.rig);
        let (pressure_pa, length_m, force_n) =
            (self.white_factor * pressure_pa, self.white_factor * length_m, self.white_factor * force_n);
        let (mut squares, mut count) = (0.0, 0.0);
        for log in self.logs {
            let log = self.rig.record(log, &Hidden::NOTHING, None)?;
            for row in (0..log.n_samples()).step_by(STRIDE) {
                let (p, l, s) = (log.pressure_pa[row], log.length_m[row], log.true_direction[row]);
                let by_pressure_n = 0.5 * (model.force_n(p + pressure_pa, l, s) - model.force_n(p - pressure_pa, l, s));
                let by_length_n = 0.5 * (model.force_n(p, l + length_m, s) - model.force_n(p, l - length_m, s));
                squares += by_pressure_n * by_pressure_n + by_length_n * by_length_n;
                count += 1.0;
            }
        }
        let through_model = squares / f64::max(count, 1.0);
        let white_n = (through_model + force_n * force_n).sqrt();
        let floor_n = if colored { (2.0_f64).sqrt() * white_n } else { white_n };
        Ok(Noise {
            white_factor: self.white_factor,
            colored,
            colored_n: if colored { white_n } else { 0.0 },
            floor_n,
            misfit_n: if colored { 0.5 * floor_n } else { 0.0 },
        })
    }

    /// Severity at which an effect alone leaves `wanted_n`, with what it leaves then; none where no severity does.
    ///
    /// # Errors
    /// See [`refit`](Self::refit).
    pub fn severity(&self, id: &str, seed: u64, wanted_n: f64) -> Result<Option<(f64, f64)>> {
        let leaves_n = |severity: f64| self.leaves_n(&Hidden { effects: &[(id, severity)], seed, misfit_n: 0.0 });
        let (mut low, mut high): (Option<f64>, Option<f64>) = (None, None);
        let mut severity: f64 = 1.0;
        for _ in 0..MOST_FITS {
            // A muscle that an effect tears apart cannot be recorded: too strong.
            let left_n = leaves_n(severity).unwrap_or(f64::INFINITY);
            if (left_n / wanted_n - 1.0).abs() <= TOLERANCE {
                return Ok(Some((severity, left_n)));
            }
            if left_n < wanted_n {
                low = Some(severity);
            } else {
                high = Some(severity);
            }
            let guess = severity * (wanted_n / left_n.max(1e-3)).clamp(0.1, 10.0);
            severity = match (low, high) {
                (Some(low), Some(high)) if !(low * 1.02..high / 1.02).contains(&guess) => (low * high).sqrt(),
                (Some(low), None) if low >= SEVERITY.1 => return Ok(None),
                (None, Some(high)) if high <= SEVERITY.0 => return Ok(None),
                _ => guess.clamp(SEVERITY.0, SEVERITY.1),
            };
        }
        Ok(None)
    }
}
