//! Two real Festo muscles, fitted and diagnosed without any option. The recordings are other people's and not in this repository:
//! `make recordings` fetches them, or `PAM_RECORDINGS` names their folder. Without them these tests say that they were skipped.

#![expect(clippy::print_stdout, reason = "a test that is skipped says so")]

use std::path::{Path, PathBuf};

use pam_artifact::ModelArtifact;
use pam_artifact::diagnosis::DiagnosisArtifact;
use pam_identification::fit::FitOptions;
use pam_muscle::MuscleFile;
use pam_recording::{ReadOptions, read_recording};

use crate::desk::{Desk, identified};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

/// Four recordings of the muscle cut to `cut`, each at one length; nothing where there are none.
fn files(cut: &str, repeat: u32) -> Vec<PathBuf> {
    let named = std::env::var_os("PAM_RECORDINGS").map(PathBuf::from);
    let shared = root().parent().map(|parent| parent.join("shared/recordings/festo-10mm-isometric"));
    let folders = [named, Some(root().join("recordings")), shared].into_iter().flatten();
    let of_folder = |folder: PathBuf| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder).into_iter().flatten();
        let (begins, ends) = (format!("bpa10_L{cut}_"), format!("_test{repeat}.csv"));
        let is_one = |name: &str| name.starts_with(&begins) && name.ends_with(&ends);
        let paths = entries.map(|entry| entry.unwrap().path());
        let mut files: Vec<PathBuf> =
            paths.filter(|path| is_one(path.file_name().unwrap().to_str().unwrap())).collect();
        files.sort();
        files
    };
    folders.map(of_folder).find(|files| !files.is_empty()).unwrap_or_default()
}

/// Fitted to one run at each length, the augmented model foretells another one to within `most_n`, root mean square over all samples;
/// what is named is the same for both muscles, of one make and on one rig.
fn is_foretold_within(cut: &str, most_n: f64) {
    let (fitted, held) = (files(cut, 9), files(cut, 10));
    if fitted.is_empty() {
        println!("skipped: no recordings of real muscles found (make recordings, or set PAM_RECORDINGS)");
        return;
    }
    let desk = Desk::empty();
    let muscle = MuscleFile::read(&root().join(format!("configs/muscle-festo-10mm-{cut}.toml"))).unwrap();
    let logs = fitted.iter().map(|path| read_recording(path, &ReadOptions::default()).unwrap()).collect();
    let model = identified(muscle, logs, FitOptions::default());
    desk.file("model.json", serde_json::to_vec(&model).unwrap());
    let words = |files: &[PathBuf], option: &str| -> String {
        files.iter().map(|file| format!("{option} {} ", file.display())).collect()
    };
    let (logs, holdouts) = (words(&fitted, ""), words(&held, "--holdout"));
    desk.run(&format!("--model model.json --out diagnosis.json --out-model augmented.json {logs}{holdouts}"));
    let (augmented, _) = ModelArtifact::read(&desk.path("augmented.json")).unwrap();
    let held_n = augmented.fit.validation.unwrap().rmse_all_n;
    println!("{cut}: {held_n:.2} N");
    assert!(held_n <= most_n, "{held_n}");
    let (diagnosis, _) = DiagnosisArtifact::read(&desk.path("diagnosis.json")).unwrap();
    let names: Vec<&str> = diagnosis.effects.iter().map(|effect| effect.id.as_str()).collect();
    assert_eq!(names, ["slack", "pressure-lag"]);
    assert_eq!(diagnosis.effects[1].alternatives, ["channel-delay"]);
}

#[test]
fn the_30_cm_muscle_is_foretold_within_3_newtons() {
    is_foretold_within("30cm", 3.0);
}

#[test]
fn the_20_cm_muscle_is_foretold_within_3_3_newtons() {
    is_foretold_within("20cm", 3.3);
}
