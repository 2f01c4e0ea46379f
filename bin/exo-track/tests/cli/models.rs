//! Models, inverses and effects that a lift is given.

use std::path::Path;

use crate::folder::{MODEL, SCHEMA, folder, run};

/// The model with another value for one of its parameters.
fn with_parameter(folder: &Path, name: &str, value: f64) {
    let mut model: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(MODEL).unwrap()).unwrap();
    let parameters = model["parameters"].as_array_mut().unwrap();
    parameters.iter_mut().find(|parameter| parameter["name"] == name).unwrap()["value"] = value.into();
    std::fs::write(folder.join("model.json"), model.to_string()).unwrap();
}

#[test]
fn a_lift_that_did_not_happen_has_no_errors_and_leaves_no_files() {
    // A muscle that pulls 36 N without pressure throws the bare arm up before the load is on it.
    let folder = folder(&[]);
    with_parameter(folder.path(), "k3", 36.0);
    let output = run(
        folder.path(),
        &[
            "--out",
            "track.csv",
            "--metrics",
            "metrics.json",
            "--figure",
            "lift.svg",
            "--trials",
            "4",
            "--trials-figure",
            "e.svg",
        ],
    );
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(text.contains("s, before the lift: the angle is off by"), "{text}");
    assert!(text.contains("there was no lift, and nothing is written; arm.mounted_length_mm = 263.5 fits"), "{text}");
    assert!(!text.contains("ITAE") && !text.contains("trials"), "{text}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "model and configuration alone");
}

#[test]
fn a_model_that_no_muscle_has_is_no_panic() {
    let say = |name: &str, value: f64, code: i32| {
        let folder = folder(&[]);
        with_parameter(folder.path(), name, value);
        let output = run(folder.path(), &["--out", "track.csv", "--metrics", "metrics.json", "--trials", "4"]);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{name} = {value:e}: {text}");
        assert!(!text.contains("NaN") && !text.contains("inf "), "{text}");
        if let Ok(metrics) = std::fs::read(folder.path().join("metrics.json")) {
            let metrics: serde_json::Value = serde_json::from_slice(&metrics).unwrap();
            assert!(metrics["left"]["errors"]["angle_rad"]["itae"].as_f64().unwrap() >= 0.0);
            jsonschema::validate(&serde_json::from_str(SCHEMA).unwrap(), &metrics).unwrap();
        }
        text
    };
    for (name, value) in [("k1", 1e300), ("k2", 1e10), ("k1", 1e10), ("k3", 1e300)] {
        say(name, value, 2);
    }
    insta::assert_snapshot!(say("rubber_friction", -1e-3, 2), @"error: model.json: rubber_friction is -1e-3, a friction that drives; identify the model anew");
}

#[test]
fn trials_of_a_model_that_is_hardly_known_are_no_panic_and_have_numbers() {
    let folder = folder(&[]);
    let mut model: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(MODEL).unwrap()).unwrap();
    for kind in ["parameters", "composites"] {
        for parameter in model[kind].as_array_mut().unwrap() {
            parameter["stderr"] = 1e300.into();
        }
    }
    std::fs::write(folder.path().join("model.json"), model.to_string()).unwrap();
    let output = run(
        folder.path(),
        &["--out", "track.csv", "--metrics", "metrics.json", "--trials", "32", "--trials-figure", "envelope.svg"],
    );
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success() && !text.contains("NaN"), "{text}");
    let metrics: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("metrics.json")).unwrap()).unwrap();
    jsonschema::validate(&serde_json::from_str(SCHEMA).unwrap(), &metrics).unwrap();
    assert!(!std::fs::read_to_string(folder.path().join("envelope.svg")).unwrap().contains("NaN"));
}

#[test]
fn a_muscle_that_the_controller_does_not_know_is_named() {
    let folder = folder(&[]);
    let say =
        || String::from_utf8(run(folder.path(), &["--out", "track.csv", "--plant", "plant.json"]).stderr).unwrap();
    std::fs::copy(MODEL, folder.path().join("plant.json")).unwrap();
    let text = say();
    assert!(text.contains("note: --plant plant.json is the model that the controller knows\n"), "{text}");
    let mut other: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(MODEL).unwrap()).unwrap();
    other["geometry"]["rest_radius_m"] = 0.011.into();
    std::fs::write(folder.path().join("plant.json"), other.to_string()).unwrap();
    let text = say();
    let expected = "note: the muscle of the lift is plant.json, of other dimensions (rest radius 11.0 mm, not 10.0 mm); the controller knows model.json\n";
    assert!(text.contains(expected), "{text}");
}

#[test]
fn an_output_that_cannot_be_written_is_refused_before_the_lift() {
    let folder = folder(&[]);
    std::fs::create_dir(folder.path().join("full")).unwrap();
    for (path, expected) in [
        ("none/track.csv", "error: cannot write none/track.csv: folder none does not exist"),
        ("full", "error: cannot write full: it is a folder"),
        ("model.json", "error: cannot write model.json: it is also an input"),
    ] {
        let output = run(folder.path(), &["--metrics", "metrics.json", "--out", path]);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(text.starts_with(expected) && text.lines().count() == 1, "{text}");
        assert!(!folder.path().join("metrics.json").exists());
    }
}

#[test]
fn an_artifact_of_another_kind_is_refused() {
    let folder = folder(&[]);
    std::fs::write(folder.path().join("other.json"), r#"{"schema": "pam-diagnosis/1"}"#).unwrap();
    for (option, expected) in [("--inverse", "pam-inverse/1"), ("--plant", "pam-model/1")] {
        let output = run(folder.path(), &["--out", "track.csv", option, "other.json"]);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(text.contains("other.json: schema is \"pam-diagnosis/1\"") && text.contains(expected), "{text}");
        assert!(!folder.path().join("track.csv").exists());
    }
}

#[test]
fn trials_hold_what_has_no_standard_error_and_say_so() {
    let folder = folder(&[]);
    let mut model: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(MODEL).unwrap()).unwrap();
    for parameter in model["parameters"].as_array_mut().unwrap() {
        if parameter["name"] == "k3" {
            parameter["stderr"] = serde_json::Value::Null;
            parameter["status"] = "at_bound".into();
        }
    }
    std::fs::write(folder.path().join("model.json"), model.to_string()).unwrap();
    let output = run(folder.path(), &["--out", "track.csv", "--metrics", "metrics.json", "--trials", "8"]);
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{text}");
    let expected =
        "note: model.json: held at their values in the trials, for want of a standard error (as at a bound): k3";
    assert!(text.lines().any(|line| line == expected), "{text}");
    assert!(folder.path().join("metrics.json").exists());
}

/// An inverse network, untrained, that says to belong to a model of some hash.
fn inverse_of(folder: &Path, sha256: Option<&str>) {
    let statistics = serde_json::json!({"n": 1, "rmse": 1.0, "median": 1.0, "p95": 1.0, "max": 1.0, "mean": 0.0});
    let scaling = |name: &str, unit: &str, offset: f64, scale: f64| serde_json::json!({"name": name, "unit": unit, "offset": offset, "scale": scale});
    let reach = |length_m: f64| serde_json::json!({"length_m": length_m, "contracting_force_n": [5.0, 600.0], "extending_force_n": [5.0, 600.0]});
    let model = sha256.map(|sha256| serde_json::json!({"path": "trained.json", "sha256": sha256, "role": "model"}));
    let inverse = serde_json::json!({
        "schema": "pam-inverse/1",
        "tool": {"name": "pam-train-inverse", "version": "0.1.0"},
        "inputs": model.into_iter().collect::<Vec<_>>(),
        "config": {
            "method": "levenberg-marquardt", "hidden": [1], "hidden_activation": "tanh",
            "output_activation": "linear", "n_design_points": 1, "n_recording_rows": 0, "validation_share": 0.2,
            "n_starts": 1, "n_epochs": 1, "patience": 1, "goal": 0.0, "learning_rate": 0.1, "update": "sample",
            "n_evaluation_points": 1, "min_slope_share": 0.05
        },
        "seed": 1,
        "layers": [3, 1, 1],
        "activations": ["tanh", "linear"],
        "weights": [[[0.5, -0.5, 0.0]], [[1.0]]],
        "biases": [[0.0], [-0.7]],
        "input_scaling": [
            scaling("force", "N", 300.0, 300.0), scaling("length", "m", 0.24, 0.03), scaling("direction", "1", 0.0, 1.0)
        ],
        "output_scaling": scaling("pressure", "Pa", 250e3, 250e3),
        "domain": {
            "pressure_pa": [0.0, 500e3], "length_m": [0.21, 0.27], "force_n": [5.0, 600.0], "min_slope_n_per_pa": 1e-5,
            "reach": [reach(0.21), reach(0.27)]
        },
        "training": {
            "n_training": 1, "n_validation": 1, "n_rows_excluded": 0,
            "starts": [{"n_epochs": 1, "best_epoch": 1, "validation_rmse_pa": 1.0, "ended": "epochs-used-up"}],
            "chosen": 0, "training_rmse_pa": [1.0], "validation_rmse_pa": [1.0]
        },
        "errors": {
            "coverage": {
                "n_cells": 1, "invertible_percent": 100.0, "slack_percent": 0.0, "beyond_percent": 0.0,
                "flat_percent": 0.0, "ambiguous_percent": 0.0
            },
            "pressure_pa": statistics, "force_n": statistics, "pressure_rmse_percent": 1.0, "force_rmse_percent": 1.0,
            "regions": []
        },
        "warnings": []
    });
    std::fs::write(folder.join("inverse.json"), inverse.to_string()).unwrap();
}

#[test]
fn an_inverse_of_another_model_is_refused_with_the_remedy() {
    let folder = folder(&[]);
    let say = || {
        let output =
            run(folder.path(), &["--inverse", "inverse.json", "--out", "track.csv", "--metrics", "metrics.json"]);
        assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(!folder.path().join("track.csv").exists() && !folder.path().join("metrics.json").exists());
        String::from_utf8(output.stderr).unwrap()
    };
    inverse_of(folder.path(), Some("0123456789abcdef"));
    insta::assert_snapshot!(say(), @"error: inverse.json: it is the inverse of another model (trained.json, SHA-256 01234567…) than --model model.json (d980eaf2…); train it anew with pam-train-inverse --model model.json --out inverse.json, or name the model that it belongs to");
    inverse_of(folder.path(), None);
    insta::assert_snapshot!(say(), @"error: inverse.json: it does not say which model it is the inverse of; train it anew with pam-train-inverse --model model.json --out inverse.json");
    let own = pam_recording::sha256_hex(&std::fs::read(MODEL).unwrap());
    inverse_of(folder.path(), Some(&own));
    let output = run(folder.path(), &["--inverse", "inverse.json", "--check"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
