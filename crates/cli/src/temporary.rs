//! Temporary files that an interrupt deletes.

use std::io::{self, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::interrupt::live;
use crate::target::folder_of;

/// A temporary that the registry knows, so that an interrupt deletes it.
#[derive(Debug)]
pub(crate) struct Temporary {
    /// Present until it is renamed.
    pub(crate) file: Option<NamedTempFile>,
}

impl Temporary {
    /// Creates one in the folder of `target`, with the permissions of a file created the plain way.
    pub(crate) fn create_beside(target: &Path) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        // A short name of its own: the target's may already be as long as the system allows.
        builder.prefix(".pam-").suffix(".tmp");
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut live = live();
        let file = builder.tempfile_in(folder_of(target))?;
        live.temporaries.insert(file.path().to_owned());
        Ok(Self { file: Some(file) })
    }
}

impl Write for Temporary {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.file {
            Some(file) => file.write(bytes),
            None => Ok(0),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(file) = self.file.take() {
            let path = file.path().to_owned();
            let mut live = live();
            drop(file);
            live.temporaries.remove(&path);
        }
    }
}
