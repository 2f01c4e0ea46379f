//! The artifact: what is written is what is read, and what does not fit together is refused.

use std::path::Path;

use pam_artifact::InverseArtifact;
use pam_inverse_model::InverseNetwork;
use serde_json::{Value, json};

/// A network of two hidden neurons, as text.
fn written() -> Value {
    let statistics = json!({ "n": 2, "rmse": 1.0, "median": 1.0, "p95": 1.0, "max": 1.0, "mean": 0.0 });
    let scaling = |name: &str, unit: &str, offset: f64, scale: f64| json!({ "name": name, "unit": unit, "offset": offset, "scale": scale });
    let reach = |length_m: f64| json!({ "length_m": length_m, "contracting_force_n": [5.0, 300.0], "extending_force_n": [5.0, 320.0] });
    json!({
        "schema": "pam-inverse/1",
        "tool": { "name": "pam-train-inverse", "version": "0.1.0" },
        "inputs": [],
        "config": {
            "method": "levenberg-marquardt", "hidden": [2], "hidden_activation": "tanh",
            "output_activation": "linear", "n_design_points": 100, "n_recording_rows": 0, "validation_share": 0.2,
            "n_starts": 1, "n_epochs": 10, "patience": 5, "goal": 0.0002, "learning_rate": 0.05, "update": "sample",
            "n_evaluation_points": 2, "min_slope_share": 0.05
        },
        "seed": 1,
        "layers": [3, 2, 1],
        "activations": ["tanh", "linear"],
        "weights": [[[0.1, 0.2, 0.3], [-0.4, 0.5, -0.6]], [[0.7, -0.8]]],
        "biases": [[0.01, -0.02], [0.1]],
        "input_scaling": [
            scaling("force", "N", 150.0, 150.0), scaling("length", "m", 0.24, 0.03), scaling("direction", "1", 0.0, 1.0)
        ],
        "output_scaling": scaling("pressure", "Pa", 250e3, 250e3),
        "domain": {
            "pressure_pa": [0.0, 500e3], "length_m": [0.21, 0.27], "force_n": [5.0, 320.0], "min_slope_n_per_pa": 1e-5,
            "reach": [reach(0.21), reach(0.24), reach(0.27)]
        },
        "training": {
            "n_training": 80, "n_validation": 20, "n_rows_excluded": 0, "starts": [], "chosen": 0,
            "training_rmse_pa": [1.0], "validation_rmse_pa": [1.0]
        },
        "errors": {
            "coverage": {
                "n_cells": 4, "invertible_percent": 100.0, "slack_percent": 0.0, "beyond_percent": 0.0,
                "flat_percent": 0.0, "ambiguous_percent": 0.0
            },
            "pressure_pa": statistics, "force_n": statistics, "pressure_rmse_percent": 0.1, "force_rmse_percent": 0.1,
            "regions": []
        },
        "warnings": []
    })
}

fn read(text: &str) -> Result<InverseArtifact, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("inverse.json");
    std::fs::write(&path, text).expect("a file");
    let message = |error: pam_artifact::ArtifactError| {
        error.to_string().replace(&*folder.path().join(Path::new("")).to_string_lossy(), "")
    };
    InverseArtifact::read(&path).map(|(artifact, _)| artifact).map_err(message)
}

/// What reading says after a change at a JSON pointer.
fn refused(pointer: &str, value: Value) -> String {
    let mut artifact = written();
    *artifact.pointer_mut(pointer).expect("a place in the artifact") = value;
    read(&artifact.to_string()).expect_err("a refusal")
}

#[test]
fn what_is_written_is_read_and_answers_the_same() {
    let artifact = read(&written().to_string()).expect("an artifact");
    let network = InverseNetwork::from_artifact(&artifact);
    let again = read(&serde_json::to_string_pretty(&artifact).expect("text")).expect("an artifact");
    assert_eq!(artifact, again);
    assert_eq!(network, InverseNetwork::from_artifact(&again));
    // By hand: x = (0, 0, 1).
    let expected = 250e3 + 250e3 * (0.7 * 0.31_f64.tanh() - 0.8 * (-0.62_f64).tanh() + 0.1);
    let answer = network.pressure_pa(150.0, 0.24, 1.0);
    assert!((answer.pressure_pa - expected).abs() < 1e-9 && !answer.outside);
    assert!(network.pressure_pa(310.0, 0.24, 1.0).outside && !network.pressure_pa(310.0, 0.24, -1.0).outside);
}

#[test]
fn a_wrong_shape_is_refused_by_name() {
    let tail = "; write the artifact anew with its program";
    for (pointer, value, expected) in [
        ("/layers", json!([2, 2, 1]), "layers are [2, 2, 1], expected three inputs, hidden layers and one output"),
        ("/layers", json!([3, 1]), "layers are [3, 1], expected three inputs, hidden layers and one output"),
        ("/layers", json!([3, 65, 1]), "a layer has 65 neurons, expected 1 to 64"),
        ("/layers", json!([3, 4, 1]), "weights of layer 1 are 2 × 3, expected 4 × 3"),
        ("/weights/0/1", json!([0.1, 0.2]), "weights of layer 1 are 2 × 2, expected 2 × 3"),
        ("/weights", json!([]), "weights has 0 layers, expected 2 as in layers"),
        ("/activations", json!(["tanh"]), "activations has 1 layers, expected 2 as in layers"),
        ("/biases/1", json!([]), "biases of layer 2 are 0, expected 1"),
        ("/input_scaling/1/scale", json!(0.0), "the scale of length is 0, expected a positive number"),
        (
            "/input_scaling/0/name",
            json!("length"),
            "the scaling is not that of force, length and direction to pressure",
        ),
        ("/domain/length_m", json!([0.27, 0.27]), "the domain's length runs from 0.27 to 0.27"),
        ("/domain/reach", json!([]), "the domain's reach has 0 lengths, expected two or more"),
        ("/domain/reach/1/length_m", json!(0.25), "length 1 of the domain's reach is 0.25 m, expected 0.24"),
    ] {
        assert_eq!(refused(pointer, value), format!("inverse.json: {expected}{tail}"));
    }
}

#[test]
fn another_schema_and_broken_numbers_are_refused() {
    assert_eq!(
        refused("/schema", json!("pam-model/1")),
        "inverse.json: schema is \"pam-model/1\", expected \"pam-inverse/1\"; write it with pam-train-inverse"
    );
    for (version, remedy) in [
        (0, "an older version wrote it; write it anew with pam-train-inverse"),
        (2, "a newer version wrote it; update the programs, or write it anew with pam-train-inverse"),
    ] {
        let found = format!("pam-inverse/{version}");
        let expected = format!("inverse.json: schema is \"{found}\", expected \"pam-inverse/1\"; {remedy}");
        assert_eq!(refused("/schema", json!(found)), expected);
    }
    assert!(refused("/weights/0/0/0", Value::Null).contains("invalid type: null, expected f64"));
    let text = written().to_string().replace("0.01", "NaN");
    assert!(read(&text).expect_err("a refusal").contains("expected a pam-inverse/1 artifact"));
}
