//! What a path given for an output stands for.

use std::io;
use std::path::{Path, PathBuf};

use crate::OutputError;
use crate::interrupt::live;

/// A target held by one output.
#[derive(Debug)]
pub(crate) struct Claim {
    /// Final path, folder in canonical form.
    pub(crate) target: PathBuf,
}

impl Claim {
    /// Takes `target`; `path` is the name to complain about.
    pub(crate) fn new(target: PathBuf, path: &Path) -> Result<Self, OutputError> {
        if live().targets.insert(target.clone()) {
            Ok(Self { target })
        } else {
            Err(OutputError::NamedTwice { path: path.to_owned() })
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        live().targets.remove(&self.target);
    }
}

/// A name for standard output.
pub(crate) fn is_stdout(path: &Path) -> bool {
    ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].iter().any(|name| path.as_os_str() == *name)
}

/// A name for an open descriptor, which may be a regular file that must not be replaced under its owner.
pub(crate) fn is_descriptor(path: &Path) -> bool {
    path.as_os_str() == "/dev/stderr" || path.starts_with("/dev/fd") || path.starts_with("/proc/self/fd")
}

/// Folder of `target`, `.` where it has none.
pub(crate) fn folder_of(target: &Path) -> &Path {
    match target.parent() {
        Some(folder) if folder.as_os_str().is_empty() => Path::new("."),
        Some(folder) => folder,
        None => target,
    }
}

/// `path` with symbolic links in its last component followed, also where they lead to nothing yet.
pub(crate) fn follow_links(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_owned();
    // As many as Linux follows.
    for _ in 0..40 {
        match std::fs::read_link(&target) {
            Ok(link) => target = folder_of(&target).join(link),
            Err(_) => return Ok(target),
        }
    }
    Err(io::Error::other("too many symbolic links"))
}
