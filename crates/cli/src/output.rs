//! Output files that are complete or not there.
//!
//! A file is written beside its target under a temporary name and renamed when it is complete, so that a
//! reader sees the old or the new content and never half of it. What is no regular file (a device, a pipe,
//! standard output) cannot be renamed into place and is written directly.
//!
//! # Design
//! [`Output::open`] only tries whether a temporary can be created; the one that counts comes into being with
//! the first byte. So nothing is left behind even by a run that is killed while it computes. Nothing is
//! forced to the disk: a rename protects readers, not against loss of power.

use std::fs::{File, OpenOptions, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::interrupt::live;
use crate::target::{Claim, OTHER_PICTURES, ends_as_picture, folder_of, follow_links, is_descriptor, is_stdout};
use crate::temporary::Temporary;
use crate::{Console, OutputError};

/// One output of a run, opened before the work starts and committed when it is done. Dropped without being
/// committed, it leaves the target as it was.
///
/// It is a writer for what is too large to hold in memory; [`Output::finish`] then publishes what was written.
#[derive(Debug)]
pub struct Output {
    /// As given on the command line, for messages.
    path: PathBuf,
    sink: Sink,
    claim: Option<Claim>,
}

#[derive(Debug)]
enum Sink {
    /// Standard output.
    Stdout,
    /// A device, a pipe, a descriptor: cannot be replaced.
    Direct(BufWriter<File>),
    /// A regular file, present or future.
    Replace(Replacement),
}

#[derive(Debug)]
struct Replacement {
    /// Final path, symbolic links followed.
    target: PathBuf,
    /// Permissions of the file that will be replaced.
    permissions: Option<Permissions>,
    temporary: Option<BufWriter<Temporary>>,
}

impl Output {
    /// Checks that `path` can be written, `-` being standard output, and holds it for this run.
    ///
    /// # Errors
    /// [`OutputError`] names the path and the way out.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let path = path.as_ref();
        if ends_as_picture(path, &["png", "pdf"]) {
            return Err(OutputError::IsPicture { path: path.to_owned() });
        }
        Self::open_figure(path)
    }

    /// As [`open`](Self::open), for a figure, which may be SVG, PNG or PDF.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn open_figure(path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let path = path.as_ref().to_owned();
        if is_stdout(&path) {
            let claim = Claim::new(PathBuf::from("-"), &path)?;
            return Ok(Self { path, sink: Sink::Stdout, claim: Some(claim) });
        }
        if ends_as_picture(&path, &OTHER_PICTURES) {
            return Err(OutputError::AnotherPicture { path });
        }
        let fail = |reason| OutputError::from_io(&path, reason);
        let existing = match std::fs::metadata(&path) {
            Ok(metadata) => Some(metadata),
            Err(reason) if reason.kind() == io::ErrorKind::NotFound => None,
            Err(reason) if reason.kind() == io::ErrorKind::NotADirectory => None,
            Err(reason) => return Err(fail(reason)),
        };
        let ends_as_folder = path.as_os_str().as_encoded_bytes().ends_with(b"/");
        if existing.as_ref().is_some_and(std::fs::Metadata::is_dir) {
            return Err(OutputError::IsFolder { path });
        }
        if existing.as_ref().is_some_and(|metadata| !metadata.is_file()) || is_descriptor(&path) {
            let file = OpenOptions::new().append(is_descriptor(&path)).write(true).open(&path).map_err(fail)?;
            return Ok(Self { path, sink: Sink::Direct(BufWriter::new(file)), claim: None });
        }
        let target = follow_links(&path).map_err(fail)?;
        let folder = folder_of(&target);
        match std::fs::metadata(folder) {
            Ok(metadata) if !metadata.is_dir() => {
                return Err(OutputError::NotAFolder { folder: folder.to_owned(), path });
            }
            Err(reason) if reason.kind() == io::ErrorKind::NotFound => {
                return Err(OutputError::MissingFolder { folder: folder.to_owned(), path });
            }
            Err(reason) if reason.kind() == io::ErrorKind::NotADirectory => {
                return Err(OutputError::NotAFolder { folder: folder.to_owned(), path });
            }
            Err(reason) => return Err(fail(reason)),
            Ok(_) => {}
        }
        if ends_as_folder {
            return Err(OutputError::MissingFolder { folder: path.clone(), path });
        }
        let permissions = existing.map(|metadata| metadata.permissions());
        if permissions.as_ref().is_some_and(Permissions::readonly) {
            return Err(OutputError::ReadOnly { path });
        }
        let Some(name) = target.file_name() else { return Err(OutputError::IsFolder { path }) };
        let claim = Claim::new(std::fs::canonicalize(folder).map_err(fail)?.join(name), &path)?;
        drop(Temporary::create_beside(&target).map_err(fail)?);
        let sink = Sink::Replace(Replacement { target, permissions, temporary: None });
        Ok(Self { path, sink, claim: Some(claim) })
    }

    /// Refuses an output that would replace one of the run's inputs.
    ///
    /// # Errors
    /// [`OutputError::IsInput`].
    pub fn apart_from<P: AsRef<Path>>(self, inputs: impl IntoIterator<Item = P>) -> Result<Self, OutputError> {
        if let (Sink::Replace(_), Some(claim)) = (&self.sink, &self.claim) {
            for input in inputs {
                if std::fs::canonicalize(input).is_ok_and(|input| input == claim.target) {
                    return Err(OutputError::IsInput { path: self.path.clone() });
                }
            }
        }
        Ok(self)
    }

    /// Path as given on the command line.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes `bytes` and publishes them.
    ///
    /// # Errors
    /// [`OutputError`]; the target is then as it was.
    pub fn commit(self, bytes: impl AsRef<[u8]>) -> Result<(), OutputError> {
        commit_all([(self, bytes)])
    }

    /// Publishes what was written.
    ///
    /// # Errors
    /// [`OutputError`]; the target is then as it was.
    pub fn finish(self) -> Result<(), OutputError> {
        finish_all([self])
    }

    fn try_write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.sink {
            Sink::Stdout => io::stdout().lock().write(bytes),
            Sink::Direct(file) => file.write(bytes),
            Sink::Replace(replacement) => replacement.temporary()?.write(bytes),
        }
    }

    /// Hands everything to the system; permissions of a replaced file are carried over.
    fn settle(&mut self) -> Result<(), OutputError> {
        let settled = match &mut self.sink {
            Sink::Stdout => io::stdout().lock().flush(),
            Sink::Direct(file) => file.flush(),
            Sink::Replace(replacement) => replacement.settle(),
        };
        settled.map_err(|reason| OutputError::from_io(&self.path, reason))
    }
}

impl Write for Output {
    /// An error already carries the message of an [`OutputError`].
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.try_write(bytes).map_err(|reason| match reason.kind() {
            io::ErrorKind::Interrupted => reason,
            kind => io::Error::new(kind, OutputError::from_io(&self.path, reason)),
        })
    }

    /// Does nothing: bytes are on their way when [`Output::finish`] says so.
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes `bytes` to `path`, all or nothing.
///
/// # Errors
/// See [`Output::open`] and [`Output::commit`].
pub fn write_file(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> Result<(), OutputError> {
    Output::open(path)?.commit(bytes)
}

/// Writes several outputs and publishes them together: nothing is renamed before everything is written.
///
/// # Errors
/// See [`Output::commit`].
pub fn commit_all<B: AsRef<[u8]>>(outputs: impl IntoIterator<Item = (Output, B)>) -> Result<(), OutputError> {
    let mut written = Vec::new();
    for (mut output, bytes) in outputs {
        let result = match &mut output.sink {
            Sink::Stdout => io::stdout().lock().write_all(bytes.as_ref()),
            Sink::Direct(file) => file.write_all(bytes.as_ref()),
            Sink::Replace(replacement) => {
                replacement.temporary().and_then(|temporary| temporary.write_all(bytes.as_ref()))
            }
        };
        result.map_err(|reason| OutputError::from_io(&output.path, reason))?;
        written.push(output);
    }
    finish_all(written)
}

/// Publishes several outputs together with [`commit_all`], and notes which files they are.
///
/// # Errors
/// See [`Output::commit`].
pub fn publish(outputs: Vec<(Output, Vec<u8>)>, console: &Console) -> Result<(), OutputError> {
    let mut written: Vec<String> = outputs.iter().map(|(output, _)| output.path().display().to_string()).collect();
    commit_all(outputs)?;
    written.retain(|path| path != "-");
    if let Some(last) = written.pop() {
        let others = if written.is_empty() { String::new() } else { format!("{} and ", written.join(", ")) };
        console.note(format!("wrote {others}{last}"));
    }
    Ok(())
}

/// A value as JSON that people can read: indented, with a line break at its end.
///
/// # Errors
/// Where a value cannot be serialized.
pub fn pretty_json(value: &impl Serialize) -> serde_json::Result<Vec<u8>> {
    let mut json = serde_json::to_vec_pretty(value)?;
    json.push(b'\n');
    Ok(json)
}

/// Publishes several outputs together; see [`commit_all`].
///
/// # Errors
/// See [`Output::finish`].
pub fn finish_all(outputs: impl IntoIterator<Item = Output>) -> Result<(), OutputError> {
    let mut outputs: Vec<Output> = outputs.into_iter().collect();
    for output in &mut outputs {
        output.settle()?;
    }
    let mut live = live();
    let mut result = Ok(());
    for output in &mut outputs {
        let Sink::Replace(replacement) = &mut output.sink else { continue };
        let Some(file) = replacement.temporary.as_mut().and_then(|writer| writer.get_mut().file.take()) else {
            continue;
        };
        live.temporaries.remove(file.path());
        if let Err(error) = file.persist(&replacement.target) {
            result = Err(OutputError::from_io(&output.path, error.error));
            break;
        }
    }
    // Before the outputs are dropped: they take the registry to release their targets.
    drop(live);
    result
}

impl Replacement {
    fn temporary(&mut self) -> io::Result<&mut BufWriter<Temporary>> {
        let temporary = match self.temporary.take() {
            Some(temporary) => temporary,
            None => BufWriter::with_capacity(1 << 16, Temporary::create_beside(&self.target)?),
        };
        Ok(self.temporary.insert(temporary))
    }

    fn settle(&mut self) -> io::Result<()> {
        let permissions = self.permissions.clone();
        let temporary = self.temporary()?;
        temporary.flush()?;
        match (permissions, &temporary.get_ref().file) {
            (Some(permissions), Some(file)) => file.as_file().set_permissions(permissions),
            _ => Ok(()),
        }
    }
}
