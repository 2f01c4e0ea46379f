//! A model against recordings: statistics of the residual, and traces for figures.

use std::ops::Range;

use pam_artifact::model::FitStatistics;
use pam_muscle::direction::Thresholds;
use pam_muscle::effects::AugmentedModel;
use pam_muscle::force::ForceModel;
use pam_muscle::motion::Instant;
use pam_recording::CHUNK_ROWS;
use pam_recording::quality::channel::whole_noise_std;
use rayon::prelude::*;

use crate::error::IdentifyError;
use crate::predict::walk_augmented;
use crate::prepare::Prepared;
pub use crate::tally::NoForceAt;
pub(crate) use crate::tally::Tally;
use crate::trace::{every, stride_of};

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
        let tally = tally(prepared, model, 0..prepared.recording.samples.n_rows())
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

/// Agreement of one recording, each row of which `visit` sees with the modelled force in N.
pub(crate) fn tally_augmented(
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
    pub(crate) fn of(tallies: &[Tally]) -> Self {
        let mut together = Tally::default();
        tallies.iter().for_each(|tally| together.merge(tally));
        Self {
            together: (!tallies.is_empty()).then(|| together.statistics()),
            each: tallies.iter().map(Tally::statistics).collect(),
        }
    }
}

/// Sums over `rows` of a recording.
///
/// # Errors
/// Where samples cannot be read back.
pub(crate) fn tally(prepared: &Prepared, model: &ForceModel, rows: Range<usize>) -> std::io::Result<Tally> {
    let samples = &prepared.recording.samples;
    let parts: std::io::Result<Vec<Tally>> = (rows.start / CHUNK_ROWS..rows.end.div_ceil(CHUNK_ROWS))
        .into_par_iter()
        .map(|index| {
            let chunk = samples.chunk(index)?;
            let mut tally = Tally::default();
            let (pressure_pa, length_m, force_n) = (chunk.pressure_pa(), chunk.length_m(), chunk.force_n());
            for row in rows.start.max(chunk.first_row())..rows.end.min(chunk.first_row() + chunk.n_rows()) {
                let here = row - chunk.first_row();
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
    let squares: Result<Vec<(usize, [f64; 2])>, IdentifyError> = recordings
        .iter()
        .map(|prepared| {
            let n_rows = prepared.recording.samples.n_rows();
            Ok((n_rows, noise_squares(prepared, model, floor_stride(n_rows), 0..n_rows)?))
        })
        .collect();
    Ok(noise_floor_of(&squares?))
}

/// The same from the rows of every recording and their [`noise_squares`].
pub(crate) fn noise_floor_of(recordings: &[(usize, [f64; 2])]) -> f64 {
    let (mut squares, mut rows) = (0.0, 0.0);
    for &(n_rows, [sum, count]) in recordings {
        let n = n_rows as f64;
        squares += n * sum / f64::max(count, 1.0);
        rows += n;
    }
    (squares / f64::max(rows, 1.0)).sqrt()
}

/// Rows from one sample that the noise floor is averaged over to the next, in a recording of so many.
pub(crate) fn floor_stride(n_rows: usize) -> usize {
    let stride = stride_of(n_rows);
    stride * (n_rows.div_ceil(stride) / FLOOR_SAMPLES).max(1)
}

/// What noise does to the residual at every `stride`-th of `rows`: sum of squares in N², and how many there are.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub(crate) fn noise_squares(
    prepared: &Prepared,
    model: &ForceModel,
    stride: usize,
    rows: Range<usize>,
) -> Result<[f64; 2], IdentifyError> {
    let channel = |name: &str| prepared.quality.channel(name);
    // A pressure wanders by itself at the pulse of its valve, and the force with it.
    let noise_pa = channel("pressure").map_or(0.0, |channel| channel.colored_noise);
    let [noise_m, noise_n] = ["length", "force"].map(|name| {
        channel(name)
            .map_or(0.0, |channel| whole_noise_std(channel.noise, channel.colored_noise, prepared.quality.period_s))
    });
    let trace = every(prepared, model, stride, rows)?;
    let (mut sum, mut count) = (0.0, 0.0);
    for index in 0..trace.time_s.len() {
        let (pressure_pa, length_m, direction) =
            (trace.pressure_pa[index], trace.length_m[index], trace.direction[index]);
        let force_n = |p: f64, l: f64| model.force_n(p, l, direction);
        // Steps of the noise itself: a chord is what noise sees.
        let by_pressure_n =
            0.5 * (force_n(pressure_pa + noise_pa, length_m) - force_n(pressure_pa - noise_pa, length_m));
        let by_length_n = 0.5 * (force_n(pressure_pa, length_m + noise_m) - force_n(pressure_pa, length_m - noise_m));
        let square = noise_n * noise_n + by_pressure_n * by_pressure_n + by_length_n * by_length_n;
        if square.is_finite() {
            sum += square;
            count += 1.0;
        }
    }
    Ok([sum, count])
}

/// Samples of one recording that the noise floor is averaged over, about.
const FLOOR_SAMPLES: usize = 1000;

#[cfg(test)]
mod tests {
    use super::*;

    use pam_muscle::force::Form;
    use pam_recording::Samples;

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
