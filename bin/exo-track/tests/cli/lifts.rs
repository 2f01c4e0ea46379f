//! Lifts, and those that are refused before they begin.

use std::path::PathBuf;
use std::process::Command;

use crate::folder::{CONFIG, MODEL, SCHEMA, folder, refused, run};

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
