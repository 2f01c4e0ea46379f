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

/// A name for standard output, dots and doubled slashes in it or not.
pub(crate) fn is_stdout(path: &Path) -> bool {
    let is = |path: &Path| ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].iter().any(|name| path == Path::new(name));
    // The folder is made plain, and the name in it stays: what it links to is a pipe without a name.
    let plain = || Some(std::fs::canonicalize(path.parent()?).ok()?.join(path.file_name()?));
    let own = || {
        let own = PathBuf::from(format!("/proc/{}/fd/1", std::process::id()));
        plain().is_some_and(|path| path == own || is(&path))
    };
    path.as_os_str() == "-" || is(path) || (path.is_absolute() && path.file_name().is_some() && own())
}

/// A name for an open descriptor, which may be a regular file that must not be replaced under its owner.
pub(crate) fn is_descriptor(path: &Path) -> bool {
    path.as_os_str() == "/dev/stderr" || path.starts_with("/dev/fd") || path.starts_with("/proc/self/fd")
}

/// Endings of pictures that no program here writes.
pub(crate) const OTHER_PICTURES: [&str; 10] = ["jpg", "jpeg", "gif", "bmp", "webp", "tif", "tiff", "eps", "ps", "emf"];

/// Whether `path` ends in one of `endings`.
pub(crate) fn ends_as_picture(path: &Path, endings: &[&str]) -> bool {
    path.extension().is_some_and(|ending| endings.iter().any(|known| ending.eq_ignore_ascii_case(known)))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn standard_output_is_known_under_all_its_names() {
        let own = format!("/proc/{}/fd/1", std::process::id());
        let names = [
            "-",
            "/dev/stdout",
            "/dev/./stdout",
            "//dev//stdout",
            "/dev/fd/1",
            "/dev/../dev/fd/./1",
            "/dev/shm/../stdout",
            &own,
        ];
        for name in names {
            assert!(is_stdout(Path::new(name)), "{name}");
        }
        for name in ["/dev/stderr", "/dev/fd/2", "stdout", "./-", "/", "..", "/dev/null"] {
            assert!(!is_stdout(Path::new(name)), "{name}");
        }
    }
}
