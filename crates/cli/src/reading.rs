//! Recordings read under the eyes of a person.

use std::path::{Path, PathBuf};

use pam_recording::{ReadError, ReadOptions, Recording, read_recording_observed};

use crate::Console;

/// Reads a recording and shows how far that has come.
///
/// # Errors
/// As [`read_recording`](pam_recording::read_recording).
pub fn read_recording(path: &Path, options: &ReadOptions, console: &Console) -> Result<Recording, ReadError> {
    let progress = console.progress(format!("reading {}", path.display()), 1);
    read_recording_observed(path, options, &mut |done, all| progress.set_of(done, all))
}

/// Reads every recording, and notes what was repaired or left aside; once where files of one logger need the same.
///
/// # Errors
/// [`ReadError`] of the first that cannot be read.
pub fn read_recordings(
    paths: &[PathBuf],
    options: &ReadOptions,
    console: &Console,
) -> Result<Vec<Recording>, ReadError> {
    let mut recordings = Vec::new();
    let mut notes: Vec<(String, Vec<String>)> = Vec::new();
    for path in paths {
        let recording = read_recording(path, options, console)?;
        let mut said = recording.repairs.notes();
        if !recording.ignored_columns.is_empty() {
            said.push(format!("not used: {}", recording.ignored_columns.join(", ")));
        }
        for words in said {
            match notes.iter_mut().find(|(known, _)| *known == words) {
                Some((_, paths)) => paths.push(recording.path.clone()),
                None => notes.push((words, vec![recording.path.clone()])),
            }
        }
        recordings.push(recording);
    }
    for (words, paths) in notes {
        let others = match paths.len() {
            1 => String::new(),
            2 => " and another".to_owned(),
            n => format!(" and {} others", n - 1),
        };
        console.note(format!("{}{others}: {words}", paths[0]));
    }
    Ok(recordings)
}
