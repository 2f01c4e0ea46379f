//! Errors hidden from a controller, and lifts that are rejected.

use std::path::Path;
use std::process::Command;

use crate::folder::{MODEL, folder, run};

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
    assert!(text.contains("effect.json: left out, as they are not the muscle's: series-compliance"), "{text}");
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

/// Reasons for which a lift is rejected, one line for each arm and trouble; its track is there to look at.
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
