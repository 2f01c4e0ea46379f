//! A model to train on: the nominal muscle, as an identification would write it, and what may be wrong with it.

use serde_json::{Value, json};

/// Fault of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Change {
    /// Nothing.
    None,
    /// There is no domain.
    NoDomain,
    /// The recordings held one length.
    OneLength,
    /// A pressure is missing.
    NullPressure,
    /// A number is none.
    NaN,
    /// A range runs backwards.
    Backwards,
    /// The gas pushes the wrong way.
    NeverRising,
    /// Its friction drives.
    Driving,
    /// It is another artifact.
    OtherSchema,
}

/// The text of `model.json`.
pub(crate) fn model_json(change: Change) -> String {
    let parameter = |name: &str, value: f64, unit: &str| json!({ "name": name, "value": value, "unit": unit, "stderr": null, "status": "fixed" });
    let statistics = json!({ "rmse_n": 1.0, "rmse_all_n": 1.0, "max_n": 3.0, "r2": 0.999, "fit_percent": 99.0, "n_samples": 1000, "n_unsettled": 0 });
    let mut model = json!({
        "schema": "pam-model/1",
        "tool": { "name": "pam-identify", "version": "0.1.0" },
        "inputs": [],
        "config": {
            "n_particles": 60, "n_iterations": 200, "n_starts": 4, "polish": true, "loss": "square", "freed": [],
            "fixed": [], "bladder_ratio": 0.89
        },
        "seed": 1,
        "geometry": {
            "rest_length_m": 0.267, "rest_radius_m": 0.010, "braid_angle_rad": 25.0_f64.to_radians(),
            "wall_thickness_m": 0.001, "strand_count": 240.0, "strand_diameter_m": 0.25e-3
        },
        "strand_modulus_pa": 3e9,
        "form": "corrected",
        "parameters": [
            parameter("k1", if change == Change::NeverRising { -0.9 } else { 0.9 }, "1"),
            parameter("k2", 1.05, "1"),
            parameter("k3", 2.0, "N"),
            parameter("c10", 118.4e3, "Pa"),
            parameter("c01", 105.7e3, "Pa"),
            parameter("strand_modulus", 3e9, "Pa"),
            parameter("rubber_friction", if change == Change::Driving { -1.2e-3 } else { 1.2e-3 }, "1"),
            parameter("strand_friction", 0.0, "1"),
        ],
        "composites": [],
        "effects": [],
        "correlation": { "names": [], "matrix": [] },
        "fit": {
            "estimation": statistics, "validation": null, "recordings": [], "noise_floor_n": 0.9,
            "force_noise_n": 0.2, "effective_samples": 500.0
        },
        "domain": {
            "pressure_pa": [500.0, 500e3], "length_m": [0.211, 0.268], "force_n": [4.5, 1119.0],
            "length_rate_m_per_s": 0.03, "pressure_rate_pa_per_s": 2.9e5
        },
        "direction": { "length_m": 150e-6, "pressure_pa": 2500.0 },
        "quality": [],
        "search": { "starts": [], "converged": true, "column_floor_rmse_n": 1.0 },
        "unbounded": null,
        "warnings": []
    });
    match change {
        Change::NoDomain => {
            model.as_object_mut().expect("an object").remove("domain");
        }
        Change::OneLength => model["domain"]["length_m"] = json!([0.26703, 0.26707]),
        Change::NullPressure => model["domain"]["pressure_pa"][1] = Value::Null,
        Change::Backwards => model["domain"]["pressure_pa"] = json!([500e3, 500.0]),
        Change::OtherSchema => model["schema"] = json!("pam-diagnosis/1"),
        Change::None | Change::NaN | Change::NeverRising | Change::Driving => {}
    }
    let text = serde_json::to_string_pretty(&model).expect("a value is text");
    if change == Change::NaN { text.replace("0.268", "NaN") } else { text }
}

/// A folder with the model in it.
pub(crate) fn folder_with(model: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    std::fs::write(folder.path().join("model.json"), model).expect("a folder to write into");
    folder
}
