//! The program as a person meets it.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// A model whose every value is known, so that its forces can be computed by hand: gas and a constant alone.
const MODEL: &str = include_str!("data/model.json");

struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("model.json"), MODEL).unwrap();
        let log = root().join("datasets/bench-nominal/multisine.csv");
        std::fs::copy(log, folder.path().join("log.csv")).unwrap();
        Self { folder }
    }

    fn file(&self, name: &str, content: &str) -> &Self {
        std::fs::write(self.folder.path().join(name), content).unwrap();
        self
    }

    fn run(&self, arguments: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pam-predict"))
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
        assert!(!self.folder.path().join("out.csv").exists(), "an output was written");
        let errors: Vec<&str> = stderr.lines().filter(|line| line.starts_with("error: ")).collect();
        assert_eq!(errors.len(), 1, "{stderr}");
        errors[0].to_owned()
    }
}

#[test]
fn adds_the_modelled_force_and_the_residual_to_every_row() {
    let bench = Bench::new();
    let output = bench.run("log.csv --model model.json --out - --quiet");
    let text = String::from_utf8(output.stdout).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("time_s,pressure_kPa,length_mm,force_N,force_model_N,residual_N"));
    let mut rows = 0;
    for line in lines {
        let [_, p, l, f, model, residual]: [f64; 6] =
            line.split(',').map(|field| field.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap();
        // π r₀² p [3 (1 - ε)² / tan² α₀ - 1 / sin² α₀] + 2 N, with r₀ = 10 mm, α₀ = 25°, L₀ = 267 mm.
        let angle = 25.0_f64.to_radians();
        let reach = l / 267.0;
        let expected =
            std::f64::consts::PI * 0.1 * p * (3.0 * reach * reach / angle.tan().powi(2) - 1.0 / angle.sin().powi(2))
                + 2.0;
        assert!((model - expected).abs() < 1e-3 + 1e-6 * expected.abs(), "{line}: {expected}");
        assert!((f - model - residual).abs() < 2e-4, "{line}");
        rows += 1;
    }
    assert_eq!(rows, 9601);
}

#[test]
fn a_recording_without_force_is_predicted_too() {
    let bench = Bench::new();
    bench.file("short.csv", "time_s,pressure_kPa,length_mm\n0,100,260\n0.01,110,259\n0.02,120,258\n");
    let output = bench.run("short.csv --model model.json --out out.csv");
    assert_eq!(output.status.code(), Some(0));
    let text = std::fs::read_to_string(bench.folder.path().join("out.csv")).unwrap();
    assert_eq!(text.lines().next(), Some("time_s,pressure_kPa,length_mm,force_model_N"));
    let refused = bench.run("short.csv --model model.json --out out.csv --max-rmse-n 1");
    assert_eq!(refused.status.code(), Some(2));
}

/// Name, value and unit.
type Value<'a> = (&'a str, f64, &'a str);

/// The model with effects, each an id with its parameters.
fn with_effects(effects: &[(&str, &[Value<'_>])]) -> String {
    let entries: Vec<String> = effects
        .iter()
        .map(|(id, parameters)| {
            let parameters: Vec<String> = parameters
                .iter()
                .map(|(name, value, unit)| {
                    format!(
                        "{{\"name\": \"{name}\", \"value\": {value:?}, \"unit\": \"{unit}\", \"stderr\": null, \"status\": \"fitted\"}}"
                    )
                })
                .collect();
            format!("{{\"id\": \"{id}\", \"parameters\": [{}]}}", parameters.join(", "))
        })
        .collect();
    MODEL.replace("\"effects\": []", &format!("\"effects\": [{}]", entries.join(", ")))
}

/// Values of a column of a CSV file.
fn column(text: &str, name: &str) -> Vec<f64> {
    let mut lines = text.lines();
    let at = lines.next().unwrap().split(',').position(|column| column == name).unwrap();
    lines.map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

#[test]
fn effects_of_size_zero_change_no_byte() {
    let bench = Bench::new();
    let damping = [("damping_n_s_per_m", 0.0, "N s/m"), ("damping_with_pressure_n_s_per_m", 0.0, "N s/m")];
    let none = with_effects(&[
        ("viscous-damping", &damping),
        ("load-dependent-friction", &[("friction_per_load", 0.0, "1")]),
        ("channel-delay", &[("pressure_delay_s", 0.0, "s"), ("length_delay_s", 0.0, "s")]),
    ]);
    bench.file("none.json", &none);
    let of = |model: &str| bench.run(&format!("log.csv --model {model} --out -"));
    let (plain, augmented) = (of("model.json"), of("none.json"));
    assert_eq!(augmented.status.code(), Some(0), "{}", String::from_utf8_lossy(&augmented.stderr));
    assert!(plain.stdout == augmented.stdout);
    let rmse = |output: &Output| {
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        said.lines().find(|line| line.contains("RMSE")).map(str::to_owned)
    };
    assert!(rmse(&plain).is_some());
    assert_eq!(rmse(&plain), rmse(&augmented));
}

#[test]
fn a_threshold_lowers_the_force_at_low_pressure() {
    let bench = Bench::new();
    let rows: String = (0..200)
        .map(|row| format!("{},{},{}\n", 0.01 * f64::from(row), 2.0 * f64::from(row), 260.0 - 0.05 * f64::from(row)))
        .collect();
    bench.file("ramp.csv", &format!("time_s,pressure_kPa,length_mm\n{rows}"));
    bench.file("threshold.json", &with_effects(&[("threshold-pressure", &[("threshold_pa", 4e4, "Pa")])]));
    let of = |model: &str| {
        let output = bench.run(&format!("ramp.csv --model {model} --out - --quiet"));
        String::from_utf8(output.stdout).unwrap()
    };
    let (plain, behind) = (of("model.json"), of("threshold.json"));
    let hinge_kpa = |excess: f64| 0.5 * (excess + excess.hypot(10.0));
    let pressures = column(&plain, "pressure_kPa");
    let forces = column(&plain, "force_model_N").into_iter().zip(column(&behind, "force_model_N"));
    for (pressure_kpa, (plain_n, behind_n)) in pressures.into_iter().zip(forces).skip(1) {
        // Gas alone pulls, in proportion to the pressure, on top of a constant of 2 N.
        let seen_kpa = hinge_kpa(pressure_kpa - 40.0) - hinge_kpa(-40.0);
        let expected_n = 2.0 + (plain_n - 2.0) * seen_kpa / pressure_kpa;
        assert!((behind_n - expected_n).abs() < 1e-3, "{pressure_kpa}: {behind_n} {expected_n}");
    }
}

#[test]
fn what_happened_once_is_left_out_and_a_delay_moves_a_channel() {
    let bench = Bench::new();
    let step = [("recording", 0.0, "1"), ("instant_s", 0.0, "s"), ("step_n", 50.0, "N")];
    bench.file("step.json", &with_effects(&[("force-step", &step)]));
    let output = bench.run("log.csv --model step.json --out -");
    assert!(output.stdout == bench.run("log.csv --model model.json --out -").stdout);
    let left_out =
        |ids: &str| format!("left out, as they act only in the recordings that the model was fitted to: {ids}");
    assert!(String::from_utf8(output.stderr).unwrap().contains(&left_out("force-step")));
    let threshold = with_effects(&[("threshold-pressure", &[("threshold_pa", 4e4, "Pa")])]);
    let id = "\"id\": \"threshold-pressure\"";
    bench.file("fitted.json", &threshold.replace(id, &format!("{id}, \"only_as_fitted\": true")));
    let fitted = bench.run("log.csv --model fitted.json --out -");
    assert!(fitted.stdout == output.stdout);
    assert!(String::from_utf8(fitted.stderr).unwrap().contains(&left_out("threshold-pressure")));

    // A pressure that rises evenly: 20 ms later it is 4 kPa higher.
    let rows: String =
        (0..400).map(|row| format!("{},{},255\n", 0.01 * f64::from(row), 2.0 + f64::from(row))).collect();
    bench.file("ramp.csv", &format!("time_s,pressure_kPa,length_mm\n{rows}"));
    let delay = [("pressure_delay_s", 0.02, "s"), ("length_delay_s", 0.0, "s")];
    bench.file("late.json", &with_effects(&[("channel-delay", &delay)]));
    let of = |model: &str| {
        let output = bench.run(&format!("ramp.csv --model {model} --out - --quiet"));
        column(&String::from_utf8(output.stdout).unwrap(), "force_model_N")
    };
    let (plain_n, late_n) = (of("model.json"), of("late.json"));
    for row in 10..390 {
        assert!((late_n[row] - plain_n[row + 2]).abs() < 1e-3, "{row}: {} {}", late_n[row], plain_n[row + 2]);
    }
}

#[test]
fn a_residual_above_the_limit_is_rejected_and_still_written() {
    let bench = Bench::new();
    let output = bench.run("log.csv --model model.json --out out.csv --max-rmse-n 1");
    assert_eq!(output.status.code(), Some(1));
    assert!(bench.folder.path().join("out.csv").exists());
    assert!(String::from_utf8(output.stderr).unwrap().contains("rejected: RMSE"));
    assert_eq!(bench.run("log.csv --model model.json --out out.csv --max-rmse-n 1000").status.code(), Some(0));
}

#[test]
fn leaving_the_model_s_domain_is_said() {
    let bench = Bench::new();
    let output = bench.run("log.csv --model model.json --out out.csv");
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("pressure runs from") && said.contains("the force is extrapolated"), "{said}");
}

#[test]
fn every_bad_input_gets_one_line_with_the_remedy() {
    let bench = Bench::new();
    bench.file("diagnosis.json", "{\"schema\": \"pam-diagnosis/1\"}");
    bench.file("earlier.json", &MODEL.replace("pam-model/1", "pam-model/0"));
    bench.file("later.json", &MODEL.replace("pam-model/1", "pam-model/9"));
    bench.file("broken.json", &MODEL[..MODEL.len() / 2]);
    bench.file("empty.json", "");
    bench.file("shape.json", &MODEL.replacen("\"name\": \"k2\"", "\"name\": \"k1\"", 1));
    bench.file("soft.json", &MODEL.replace("1e15", "-3e9"));
    bench.file("odd.json", &MODEL.replacen("\"form\"", "\"shape\"", 1));
    bench.file("gears.json", &with_effects(&[("stribek", &[])]));
    let cases = [
        ("log.csv --model none.json --out out.csv", "cannot read none.json: no such file; check the path"),
        (
            "log.csv --model diagnosis.json --out out.csv",
            "diagnosis.json: schema is \"pam-diagnosis/1\", expected \"pam-model/1\"; write it with pam-identify",
        ),
        (
            "log.csv --model later.json --out out.csv",
            "later.json: schema is \"pam-model/9\", expected \"pam-model/1\"; a newer version wrote it; update the programs, \
             or write it anew with pam-identify",
        ),
        (
            "log.csv --model earlier.json --out out.csv",
            "earlier.json: schema is \"pam-model/0\", expected \"pam-model/1\"; an older version wrote it; write it anew with \
             pam-identify",
        ),
        (
            "log.csv --model gears.json --out out.csv",
            "gears.json: effect \"stribek\" is unknown; the nearest are stribeck, slack, inertia; write the artifact anew with \
             its program",
        ),
        (
            "log.csv --model broken.json --out out.csv",
            "broken.json:73:10: EOF while parsing a value; expected a pam-model/1 artifact",
        ),
        (
            "log.csv --model empty.json --out out.csv",
            "empty.json:1:0: EOF while parsing a value; expected a pam-model/1 artifact",
        ),
        (
            "log.csv --model shape.json --out out.csv",
            "shape.json: parameter k1 stands there twice; write the artifact anew with its program",
        ),
        (
            "log.csv --model soft.json --out out.csv",
            "soft.json: strand_modulus is -3000000000, which no strand has; write the artifact anew with its program",
        ),
        (
            "log.csv --model odd.json --out out.csv",
            "odd.json:28:8: unknown field `shape`, expected one of `schema`, `tool`, `inputs`, `config`, `seed`, `muscle_name`, `geometry`, `strand_modulus_pa`, `form`, `parameters`, `composites`, `effects`, `correlation`, `fit`, `domain`, `direction`, `standstill_laws`, `quality`, `search`, `unbounded`, `warnings`; expected a pam-model/1 artifact",
        ),
        ("none.csv --model model.json --out out.csv", "none.csv: no such file; check the path"),
        (
            "log.csv --model model.json --out log.csv",
            "cannot write log.csv: it is also an input, which the run would destroy; name another",
        ),
        (
            "log.csv --model model.json",
            "the following required arguments were not provided: --out <PREDICTED.csv>; see --help",
        ),
    ];
    for (arguments, expected) in cases {
        assert_eq!(bench.refusal(arguments), format!("error: {expected}"), "{arguments}");
    }
}

/// The shipped recording with every row changed: time s, pressure kPa, length mm, force N in and out.
fn reworked(header: &str, change: impl Fn(usize, [f64; 4]) -> [f64; 4]) -> String {
    let log = std::fs::read_to_string(root().join("datasets/bench-nominal/multisine.csv")).unwrap();
    let mut text = format!("{header}\n");
    for (index, line) in log.lines().skip(1).enumerate() {
        let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let [t, p, l, f] = change(index, [fields[0], fields[1], fields[2], fields[3]]);
        text.push_str(&format!("{t},{p},{l},{f}\n"));
    }
    text
}

const HEADER: &str = "time_s,pressure_kPa,length_mm,force_N";

#[test]
fn a_recording_in_other_units_is_refused_and_none_of_its_samples_is_counted_as_agreement() {
    let bench = Bench::new();
    bench.file("pascal.csv", &reworked(HEADER, |_, [t, p, l, f]| [t, 1e3 * p, l, f]));
    bench.file("meters.csv", &reworked("time_s,pressure_kPa,length_m,force_N", |_, row| row));
    for (log, channel) in [("pascal.csv", "pressure"), ("meters.csv", "length")] {
        let said = bench.refusal(&format!("{log} --model model.json --out out.csv"));
        assert!(said.contains(&format!("{log}: {channel} reaches")), "{said}");
    }
    let said = bench.refusal("meters.csv --model model.json --out out.csv --accept-implausible");
    assert!(said.contains("meters.csv: the modelled force is no number in"), "{said}");
    assert!(said.contains("first at") && said.contains("are straight there"), "{said}");
}

#[test]
fn a_length_beyond_the_strands_is_located_among_samples_that_count() {
    let bench = Bench::new();
    // The strands are 294.6 mm long.
    let text = reworked(HEADER, |row, [t, p, l, f]| [t, p, if row >= 5000 { 295.0 + 1e-3 * row as f64 } else { l }, f]);
    bench.file("long.csv", &text);
    let said = bench.refusal("long.csv --model model.json --out out.csv --accept-implausible");
    assert!(said.contains("300.") && said.contains("mm)") && said.contains("first at 50.000 s"), "{said}");
    // Without a force every row counts.
    bench.file("free.csv", "time_s,pressure_kPa,length_mm\n0,100,260\n0.01,100,295\n0.02,100,260\n");
    let said = bench.refusal("free.csv --model model.json --out out.csv --accept-implausible");
    assert!(said.contains("no number in 1 of 3"), "{said}");
}

#[test]
fn an_instrument_that_explains_what_the_model_misses_is_named() {
    let bench = Bench::new();
    let forces = {
        let output = bench.run("log.csv --model model.json --out - --quiet");
        column(&String::from_utf8(output.stdout).unwrap(), "force_model_N")
    };
    // The model's own force, as other instruments read it.
    bench.file("own.csv", &reworked(HEADER, |row, [t, p, l, _]| [t, p, l, forces[row]]));
    bench.file("gain.csv", &reworked(HEADER, |row, [t, p, l, _]| [t, p, l, 1.3 * forces[row]]));
    bench.file("zero.csv", &reworked(HEADER, |row, [t, p, l, _]| [t, p + 30.0, l, forces[row]]));
    let said = |log: &str| {
        let output = bench.run(&format!("{log} --model model.json --out out.csv"));
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(!said("own.csv").contains("misses this recording"));
    let gain = said("gain.csv");
    assert!(gain.contains("gain.csv: the model misses this recording by"), "{gain}");
    assert!(gain.contains("the force reads 1.300 times what it should"), "{gain}");
    assert!(said("zero.csv").contains("the pressure reads 30.0"), "{}", said("zero.csv"));
}

#[test]
fn a_limit_is_a_number_above_zero() {
    let bench = Bench::new();
    for limit in ["nan", "-1", "0", "inf", "two"] {
        let said = bench.refusal(&format!("log.csv --model model.json --out out.csv --max-rmse-n {limit}"));
        assert!(said.contains("expected a number above 0") && !said.contains("-- -1"), "{said}");
    }
}

/// The published schema.
const SCHEMA: &str = include_str!("../../../crates/artifact/schemas/pam-prediction-1.json");

#[test]
fn metrics_obey_their_schema_and_tell_counted_from_all_samples() {
    let bench = Bench::new();
    let output = bench.run("log.csv --model model.json --metrics metrics.json --figure p.svg --max-rmse-all-n 1");
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("rejected: RMSE over all samples,") && said.contains("--max-rmse-all-n 1"), "{said}");
    let metrics: serde_json::Value =
        serde_json::from_slice(&std::fs::read(bench.folder.path().join("metrics.json")).unwrap()).unwrap();
    let printed = bench.run("--schema").stdout;
    assert!(printed == SCHEMA.as_bytes(), "the published schema is stale; run scripts/schemas");
    jsonschema::validate(&serde_json::from_str(SCHEMA).unwrap(), &metrics).unwrap();
    let number = |of: &str, name: &str| metrics[of][name].as_f64().unwrap();
    assert!(number("counted", "n_samples") < number("all", "n_samples"));
    assert_eq!(metrics["all"]["n_samples"], metrics["n_rows"]);
    assert_eq!(metrics["accepted"], false);
    // By hand from the rows that are written.
    let rows = String::from_utf8(bench.run("log.csv --model model.json --out - --quiet").stdout).unwrap();
    let residuals = column(&rows, "residual_N");
    let rmse_n = (residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64).sqrt();
    assert!((number("all", "rmse_n") - rmse_n).abs() < 1e-4 * rmse_n, "{} {rmse_n}", number("all", "rmse_n"));
    let band_n = number("band", "half_width_n");
    let inside = residuals.iter().filter(|r| r.abs() <= band_n).count() as f64 / residuals.len() as f64;
    // This model has no uncertainty of its parameters, so that the band is as wide everywhere.
    assert!((number("all", "inside_band") - inside).abs() < 1e-3, "{inside}");
    let svg = std::fs::read_to_string(bench.folder.path().join("p.svg")).unwrap();
    assert!(svg.contains("log.csv: measured and modelled") && svg.len() < 200_000);
}

#[test]
fn where_the_model_extrapolates_is_a_share_of_the_samples() {
    let bench = Bench::new();
    let narrow: serde_json::Value = serde_json::from_str(MODEL).unwrap();
    let mut narrow = narrow;
    narrow["domain"]["pressure_pa"] = serde_json::json!([0.0, 1e9]);
    narrow["domain"]["length_m"] = serde_json::json!([0.0, 1.0]);
    bench.file("wide.json", &narrow.to_string());
    let share = |model: &str| {
        bench.run(&format!("log.csv --model {model} --metrics metrics.json --quiet"));
        let text = std::fs::read(bench.folder.path().join("metrics.json")).unwrap();
        let metrics: serde_json::Value = serde_json::from_slice(&text).unwrap();
        metrics["extrapolation"]["share"].as_f64().unwrap()
    };
    assert_eq!(share("wide.json"), 0.0);
    assert!(share("model.json") > 0.0);
}

#[test]
#[expect(clippy::print_stdout, reason = "a skipped test must be seen")]
fn a_figure_is_what_its_ending_says() {
    let bench = Bench::new();
    let begins = |name: &str, bytes: &[u8]| {
        let output = bench.run(&format!("log.csv --model model.json --figure {name}"));
        let said = String::from_utf8(output.stderr).unwrap();
        if said.contains("none is installed") {
            return println!("skipped: no font is installed");
        }
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(std::fs::read(bench.folder.path().join(name)).unwrap().starts_with(bytes), "{name}");
    };
    begins("a.png", b"\x89PNG");
    begins("a.pdf", b"%PDF-");
    begins("a.svg", b"<svg");
    let said = bench.refusal("log.csv --model model.json --figure a.bmp");
    assert!(said.contains("figures are SVG, PNG or PDF; name it a.png"), "{said}");
}

#[test]
fn what_is_wrong_with_the_recording_itself_is_said() {
    let bench = Bench::new();
    let header = "time_s,pressure_kPa,length_mm,force_N";
    let said = |change: &dyn Fn(usize, [f64; 4]) -> [f64; 4]| {
        bench.file("bad.csv", &reworked(header, change));
        let output = bench.run("bad.csv --model model.json --out out.csv");
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stderr).unwrap()
    };
    let hum = said(&|_, [t, p, l, f]| [t, p, l, f + 200.0 * (62.8 * t).sin()]);
    assert!(hum.contains("bad.csv: the noise of its sensors alone leaves"), "{hum}");
    let clipped = said(&|_, [t, p, l, f]| [t, p, l, f.min(500.0)]);
    assert!(clipped.contains("force is stuck at its high end (500.0000 N)"), "{clipped}");
    let as_is = said(&|_, values| values);
    assert!(!as_is.contains("stuck") && !as_is.contains("noise of its sensors"), "{as_is}");
}
