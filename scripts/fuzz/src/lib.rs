//! What the fuzz targets share: a file for the input, a mutator that knows JSON, inputs that are in order, and a short fit.

pub mod json;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use pam_artifact::ModelArtifact;
use pam_identification::fit::FitOptions;
use pam_identification::identify::{Request, check};
use pam_muscle::MuscleFile;
use pam_recording::{ReadOptions, Recording, read_recording};

/// Gives `bytes` to `take` as a file, as every reader wants one. The file is the same one each time.
pub fn with_file<T>(bytes: &[u8], take: impl FnOnce(&Path) -> T) -> T {
    static PATH: OnceLock<PathBuf> = OnceLock::new();
    let path = PATH.get_or_init(|| {
        let memory = Path::new("/dev/shm");
        let folder = if memory.is_dir() { memory.to_owned() } else { std::env::temp_dir() };
        folder.join(format!("pam-fuzz-{}", std::process::id()))
    });
    let mut file = std::fs::File::create(path).expect("a file for the input");
    file.write_all(bytes).expect("a file for the input");
    drop(file);
    let taken = take(path);
    // Only a finding leaves its file behind.
    let _ = std::fs::remove_file(path);
    taken
}

/// The muscle that inputs in order are about.
pub fn nominal_muscle() -> MuscleFile {
    MuscleFile::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../configs/muscle-nominal.toml")))
        .expect("the nominal muscle")
}

/// A model of it, plain enough to begin with.
pub fn nominal_model() -> ModelArtifact {
    static MODEL: OnceLock<ModelArtifact> = OnceLock::new();
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/seeds/model/plain.json"));
    MODEL.get_or_init(|| ModelArtifact::read(path).expect("the seed is a model").0).clone()
}

/// Four seconds of that muscle on a bench: length to and fro, pressure up.
pub fn short_recording() -> Recording {
    static TEXT: OnceLock<String> = OnceLock::new();
    let text = TEXT.get_or_init(|| {
        let mut text = "time_s,pressure_kPa,length_mm,force_N\n".to_owned();
        for row in 0..200 {
            let time_s = 0.02 * f64::from(row);
            let length_mm = 245.0 + 15.0 * (3.0 * time_s).sin();
            let pressure_kpa = 100.0 + 60.0 * time_s;
            let force_n = pressure_kpa * (length_mm - 205.0) / 45.0;
            text += &format!("{time_s:.2},{pressure_kpa:.2},{length_mm:.3},{force_n:.2}\n");
        }
        text
    });
    with_file(text.as_bytes(), |path| read_recording(path, &ReadOptions::default())).expect("a recording in order")
}

/// Identifies `muscle` from `recording`, with as little search as there can be.
pub fn fit_shortly(muscle: MuscleFile, recording: Recording, accept_implausible: bool) {
    let options = FitOptions { n_particles: 4, n_iterations: 2, n_starts: 1, seed: 1, polish: true };
    let request = Request { accept_implausible, unbounded: true, ..Request::of(vec![recording], muscle, options) };
    if let Ok(checked) = check(request) {
        let _ = checked.identify();
    }
}
