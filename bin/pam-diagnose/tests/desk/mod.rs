//! A folder with recordings of the nominal muscle, or of ones that differ from it, and the models that fits find.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use pam_artifact::{Input, InputRole, Tool};
use pam_identification::fit::FitOptions;
use pam_identification::identify::{Request, check};
use pam_muscle::MuscleFile;
use pam_recording::{ReadOptions, read_recording};

use pam_virtual_bench::{Bench, Concealed, Options, Parameters, TrueMuscle, command};

const PROTOCOLS: [&str; 3] = ["minor-loops", "isobaric-triangles", "isometric-ramps"];

fn muscle_file() -> MuscleFile {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    MuscleFile::read(&root.join("configs/muscle-nominal.toml")).unwrap()
}

/// The recordings of a series, as a command line has them.
pub(crate) fn logs(series: &str) -> String {
    PROTOCOLS.map(|protocol| format!("{series}-{protocol}.csv")).join(" ")
}

/// The folder.
pub(crate) struct Desk {
    folder: tempfile::TempDir,
}

impl Desk {
    pub(crate) fn empty() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Records a `series` in which `effects` are concealed, the channel `shifted` reads so much more, and parameters are `set`.
    pub(crate) fn record(
        &self,
        series: &str,
        effects: &[Concealed],
        shifted: Option<(&str, f64)>,
        seed: u64,
        set: fn(&mut Parameters),
    ) {
        let MuscleFile { muscle, strand_modulus_pa, .. } = muscle_file();
        let mut parameters = Parameters::nominal();
        set(&mut parameters);
        let truth = TrueMuscle::new(muscle, strand_modulus_pa, parameters);
        let options = Options { duration_scale: 0.2, ..Options::default() };
        for (index, protocol) in PROTOCOLS.into_iter().enumerate() {
            let bench = Bench::new(truth.clone(), command(protocol, &truth, &options).unwrap());
            let bench = bench.with_effects(effects, 1).unwrap();
            let mut csv = Vec::new();
            bench.record(seed + index as u64).write_csv(&mut csv).unwrap();
            let text = String::from_utf8(csv).unwrap();
            let text = shifted.map_or(text.clone(), |(column, by)| more(&text, column, by));
            std::fs::write(self.path(&format!("{series}-{protocol}.csv")), text).unwrap();
        }
    }

    /// Writes the model that a fit to the recordings of a `series` finds.
    pub(crate) fn identify(&self, series: &str, model: &str) {
        let logs = logs(series);
        let read = |name: &str| read_recording(&self.path(name), &ReadOptions::default()).unwrap();
        let options = FitOptions { n_particles: 30, n_iterations: 60, n_starts: 1, seed: 1, polish: true };
        let request = Request::of(logs.split(' ').map(read).collect(), muscle_file(), options);
        let request = Request { accept_implausible: true, ..request };
        let checked = check(request).unwrap();
        let config = checked.config();
        let tool = Tool { name: "pam-identify".to_owned(), version: "0.1.0".to_owned() };
        let muscle = Input { path: "muscle.toml".to_owned(), sha256: "0".repeat(64), role: InputRole::Muscle };
        let recordings = logs.split(' ').map(|name| Input::recording(&read(name), InputRole::Estimation));
        let inputs = std::iter::once(muscle).chain(recordings).collect();
        let found = checked.identify().unwrap().artifact(tool, inputs, config, 1);
        std::fs::write(self.path(model), found.json().unwrap()).unwrap();
    }

    pub(crate) fn run(&self, arguments: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pam-diagnose"))
            .args(arguments.split(' ').filter(|word| !word.is_empty()))
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .output()
            .unwrap()
    }
}

/// `csv` with a column that reads so much more.
fn more(csv: &str, column: &str, by: f64) -> String {
    let at = csv.lines().next().unwrap().split(',').position(|name| name == column).unwrap();
    let row = |(index, line): (usize, &str)| {
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        if index > 0 {
            fields[at] = (fields[at].parse::<f64>().unwrap() + by).to_string();
        }
        fields.join(",") + "\n"
    };
    csv.lines().enumerate().map(row).collect()
}
