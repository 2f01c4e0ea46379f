//! A folder with the muscle file and one good recording, and the program in it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}

pub(crate) fn shipped(name: &str) -> String {
    std::fs::read_to_string(root().join("datasets/bench-nominal").join(name)).unwrap()
}

/// A folder with the muscle file and one good recording.
pub(crate) struct Bench {
    pub(crate) folder: tempfile::TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::copy(root().join("configs/muscle-nominal.toml"), folder.path().join("m.toml")).unwrap();
        std::fs::write(folder.path().join("good.csv"), shipped("isobaric-triangles.csv")).unwrap();
        Self { folder }
    }

    pub(crate) fn file(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.folder.path().join(name), content).unwrap();
        self
    }

    pub(crate) fn run(&self, arguments: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_pam-identify"))
            .args(arguments.split(' ').filter(|word| !word.is_empty()).map(|word| word.replace('~', " ")))
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .output()
            .unwrap()
    }

    /// The one line of an error; nothing may have been written.
    pub(crate) fn refusal(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(output.stdout.is_empty());
        assert!(!self.folder.path().join("model.json").exists(), "an output was written");
        let left: Vec<_> = std::fs::read_dir(self.folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name.starts_with('.'))
            .collect();
        assert!(left.is_empty(), "left behind: {left:?}");
        let errors: Vec<&str> = stderr.lines().filter(|line| line.starts_with("error: ")).collect();
        assert_eq!(errors.len(), 1, "{stderr}");
        errors[0].to_owned()
    }
}

/// The good recording with every row changed: time s, pressure kPa, length mm, force N in and out.
pub(crate) fn reworked(change: impl Fn(usize, [f64; 4]) -> [f64; 4]) -> String {
    let mut text = "time_s,pressure_kPa,length_mm,force_N\n".to_owned();
    for (index, line) in shipped("isobaric-triangles.csv").lines().skip(1).enumerate() {
        let mut fields = line.split(',').map(|field| field.parse::<f64>().unwrap());
        let row = [(); 4].map(|()| fields.next().unwrap());
        let [t, p, l, f] = change(index, row);
        text.push_str(&format!("{t},{p},{l},{f}\n"));
    }
    text
}

pub(crate) const TAIL: &str = "--muscle m.toml --out model.json";

/// The published schema.
pub(crate) const SCHEMA: &str = include_str!("../../../../crates/artifact/schemas/pam-model-1.json");
