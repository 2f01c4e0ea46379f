//! Effects that are concealed, and what is said of them.

use pam_artifact::diagnosis::Verdict;
use pam_artifact::{DiagnosisArtifact, ModelArtifact};
use pam_virtual_bench::Concealed;
use std::fmt::Write as _;

use crate::desk::{Desk, HELD, LOGS, MODEL_SCHEMA, SCHEMA};

/// Residual of the programs after the diagnosis on a held-out recording, root mean square in N.
fn predicted_rmse_n(desk: &Desk, model: &ModelArtifact) -> f64 {
    let prepared = pam_identification::predict::prepare(desk.recording("multisine.csv"), model).unwrap();
    let augmented = model.augmented_model().elsewhere();
    let found = pam_identification::evaluate::evaluate_augmented(&[prepared], &augmented, model.direction).unwrap();
    found.together.unwrap().rmse_n
}

fn finds(desk: &Desk, id: &str, folder_tag: &str) {
    let files = format!("--out diagnosis.json --out-model augmented.json --report {folder_tag}.html");
    let (diagnosis, model) = desk.diagnosed(&format!("{LOGS} --model model.json {HELD} {files}"), 0);
    let named: Vec<&str> = diagnosis.effects.iter().map(|effect| effect.id.as_str()).collect();
    assert_eq!(named.first(), Some(&id), "{}", diagnosis.statement);
    assert!(!diagnosis.regions.is_empty());
    let held = diagnosis.fit.holdout.unwrap();
    assert!(held.rmse_after_n < 0.7 * held.rmse_before_n, "{held:?}");
    // The model that was written is the one that was judged, and its values are those of the diagnosis.
    let predicted_n = predicted_rmse_n(desk, &model);
    assert!((predicted_n - held.rmse_after_n).abs() < 1e-9 * predicted_n, "{predicted_n} {held:?}");
    assert_eq!(model.fit.validation.unwrap().rmse_n, held.rmse_after_n);
    let has_name = |id: &str| id != "static-map" && id != "empirical";
    assert_eq!(model.effects.iter().filter(|effect| has_name(&effect.id)).count(), named.len());
    assert_eq!(model.tool.name, "pam-diagnose");
    let report = std::fs::read_to_string(desk.path(&format!("{folder_tag}.html"))).unwrap();
    assert!(report.contains(&diagnosis.effects[0].separating_test) && report.contains("<svg"));
    // Nothing from elsewhere, and the headline says what the artifact and the cards say.
    assert!(!report.contains("src=") && !report.contains("<link") && report.len() < 1_500_000, "{}", report.len());
    let headline =
        format!("from {:.2} to {:.2} N", diagnosis.fit.estimation.rmse_before_n, diagnosis.fit.estimation.rmse_after_n);
    assert!(diagnosis.statement.contains(&headline) && report.contains(&headline), "{}", diagnosis.statement);
    assert!(
        report.contains("Base parameters before and after") && report.contains("<pre class=\"command\">pam-diagnose ")
    );
}

#[test]
fn presliding_that_was_concealed_is_named_and_pays_on_what_was_held_out() {
    finds(Desk::presliding(), "presliding-hysteresis", "presliding");
}

#[test]
fn a_threshold_pressure_that_was_concealed_is_named_and_pays_on_what_was_held_out() {
    finds(&Desk::with(&[Concealed::new("threshold-pressure", 1.0)]), "threshold-pressure", "threshold");
}

#[test]
fn a_mass_that_knocks_is_confirmed_by_a_chirp() {
    let desk = Desk::with(&[Concealed::new("inertia", 6.0)]);
    let files = "--out diagnosis.json --out-model augmented.json --next-experiment next.csv --quiet";
    let (diagnosis, _) = desk.diagnosed(&format!("{LOGS} --model model.json {files}"), 0);
    let ids: Vec<&str> = diagnosis.effects.iter().map(|effect| effect.id.as_str()).collect();
    assert_eq!(ids, ["inertia"]);
    let next = diagnosis.next_experiment.unwrap();
    assert_eq!((next.protocol.as_str(), next.separates), ("length-chirp", vec!["inertia".to_owned()]));
    assert!(next.separation_n > 0.3, "{}", next.separation_n);
    assert!(desk.path("next.csv").exists());
}

#[test]
fn a_mass_that_swings_is_named_beside_what_is_slow_and_larger() {
    let desk = Desk::plain();
    let (model, _) = ModelArtifact::read(&desk.path("model.json")).unwrap();
    let model = model.augmented_model();
    for file in 0..4 {
        let mut csv = "time_s,pressure_kPa,length_mm,force_N\n".to_owned();
        for row in 0..6000 {
            let time_s = 0.01 * f64::from(row);
            // It swings at two frequencies: at one alone a mass is as good as a stiffness.
            let [one, two] = [1.0 + 0.1 * f64::from(file), 2.5].map(|hz| std::f64::consts::TAU * hz);
            let length_m = 0.23 + 6e-3 * (one * time_s).sin() + 8e-4 * (two * time_s).sin();
            let speed = 6e-3 * one * (one * time_s).cos() + 8e-4 * two * (two * time_s).cos();
            let pulled_n = -6e-3 * one.powi(2) * (one * time_s).sin() - 8e-4 * two.powi(2) * (two * time_s).sin();
            let pressure_pa = 2e5 + 6e4 * (0.3 * time_s + f64::from(file)).sin();
            let misfit_n = 1.5e-9 * (pressure_pa - 2e5).powi(2);
            let force_n = model.settled_force_n(pressure_pa, length_m, -speed.signum()) + 6.0 * pulled_n + misfit_n;
            let wobble = f64::from(row * 7919 % 1013) / 506.0 - 1.0;
            writeln!(csv, "{time_s:.2},{:.3},{:.4},{:.3}", 1e-3 * pressure_pa, 1e3 * length_m, force_n + 0.2 * wobble)
                .unwrap();
        }
        desk.file(&format!("swung-{file}.csv"), csv);
    }
    let files =
        "swung-0.csv swung-1.csv swung-2.csv --holdout swung-3.csv --out diagnosis.json --out-model augmented.json";
    let (diagnosis, _) = desk.diagnosed(&format!("{files} --model model.json --quiet"), 1);
    let mass = diagnosis.effects.iter().find(|effect| effect.id == "inertia").expect(&diagnosis.statement);
    let mass_kg = mass.parameters.iter().find(|parameter| parameter.name == "mass_kg").unwrap().value;
    assert!((mass_kg / 6.0 - 1.0).abs() < 0.1, "{:?}", mass.parameters);
    let held = diagnosis.fit.holdout.unwrap();
    assert!(held.rmse_all_after_n < held.rmse_all_before_n, "{held:?}");
    // It is one of those that may be named.
    let (diagnosis, _) = desk.diagnosed(&format!("{files} --model model.json --max-effects 1 --quiet"), 1);
    let ids: Vec<&str> = diagnosis.effects.iter().map(|effect| effect.id.as_str()).collect();
    assert_eq!(ids, ["inertia"]);
}

#[test]
fn a_length_that_is_held_says_nothing_of_its_delay() {
    let desk = Desk::plain();
    let (model, _) = ModelArtifact::read(&desk.path("model.json")).unwrap();
    let model = model.augmented_model();
    // White noise of a sort.
    let noise = |row: i32, channel: i32| {
        let wild = (f64::from(row * 4 + channel) * 12.9898).sin() * 43758.5453;
        wild - wild.floor() - 0.5
    };
    for (file, length_mm) in [240.0, 232.0, 224.0, 216.0].into_iter().enumerate() {
        let mut csv = "time_s,pressure_kPa,length_mm,force_N\n".to_owned();
        for row in 0..4000 {
            let time_s = 0.01 * f64::from(row);
            // Slow and fast together: at one rate alone a delay is as good as friction.
            let pressure_kpa = |time_s: f64| 250.0 - 100.0 * (0.7 * time_s).cos() - 90.0 * (4.3 * time_s).cos();
            let force_n = model.settled_force_n(1e3 * pressure_kpa(time_s), 1e-3 * length_mm, 0.0);
            writeln!(
                csv,
                "{time_s:.2},{:.3},{:.4},{:.3}",
                pressure_kpa(time_s - 0.02) + 0.3 * noise(row, 0),
                length_mm + 0.02 * noise(row, 1),
                force_n + noise(row, 2)
            )
            .unwrap();
        }
        desk.file(&format!("held-{file}.csv"), csv);
    }
    let files = "held-0.csv held-1.csv held-2.csv held-3.csv";
    let (diagnosis, model) = desk.diagnosed(
        &format!("{files} --model model.json --out diagnosis.json --out-model augmented.json --max-effects 1 --quiet"),
        0,
    );
    assert_eq!(diagnosis.effects[0].id, "channel-delay");
    let parameters = &model.effects[0].parameters;
    assert!((parameters[0].value - 0.02).abs() < 1e-3, "{parameters:?}");
    assert_eq!(parameters[1].value, 0.0, "{parameters:?}");
    assert!(parameters[1].stderr.is_none_or(|stderr_s| stderr_s > 5e-4), "{parameters:?}");
}

#[test]
fn where_nothing_is_missing_nothing_is_named() {
    let desk = Desk::plain();
    let files = "--out diagnosis.json --out-model augmented.json --report plain.html --next-experiment next.csv";
    let (diagnosis, model) = desk.diagnosed(&format!("{LOGS} --model model.json {HELD} {files}"), 0);
    assert_eq!(diagnosis.verdict, Verdict::Consistent);
    assert!(diagnosis.effects.is_empty() && diagnosis.regions.is_empty() && model.effects.is_empty());
    assert!(!desk.path("next.csv").exists(), "nothing is in question");
}

#[test]
fn a_diagnosed_model_may_be_diagnosed_again() {
    let desk = Desk::with(&[Concealed::new("presliding-hysteresis", 1.0)]);
    let files = "--out diagnosis.json --out-model augmented.json --quiet";
    let (first, model) = desk.diagnosed(&format!("{LOGS} --model model.json {files}"), 0);
    desk.file("once.json", serde_json::to_vec(&model).unwrap());
    let (second, again) = desk.diagnosed(&format!("{LOGS} --model once.json {files}"), 0);
    assert_eq!(first.effects[0].id, second.effects[0].id);
    assert!(second.warnings.iter().any(|warning| warning.contains("weighed anew")), "{:?}", second.warnings);
    let values = |model: &ModelArtifact| -> Vec<f64> { model.parameters.iter().map(|entry| entry.value).collect() };
    for (once, twice) in values(&model).into_iter().zip(values(&again)) {
        assert!((once - twice).abs() <= 1e-3 * once.abs(), "{once} {twice}");
    }
}

#[test]
fn the_same_inputs_give_the_same_bytes_on_any_number_of_threads() {
    let desk = Desk::presliding();
    let of = |threads: usize| {
        let names = ["d.json", "m.json", "r.html", "n.csv"].map(|name| format!("{threads}-{name}"));
        let [diagnosis, model, report, next] = &names;
        let output = desk.run(&format!(
            "{LOGS} --model model.json {HELD} --threads {threads} --quiet --out {diagnosis} --out-model {model} --report \
             {report} --next-experiment {next}"
        ));
        assert!(matches!(output.status.code(), Some(0 | 1)));
        assert!(output.stdout.is_empty() && output.stderr.is_empty());
        names.map(|name| std::fs::read(desk.path(&name)).unwrap())
    };
    assert!(of(1) == of(2));
}

#[test]
fn the_artifacts_obey_their_schemas_and_one_goes_to_standard_output() {
    let desk = Desk::presliding();
    let output = desk.run(&format!("{LOGS} --model model.json {HELD} --out - --out-model schema-model.json --quiet"));
    let artifact: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(desk.run("--schema").stdout == SCHEMA.as_bytes(), "the published schema is stale; run scripts/schemas");
    jsonschema::validate(&serde_json::from_str(SCHEMA).unwrap(), &artifact).unwrap();
    let model: serde_json::Value =
        serde_json::from_slice(&std::fs::read(desk.path("schema-model.json")).unwrap()).unwrap();
    jsonschema::validate(&serde_json::from_str(MODEL_SCHEMA).unwrap(), &model).unwrap();
    assert!(!model["effects"].as_array().unwrap().is_empty());
    assert_eq!(artifact["schema"], "pam-diagnosis/1");
    assert_eq!(artifact["inputs"].as_array().unwrap().len(), 5);
    assert_eq!(
        artifact["isolability"]["ids"].as_array().unwrap().len(),
        artifact["candidates"].as_array().unwrap().len()
    );
}

#[test]
fn an_effect_that_is_excluded_is_not_named() {
    let desk = Desk::presliding();
    let arguments = format!("{LOGS} --model model.json --exclude presliding-hysteresis --out - --quiet");
    let artifact: DiagnosisArtifact = serde_json::from_slice(&desk.run(&arguments).stdout).unwrap();
    assert!(artifact.effects.iter().all(|effect| effect.id != "presliding-hysteresis"));
    assert!(artifact.candidates.iter().all(|candidate| candidate.id != "presliding-hysteresis"));
    assert_eq!(artifact.config.excluded, ["presliding-hysteresis"]);
}

#[test]
fn a_limit_of_what_matters_makes_a_mismatch_consistent() {
    let desk = Desk::presliding();
    let arguments = format!("{LOGS} --model model.json --matters-above-n 500 --out - --quiet");
    let artifact: DiagnosisArtifact = serde_json::from_slice(&desk.run(&arguments).stdout).unwrap();
    assert_eq!(artifact.verdict, Verdict::Consistent);
}

#[test]
fn what_could_be_told_apart_is_a_matrix_on_standard_output() {
    let desk = Desk::plain();
    let output = desk.run(&format!("{LOGS} --model model.json --isolability --quiet"));
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("Distinguishability") && text.contains("threshold-pressure"), "{text}");
}

#[test]
fn a_check_writes_nothing() {
    let desk = Desk::plain();
    let output = desk.run(&format!("{LOGS} --model model.json {HELD} --check --out refused.json"));
    assert_eq!(output.status.code(), Some(0));
    assert!(!desk.path("refused.json").exists());
    assert!(String::from_utf8(output.stderr).unwrap().ends_with("inputs are fine; nothing was diagnosed (--check)\n"));
}
