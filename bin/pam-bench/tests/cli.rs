//! Runs the executable.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The published schema.
const SCHEMA: &str = include_str!("../../../crates/artifact/schemas/pam-bench-truth-1.json");

fn configs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../configs")
}

fn nominal() -> String {
    configs().join("muscle-nominal.toml").to_str().expect("a path of readable characters").to_owned()
}

fn pam_bench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pam-bench")).args(arguments).output().expect("the program starts")
}

/// Records a lift to standard output, with more arguments.
fn lift(arguments: &[&str]) -> Output {
    let muscle = nominal();
    let mut all = vec!["--muscle", &muscle, "--protocol", "lift", "--out", "-"];
    all.extend(arguments);
    pam_bench(&all)
}

fn error_line(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    let text = String::from_utf8_lossy(&output.stderr);
    let errors: Vec<&str> = text.lines().filter(|line| line.starts_with("error: ")).collect();
    assert_eq!(errors.len(), 1, "{text}");
    errors[0].to_owned()
}

#[test]
fn a_log_goes_to_standard_output_and_the_note_beside_it() {
    let output = lift(&[]);
    assert_eq!(output.status.code(), Some(0));
    let log = String::from_utf8(output.stdout).unwrap();
    assert!(log.starts_with("time_s,pressure_kPa,length_mm,force_N\n0.000,"), "{log:.80}");
    let note = String::from_utf8(output.stderr).unwrap();
    assert!(note.starts_with("note: lift: 38 s, about 7600 rows, "), "{note}");
}

#[test]
fn quiet_says_nothing() {
    assert!(lift(&["--quiet"]).stderr.is_empty());
}

#[test]
fn equal_seeds_give_equal_bytes_on_any_number_of_threads() {
    let one = lift(&["--seed", "4", "--threads", "1"]).stdout;
    assert_eq!(one, lift(&["--seed", "4", "--threads", "2"]).stdout);
    assert_ne!(one, lift(&["--seed", "5"]).stdout);
}

#[test]
fn every_muscle_in_configs_passes_every_protocol() {
    let list = pam_bench(&["--list-protocols"]);
    assert_eq!(list.status.code(), Some(0));
    let protocols = String::from_utf8(list.stdout).unwrap();
    assert_eq!(protocols.lines().count(), 15);
    let mut muscles = 0;
    for entry in std::fs::read_dir(configs()).unwrap() {
        let path = entry.unwrap().path();
        if !path.file_name().unwrap().to_str().unwrap().starts_with("muscle-") {
            continue;
        }
        muscles += 1;
        for protocol in protocols.lines().map(|line| line.split_whitespace().next().unwrap()) {
            let output = pam_bench(&["--muscle", path.to_str().unwrap(), "--protocol", protocol, "--check", "--quiet"]);
            assert_eq!(output.status.code(), Some(0), "{}, {protocol}", path.display());
            assert!(output.stdout.is_empty() && output.stderr.is_empty());
        }
    }
    assert!(muscles >= 3);
}

#[test]
fn the_truth_names_parameters_and_sensors_as_its_schema_says() {
    let folder = tempfile::tempdir().unwrap();
    let (log, truth) = (folder.path().join("log.csv"), folder.path().join("truth.json"));
    let muscle = nominal();
    let output = pam_bench(&[
        "--muscle",
        &muscle,
        "--protocol",
        "dwell",
        "--duration-scale",
        "0.01",
        "--set",
        "k1=0.85",
        "--out",
        log.to_str().unwrap(),
        "--truth",
        truth.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(log.exists());
    let truth: serde_json::Value = serde_json::from_slice(&std::fs::read(truth).unwrap()).unwrap();
    assert!(pam_bench(&["--schema"]).stdout == SCHEMA.as_bytes(), "the published schema is stale; run scripts/schemas");
    jsonschema::validate(&serde_json::from_str(SCHEMA).unwrap(), &truth).unwrap();
    assert_eq!(truth["parameters"][0]["value"], 0.85);
    assert_eq!(truth["config"]["protocol_id"], "P14");
}

#[test]
fn a_misspelt_protocol_is_refused_with_the_nearest_name() {
    let output = pam_bench(&["--muscle", &nominal(), "--protocol", "isobaric-triangle", "--out", "-"]);
    let expected = "error: there is no protocol \"isobaric-triangle\"; did you mean \"isobaric-triangles\"?";
    assert_eq!(error_line(&output), expected);
}

#[test]
fn a_misspelt_parameter_is_refused_with_the_nearest_name() {
    let line = error_line(&lift(&["--set", "ruber_friction=1e-3"]));
    assert_eq!(line, "error: --set: the muscle has no parameter \"ruber_friction\"; did you mean \"rubber_friction\"?");
}

#[test]
fn values_out_of_range_are_refused_with_the_range() {
    for (arguments, place) in [
        (["--noise", "-1"], "--noise -1: noise of the pressure channel is -0.5"),
        (["--rate", "0"], "--rate: sampling rate 0 Hz"),
        (["--duration-scale", "0"], "--duration-scale: duration scale 0"),
        (["--highest-pressure", "9000"], "--highest-pressure: highest pressure 9000000 Pa"),
        (["--set", "k1"], "expected NAME=VALUE, as in k1=0.9"),
        (["--set", "k1=high"], "\"high\" is no number"),
        (["--set", "k1=nan"], "k1 = NaN is outside 0 to 2"),
        (["--force-noise-correlation", "1"], "correlation of the force noise is 1"),
        (["--noise", "inf"], "noise of the pressure channel is inf"),
    ] {
        let line = error_line(&lift(&arguments));
        assert!(line.contains(place), "{line}");
    }
}

#[test]
fn a_muscle_may_hang_slack_only_where_that_is_asked_for() {
    let muscle = nominal();
    let ramps = |lowest_tension| {
        let fixed = ["--muscle", &muscle, "--protocol", "isometric-ramps", "--duration-scale", "0.02", "--out", "-"];
        pam_bench(&[fixed.as_slice(), ["--lowest-tension", lowest_tension].as_slice()].concat())
    };
    assert!(error_line(&ramps("5000")).contains("finds this muscle slack: it never pulls 5000 N"));
    let log = String::from_utf8(ramps("-inf").stdout).unwrap();
    assert!(log.lines().any(|line| line.contains(",-6")), "the bladder pushes with some 60 N");
}

#[test]
fn an_output_that_cannot_be_written_is_named_and_nothing_is_left_behind() {
    let folder = tempfile::tempdir().unwrap();
    let truth = folder.path().join("nowhere/truth.json");
    let log = folder.path().join("log.csv");
    let output = pam_bench(&[
        "--muscle",
        &nominal(),
        "--protocol",
        "lift",
        "--out",
        log.to_str().unwrap(),
        "--truth",
        truth.to_str().unwrap(),
    ]);
    assert!(error_line(&output).contains("nowhere"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn the_muscle_file_is_never_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let muscle = folder.path().join("m.toml");
    std::fs::copy(nominal(), &muscle).unwrap();
    let muscle = muscle.to_str().unwrap();
    error_line(&pam_bench(&["--muscle", muscle, "--protocol", "lift", "--out", muscle]));
    assert!(std::fs::read_to_string(muscle).unwrap().contains("rest_length_mm"));
}

#[test]
fn a_missing_muscle_file_is_named() {
    let line = error_line(&pam_bench(&["--muscle", "no-such.toml", "--protocol", "lift", "--out", "-"]));
    assert!(line.contains("no-such.toml"), "{line}");
}

#[test]
fn help_has_an_example_that_works() {
    let help = String::from_utf8(pam_bench(&["--help"]).stdout).unwrap();
    assert!(help.contains("pam-bench --muscle configs/muscle-nominal.toml --protocol isometric-ramps"), "{help}");
}

#[test]
fn every_effect_is_listed_with_one_line() {
    let output = pam_bench(&["--list-effects"]);
    assert_eq!(output.status.code(), Some(0));
    let list = String::from_utf8(output.stdout).unwrap();
    assert_eq!(list.lines().count(), 24);
    assert!(list.lines().any(|line| line.starts_with("stribeck ")));
}

#[test]
fn a_misspelt_effect_is_refused_with_the_nearest_id() {
    let line = error_line(&lift(&["--effect", "stribek"]));
    assert_eq!(line, "error: --effect: there is no effect \"stribek\"; did you mean \"stribeck\"?");
    let line = error_line(&lift(&["--effect", "gearbox"]));
    assert_eq!(line, "error: --effect: there is no effect \"gearbox\"; --list-effects shows all");
}

#[test]
fn concealed_effects_are_in_the_truth_and_not_in_the_columns_of_the_log() {
    let folder = tempfile::tempdir().unwrap();
    let truth = folder.path().join("truth.json");
    let arguments =
        ["--effect", "rubbing-tie:0.5", "--effect", "inertia", "--effect-seed", "9", "--smooth-misfit-n", "0.4"];
    let output = lift(&[arguments.as_slice(), &["--truth", truth.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let log = String::from_utf8(output.stdout).unwrap();
    assert!(log.starts_with("time_s,pressure_kPa,length_mm,force_N\n") && !log.contains('#'));
    assert!(!String::from_utf8_lossy(&output.stderr).contains("rubbing"));
    let truth: serde_json::Value = serde_json::from_slice(&std::fs::read(truth).unwrap()).unwrap();
    jsonschema::validate(&serde_json::from_str(SCHEMA).unwrap(), &truth).unwrap();
    assert_eq!(truth["config"]["effect_seed"], 9);
    assert_eq!(truth["config"]["smooth_misfit_n"], 0.4);
    let tie = &truth["effects"][0];
    assert_eq!((&tie["id"], &tie["severity"]), (&"rubbing-tie".into(), &0.5.into()));
    assert_eq!(tie["place"]["coordinate"], "contraction");
    assert!(tie["parameters"].as_array().unwrap().len() >= 4);
    assert_eq!(truth["effects"][1]["parameters"][0]["unit"], "kg");
}

#[test]
fn a_random_muscle_is_written_as_a_file_that_is_read_again_as_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let muscle = folder.path().join("m.toml");
    let muscle = muscle.to_str().unwrap();
    let (first, second) = (folder.path().join("a.json"), folder.path().join("b.json"));
    let record = |of: &[&str], truth: &Path| -> serde_json::Value {
        let fixed = ["--protocol", "lift", "--out", "-", "--quiet", "--truth", truth.to_str().unwrap()];
        let output = pam_bench(&[of, &fixed].concat());
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&std::fs::read(truth).unwrap()).unwrap()
    };
    let drawn = record(&["--random-muscle", "7", "--write-muscle", muscle], &first);
    let read = record(&["--muscle", muscle], &second);
    for (name, value) in drawn["geometry"].as_object().unwrap() {
        let (drawn, read) = (value.as_f64().unwrap(), read["geometry"][name].as_f64().unwrap());
        assert!((drawn / read - 1.0).abs() < 1e-9, "{name}: {drawn} {read}");
    }
    assert_ne!(drawn["parameters"], read["parameters"]);
    let alone = folder.path().join("alone.toml");
    let output = pam_bench(&["--random-muscle", "7", "--write-muscle", alone.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(std::fs::read(alone).unwrap(), std::fs::read(muscle).unwrap());
}

#[test]
fn force_noise_may_be_colored_with_a_stated_total() {
    let noisy = ["--force-noise-n", "0.3", "--force-noise-correlation", "0.98"];
    assert_eq!(lift(&noisy).status.code(), Some(0));
    let line = error_line(&lift(&["--force-noise-n", "-1"]));
    assert!(line.contains("--force-noise-n: noise of the force channel is -1"), "{line}");
}
