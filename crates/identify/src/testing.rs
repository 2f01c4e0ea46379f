//! A muscle, thresholds and recordings that the tests share.

use pam_muscle::Muscle;
use pam_muscle::direction::{Standstill, Thresholds};
use pam_muscle::force::{BaseParameters, ForceModel, Form};
use pam_recording::{Recording, Repairs, Samples};

/// Thresholds of a clean recording.
pub(crate) const THRESHOLDS: Thresholds =
    Thresholds { length_m: 1e-4, pressure_pa: 1e3, held_m: 0.0, turn_m: 0.0, standstill: Standstill::AT_ONCE };

/// The muscle of the paper with round parameters.
pub(crate) fn model() -> ForceModel {
    let muscle = Muscle::nominal();
    let parameters = BaseParameters { theta: [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 1.0 / 3e9, 1.2e-3, 0.0] };
    ForceModel::new(&muscle, 3e9, Form::Corrected, parameters)
}

/// A recording of `samples` without a gap.
pub(crate) fn recording(path: &str, samples: Samples) -> Recording {
    Recording {
        path: path.to_owned(),
        sha256: String::new(),
        segments: std::iter::once(0..samples.n_rows()).collect(),
        samples,
        repairs: Repairs::default(),
        ignored_columns: Vec::new(),
    }
}
