//! Points along recordings: pressures, lengths and directions as they happened, forces as the model says.

use pam_artifact::ModelArtifact;
use pam_muscle::direction::{Direction, Driver};
use pam_muscle::force::Form;
use pam_recording::Recording;

use crate::design::Point;
use crate::{ExactInverse, InverseError};

/// Points of recordings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Recorded {
    /// Rows that were taken.
    pub points: Vec<Point>,
    /// Rows that were looked at and left out: outside the domain, or without an inverse.
    pub n_excluded: usize,
    /// Recorded forces less the model's at the rows that were taken, root mean square in N; none without recorded forces.
    pub force_rmse_n: Option<f64>,
}

/// At most about `n` rows of `recordings`, evenly spaced.
///
/// # Errors
/// [`InverseError::Samples`] where samples cannot be read back, [`InverseError::NothingRecorded`] where no row is a point.
pub fn points(
    recordings: &[Recording],
    artifact: &ModelArtifact,
    inverse: &ExactInverse,
    n: usize,
) -> Result<Recorded, InverseError> {
    let n_rows: usize = recordings.iter().map(|recording| recording.samples.n_rows()).sum();
    let every = n_rows.div_ceil(n.max(1)).max(1);
    let driver = match artifact.form {
        Form::Corrected => Driver::Motion,
        Form::AsPrinted => Driver::Pressure,
    };
    let failed = |reason| InverseError::Samples { reason };
    let mut recorded = Recorded::default();
    let (mut squares, mut n_forces) = (0.0, 0.0);
    for recording in recordings {
        let directions = Direction::of(recording, artifact.direction, driver).map_err(failed)?;
        for chunk in recording.samples.chunks() {
            let chunk = chunk.map_err(failed)?;
            let columns = chunk.rows().zip(chunk.pressure_pa()).zip(chunk.length_m());
            for ((row, &pressure_pa), &length_m) in columns.filter(|((row, _), _)| row % every == 0) {
                if recording.samples.has_force() {
                    let settled_n = inverse.model().settled_force_n(pressure_pa, length_m, directions.sign(row));
                    let error_n = chunk.force_n()[row - chunk.rows().start] - settled_n;
                    // Beyond its strands' length a muscle has no force to compare.
                    if error_n.is_finite() {
                        squares += error_n * error_n;
                        n_forces += 1.0;
                    }
                }
                match point(inverse, pressure_pa, length_m, directions.sign(row)) {
                    Some(point) => recorded.points.push(point),
                    None => recorded.n_excluded += 1,
                }
            }
        }
    }
    if recorded.points.is_empty() && recorded.n_excluded > 0 {
        return Err(InverseError::NothingRecorded { n_rows: recorded.n_excluded });
    }
    recorded.force_rmse_n = (n_forces > 0.0).then(|| (squares / n_forces).sqrt());
    Ok(recorded)
}

/// The point at a pressure, if that is the pressure which the inverse gives for its force.
fn point(inverse: &ExactInverse, pressure_pa: f64, length_m: f64, direction: f64) -> Option<Point> {
    let [shortest_m, longest_m] = inverse.inverse_box().length_m;
    if !(shortest_m..=longest_m).contains(&length_m) {
        return None;
    }
    let [low_pa, high_pa] = inverse.branch(length_m, direction)?.pressure_pa;
    let force_n = inverse.model().settled_force_n(pressure_pa, length_m, direction);
    (low_pa..=high_pa).contains(&pressure_pa).then_some(Point { pressure_pa, length_m, direction, force_n })
}
