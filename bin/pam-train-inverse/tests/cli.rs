//! Runs the executable.

mod model;

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use model::{Change, folder_with, model_json};
use pam_artifact::InverseArtifact;
use pam_inverse_model::InverseNetwork;

/// The published schema.
const SCHEMA: &str = include_str!("../../../crates/artifact/schemas/pam-inverse-1.json");

/// Options that make a training short.
const SHORT: [&str; 6] = ["--points", "900", "--starts", "1", "--judge-points", "2000"];

fn pam_train_inverse(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pam-train-inverse"));
    command.current_dir(folder).args(arguments).output().expect("the program starts")
}

/// Trains on `model.json`, short but for what `arguments` say.
fn train(folder: &Path, arguments: &[&str]) -> Output {
    let mut all = vec!["--model", "model.json", "--out", "inverse.json"];
    for pair in SHORT.chunks(2).filter(|pair| !arguments.contains(&pair[0])) {
        all.extend(pair);
    }
    all.extend(arguments);
    pam_train_inverse(folder, &all)
}

/// The one line that a refused run says; nothing may be left behind.
fn refused(folder: &Path, output: &Output) -> String {
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty());
    assert!(!folder.join("inverse.json").exists() && !folder.join("inverse.svg").exists());
    let text = String::from_utf8_lossy(&output.stderr).trim_end().to_owned();
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

/// Message of a training on a changed model.
fn refused_model(change: Change) -> String {
    let folder = folder_with(&model_json(change));
    refused(folder.path(), &train(folder.path(), &["--figure", "inverse.svg"]))
}

#[test]
fn a_model_becomes_a_network_a_figure_and_tables() {
    let folder = folder_with(&model_json(Change::None));
    let output = train(folder.path(), &["--figure", "inverse.svg"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(output.stdout.is_empty());
    for heading in [
        "Training of a 3-20-1 network on 720 points",
        "Accuracy on ",
        "Where the errors are",
        "Network and exact inverse",
    ] {
        assert!(said.contains(heading), "{said}");
    }
    assert!(said.ends_with("note: wrote inverse.json and inverse.svg\n"), "{said}");
    let (artifact, _) = InverseArtifact::read(&folder.path().join("inverse.json")).unwrap();
    assert!(artifact.errors.pressure_rmse_percent < 0.3 && artifact.errors.force_rmse_percent < 0.5);
    let network = InverseNetwork::from_artifact(&artifact);
    assert!(!network.pressure_pa(100.0, 0.25, 1.0).outside);
    let svg = std::fs::read_to_string(folder.path().join("inverse.svg")).unwrap();
    assert!(svg.contains("Learned pressure") && svg.ends_with("</svg>\n"), "{}", svg.len());
}

#[test]
fn the_artifact_obeys_its_schema() {
    let folder = folder_with(&model_json(Change::None));
    let schema = pam_train_inverse(folder.path(), &["--schema"]);
    assert_eq!(schema.status.code(), Some(0));
    assert!(schema.stdout == SCHEMA.as_bytes(), "the published schema is stale; run scripts/schemas");
    let schema: serde_json::Value = serde_json::from_str(SCHEMA).unwrap();
    let artifact = pam_train_inverse(folder.path(), &[&["--model", "model.json", "--out", "-"], &SHORT[..]].concat());
    let artifact: serde_json::Value = serde_json::from_slice(&artifact.stdout).unwrap();
    let validator = jsonschema::validator_for(&schema).unwrap();
    let errors: Vec<String> = validator.iter_errors(&artifact).map(|error| error.to_string()).collect();
    assert!(errors.is_empty(), "{errors:?}");
    assert_eq!(artifact["schema"], "pam-inverse/1");
    assert_eq!(artifact["inputs"][0]["role"], "model");
}

#[test]
fn equal_seeds_give_equal_bytes_on_any_number_of_threads() {
    let folder = folder_with(&model_json(Change::None));
    let bytes = |arguments: &[&str]| {
        let output =
            train(folder.path(), &[&["--quiet", "--starts", "2", "--figure", "inverse.svg"], arguments].concat());
        assert!(output.status.success() && output.stderr.is_empty());
        let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
        (read("inverse.json"), read("inverse.svg"))
    };
    let one = bytes(&["--threads", "1"]);
    assert!(one == bytes(&["--threads", "3"]));
    assert!(one.0 != bytes(&["--seed", "2"]).0);
}

#[test]
fn another_language_reads_the_weights_and_agrees() {
    let folder = folder_with(&model_json(Change::None));
    for arguments in [&[][..], &["--activation", "sigmoid", "--output-activation", "sigmoid"], &["--hidden", "7,5"]] {
        let mut all = vec!["--model", "model.json", "--out", "inverse.json", "--max-error-percent", "50", "--quiet"];
        all.extend(["--points", "900", "--starts", "1", "--epochs", "10", "--judge-points", "500"]);
        all.extend(arguments);
        assert_eq!(pam_train_inverse(folder.path(), &all).status.code(), Some(0));
        let (artifact, _) = InverseArtifact::read(&folder.path().join("inverse.json")).unwrap();
        let network = InverseNetwork::from_artifact(&artifact);
        let points =
            [[100.0, 0.25, 1.0], [100.0, 0.25, -1.0], [900.0, 0.25, 1.0], [33.5, 0.2255, 0.3], [50.0, 0.3, 1.0]];
        let lines: Vec<String> = points.iter().map(|[f, l, s]| format!("{f} {l} {s}\n")).collect();
        let Some(printed) = python(&folder.path().join("inverse.json"), &lines.concat()) else { return };
        for (line, [force_n, length_m, direction]) in printed.lines().zip(points) {
            let ours = network.pressure_pa(force_n, length_m, direction);
            let (pressure, flag) = line.split_once(' ').unwrap();
            let theirs_pa: f64 = pressure.parse().unwrap();
            let scale_pa = artifact.domain.pressure_pa[1];
            assert!((theirs_pa - ours.pressure_pa).abs() < 1e-12 * scale_pa, "{line} {ours:?}");
            assert_eq!(flag == "1", ours.outside, "{force_n} {length_m} {direction}");
        }
        assert_eq!(printed.lines().count(), points.len());
    }
}

/// Output of the example script; none where there is no Python.
#[expect(clippy::print_stderr, reason = "a skipped test must be seen")]
fn python(artifact: &Path, points: &str) -> Option<String> {
    let script: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scripts/evaluate-inverse.py");
    assert!(std::fs::read_to_string(&script).expect("the script").lines().count() <= 30);
    let child = Command::new("python3")
        .arg(script)
        .arg(artifact)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let Ok(mut child) = child else {
        eprintln!("SKIPPED: python3 is not there, so the example script was not run");
        return None;
    };
    std::io::Write::write_all(&mut child.stdin.take().expect("a pipe"), points.as_bytes()).expect("points are read");
    let output = child.wait_with_output().expect("the script ends");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).expect("text"))
}

#[test]
fn a_network_that_is_not_good_enough_is_written_and_rejected() {
    let folder = folder_with(&model_json(Change::None));
    let output = train(folder.path(), &["--method", "backpropagation", "--epochs", "3"]);
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    let last = said.lines().last().unwrap();
    assert!(last.starts_with("warning: rejected: RMSE ") && last.ends_with("above --max-error-percent 0.3"), "{last}");
    assert!(folder.path().join("inverse.json").exists());
}

#[test]
fn recordings_may_be_trained_at_and_rows_outside_are_counted() {
    let folder = folder_with(&model_json(Change::None));
    let mut log = "time_s,pressure_kPa,length_mm\n".to_owned();
    for row in 0..1000 {
        let phase = f64::from(row) * 0.0628;
        let length_mm = 240.0 + 35.0 * (0.7 * phase).sin();
        log += &format!("{:.2},{:.3},{length_mm:.3}\n", f64::from(row) * 0.01, 250.0 + 200.0 * phase.sin());
    }
    std::fs::write(folder.path().join("log.csv"), log).unwrap();
    let output = train(folder.path(), &["log.csv"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("rows of the recordings are left out"), "{said}");
    let (artifact, _) = InverseArtifact::read(&folder.path().join("inverse.json")).unwrap();
    let report = &artifact.training;
    assert_eq!(report.n_training + report.n_validation + report.n_rows_excluded, 1900);
    assert_eq!(artifact.inputs[1].path, "log.csv");
}

#[test]
fn recordings_of_another_muscle_are_refused_or_doubted() {
    let folder = folder_with(&model_json(Change::None));
    let log = |length_mm: f64, force_n: f64| {
        let row = |row: u32| {
            let phase = f64::from(row) * 0.0628;
            let (pressure_kpa, length_mm) = (250.0 + 150.0 * phase.sin(), length_mm + 10.0 * (0.7 * phase).sin());
            format!("{:.2},{pressure_kpa:.3},{length_mm:.3},{:.3}\n", f64::from(row) * 0.01, force_n + phase.sin())
        };
        let rows: String = (0..1000).map(row).collect();
        std::fs::write(folder.path().join("log.csv"), format!("time_s,pressure_kPa,length_mm,force_N\n{rows}"))
            .unwrap();
    };
    // A muscle that is half as long.
    log(130.0, 300.0);
    insta::assert_snapshot!(refused(folder.path(), &train(folder.path(), &["log.csv"])), @"error: model.json: none of the 1000 rows that were taken from the recordings lies where the model can be inverted; name recordings of its muscle, or none");
    // One of this length, with forces that this one never has there.
    log(240.0, 900.0);
    let text = String::from_utf8(train(folder.path(), &["log.csv"]).stderr).unwrap();
    assert!(
        text.contains(
            " N from the model's, which left 1.0 N where it was identified: are these recordings of its muscle?"
        ),
        "{text}"
    );
}

#[test]
fn a_network_that_saw_one_corner_is_judged_on_the_whole_domain() {
    let folder = folder_with(&model_json(Change::None));
    let row = |row: u32| {
        let phase = f64::from(row) * 0.0628;
        let (pressure_kpa, length_mm) = (100.0 + 50.0 * phase.sin(), 255.0 + 8.0 * (0.7 * phase).sin());
        format!("{:.2},{pressure_kpa:.3},{length_mm:.3}\n", f64::from(row) * 0.01)
    };
    let rows: String = (0..1000).map(row).collect();
    std::fs::write(folder.path().join("log.csv"), format!("time_s,pressure_kPa,length_mm\n{rows}")).unwrap();
    assert_eq!(train(folder.path(), &["log.csv", "--points", "0"]).status.code(), Some(1));
}

#[test]
fn check_writes_nothing() {
    let folder = folder_with(&model_json(Change::None));
    let output = pam_train_inverse(folder.path(), &["--model", "model.json", "--check"]);
    assert_eq!(output.status.code(), Some(0));
    insta::assert_snapshot!(
        String::from_utf8(output.stderr).unwrap(),
        @"note: inputs are fine: 2000 points to train at (--check)"
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_model_without_a_usable_domain_is_refused() {
    insta::assert_snapshot!(refused_model(Change::NoDomain), @"error: model.json:121:1: missing field `domain`; expected a pam-model/1 artifact");
    insta::assert_snapshot!(refused_model(Change::OneLength), @"error: model.json: the model's domain covers length 267.03 to 267.07 mm only; identify it from recordings in which the length varies");
    insta::assert_snapshot!(refused_model(Change::NullPressure), @"error: model.json:33:10: invalid type: null, expected f64; expected a pam-model/1 artifact");
    insta::assert_snapshot!(refused_model(Change::NaN), @"error: model.json:28:7: expected value; expected a pam-model/1 artifact");
    insta::assert_snapshot!(refused_model(Change::Backwards), @"error: model.json: the model's domain covers pressure 500 to 0.5 kPa only; identify it from recordings in which the pressure varies");
    insta::assert_snapshot!(refused_model(Change::NeverRising), @"error: model.json: the model can be inverted in 0.0 % of its domain only (0.0 % slack, 100.0 % where force does not grow with pressure); check the model");
    insta::assert_snapshot!(refused_model(Change::Driving), @"error: model.json: rubber_friction is -1.2e-3, a friction that drives; identify the model anew");
    insta::assert_snapshot!(refused_model(Change::OtherSchema), @r#"error: model.json: schema is "pam-diagnosis/1", expected "pam-model/1"; write it with pam-identify"#);
}

#[test]
fn a_mistake_on_the_command_line_is_one_line() {
    let folder = folder_with(&model_json(Change::None));
    let say = |arguments: &[&str]| refused(folder.path(), &train(folder.path(), arguments));
    insta::assert_snapshot!(say(&["--hidden", "65"]), @"error: invalid value '65' for '--hidden <N>': 65 is not in 1..=64; see --help");
    insta::assert_snapshot!(say(&["--validation-share", "1"]), @"error: --validation-share 1 is outside 0 to 0.9");
    insta::assert_snapshot!(say(&["--learning-rate", "nan"]), @"error: --learning-rate NaN is not a positive number");
    insta::assert_snapshot!(say(&["--activation", "linear"]), @"error: --activation linear makes no network; take tanh or sigmoid");
    insta::assert_snapshot!(say(&["--points", "0"]), @"error: --points 0 leaves nothing to train at; name a recording");
    insta::assert_snapshot!(say(&["--points", "50"]), @"error: 40 points to train on for 101 weights and biases; take more points or fewer hidden neurons");
    insta::assert_snapshot!(say(&["--figure", "inverse.json"]), @"error: two outputs go to inverse.json; name different ones");
    insta::assert_snapshot!(say(&["missing.csv"]), @"error: missing.csv: no such file; check the path");
}

#[test]
fn a_recording_is_trained_at_once() {
    let folder = folder_with(&model_json(Change::None));
    let noisy = |row: u32| f64::from(row * 7919 % 101) / 101.0;
    let row = |row: u32| {
        let phase = f64::from(row) * 0.0628;
        let (pressure_kpa, length_mm) = (250.0 + 150.0 * phase.sin() + noisy(row), 240.0 + 10.0 * (0.7 * phase).sin());
        format!("{:.2},{pressure_kpa:.3},{length_mm:.3},{:.3}\n", f64::from(row) * 0.01, 300.0 + noisy(row))
    };
    for (name, rows) in [("log.csv", 0..1000), ("part.csv", 200..700)] {
        let rows: String = rows.map(row).collect();
        std::fs::write(folder.path().join(name), format!("time_s,pressure_kPa,length_mm,force_N\n{rows}")).unwrap();
    }
    let said = refused(folder.path(), &train(folder.path(), &["log.csv", "part.csv"]));
    insta::assert_snapshot!(said, @"error: part.csv: has the same samples as log.csv; a recording counts once: leave one of them out");
}
