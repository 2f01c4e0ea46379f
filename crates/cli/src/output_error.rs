//! Why an output cannot be written.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Why an output cannot be written; every message names the path and the way out.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The path names a folder.
    #[error("cannot write {}: it is a folder; name a file inside it", shown(path))]
    IsFolder {
        /// Path as given.
        path: PathBuf,
    },
    /// The folder does not exist.
    #[error("cannot write {}: folder {} does not exist; create it with `mkdir -p {}`", shown(path), folder.display(), folder.display())]
    MissingFolder {
        /// Path as given.
        path: PathBuf,
        /// Folder that is missing.
        folder: PathBuf,
    },
    /// What should be the folder is a file.
    #[error("cannot write {}: {} is not a folder; name another path", shown(path), folder.display())]
    NotAFolder {
        /// Path as given.
        path: PathBuf,
        /// File in the folder's place.
        folder: PathBuf,
    },
    /// The file exists and is protected.
    #[error("cannot write {}: the file is read-only; make it writable or name another", shown(path))]
    ReadOnly {
        /// Path as given.
        path: PathBuf,
    },
    /// The system does not allow it.
    #[error("cannot write {}: permission denied; name a path in a folder that you may write to", shown(path))]
    Denied {
        /// Path as given.
        path: PathBuf,
    },
    /// The file system is mounted read-only.
    #[error("cannot write {}: the file system is read-only; name a path elsewhere", shown(path))]
    ReadOnlyFileSystem {
        /// Path as given.
        path: PathBuf,
    },
    /// No space is left.
    #[error("cannot write {}: no space left on the device; free some or name a path elsewhere", shown(path))]
    Full {
        /// Path as given.
        path: PathBuf,
    },
    /// Nobody reads any more.
    #[error("{} was closed before everything was written", shown(path))]
    Closed {
        /// Path as given, `-` for standard output.
        path: PathBuf,
    },
    /// Two outputs of one run have the same target.
    #[error("two outputs go to {}; name different ones", shown(path))]
    NamedTwice {
        /// Path as given the second time.
        path: PathBuf,
    },
    /// The output would replace one of the inputs.
    #[error("cannot write {}: it is also an input, which the run would destroy; name another", shown(path))]
    IsInput {
        /// Path as given.
        path: PathBuf,
    },
    /// The name is that of a picture in a format that is not written.
    #[error(
        "cannot write {}: figures are SVG, PNG or PDF; name it {}",
        shown(path),
        path.with_extension("png").display()
    )]
    AnotherPicture {
        /// Path as given.
        path: PathBuf,
    },
    /// The name is that of a picture, and the output is none.
    #[error(
        "cannot write {}: it is the name of a picture, and this output is none; give it another ending",
        shown(path)
    )]
    IsPicture {
        /// Path as given.
        path: PathBuf,
    },
    /// Anything else that the system says.
    #[error("cannot write {}: {reason}", shown(path))]
    Io {
        /// Path as given.
        path: PathBuf,
        /// Message of the system.
        reason: std::io::Error,
    },
}

impl OutputError {
    /// Sorts what the system said about `path`.
    pub(crate) fn from_io(path: &Path, reason: std::io::Error) -> Self {
        let path = path.to_owned();
        match reason.kind() {
            ErrorKind::IsADirectory => Self::IsFolder { path },
            ErrorKind::PermissionDenied => Self::Denied { path },
            ErrorKind::ReadOnlyFilesystem => Self::ReadOnlyFileSystem { path },
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => Self::Full { path },
            ErrorKind::BrokenPipe => Self::Closed { path },
            _ => Self::Io { path, reason },
        }
    }
}

/// `-` in words, everything else as it is.
fn shown(path: &Path) -> std::path::Display<'_> {
    if path.as_os_str() == "-" { Path::new("standard output").display() } else { path.display() }
}
