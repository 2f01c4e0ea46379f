//! A folder with recordings of the nominal muscle and the model that a fit finds, and the program in it.

use pam_artifact::diagnosis::Verdict;
use pam_artifact::{DiagnosisArtifact, Input, InputRole, ModelArtifact, Tool};
use pam_identification::fit::FitOptions;
use pam_identification::identify::{Request, check};
use pam_muscle::MuscleFile;
use pam_recording::{ReadOptions, Recording, read_recording};

use pam_virtual_bench::{Bench, Concealed, Options, Parameters, TrueMuscle, command};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

pub(crate) const FITTED: [&str; 3] = ["minor-loops", "isobaric-triangles", "isometric-ramps"];

pub(crate) const LOGS: &str = "minor-loops.csv isobaric-triangles.csv isometric-ramps.csv";

pub(crate) const HELD: &str = "--holdout multisine.csv";

/// The published schemas of what the program writes.
pub(crate) const SCHEMA: &str = include_str!("../../../../crates/artifact/schemas/pam-diagnosis-1.json");

pub(crate) const MODEL_SCHEMA: &str = include_str!("../../../../crates/artifact/schemas/pam-model-1.json");

pub(crate) fn muscle_file() -> MuscleFile {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    MuscleFile::read(&root.join("configs/muscle-nominal.toml")).unwrap()
}

/// A folder with recordings of the nominal muscle, three to fit and one to hold out, and the model that a fit finds.
pub(crate) struct Desk {
    pub(crate) folder: tempfile::TempDir,
}

impl Desk {
    pub(crate) fn empty() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub(crate) fn with(concealed: &[Concealed]) -> Self {
        let desk = Self::empty();
        let MuscleFile { muscle, strand_modulus_pa, .. } = muscle_file();
        let truth = TrueMuscle::new(muscle, strand_modulus_pa, Parameters::nominal());
        let options = Options { duration_scale: 0.1, ..Options::default() };
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
    pub(crate) fn plain() -> &'static Self {
        static DESK: OnceLock<Desk> = OnceLock::new();
        DESK.get_or_init(|| Self::with(&[]))
    }

    /// With a bump of 9 N over the contraction in every log, which no effect of the catalogue is.
    pub(crate) fn touched() -> &'static Self {
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
    pub(crate) fn presliding() -> &'static Self {
        static DESK: OnceLock<Desk> = OnceLock::new();
        DESK.get_or_init(|| Self::with(&[Concealed::new("presliding-hysteresis", 1.0)]))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn file(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    pub(crate) fn recording(&self, name: &str) -> Recording {
        read_recording(&self.path(name), &ReadOptions::default()).unwrap()
    }

    /// The model of pam-identify.
    pub(crate) fn identified(&self) -> ModelArtifact {
        self.identified_from(&FITTED)
    }

    pub(crate) fn identified_from(&self, names: &[&str]) -> ModelArtifact {
        let logs = names.iter().map(|name| self.recording(&format!("{name}.csv"))).collect();
        let options = FitOptions { n_particles: 30, n_iterations: 60, n_starts: 1, seed: 1, polish: true };
        identified(muscle_file(), logs, options)
    }

    pub(crate) fn run(&self, arguments: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pam-diagnose"))
            .args(arguments.split(' ').filter(|word| !word.is_empty()))
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .output()
            .unwrap()
    }

    /// Diagnosis and model of a run that must end with `code`; 1 is right as well where something is named and something is left,
    /// which reversals alone bring about.
    pub(crate) fn diagnosed(&self, arguments: &str, code: i32) -> (DiagnosisArtifact, ModelArtifact) {
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
    pub(crate) fn refusal(&self, arguments: &str) -> String {
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

/// The model that a fit of `muscle` to `logs` finds.
pub(crate) fn identified(muscle: MuscleFile, logs: Vec<Recording>, options: FitOptions) -> ModelArtifact {
    let request = Request { accept_implausible: true, ..Request::of(logs, muscle, options) };
    let checked = check(request).unwrap();
    let config = checked.config();
    let tool = Tool { name: "pam-identify".to_owned(), version: "0.1.0".to_owned() };
    let input = Input { path: "muscle.toml".to_owned(), sha256: "0".repeat(64), role: InputRole::Muscle };
    checked.identify().unwrap().artifact(tool, vec![input], config, 1)
}

/// Rows of a recording, each changed: time s, pressure kPa, length mm, force N.
pub(crate) fn reworked(desk: &Desk, name: &str, change: impl Fn([f64; 4]) -> [f64; 4]) -> String {
    let mut text = "time_s,pressure_kPa,length_mm,force_N\n".to_owned();
    for line in std::fs::read_to_string(desk.path(name)).unwrap().lines().skip(1) {
        let mut fields = line.split(',').map(|field| field.parse::<f64>().unwrap());
        let [t, p, l, f] = change([(); 4].map(|()| fields.next().unwrap()));
        text.push_str(&format!("{t},{p},{l},{f}\n"));
    }
    text
}

/// `log` with a bump of 9 N around a contraction of 10 %.
pub(crate) fn touched(log: &str) -> String {
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
