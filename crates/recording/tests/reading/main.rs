//! The reader of recordings from outside: what it understands, repairs and refuses, with every message.

#![expect(clippy::unwrap_used, reason = "a helper of a test may panic as the test may")]

mod loggers;
mod mat;
mod never_panics;
mod options;
mod real_files;
mod refusals;
mod repairs;
mod understood;

use std::path::Path;

use pam_recording::{ReadError, ReadOptions, Recording, read_recording};

/// Reads `text` from a file called `log.csv`.
fn read(text: impl AsRef<[u8]>, options: &ReadOptions) -> Result<Recording, ReadError> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("log.csv");
    std::fs::write(&path, text).unwrap();
    read_recording(&path, options).map_err(|error| ReadError { path: "log.csv".into(), ..error })
}

/// Reads `text` as it is.
fn recording(text: impl AsRef<[u8]>) -> Recording {
    read(text, &ReadOptions::default()).unwrap()
}

/// The message with which `text` is refused.
fn refusal(text: impl AsRef<[u8]>, options: &ReadOptions) -> String {
    let message = read(text, options).unwrap_err().to_string();
    assert!(!message.contains('\n'), "{message:?}");
    message
}

/// Options as on a command line.
fn options<const N: usize>(arguments: [&str; N]) -> ReadOptions {
    let mut options = ReadOptions::default();
    for argument in arguments {
        let (flag, value) = argument.split_once(' ').unwrap_or((argument, ""));
        match flag {
            "--columns" => options.columns = Some(value.parse().unwrap()),
            "--map" => options.map.push(value.parse().unwrap()),
            "--fixed" => options.fixed.push(value.parse().unwrap()),
            "--calibrate" => options.calibrate.push(value.parse().unwrap()),
            "--skip-bad-rows" => options.skip_bad_rows = true,
            "--force-optional" => options.force_required = false,
            "--min-rows" => options.min_rows = value.parse().unwrap(),
            _ => panic!("{argument}"),
        }
    }
    options
}

/// All rows: time, pressure, length, force.
fn rows(recording: &Recording) -> Vec<[f64; 4]> {
    let mut rows = Vec::new();
    for chunk in recording.samples.chunks() {
        let chunk = chunk.unwrap();
        for row in 0..chunk.n_rows() {
            let force_n = chunk.force_n().get(row).copied().unwrap_or(f64::NAN);
            rows.push([chunk.time_s()[row], chunk.pressure_pa()[row], chunk.length_m()[row], force_n]);
        }
    }
    rows
}

/// All stamps.
fn stamps_s(recording: &Recording) -> Vec<f64> {
    rows(recording).into_iter().map(|row| row[0]).collect()
}

/// A file with these stamps and a force that varies.
fn log_with_stamps(stamps: impl IntoIterator<Item = f64>) -> String {
    let mut text = "time_s,pressure_kPa,length_mm,force_N\n".to_owned();
    for (index, stamp) in stamps.into_iter().enumerate() {
        text += &format!("{stamp},100,200,{}\n", index % 7);
    }
    text
}

fn exists(path: &Path) -> bool {
    path.try_exists().unwrap_or(false)
}
