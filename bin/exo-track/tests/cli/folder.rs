//! A folder with the configuration of a lift and a model, and the program in it.

use std::path::Path;
use std::process::{Command, Output};

pub(crate) const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/model.json");

/// The published schema.
pub(crate) const SCHEMA: &str = include_str!("../../../../crates/artifact/schemas/exo-metrics-1.json");

pub(crate) const CONFIG: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../configs/lift.toml");

/// A folder with the configuration, changed by replacing text, and the model.
pub(crate) fn folder(changes: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let mut text = std::fs::read_to_string(CONFIG).unwrap();
    for (old, new) in changes {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    std::fs::write(folder.path().join("lift.toml"), text).unwrap();
    std::fs::copy(MODEL, folder.path().join("model.json")).unwrap();
    folder
}

pub(crate) fn run(folder: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_exo-track"))
        .current_dir(folder)
        .args(["--config", "lift.toml", "--model", "model.json"])
        .args(more)
        .output()
        .unwrap()
}

/// Standard error of a run that is refused: one line, exit code 2, no output.
pub(crate) fn refused(changes: &[(&str, &str)]) -> String {
    let folder = folder(changes);
    let output = run(folder.path(), &["--out", "track.csv", "--metrics", "metrics.json"]);
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(!folder.path().join("track.csv").exists() && !folder.path().join("metrics.json").exists());
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}
