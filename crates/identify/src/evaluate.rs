//! A model against recordings: statistics of the residual, and traces for figures.

use pam_core::artifact::model::FitStatistics;
use pam_core::direction::Thresholds;
use pam_core::effects::AugmentedModel;
use pam_core::force::ForceModel;
use pam_core::motion::Instant;
use pam_core::quality::channel::whole_noise_std;
use rayon::prelude::*;

use crate::error::IdentifyError;
use crate::predict::walk_augmented;
use crate::prepare::Prepared;
use crate::trace::{every, trace_stride};

/// Where a model first gave no number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoForceAt {
    /// Time, in s.
    pub time_s: f64,
    /// Gauge pressure, in Pa.
    pub pressure_pa: f64,
    /// Length, in m.
    pub length_m: f64,
}

/// Sums over samples whose direction is settled.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Tally {
    n_samples: usize,
    n_unsettled: usize,
    /// Samples that would count, had the model a force for them, and the first of them.
    n_without_force: usize,
    first_without_force: Option<NoForceAt>,
    residuals: f64,
    residual_squares: f64,
    unsettled_squares: f64,
    largest: f64,
    forces: f64,
    force_squares: f64,
    first_force_n: f64,
}

impl Tally {
    pub(crate) fn push(&mut self, force_n: f64, model_n: f64, at: impl FnOnce() -> NoForceAt) {
        let residual_n = force_n - model_n;
        // Its square is what is summed.
        if !(residual_n * residual_n).is_finite() {
            self.n_without_force += 1;
            self.first_without_force.get_or_insert_with(at);
            return;
        }
        if self.n_samples == 0 {
            self.first_force_n = force_n;
        }
        self.n_samples += 1;
        self.residuals += residual_n;
        self.residual_squares += residual_n * residual_n;
        self.largest = self.largest.max(residual_n.abs());
        // Relative to the first force, so that a large mean costs no digits.
        let relative_n = force_n - self.first_force_n;
        self.forces += relative_n;
        self.force_squares += relative_n * relative_n;
    }

    fn push_unsettled(&mut self, force_n: f64, model_n: f64) {
        let residual_n = force_n - model_n;
        if (residual_n * residual_n).is_finite() {
            self.n_unsettled += 1;
            self.unsettled_squares += residual_n * residual_n;
        }
    }

    fn merge(&mut self, other: &Self) {
        self.n_unsettled += other.n_unsettled;
        self.unsettled_squares += other.unsettled_squares;
        self.n_without_force += other.n_without_force;
        self.first_without_force = self.first_without_force.or(other.first_without_force);
        if other.n_samples == 0 {
            return;
        }
        if self.n_samples == 0 {
            self.first_force_n = other.first_force_n;
        }
        let shift_n = other.first_force_n - self.first_force_n;
        let n = other.n_samples as f64;
        self.force_squares += other.force_squares + 2.0 * shift_n * other.forces + n * shift_n * shift_n;
        self.forces += other.forces + n * shift_n;
        self.n_samples += other.n_samples;
        self.residuals += other.residuals;
        self.residual_squares += other.residual_squares;
        self.largest = self.largest.max(other.largest);
    }

    /// Refuses statistics over nothing, or over what is left after a model gave no force.
    fn judge(&self, prepared: &Prepared, model: &ForceModel) -> Result<(), IdentifyError> {
        let path = || prepared.recording.path.clone();
        if let Some(at) = self.first_without_force {
            let n_counted = self.n_samples + self.n_without_force;
            return Err(without_force(path(), self.n_without_force, n_counted, at, model));
        }
        if self.n_samples == 0 {
            return Err(IdentifyError::NothingCounted { path: path(), n_rows: prepared.recording.samples.n_rows() });
        }
        Ok(())
    }

    /// Mean residual, in N.
    pub(crate) fn mean_n(&self) -> f64 {
        self.residuals / self.n_samples.max(1) as f64
    }

    pub(crate) fn statistics(&self) -> FitStatistics {
        let n = self.n_samples.max(1) as f64;
        let spread = (self.force_squares - self.forces * self.forces / n).max(f64::MIN_POSITIVE);
        let share = self.residual_squares / spread;
        // A force that never varies, as under a dead weight, leaves nothing of itself to explain.
        let share = if share.is_finite() { share } else { 1.0 };
        FitStatistics {
            rmse_n: (self.residual_squares / n).sqrt(),
            rmse_all_n: ((self.residual_squares + self.unsettled_squares)
                / (self.n_samples + self.n_unsettled).max(1) as f64)
                .sqrt(),
            max_n: self.largest,
            r2: 1.0 - share,
            fit_percent: 100.0 * (1.0 - share.sqrt()),
            n_samples: self.n_samples,
            n_unsettled: self.n_unsettled,
        }
    }
}

/// Statistics of every recording and of all together.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// All recordings together; none where there are no recordings.
    pub together: Option<FitStatistics>,
    /// Each recording, in order.
    pub each: Vec<FitStatistics>,
}

/// Compares `model` with `recordings`.
///
/// # Errors
/// [`IdentifyError::WithoutForce`] where the model has no force for a sample that counts,
/// [`IdentifyError::NothingCounted`] where none does, [`IdentifyError::Samples`] where samples cannot be read back.
pub fn evaluate(recordings: &[Prepared], model: &ForceModel) -> Result<Evaluation, IdentifyError> {
    let tally = |prepared: &Prepared| {
        let tally = tally(prepared, model)
            .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
        tally.judge(prepared, model)?;
        Ok(tally)
    };
    let tallies: Result<Vec<Tally>, IdentifyError> = recordings.iter().map(tally).collect();
    Ok(Evaluation::of(&tallies?))
}

/// Compares an augmented model with `recordings`, each numbered by its place among them; `thresholds` are those of the
/// direction. A model without effects costs what [`evaluate`] costs.
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_augmented(
    recordings: &[Prepared],
    model: &AugmentedModel,
    thresholds: Thresholds,
) -> Result<Evaluation, IdentifyError> {
    if model.is_plain() {
        return evaluate(recordings, model.base());
    }
    let tallies: Result<Vec<Tally>, IdentifyError> = recordings
        .par_iter()
        .enumerate()
        .map(|(index, prepared)| tally_augmented(prepared, model, thresholds, index, &mut |_, _| {}))
        .collect();
    Ok(Evaluation::of(&tallies?))
}

/// The same, with what is left of the samples of each recording in N, as much as a trace holds of them; zero where they are
/// not counted.
///
/// # Errors
/// As [`evaluate`].
pub fn evaluate_residuals(
    recordings: &[Prepared],
    model: &AugmentedModel,
    thresholds: Thresholds,
) -> Result<(Evaluation, Vec<Vec<f64>>), IdentifyError> {
    let walked = |(index, prepared): (usize, &Prepared)| {
        let stride = trace_stride(prepared);
        let mut residuals_n = Vec::new();
        let tally = tally_augmented(prepared, model, thresholds, index, &mut |instant, model_n| {
            if instant.row.is_multiple_of(stride) {
                residuals_n.push(if instant.settled { instant.force_n - model_n } else { 0.0 });
            }
        })?;
        Ok((tally, residuals_n))
    };
    let walked: Result<Vec<(Tally, Vec<f64>)>, IdentifyError> = recordings.par_iter().enumerate().map(walked).collect();
    let (tallies, residuals_n): (Vec<Tally>, Vec<Vec<f64>>) = walked?.into_iter().unzip();
    let evaluation = if model.is_plain() { evaluate(recordings, model.base())? } else { Evaluation::of(&tallies) };
    Ok((evaluation, residuals_n))
}

/// Agreement of one recording, each row of which `visit` sees with the modelled force in N.
fn tally_augmented(
    prepared: &Prepared,
    model: &AugmentedModel,
    thresholds: Thresholds,
    index: usize,
    visit: &mut dyn FnMut(&Instant, f64),
) -> Result<Tally, IdentifyError> {
    let mut tally = Tally::default();
    walk_augmented(prepared, model, thresholds, index, &mut |instant, model_n| {
        if instant.settled {
            let moment = &instant.moment;
            tally.push(instant.force_n, model_n, || NoForceAt {
                time_s: moment.time_s,
                pressure_pa: moment.pressure_pa,
                length_m: moment.length_m,
            });
        } else {
            tally.push_unsettled(instant.force_n, model_n);
        }
        visit(instant, model_n);
    })
    .map_err(|reason| IdentifyError::Samples { path: prepared.recording.path.clone(), reason })?;
    tally.judge(prepared, model.base())?;
    Ok(tally)
}

/// Message about a model that has no force for `n` of `n_counted` samples, the first of them `at`.
pub fn without_force(path: String, n: usize, n_counted: usize, at: NoForceAt, model: &ForceModel) -> IdentifyError {
    let strand_m = model.muscle().strand_length_m();
    let reason = if at.length_m >= strand_m {
        format!(
            "strands of {:.2} mm are straight there; check the unit of the length, and that recording and model belong \
             together",
            strand_m * 1e3
        )
    } else {
        "check the units of the channels, and that recording and model belong together".to_owned()
    };
    IdentifyError::WithoutForce {
        path,
        n,
        n_counted,
        time_s: at.time_s,
        pressure_kpa: at.pressure_pa * 1e-3,
        length_mm: at.length_m * 1e3,
        reason,
    }
}

impl Evaluation {
    fn of(tallies: &[Tally]) -> Self {
        let mut together = Tally::default();
        tallies.iter().for_each(|tally| together.merge(tally));
        Self {
            together: (!tallies.is_empty()).then(|| together.statistics()),
            each: tallies.iter().map(Tally::statistics).collect(),
        }
    }
}

fn tally(prepared: &Prepared, model: &ForceModel) -> std::io::Result<Tally> {
    let samples = &prepared.recording.samples;
    let parts: std::io::Result<Vec<Tally>> = (0..samples.n_chunks())
        .into_par_iter()
        .map(|index| {
            let chunk = samples.chunk(index)?;
            let mut tally = Tally::default();
            let (pressure_pa, length_m, force_n) = (chunk.pressure_pa(), chunk.length_m(), chunk.force_n());
            for here in 0..chunk.n_rows() {
                let row = chunk.first_row() + here;
                let model_n = model.force_n(pressure_pa[here], length_m[here], prepared.direction.sign(row));
                if prepared.direction.is_settled(row) {
                    tally.push(force_n[here], model_n, || NoForceAt {
                        time_s: chunk.time_s()[here],
                        pressure_pa: pressure_pa[here],
                        length_m: length_m[here],
                    });
                } else {
                    tally.push_unsettled(force_n[here], model_n);
                }
            }
            Ok(tally)
        })
        .collect();
    let mut total = Tally::default();
    for part in parts? {
        total.merge(&part);
    }
    Ok(total)
}

/// Root mean square, in N, of what the noise of all three channels does to the residual of a perfect model:
/// `σ_F² + (∂F/∂p σ_p)² + (∂F/∂L σ_L)²`, over samples spread across the recordings.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn noise_floor_n(recordings: &[Prepared], model: &ForceModel) -> Result<f64, IdentifyError> {
    let (mut squares, mut rows) = (0.0, 0.0);
    for prepared in recordings {
        let channel = |name: &str| prepared.quality.channel(name);
        // A pressure wanders by itself at the pulse of its valve, and the force with it.
        let noise_pa = channel("pressure").map_or(0.0, |channel| channel.colored_noise);
        let [noise_m, noise_n] = ["length", "force"].map(|name| {
            channel(name)
                .map_or(0.0, |channel| whole_noise_std(channel.noise, channel.colored_noise, prepared.quality.period_s))
        });
        let stride = trace_stride(prepared);
        let trace = every(
            prepared,
            model,
            stride * (prepared.recording.samples.n_rows().div_ceil(stride) / FLOOR_SAMPLES).max(1),
        )?;
        let (mut sum, mut count) = (0.0, 0.0);
        for index in 0..trace.time_s.len() {
            let (pressure_pa, length_m, direction) =
                (trace.pressure_pa[index], trace.length_m[index], trace.direction[index]);
            let force_n = |p: f64, l: f64| model.force_n(p, l, direction);
            // Steps of the noise itself: a chord is what noise sees.
            let by_pressure_n =
                0.5 * (force_n(pressure_pa + noise_pa, length_m) - force_n(pressure_pa - noise_pa, length_m));
            let by_length_n =
                0.5 * (force_n(pressure_pa, length_m + noise_m) - force_n(pressure_pa, length_m - noise_m));
            let square = noise_n * noise_n + by_pressure_n * by_pressure_n + by_length_n * by_length_n;
            if square.is_finite() {
                sum += square;
                count += 1.0;
            }
        }
        let n = prepared.recording.samples.n_rows() as f64;
        squares += n * sum / f64::max(count, 1.0);
        rows += n;
    }
    Ok((squares / f64::max(rows, 1.0)).sqrt())
}

/// Samples of one recording that the noise floor is averaged over, about.
const FLOOR_SAMPLES: usize = 1000;

#[cfg(test)]
mod tests {
    use super::*;

    use pam_core::force::Form;
    use pam_core::recording::Samples;

    use crate::prepare::{direct, gate};
    use crate::testing::{THRESHOLDS, model, recording};

    /// A muscle that shortens evenly; `length_m` of the last row is `last_m`.
    fn ramp(last_m: f64) -> Prepared {
        let rows = || (0..200_i32).map(f64::from);
        let time_s: Vec<f64> = rows().map(|row| 0.01 * row).collect();
        let mut length_m: Vec<f64> = rows().map(|row| 0.26 - 1e-4 * row).collect();
        length_m[199] = last_m;
        let force_n: Vec<f64> = rows().map(|row| 300.0 - row).collect();
        let samples = Samples::from_columns(&time_s, &[2e5; 200], &length_m, &force_n);
        direct(gate(vec![recording("ramp.csv", samples)]).unwrap(), THRESHOLDS, Form::Corrected).unwrap().remove(0)
    }

    #[test]
    fn no_agreement_is_claimed_over_no_samples() {
        let mut still = ramp(0.24);
        still.direction.leave_out(0..200);
        let refused = evaluate(std::slice::from_ref(&still), &model()).unwrap_err();
        assert!(matches!(refused, IdentifyError::NothingCounted { n_rows: 200, .. }), "{refused}");
        let augmented = AugmentedModel::from(model());
        assert!(evaluate_augmented(&[still], &augmented, THRESHOLDS).is_err());
    }

    #[test]
    fn a_sample_without_a_modelled_force_is_counted_and_located() {
        let model = model();
        let mut tally = Tally::default();
        let at = |time_s: f64| NoForceAt { time_s, pressure_pa: 2e5, length_m: 0.3 };
        tally.push(300.0, 299.0, || at(0.0));
        tally.push(300.0, f64::NAN, || at(0.1));
        // Its square is none.
        tally.push(300.0, 1e200, || at(0.2));
        match tally.judge(&ramp(0.24), &model).unwrap_err() {
            IdentifyError::WithoutForce { n: 2, n_counted: 3, time_s, reason, .. } => {
                assert_eq!(time_s, 0.1);
                assert!(reason.contains("294.60 mm"), "{reason}");
            }
            other => panic!("{other}"),
        }
    }
}
