//! Recordings read under the eyes of a person.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

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
    for recording in read_each(paths, options, console) {
        let recording = recording?;
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

/// The recordings in order, up to the first that cannot be read, as many at a time as there are cores. Each on a thread of its own, and not on
/// one that works for all: it may wait for a pipe.
fn read_each(
    paths: &[PathBuf],
    options: &ReadOptions,
    console: &Console,
) -> impl Iterator<Item = Result<Recording, ReadError>> {
    let next = Mutex::new(0..paths.len());
    let read = Mutex::new(Vec::new());
    let go_on = || {
        loop {
            let index = next.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some(index) = index else { break };
            let recording = read_recording(&paths[index], options, console);
            if recording.is_err() {
                *next.lock().unwrap_or_else(PoisonError::into_inner) = 0..0;
            }
            read.lock().unwrap_or_else(PoisonError::into_inner).push((index, recording));
        }
    };
    std::thread::scope(|scope| {
        let others = std::thread::available_parallelism().map_or(1, usize::from).min(paths.len()).saturating_sub(1);
        (0..others).for_each(|_| {
            scope.spawn(go_on);
        });
        go_on();
    });
    let mut read = read.into_inner().unwrap_or_else(PoisonError::into_inner);
    read.sort_by_key(|(index, _)| *index);
    read.into_iter().map(|(_, recording)| recording)
}
