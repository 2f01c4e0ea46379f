//! The program as a person meets it: diagnoses of concealed effects, messages, exit codes, files that are there or not.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

use pam_core::artifact::diagnosis::Verdict;
use pam_core::artifact::model::Loss;
use pam_core::artifact::{DiagnosisArtifact, Input, InputRole, ModelArtifact, Tool};
use pam_core::force::Form;
use pam_core::muscle::MuscleFile;
use pam_core::recording::{ReadOptions, Recording, read_recording};
use pam_identification::fit::FitOptions;
use pam_identification::identify::{Request, check};
use pam_identification::search_space::LATEX_RATIO;
use pam_virtual_bench::{Bench, Concealed, Options, Parameters, TrueMuscle, command};

const FITTED: [&str; 3] = ["minor-loops", "isobaric-triangles", "isometric-ramps"];
const LOGS: &str = "minor-loops.csv isobaric-triangles.csv isometric-ramps.csv";
const HELD: &str = "--holdout multisine.csv";

/// The published schemas of what the program writes.
const SCHEMA: &str = include_str!("../../../crates/core/schemas/pam-diagnosis-1.json");
const MODEL_SCHEMA: &str = include_str!("../../../crates/core/schemas/pam-model-1.json");

fn muscle_file() -> MuscleFile {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    MuscleFile::read(&root.join("configs/muscle-nominal.toml")).unwrap()
}

/// A folder with recordings of the nominal muscle, three to fit and one to hold out, and the model that a fit finds.
struct Desk {
    folder: tempfile::TempDir,
}

impl Desk {
    fn with(concealed: &[Concealed]) -> Self {
        let desk = Self { folder: tempfile::tempdir().unwrap() };
        let MuscleFile { muscle, strand_modulus_pa, .. } = muscle_file();
        let truth = TrueMuscle::new(muscle, strand_modulus_pa, Parameters::nominal());
        let options = Options { duration_scale: 0.2, ..Options::default() };
        for (seed, protocol) in FITTED.into_iter().chain(["multisine"]).enumerate() {
            let command = command(protocol, &truth, &options).unwrap();
            let bench = Bench::new(truth.clone(), command).with_effects(concealed, 1).unwrap();
            let mut csv = Vec::new();
            bench.record(seed as u64 + 1).write_csv(&mut csv).unwrap();
            desk.file(&format!("{protocol}.csv"), csv);
        }
        let model = desk.identified();
        desk.file("model.json", serde_json::to_vec(&model).unwrap());
        desk
    }

    /// Without anything concealed.
    fn plain() -> &'static Self {
        static DESK: OnceLock<Desk> = OnceLock::new();
        DESK.get_or_init(|| Self::with(&[]))
    }

    /// With a bump of 9 N over the contraction in every log, which no effect of the catalogue is.
    fn touched() -> &'static Self {
        static DESK: OnceLock<Desk> = OnceLock::new();
        DESK.get_or_init(|| {
            let desk = Self::with(&[]);
            for name in FITTED.into_iter().chain(["multisine"]) {
                let path = desk.path(&format!("{name}.csv"));
                let touched = touched(&std::fs::read_to_string(&path).unwrap());
                std::fs::write(path, touched).unwrap();
            }
            desk.file("model.json", serde_json::to_vec(&desk.identified()).unwrap());
            desk
        })
    }

    /// With pre-sliding.
    fn presliding() -> &'static Self {
        static DESK: OnceLock<Desk> = OnceLock::new();
        DESK.get_or_init(|| Self::with(&[Concealed::new("presliding-hysteresis", 1.0)]))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn file(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    fn recording(&self, name: &str) -> Recording {
        read_recording(&self.path(name), &ReadOptions::default()).unwrap()
    }

    /// What pam-identify finds.
    fn identified(&self) -> ModelArtifact {
        self.identified_from(&FITTED)
    }

    fn identified_from(&self, names: &[&str]) -> ModelArtifact {
        let request = Request {
            estimation: names.iter().map(|name| self.recording(&format!("{name}.csv"))).collect(),
            validation: Vec::new(),
            muscle: muscle_file(),
            form: Form::Corrected,
            options: FitOptions { n_particles: 30, n_iterations: 60, n_starts: 1, seed: 1, polish: true },
            loss: Loss::Square,
            free: Vec::new(),
            fix: Vec::new(),
            bladder_ratio: LATEX_RATIO,
            length_play_m: None,
            pressure_play_pa: None,
            assumed: pam_core::artifact::model::Assumed::default(),
            accept_implausible: true,
            unbounded: false,
        };
        let checked = check(request).unwrap();
        let config = checked.config();
        let tool = Tool { name: "pam-identify".to_owned(), version: "0.1.0".to_owned() };
        let input = Input { path: "muscle.toml".to_owned(), sha256: "0".repeat(64), role: InputRole::Muscle };
        checked.identify().unwrap().artifact(tool, vec![input], config, 1)
    }

    fn run(&self, arguments: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pam-diagnose"))
            .args(arguments.split(' ').filter(|word| !word.is_empty()))
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .output()
            .unwrap()
    }

    /// Diagnosis and model of a run that must end with `code`; 1 is right as well where something is named and something is left,
    /// which reversals alone bring about.
    fn diagnosed(&self, arguments: &str, code: i32) -> (DiagnosisArtifact, ModelArtifact) {
        let output = self.run(arguments);
        let (diagnosis, _) = DiagnosisArtifact::read(&self.path("diagnosis.json")).unwrap();
        let named = !diagnosis.effects.is_empty();
        let in_part = matches!(diagnosis.verdict, Verdict::ExplainedInPart | Verdict::Unexplained) && named;
        let code = if in_part { 1 } else { code };
        assert_eq!(output.status.code(), Some(code), "{}", String::from_utf8_lossy(&output.stderr));
        let (model, _) = ModelArtifact::read(&self.path("augmented.json")).unwrap();
        (diagnosis, model)
    }

    /// The one line of an error; nothing may have been written.
    fn refusal(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments}: {stderr}");
        assert!(output.stdout.is_empty());
        let written: Vec<String> = std::fs::read_dir(self.folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name.starts_with('.') || name.starts_with("refused"))
            .collect();
        assert!(written.is_empty(), "{arguments}: written {written:?}");
        let errors: Vec<&str> = stderr.lines().filter(|line| line.starts_with("error: ")).collect();
        assert_eq!(errors.len(), 1, "{arguments}: {stderr}");
        errors[0].to_owned()
    }
}

/// What the programs behind the diagnosis predict of a held-out recording, root mean square of the residual in N.
fn predicted_rmse_n(desk: &Desk, model: &ModelArtifact) -> f64 {
    let prepared = pam_identification::predict::prepare(desk.recording("multisine.csv"), model).unwrap();
    let augmented = model.augmented_model().without_events();
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

/// `log` with a bump of 9 N around a contraction of 10 %.
fn touched(log: &str) -> String {
    let (header, rows) = log.split_once('\n').unwrap();
    let column = |word: &str| header.split(',').position(|column| column.contains(word)).unwrap();
    let (length, force) = (column("length"), column("force"));
    let mut text = header.to_owned();
    for row in rows.lines() {
        let mut fields: Vec<String> = row.split(',').map(str::to_owned).collect();
        let contraction = 1.0 - fields[length].parse::<f64>().unwrap() / 267.0;
        let away = ((contraction - 0.1) / 0.04).clamp(-1.0, 1.0);
        let bump_n = 4.5 * (1.0 + (std::f64::consts::PI * away).cos());
        fields[force] = format!("{:.4}", fields[force].parse::<f64>().unwrap() + bump_n);
        text.push('\n');
        text.push_str(&fields.join(","));
    }
    text + "\n"
}

const GUARD: &str = r#"
[[effect]]
id = "touching-guard"
name = "a guard that touches the muscle"
driver = "contraction"
shape = { bump = { center = [0.02, 0.25], width = [0.005, 0.05] } }
amplitude = [-300.0, 300.0]
"#;

#[test]
fn an_effect_of_a_users_own_is_named_and_its_model_works_without_its_file() {
    let desk = Desk::touched();
    desk.file("guard.toml", GUARD);
    let (diagnosis, model) = desk.diagnosed(
        &format!(
            "{LOGS} --model model.json {HELD} --effects guard.toml --out diagnosis.json --out-model augmented.json"
        ),
        0,
    );
    assert_eq!(diagnosis.effects[0].id, "touching-guard");
    assert!((diagnosis.effects[0].parameters[0].value - 0.1).abs() < 3e-3, "{:?}", diagnosis.effects[0]);
    let fit = diagnosis.fit.holdout.unwrap();
    assert!(fit.rmse_after_n < 0.5 * fit.rmse_before_n, "{fit:?}");
    assert!(model.effects.iter().any(|entry| entry.sentence.is_some()));
    let text = String::from_utf8(desk.run("--effects guard.toml --explain touching-guard").stdout).unwrap();
    assert!(text.starts_with("A guard that touches the muscle (touching-guard)\n"), "{text}");
}

#[test]
fn a_file_of_effects_that_cannot_be_used_is_refused_with_the_place() {
    let desk = Desk::plain();
    let refusal = |text: &str| {
        desk.file("own.toml", text);
        let output = desk.run("--effects own.toml --explain all");
        assert_eq!(output.status.code(), Some(2), "{text}");
        String::from_utf8(output.stderr).unwrap()
    };
    let messages = [
        refusal(""),
        refusal("[[effect]]\nid = 3\n"),
        refusal(&GUARD.replace("touching-guard", "slack")),
        refusal(&GUARD.replace("[0.005, 0.05]", "[0.05, 0.005]")),
    ];
    insta::assert_snapshot!(messages.concat(), @r#"
    error: own.toml: it has no [[effect]]; configs/effects/touching-guard.toml shows one
    error: own.toml: line 2, column 6: invalid type: integer `3`, expected a string
    error: own.toml: effect "slack": the id is taken; give it another
    error: own.toml: effect "touching-guard": width is no range; give its ends as [low, high], both above zero
    "#);
}

#[test]
fn every_effect_is_explained_and_drawn() {
    let desk = Desk::plain();
    let list = String::from_utf8(desk.run("--explain all").stdout).unwrap();
    let ids: Vec<&str> = list.lines().skip(2).filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(ids.len(), pam_core::effects::CATALOGUE.len());
    for id in ids {
        let output = desk.run(&format!("--explain {id} --figure {id}.svg --quiet"));
        assert_eq!(output.status.code(), Some(0), "{id}");
        let text = String::from_utf8(output.stdout).unwrap();
        assert!(text.contains(&format!("({id})")), "{text}");
        assert!(["Equation", "Signature", "Confused with", "Test"].iter().all(|title| text.contains(title)), "{text}");
        assert!(text.lines().filter(|line| !line.contains('─')).all(|line| line.chars().count() < 160), "{text}");
        assert!(std::fs::read_to_string(desk.path(&format!("{id}.svg"))).unwrap().starts_with("<svg"));
    }
}

/// Files with every row of the recordings that are fitted changed, as words of a command line.
fn all_reworked(desk: &Desk, tag: &str, change: impl Fn([f64; 4]) -> [f64; 4] + Copy) -> String {
    let names = FITTED.map(|name| {
        let changed = format!("{tag}-{name}.csv");
        desk.file(&changed, reworked(desk, &format!("{name}.csv"), change));
        changed
    });
    names.join(" ")
}

#[test]
fn a_model_that_was_fitted_to_the_recordings_follows_them_as_given() {
    for desk in [Desk::plain(), Desk::presliding()] {
        let files = "--out followed.json --out-model augmented.json --quiet";
        let output = desk.run(&format!("{LOGS} --model model.json {HELD} {files}"));
        assert!(matches!(output.status.code(), Some(0 | 1)));
        let (diagnosis, _) = DiagnosisArtifact::read(&desk.path("followed.json")).unwrap();
        let given = diagnosis.as_given.unwrap();
        assert!(!given.misses && given.instrument.is_none() && given.holdout_missed.is_empty(), "{given:?}");
        // The same fit over the same samples.
        assert!((given.estimation.rmse_n / given.refitted.rmse_n - 1.0).abs() < 0.01, "{given:?}");
        assert!(given.shifts.iter().all(|shift| shift.standard_errors.is_none_or(|errors| errors.abs() < 1.0)));
    }
}

#[test]
fn a_gain_that_changed_after_the_identification_is_said_first_and_named() {
    let desk = &Desk::with(&[]);
    let logs = all_reworked(desk, "gain", |[t, p, l, f]| [t, p, l, 1.15 * f]);
    let files = "--out diagnosis.json --out-model augmented.json";
    let (diagnosis, _) = desk.diagnosed(&format!("{logs} --model model.json --report gain.html {files}"), 1);
    assert_eq!(diagnosis.verdict, Verdict::Unexplained, "{}", diagnosis.statement);
    assert!(diagnosis.statement.starts_with("The model as given misses the recordings by "), "{}", diagnosis.statement);
    assert!(diagnosis.statement.contains("refitted by ") && diagnosis.statement.contains("k1 shifted by "));
    assert!(diagnosis.statement.contains("the force reads 1.150 times what it should"), "{}", diagnosis.statement);
    let given = diagnosis.as_given.unwrap();
    assert!(given.misses && given.estimation.rmse_n > 20.0 * given.refitted.rmse_n, "{given:?}");
    // Eq. 11 is linear in k1: it takes in the gain, and by far more than it is uncertain.
    let k1 = given.shifts.iter().find(|shift| shift.parameter == "k1").unwrap();
    assert!((k1.refitted / k1.given - 1.15).abs() < 5e-3 && k1.standard_errors.unwrap() > 40.0, "{k1:?}");
    let page = std::fs::read_to_string(desk.path("gain.html")).unwrap();
    assert!(page.contains("The model as given is not that of these recordings") && page.contains("standard errors"));
}

#[test]
fn an_effect_that_came_after_the_identification_is_no_other_muscle() {
    let desk = &Desk::with(&[Concealed::new("presliding-hysteresis", 1.0)]);
    desk.file("before.json", std::fs::read(Desk::plain().path("model.json")).unwrap());
    let files = "--out diagnosis.json --out-model augmented.json";
    let (diagnosis, _) = desk.diagnosed(&format!("{LOGS} --model before.json {files}"), 0);
    assert_eq!(diagnosis.effects[0].id, "presliding-hysteresis");
    assert!(!diagnosis.as_given.unwrap().misses, "{}", diagnosis.statement);
}

#[test]
fn recordings_of_another_muscle_are_refused_unless_they_are_accepted() {
    let desk = &Desk::with(&[]);
    let mut other: serde_json::Value =
        serde_json::from_slice(&std::fs::read(desk.path("model.json")).unwrap()).unwrap();
    other["geometry"]["rest_radius_m"] = 0.0135.into();
    desk.file("other.json", other.to_string());
    let said = desk.refusal(&format!("{LOGS} --model other.json --out refused.json"));
    assert!(said.contains("minor-loops.csv: the model as given misses the recordings by"), "{said}");
    assert!(said.contains("another muscle; identify a model from them with pam-identify"), "{said}");
    assert!(said.contains("--accept-implausible"), "{said}");
    let said = desk.refusal(&format!("{LOGS} --model other.json --check"));
    assert!(said.contains("another muscle"), "{said}");
    let files = "--out diagnosis.json --out-model augmented.json --accept-implausible";
    let (diagnosis, _) = desk.diagnosed(&format!("{LOGS} --model other.json {files}"), 1);
    assert!(diagnosis.statement.starts_with("The model as given misses the recordings"), "{}", diagnosis.statement);
    assert!(!matches!(diagnosis.verdict, Verdict::Consistent | Verdict::Explained));
}

/// Rows of a recording in which the length is within 0.3 mm of what it is for the longest.
fn at_one_length(desk: &Desk, name: &str) -> String {
    let text = std::fs::read_to_string(desk.path(name)).unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let length_mm = |row: &str| row.split(',').nth(2).unwrap().parse::<f64>().unwrap();
    let first_mm = rows.lines().map(length_mm).next().unwrap();
    let kept: Vec<&str> = rows.lines().take_while(|row| (length_mm(row) - first_mm).abs() < 0.3).collect();
    format!("{header}\n{}\n", kept.join("\n"))
}

#[test]
fn a_hold_out_far_from_what_was_fitted_is_of_no_other_muscle() {
    let desk = &Desk::with(&[]);
    let held = at_one_length(desk, "isometric-ramps.csv");
    desk.file("one-length.csv", held);
    desk.file("narrow.json", serde_json::to_vec(&desk.identified_from(&["one-length"])).unwrap());
    let files = "--out narrow-diagnosis.json --quiet";
    let output = desk.run(&format!("one-length.csv --model narrow.json {HELD} {files}"));
    assert_ne!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    let (diagnosis, _) = DiagnosisArtifact::read(&desk.path("narrow-diagnosis.json")).unwrap();
    assert!(!diagnosis.statement.contains("another muscle"), "{}", diagnosis.statement);
    assert!(diagnosis.warnings.iter().any(|words| words.contains("no fitted recording was near")));
    let held = diagnosis.fit.holdout.unwrap();
    if held.rmse_after_n > 10.0 * held.noise_floor_n {
        assert!(diagnosis.statement.contains("judges the extrapolation"), "{}", diagnosis.statement);
    }
}

#[test]
fn a_fault_in_what_was_held_out_decides() {
    let desk = &Desk::with(&[]);
    let held = "multisine.csv";
    desk.file("turned.csv", reworked(desk, held, |[t, p, l, f]| [t, p, l, -f]));
    desk.file("longer.csv", reworked(desk, held, |[t, p, l, f]| [t, p, l + 60.0, f]));
    desk.file("pascal.csv", reworked(desk, held, |[t, p, l, f]| [t, 1e3 * p, l, f]));
    desk.file("gain.csv", reworked(desk, held, |[t, p, l, f]| [t, p, l, 1.2 * f]));
    desk.file("datum.csv", reworked(desk, held, |[t, p, l, f]| [t, p, l + 4.0, f]));
    for (name, says) in [
        ("turned", "turned.csv: force falls as pressure rises"),
        ("longer", "longer.csv: length runs from"),
        ("pascal", "pascal.csv: pressure reaches"),
    ] {
        let said = desk.refusal(&format!("{LOGS} --model model.json --holdout {name}.csv --out refused.json"));
        assert!(said.contains(says), "{said}");
    }
    for (name, says) in [("gain", "the force reads 1.200 times what it should"), ("datum", "the length reads 4.0")] {
        let files = "--out diagnosis.json --out-model augmented.json";
        let line = format!("{LOGS} --model model.json --holdout {name}.csv {files}");
        let (diagnosis, _) = desk.diagnosed(&line, 1);
        assert_eq!(diagnosis.verdict, Verdict::Unexplained, "{}", diagnosis.statement);
        let first = format!("Held out, {name}.csv is missed by ");
        assert!(diagnosis.statement.starts_with(&first), "{}", diagnosis.statement);
        assert!(diagnosis.statement.contains(says), "{}", diagnosis.statement);
    }
}

/// Rows of a recording, each changed: time s, pressure kPa, length mm, force N.
fn reworked(desk: &Desk, name: &str, change: impl Fn([f64; 4]) -> [f64; 4]) -> String {
    let mut text = "time_s,pressure_kPa,length_mm,force_N\n".to_owned();
    for line in std::fs::read_to_string(desk.path(name)).unwrap().lines().skip(1) {
        let mut fields = line.split(',').map(|field| field.parse::<f64>().unwrap());
        let [t, p, l, f] = change([(); 4].map(|()| fields.next().unwrap()));
        text.push_str(&format!("{t},{p},{l},{f}\n"));
    }
    text
}

#[test]
fn every_mistake_gets_one_line_with_place_and_remedy() {
    // One of its own: other tests write beside the shared one while a refusal looks for leftovers.
    let desk = &Desk::with(&[]);
    let triangles = "isobaric-triangles.csv";
    desk.file("copy.csv", std::fs::read(desk.path(triangles)).unwrap());
    desk.file("rewritten.csv", reworked(desk, triangles, |row| row));
    desk.file("still.csv", reworked(desk, triangles, |[t, p, l, _]| [t, p, l, 7.5]));
    desk.file("held.csv", reworked(desk, triangles, |[t, _, _, f]| [t, 300.0, 250.0, f]));
    desk.file("clipped.csv", reworked(desk, triangles, |[t, p, l, f]| [t, p, l, f.min(300.0)]));
    desk.file("other.csv", reworked(desk, triangles, |[t, p, l, f]| [t, p, l + 60.0, f]));
    let head: Vec<String> =
        std::fs::read_to_string(desk.path(triangles)).unwrap().lines().take(400).map(str::to_owned).collect();
    desk.file("short.csv", head.join("\n") + "\n");
    desk.file("empty.csv", "");
    desk.file("broken.json", "{\"schema\": \"pam-model/1\",");
    desk.file("inverse.json", "{\"schema\": \"pam-inverse/1\"}");
    desk.file("sub", "");
    let to = "--out refused.json";
    let cases = [
        format!("{LOGS} --model model.json --holdout {triangles} {to}"),
        format!("{LOGS} --model model.json --holdout copy.csv {to}"),
        format!("{LOGS} --model model.json --holdout rewritten.csv {to}"),
        format!("still.csv --model model.json {to}"),
        format!("held.csv --model model.json {to}"),
        format!("clipped.csv --model model.json {to}"),
        format!("other.csv --model model.json {to}"),
        format!("short.csv --model model.json {to}"),
        format!("empty.csv --model model.json {to}"),
        format!("missing.csv --model model.json {to}"),
        format!("{LOGS} --model missing.json {to}"),
        format!("{LOGS} --model broken.json {to}"),
        format!("{LOGS} --model inverse.json {to}"),
        format!("{LOGS} --model model.json --out sub/refused.json"),
        format!("{LOGS} --model model.json --out refused.json --report nowhere/refused.html"),
        format!("{LOGS} --model model.json --out refused.json --out-model refused.json"),
        format!("{LOGS} --model model.json --out model.json"),
        format!("{LOGS} --model model.json --out /dev/full"),
        format!("{LOGS} --model model.json {to} --exclude stribek"),
        format!("{LOGS} --model model.json {to} --exclude gearbox"),
        format!("{LOGS} --model model.json {to} --max-effects 0"),
        format!("{LOGS} --model model.json {to} --matters-above-n -1"),
        format!("{LOGS} --model model.json"),
        format!("{LOGS} {to}"),
        format!("--model model.json {to}"),
        format!("{LOGS} --model model.json {to} --figure refused.svg"),
        "--explain stribek".to_owned(),
        "--explain all --figure refused.svg".to_owned(),
        format!("--explain stribeck {to}"),
    ];
    let said: Vec<String> = cases.iter().map(|arguments| desk.refusal(arguments)).collect();
    insta::assert_snapshot!(said.join("\n"), @r#"
    error: isobaric-triangles.csv: is fitted and held out as well; hold out a recording that the diagnosis does not see
    error: copy.csv: has the same samples as isobaric-triangles.csv, which is fitted; a hold-out must be a recording that nothing was fitted to
    error: rewritten.csv: has the same samples as isobaric-triangles.csv, which is fitted; a hold-out must be a recording that nothing was fitted to
    error: still.csv: force never varies (it is 7.5 N in every row); check the load cell and the column that holds it, or for a dead weight leave the column out and give --fixed force_N=7.5
    error: held.csv: pressure stays at 300 kPa throughout; check its wiring, or leave the recording out
    error: clipped.csv: force stands at 300.0 N, the end of its range, in 51 % of the samples; the sensor is saturated: leave the recording out, or take a sensor with more range
    error: other.csv: length runs from 270.8 to 328.5 mm, which a muscle of rest length 267.0 mm cannot have (it would be stretched by more than a tenth, or its strands straight); check that the recording and the model belong together, or go on with --accept-implausible
    error: short.csv: 2.0 s of motion in all is too short to judge by; record at least 3 s more (blocks of some seconds are held out in turn)
    error: empty.csv: the file holds no rows; record again, or check that the logger closed the file
    error: missing.csv: no such file; check the path
    error: cannot read missing.json: no such file; check the path
    error: broken.json:1:25: EOF while parsing a value; expected a pam-model/1 artifact
    error: inverse.json: schema is "pam-inverse/1", expected "pam-model/1"; write it with pam-identify
    error: cannot write sub/refused.json: sub is not a folder; name another path
    error: cannot write nowhere/refused.html: folder nowhere does not exist; create it with `mkdir -p nowhere`
    error: two outputs go to refused.json; name different ones
    error: cannot write model.json: it is also an input, which the run would destroy; name another
    error: cannot write /dev/full: no space left on the device; free some or name a path elsewhere
    error: --exclude: no effect is called "stribek"; did you mean stribeck?
    error: --exclude: no effect is called "gearbox"; pam-diagnose --explain all lists them
    error: invalid value '0' for '--max-effects <N>': 0 is not in 1..=10; see --help
    error: --matters-above-n -1 is no size of a force; give newtons from 0 up
    error: the following required arguments were not provided: --out <DIAGNOSIS.json>; see --help
    error: the following required arguments were not provided: --model <MODEL.json>; see --help
    error: the following required arguments were not provided: <LOG>...; see --help
    error: --figure draws an effect; name it with --explain (figures of a diagnosis are in --report)
    error: --explain: no effect is called "stribek"; did you mean stribeck?
    error: --figure draws one effect; name it instead of all
    error: the argument '--explain <ID>' cannot be used with '--out <DIAGNOSIS.json>'; see --help
    "#);
}
