//! The executable: a lift from files, and what it says to wrong ones.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/model.json");
/// The published schema.
const SCHEMA: &str = include_str!("../../../crates/core/schemas/exo-metrics-1.json");
const CONFIG: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../configs/lift.toml");

/// A folder with the configuration, changed by replacing text, and the model.
fn folder(changes: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut text = std::fs::read_to_string(CONFIG).unwrap();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    std::fs::write(folder.path().join("lift.toml"), text).unwrap();
    std::fs::copy(MODEL, folder.path().join("model.json")).unwrap();
    folder
}

fn run(folder: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_exo-track"))
        .current_dir(folder)
        .args(["--config", "lift.toml", "--model", "model.json"])
        .args(more)
        .output()
        .unwrap()
}

/// Standard error of a run that is refused: one line, exit code 2, no output.
fn refused(changes: &[(&str, &str)]) -> String {
    let folder = folder(changes);
    let output = run(folder.path(), &["--out", "track.csv", "--metrics", "metrics.json"]);
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(!folder.path().join("track.csv").exists() && !folder.path().join("metrics.json").exists());
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

#[test]
fn every_configuration_of_a_lift_is_fine() {
    let configs = PathBuf::from(CONFIG).parent().unwrap().to_owned();
    let mut seen = 0;
    for entry in std::fs::read_dir(configs).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if name.starts_with("lift") {
            let output = Command::new(env!("CARGO_BIN_EXE_exo-track"))
                .args(["--model", MODEL, "--check", "--config"])
                .arg(&path)
                .output()
                .unwrap();
            assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
            seen += 1;
        }
    }
    assert!(seen > 0);
}

#[test]
fn a_lift_writes_track_metrics_and_figures_that_are_the_same_again() {
    let folder = folder(&[]);
    let files =
        |run: u32| ["track.csv", "metrics.json", "lift.svg", "envelope.svg"].map(|name| format!("{run}-{name}"));
    let mut contents = Vec::new();
    for (number, threads) in [(1, "1"), (2, "2")] {
        let names = files(number);
        let output = run(
            folder.path(),
            &[
                "--out",
                &names[0],
                "--metrics",
                &names[1],
                "--figure",
                &names[2],
                "--trials",
                "64",
                "--trials-figure",
                &names[3],
                "--threads",
                threads,
            ],
        );
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        contents.push(names.map(|name| std::fs::read_to_string(folder.path().join(name)).unwrap()));
    }
    assert_eq!(contents[0], contents[1]);
    let [track, metrics, ..] = &contents[0];
    assert_eq!(track.lines().count(), 502, "a header and 5 s at 100 Hz");
    assert!(track.lines().all(|line| line.split(',').count() == 46));
    let metrics: serde_json::Value = serde_json::from_str(metrics).unwrap();
    let printed = Command::new(env!("CARGO_BIN_EXE_exo-track")).arg("--schema").output().unwrap().stdout;
    assert!(printed == SCHEMA.as_bytes(), "the published schema is stale; run scripts/schemas");
    jsonschema::validate(&serde_json::from_str(SCHEMA).unwrap(), &metrics).unwrap();
    for arm in ["left", "right"] {
        let angle = &metrics[arm]["errors"]["angle_rad"];
        assert!(angle["max"].as_f64().unwrap() <= 0.00175 && angle["rmse"].as_f64().unwrap() <= 0.00048);
    }
    assert_eq!(metrics["trials"]["n_trials"], 64);
}

#[test]
fn the_example_is_a_configuration_that_is_accepted_unchanged() {
    let folder = folder(&[]);
    let example = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_exo-track"));
        let output = command.current_dir(folder.path()).arg("--example").args(more).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        output.stdout
    };
    let printed = example(&[]);
    assert!(printed.starts_with(b"# "), "it is commented");
    example(&["--out", "lift.toml"]);
    assert_eq!(std::fs::read(folder.path().join("lift.toml")).unwrap(), printed);
    let output = run(folder.path(), &["--check"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn what_no_lift_has_is_refused_by_name() {
    insta::assert_snapshot!(refused(&[("mass_kg = 5.0 ", "mass_kg = nan ")]), @"error: lift.toml: load.mass_kg = NaN is outside 0 to 500; write a number");
    insta::assert_snapshot!(refused(&[("mass_kg = 5.0 ", "mass_kg = -5.0 ")]), @"error: lift.toml: load.mass_kg = -5 is outside 0 to 500; check the value and its unit");
    insta::assert_snapshot!(refused(&[("period_ms = 10.0", "period_ms = 10.5")]), @"error: lift.toml: controller.period_ms = 10.5 is no multiple of plant.step_ms = 1; choose 10 or 11, or another step");
    insta::assert_snapshot!(refused(&[("duration_s = 5.0", "duration_s = 5.003")]), @"error: lift.toml: reference.duration_s = 5.003 is no multiple of controller.period_ms / 1000 = 0.01; choose 5 or 5.01, or another step");
    insta::assert_snapshot!(refused(&[("highest_kpa = 500.0", "highest_kpa = 700.0")]), @"error: lift.toml: valve.highest_kpa = 700 is not below valve.supply_kpa = 600");
    insta::assert_snapshot!(refused(&[("kp_per_s2", "kp_per_s")]), @"error: lift.toml:66:1: unknown field `kp_per_s`; did you mean `kp_per_s2`?");
    insta::assert_snapshot!(refused(&[("duration_s = 5.0", "duration_s = 3600.0"), ("period_ms = 10.0", "period_ms = 1.0")]), @"error: lift.toml: the lift has 3602000 periods of the controller, more than 500000; shorten the times of [reference] or lengthen controller.period_ms");
    insta::assert_snapshot!(refused(&[("\"proportional\"", "\"poppet\"")]), @"error: lift.toml:46:8: unknown variant `poppet`, expected `proportional` or `on-off`");
}

#[test]
fn a_reference_out_of_reach_is_refused_with_angle_and_forces() {
    insta::assert_snapshot!(refused(&[("mass_kg = 5.0 ", "mass_kg = 60.0 ")]), @"error: lift.toml: the muscle cannot reach the reference: at 0.202 rad (2.98 s, length 239.5 mm) the lift needs 609.7 N, and 500 kPa give 607.1 N; no mounted length helps; load.mass_kg = 42.0 fits");
}

#[test]
fn a_muscle_mounted_too_short_or_too_long_is_refused_before_the_lift() {
    insta::assert_snapshot!(refused(&[("# mounted_length_mm = 267.0", "mounted_length_mm = 160.0")]), @"error: lift.toml: the muscle cannot reach the reference: at 0.000 rad (0.00 s) it is slack, as a muscle of 160.0 mm pulls nothing even at 500 kPa, and the lift needs 56.7 N (extrapolated: the model was identified on 210.8 to 268.4 mm); arm.mounted_length_mm = 252.0 fits");
    insta::assert_snapshot!(refused(&[("# mounted_length_mm = 267.0", "mounted_length_mm = 300.0")]), @"error: lift.toml: the muscle cannot reach the reference: at 0.000 rad (0.00 s) it is 300.0 mm long, and its strands are straight at 294.6 mm (extrapolated: the model was identified on 210.8 to 268.4 mm); arm.mounted_length_mm = 268.5 fits");
    insta::assert_snapshot!(refused(&[("# mounted_length_mm = 267.0", "mounted_length_mm = 272.0")]), @"error: lift.toml: the muscle cannot reach the reference: at 0.000 rad (0.00 s, length 272.0 mm) the lift needs 56.7 N, and the muscle pulls 64.8 N already at 0 kPa (extrapolated: the model was identified on 210.8 to 268.4 mm); arm.mounted_length_mm = 268.5 fits");
    insta::assert_snapshot!(refused(&[("from_rad = 0.0 ", "from_rad = -0.1 ")]), @"error: lift.toml: the muscle cannot reach the reference: before the load is on the arms, a muscle of 279.7 mm pulls 365.9 N at 0 kPa and lifts the bare arm by more than half of limits.diverged_rad (extrapolated: the model was identified on 210.8 to 268.4 mm); arm.mounted_length_mm = 256.0 fits");
}

#[test]
fn a_mounted_length_that_is_proposed_makes_the_lift_a_success() {
    for (mounted, fits) in [("160.0", "252.0"), ("300.0", "268.5")] {
        let wrong = format!("mounted_length_mm = {mounted}");
        assert!(
            refused(&[("# mounted_length_mm = 267.0", &wrong)])
                .contains(&format!("arm.mounted_length_mm = {fits} fits"))
        );
        let folder = folder(&[("# mounted_length_mm = 267.0", &format!("mounted_length_mm = {fits}"))]);
        let output = run(folder.path(), &["--out", "track.csv"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn a_refused_lift_of_a_diagnosed_muscle_is_answered_at_once() {
    // The search for a length passes the strands' own, where eq. 11 has no force to be read as slack.
    let folder = folder(&[("# mounted_length_mm = 267.0", "mounted_length_mm = 160.0")]);
    let mut model: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(MODEL).unwrap()).unwrap();
    let value = |name, value, unit| serde_json::json!({"name": name, "value": value, "unit": unit, "stderr": null, "status": "fitted"});
    let parameters = [value("floor_n", -8.0, "N"), value("softness_n", 8.0, "N")];
    model["effects"] = serde_json::json!([{"id": "slack", "parameters": parameters}]);
    std::fs::write(folder.path().join("model.json"), model.to_string()).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_exo-track"))
        .current_dir(folder.path())
        .args(["--config", "lift.toml", "--model", "model.json", "--out", "track.csv"])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // A tenth of a second is what it takes; a slow machine that does other things takes longer, and a search without end for ever.
    let deadline = std::time::Instant::now() + std::time::Duration::from_secs(20);
    while child.try_wait().unwrap().is_none() {
        if std::time::Instant::now() > deadline {
            child.kill().unwrap();
            panic!("no answer within 20 s");
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("the lift needs 56.7 N") && text.contains("arm.mounted_length_mm = 25"), "{text}");
}

#[test]
fn a_lift_beyond_the_recordings_is_said_to_extrapolate_already_by_check() {
    let folder = folder(&[("# mounted_length_mm = 267.0", "mounted_length_mm = 270.0")]);
    for more in [&["--check"][..], &["--out", "track.csv"]] {
        let text = String::from_utf8(run(folder.path(), more).stderr).unwrap();
        let warning = "mm, and the model was identified on 210.8 to 268.4 mm: it extrapolates; record bench data there";
        assert!(text.contains("warning: the lift uses a length of 22") && text.contains(warning), "{text}");
    }
}

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
    let own = pam_core::artifact::sha256_hex(&std::fs::read(MODEL).unwrap());
    inverse_of(folder.path(), Some(&own));
    let output = run(folder.path(), &["--inverse", "inverse.json", "--check"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// The model with an effect of one parameter.
fn with_effect(folder: &Path, id: &str, parameters: &[(&str, f64, &str)]) {
    let text = std::fs::read_to_string(MODEL).unwrap();
    let mut model: serde_json::Value = serde_json::from_str(&text).unwrap();
    let entry = |&(name, value, unit): &(&str, f64, &str)| serde_json::json!({"name": name, "value": value, "unit": unit, "stderr": null, "status": "fitted"});
    let parameters: Vec<serde_json::Value> = parameters.iter().map(entry).collect();
    model["effects"] = serde_json::json!([{"id": id, "parameters": parameters}]);
    std::fs::write(folder.join("effect.json"), model.to_string()).unwrap();
}

/// Mean absolute angle error of the left arm, in rad.
fn mae_rad(folder: &Path, more: &[&str]) -> f64 {
    let output = run(folder, &[&["--out", "track.csv", "--metrics", "metrics.json"], more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let metrics: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("metrics.json")).unwrap()).unwrap();
    metrics["left"]["errors"]["angle_rad"]["mae"].as_f64().unwrap()
}

#[test]
fn a_concealed_threshold_costs_tracking_and_a_model_that_knows_it_gets_it_back() {
    let folder = folder(&[]);
    let base_rad = mae_rad(folder.path(), &[]);
    with_effect(folder.path(), "threshold-pressure", &[("threshold_pa", 4e4, "Pa")]);
    let concealed_rad = mae_rad(folder.path(), &["--plant", "effect.json"]);
    let output = Command::new(env!("CARGO_BIN_EXE_exo-track"))
        .current_dir(folder.path())
        .args(["--config", "lift.toml", "--model", "effect.json", "--out", "track.csv", "--metrics", "metrics.json"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metrics: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("metrics.json")).unwrap()).unwrap();
    let known_rad = metrics["left"]["errors"]["angle_rad"]["mae"].as_f64().unwrap();
    assert!(concealed_rad > 5.0 * base_rad && known_rad < 2.0 * base_rad, "{base_rad} {concealed_rad} {known_rad}");
}

#[test]
fn an_effect_that_is_not_the_muscle_s_stays_at_the_bench() {
    let folder = folder(&[]);
    let base_rad = mae_rad(folder.path(), &[]);
    with_effect(
        folder.path(),
        "series-compliance",
        &[("compliance_m_per_n", 1e-6, "m/N"), ("sliding_share", 1.0, "1"), ("hardening_per_n", 0.0, "1/N")],
    );
    assert_eq!(mae_rad(folder.path(), &["--plant", "effect.json"]).to_bits(), base_rad.to_bits());
    let output = run(folder.path(), &["--out", "track.csv", "--plant", "effect.json"]);
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(
        text.contains("effect.json: left out of the lift, as they are not the muscle's: series-compliance"),
        "{text}"
    );
}

#[test]
fn an_effect_that_the_catalogue_does_not_have_is_refused() {
    let folder = folder(&[]);
    with_effect(folder.path(), "gearbox", &[("ratio", 2.0, "1")]);
    let output = run(folder.path(), &["--out", "track.csv", "--plant", "effect.json"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("effect.json: effect \"gearbox\" is unknown; the nearest are"), "{text}");
}

/// What a lift is rejected for, one line for each arm and trouble; its track is there to look at.
fn rejected(changes: &[(&str, &str)]) -> String {
    let folder = folder(changes);
    let output = run(folder.path(), &["--out", "track.csv"]);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(folder.path().join("track.csv").exists());
    text.lines().filter(|line| line.contains("rejected")).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_lift_that_saturates_slackens_or_diverges_is_rejected_with_time_and_reason() {
    let all = |text: &str, parts: &[&str]| parts.iter().for_each(|part| assert!(text.contains(part), "{part}: {text}"));
    // A stiff joint that nobody told the controller of, and little pressure.
    let stiff = [("damping_n_m_s = 0.05", "damping_n_m_s = 20.0"), ("duration_s = 5.0", "duration_s = 1.0")];
    let weak = [stiff[0], stiff[1], ("highest_kpa = 500.0", "highest_kpa = 105.0")];
    all(&rejected(&weak), &["left arm saturated from 0.5", "rad): the highest pressure pulls less than the 9"]);
    let light = [("# true_mass_kg = 6.5", "true_mass_kg = 0.3")];
    all(&rejected(&light), &["right arm saturated from 0.0", "even the lowest pressure pulls more than the 0."]);
    let lively = [("kp_per_s2 = 80.0", "kp_per_s2 = 600.0"), ("diverged_rad = 0.1", "diverged_rad = 1.0")];
    all(&rejected(&lively), &["left arm slack at", "rad): the muscle would have to push"]);
    let at_once = [("handover_s = 1.5", "handover_s = 0.0"), ("hold_s = 0.5", "hold_s = 0.0")];
    let unstable = [("kp_per_s2 = 80.0", "kp_per_s2 = 3000.0"), at_once[0], at_once[1]];
    all(&rejected(&unstable), &["left arm given up at", "rad, more than limits.diverged_rad"]);
}
