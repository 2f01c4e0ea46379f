//! Recordings read under the eyes of a person.

use std::path::Path;

use pam_core::recording::{ReadError, ReadOptions, Recording, read_recording_observed};

use crate::Console;

/// Reads a recording and shows how far that has come.
///
/// # Errors
/// As [`read_recording`](pam_core::recording::read_recording).
pub fn read_recording(path: &Path, options: &ReadOptions, console: &Console) -> Result<Recording, ReadError> {
    let progress = console.progress(format!("reading {}", path.display()), 1);
    read_recording_observed(path, options, &mut |done, all| progress.set_of(done, all))
}
