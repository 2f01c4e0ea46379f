//! A gauge whose zero is elsewhere, after a fit that ended where no muscle is.
//!
//! The fit is repeated from where it ended with pressures a little lower or higher. Where that leaves less than half of the
//! residual beyond the sensors' noise, the gauge reads too much or too little by as much, a hundred kilopascals of it being the atmosphere; or the
//! muscle has a threshold pressure, which does the same to all pressures above it. Recordings of the vented muscle tell the
//! one from the other, and so both are said.

use std::io;

use pam_muscle::force::columns::{ForceColumns, N_COLUMNS};
use pam_optim::gathered::Gathered;
use pam_optim::polish::descend;
use pam_optim::summary::Summary;

use crate::identify::Identified;
use crate::prepare::Prepared;
use crate::problem::ForceProblem;

/// Shifts that are looked at, in Pa, and the distance between two of them.
const LOWEST_PA: f64 = -60e3;
const HIGHEST_PA: f64 = 120e3;
const PITCH_PA: f64 = 10e3;
/// Samples of all recordings that take part, about.
const SAMPLES: usize = 4000;
/// Share of the RMSE beyond the sensors' noise that must be left at most.
const LEFT: f64 = 0.5;
/// The atmosphere, in Pa, and what weather, height and the fit may add to it or take from it.
const ATMOSPHERE_PA: f64 = 101.3e3;
const WEATHER_PA: f64 = 15e3;

/// Pressure, length, direction and force of samples that count.
pub(super) type Sample = (f64, f64, f64, f64);

/// Share that a shift of the pressure explains, in words; none where it explains little.
///
/// # Errors
/// Where samples cannot be read back.
pub fn explain(found: &Identified) -> io::Result<Option<String>> {
    let samples = samples(found)?;
    let largest_n_per_m = samples.iter().map(|&(pressure_pa, length_m, ..)| (pressure_pa - LOWEST_PA) * length_m);
    let columns = ForceColumns::new(
        &found.muscle,
        found.model.strand_modulus_pa(),
        found.model.form(),
        largest_n_per_m.fold(0.0, f64::max),
    );
    let rmse_n = |shift_pa: f64| left_n(found, &columns, &samples, shift_pa);
    let as_is_n = rmse_n(0.0);
    let mut best = (0.0, as_is_n);
    let mut take = |shift_pa: f64| {
        let candidate = (shift_pa, rmse_n(shift_pa));
        if candidate.1 < best.1 {
            best = candidate;
        }
        best.0
    };
    let steps = ((HIGHEST_PA - LOWEST_PA) / PITCH_PA).round() as i32;
    for step in 0..=steps {
        take(LOWEST_PA + f64::from(step) * PITCH_PA);
    }
    let mut pitch_pa = PITCH_PA;
    while pitch_pa > 500.0 {
        pitch_pa *= 0.5;
        let here_pa = take(0.0);
        take(here_pa - pitch_pa);
        take(here_pa + pitch_pa);
    }
    let (shift_pa, left_n) = best;
    // Below what the sensors leave there is nothing to explain.
    let excess = |rmse_n: f64| (rmse_n * rmse_n - found.noise_floor_n.powi(2)).max(0.0);
    if left_n.is_nan() || excess(left_n) >= LEFT * LEFT * excess(as_is_n) {
        return Ok(None);
    }
    let lowest_pa = samples.iter().map(|sample| sample.0).fold(f64::INFINITY, f64::min);
    let shift_kpa = shift_pa * 1e-3;
    let gain = format!("{left_n:.2} N stay unexplained instead of {as_is_n:.2} N");
    let is_absolute = (shift_pa - ATMOSPHERE_PA).abs() < WEATHER_PA && lowest_pa > ATMOSPHERE_PA - WEATHER_PA;
    let threshold = "or the muscle has a threshold pressure of as much, which a recording of the vented muscle tells";
    Ok(Some(if is_absolute {
        format!(
            "with pressures lower by {shift_kpa:.1} kPa {gain}: the pressure is absolute (add --calibrate 'pressure_kPa = 1 * \
             pressure_kPa - 101.3'), {threshold}"
        )
    } else if shift_pa > 0.0 {
        format!("with pressures lower by {shift_kpa:.1} kPa {gain}: the zero of the gauge is too high, {threshold}")
    } else {
        format!("with pressures higher by {:.1} kPa {gain}: the zero of the gauge is too low", -shift_kpa)
    }))
}

fn samples(found: &Identified) -> io::Result<Vec<Sample>> {
    let stride = stride(found);
    let each: io::Result<Vec<Vec<Sample>>> =
        found.estimation.iter().map(|prepared| samples_of(prepared, stride)).collect();
    Ok(each?.concat())
}

/// Every so-many-th row takes part.
pub(super) fn stride(found: &Identified) -> usize {
    let n_rows: usize = found.estimation.iter().map(|prepared| prepared.recording.samples.n_rows()).sum();
    (n_rows / SAMPLES).max(1)
}

/// Every `stride`-th counted sample of a recording.
pub(super) fn samples_of(prepared: &Prepared, stride: usize) -> io::Result<Vec<Sample>> {
    let mut samples = Vec::new();
    for chunk in prepared.recording.samples.chunks() {
        let chunk = chunk?;
        for row in chunk.rows().filter(|row| row.is_multiple_of(stride) && prepared.direction.is_settled(*row)) {
            let here = row - chunk.first_row();
            let sign = prepared.direction.sign(row);
            samples.push((chunk.pressure_pa()[here], chunk.length_m()[here], sign, chunk.force_n()[here]));
        }
    }
    Ok(samples)
}

/// The samples that eq. 11 has a force for, in one triangle.
pub(super) fn summary_of(columns: &ForceColumns, samples: impl Iterator<Item = Sample>) -> Summary {
    let mut gathered = Gathered::new(N_COLUMNS);
    for (pressure_pa, length_m, direction, force_n) in samples {
        let row = columns.row(pressure_pa, length_m, direction);
        if row.iter().all(|value| value.is_finite()) {
            gathered.push(row.into_iter().chain([force_n]));
        }
    }
    gathered.summary()
}

/// RMSE of the fit to the samples of a triangle, in N.
pub(super) fn fitted_n(found: &Identified, columns: &ForceColumns, summary: &Summary) -> f64 {
    if summary.n_rows() == 0 {
        return f64::INFINITY;
    }
    let problem = ForceProblem { summary, columns, space: &found.space, steps: &[] };
    // From the middle of the box: where the fit ended it may lean on a wall.
    let modulus_pa = found.model.strand_modulus_pa();
    let center: Vec<f64> =
        (0..found.space.free.len()).map(|index| found.space.nominal_coordinate(index, modulus_pa)).collect();
    (2.0 * descend(&problem, &center).cost).sqrt()
}

/// RMSE of the fit to pressures that are lower by a shift, in N.
fn left_n(found: &Identified, columns: &ForceColumns, samples: &[Sample], shift_pa: f64) -> f64 {
    let shifted =
        samples.iter().map(|&(pressure_pa, length_m, sign, force_n)| (pressure_pa - shift_pa, length_m, sign, force_n));
    fitted_n(found, columns, &summary_of(columns, shifted))
}
