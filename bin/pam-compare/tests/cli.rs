//! The program as a person meets it: messages, exit codes, files that are there or not.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A model whose every value is known: gas and a constant alone.
const MODEL: &str = include_str!("../../pam-predict/tests/data/model.json");
/// The published schema.
const SCHEMA: &str = include_str!("../../../crates/artifact/schemas/pam-comparison-1.json");

/// A folder with two models and a recording that follows the second.
struct Desk {
    folder: tempfile::TempDir,
}

impl Desk {
    fn new() -> Self {
        let desk = Self { folder: tempfile::tempdir().unwrap() };
        desk.file("a.json", MODEL);
        desk.file("b.json", &with_k3("4.0"));
        desk.file("log.csv", &recording(4.0, 4000));
        desk
    }

    fn file(&self, name: &str, content: &str) {
        std::fs::write(self.path(name), content).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, arguments: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pam-compare"))
            .args(arguments.split(' '))
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .output()
            .unwrap()
    }

    fn refusal(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(!self.path("out.json").exists(), "an output was written");
        let errors: Vec<&str> = stderr.lines().filter(|line| line.starts_with("error: ")).collect();
        assert_eq!(errors.len(), 1, "{stderr}");
        errors[0].to_owned()
    }
}

fn with_k3(value: &str) -> String {
    let at = MODEL.find("\"name\": \"k3\"").unwrap();
    let from = at + MODEL[at..].find("\"value\": ").unwrap() + "\"value\": ".len();
    let to = from + MODEL[from..].find(',').unwrap();
    format!("{}{value}{}", &MODEL[..from], &MODEL[to..])
}

/// A muscle of the model's geometry that obeys it with `k3_n`, with noise; pressure and length move slowly.
fn recording(k3_n: f64, n: usize) -> String {
    let angle = 25.0_f64.to_radians();
    let mut text = "time_s,pressure_kPa,length_mm,force_N\n".to_owned();
    let mut state = 1_u64;
    for row in 0..n {
        let time_s = row as f64 * 0.01;
        let pressure_kpa = 200.0 + 80.0 * (0.9 * time_s).sin();
        let length_mm = 250.0 + 10.0 * (0.5 * time_s).sin();
        let reach = length_mm / 267.0;
        let gas = std::f64::consts::PI
            * 0.1
            * pressure_kpa
            * (3.0 * reach * reach / angle.tan().powi(2) - angle.sin().powi(-2));
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let noise = 4.0 * ((state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5);
        text += &format!("{time_s:.2},{pressure_kpa:.3},{length_mm:.4},{:.3}\n", gas + k3_n + noise);
    }
    text
}

#[test]
fn the_better_model_is_named_with_the_interval_and_the_exit_code() {
    let desk = Desk::new();
    let output = desk.run("a.json b.json log.csv --out out.json");
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    assert!(stderr.starts_with("B is better: RMSE "), "{stderr}");
    assert!(stderr.lines().all(|line| line.chars().count() <= 80), "{stderr}");
    let artifact: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(desk.path("out.json")).unwrap()).unwrap();
    let schema = serde_json::from_str(SCHEMA).unwrap();
    jsonschema::validate(&schema, &artifact).unwrap();
    assert_eq!(artifact["outcome"], "b");
    let counted = &artifact["together"]["counted"];
    // Noise of 4/√12 N, and beside it the 2 N that a lacks.
    assert!((counted["rmse_b_n"].as_f64().unwrap() - 1.155).abs() < 0.05, "{counted}");
    assert!((counted["rmse_a_n"].as_f64().unwrap() - 2.31).abs() < 0.05, "{counted}");
    assert!(counted["p_value"].as_f64().unwrap() < 0.01 && counted["interval_n"][1].as_f64().unwrap() < 0.0);
    // The other way round the candidate is worse, and that is a rejection.
    let rejected = desk.run("b.json a.json -- log.csv --out out.json");
    let code = desk.run("b.json a.json --out out.json -- log.csv").status.code();
    assert_eq!((rejected.status.code(), code), (Some(2), Some(1)));
}

#[test]
fn equal_seeds_give_equal_bytes_on_any_number_of_threads() {
    let desk = Desk::new();
    let out = |threads: &str| desk.run(&format!("a.json b.json log.csv --out - --quiet --threads {threads}")).stdout;
    assert!(!out("1").is_empty());
    assert_eq!(out("1"), out("2"));
}

#[test]
fn a_short_recording_says_that_it_is_too_short() {
    let desk = Desk::new();
    desk.file("short.csv", &recording(4.0, 150));
    let output = desk.run("a.json b.json short.csv --accept-implausible");
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    assert!(stderr.contains("Too short to judge") || stderr.contains("B is better"), "{stderr}");
}

#[test]
fn who_was_fitted_to_a_recording_has_an_advantage_and_that_is_said() {
    let desk = Desk::new();
    let sha256 = pam_recording::sha256_hex(recording(4.0, 4000).as_bytes());
    let mut model: serde_json::Value = serde_json::from_str(&with_k3("4.0")).unwrap();
    let input = serde_json::json!({ "path": "log.csv", "sha256": sha256, "role": "estimation" });
    model["inputs"].as_array_mut().unwrap().push(input);
    desk.file("b.json", &model.to_string());
    let stderr = String::from_utf8(desk.run("a.json b.json log.csv").stderr).unwrap();
    assert!(stderr.contains("warning: log.csv: only one of the models was fitted to it"), "{stderr}");
}

#[test]
fn bad_input_gets_one_line_and_no_file() {
    let desk = Desk::new();
    desk.file("bench.toml", "[force]\nunit = \"N\"\ncolumn = \"F\"\n");
    desk.file("empty.csv", "");
    for (arguments, expected) in [
        ("a.json a.json log.csv", "error: a.json and a.json are the same model; name two to compare"),
        ("a.json b.json log.csv log.csv", "error: log.csv: is named twice; name each recording once"),
        (
            "a.json b.json log.csv ./log.csv",
            "error: ./log.csv: has the same samples as log.csv, which is held out as well; leave one of them out",
        ),
        ("log.csv b.json log.csv", "error: log.csv:1:2: this is no JSON; expected a pam-model/1 artifact"),
        ("a.json log.csv log.csv", "error: log.csv:1:"),
        ("a.json c.json log.csv", "error: cannot read c.json: no such file"),
        (
            "a.json b.json log.csv --channels bench.toml",
            "error: log.csv: bench.toml [force] names column \"F\", which the file lacks",
        ),
        ("a.json b.json empty.csv", "error: empty.csv: the file holds no rows"),
        ("a.json b.json log.csv --out a.json", "error: cannot write a.json: it is also an input"),
        ("a.json b.json", "error: the following required arguments were not provided: <LOG>..."),
    ] {
        let arguments =
            if arguments.contains("--out") { arguments.to_owned() } else { format!("{arguments} --out out.json") };
        let refused = desk.refusal(&arguments);
        assert!(refused.starts_with(expected), "{arguments}: {refused}");
    }
}

#[test]
fn the_published_schema_is_the_one_that_the_program_prints() {
    let output = Desk::new().run("--schema");
    assert_eq!(String::from_utf8(output.stdout).unwrap(), SCHEMA, "run scripts/schemas");
    assert!(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../crates/artifact/schemas/pam-comparison-1.json").is_file()
    );
}
