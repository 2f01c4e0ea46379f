//! Chunks in an unnamed temporary file: written once in order, read by position from any thread.

use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

/// The file; the system removes it with the last handle, also after a crash.
#[derive(Debug)]
pub(crate) struct Spill {
    file: File,
    chunk_len: usize,
    bytes: Vec<u8>,
    #[cfg(not(unix))]
    cursor: std::sync::Mutex<()>,
}

impl Spill {
    /// A file in `directory` for chunks of `chunk_len` numbers; only the last may have fewer.
    pub(crate) fn create(directory: &Path, chunk_len: usize) -> io::Result<Self> {
        Ok(Self {
            file: tempfile::tempfile_in(directory)?,
            chunk_len,
            bytes: Vec::with_capacity(chunk_len * 8),
            #[cfg(not(unix))]
            cursor: std::sync::Mutex::new(()),
        })
    }

    /// Writes the next chunk.
    pub(crate) fn append(&mut self, chunk: &[f64]) -> io::Result<()> {
        self.bytes.clear();
        self.bytes.extend(chunk.iter().flat_map(|value| value.to_le_bytes()));
        self.file.write_all(&self.bytes)
    }

    /// Reads `len` numbers of chunk `index`.
    pub(crate) fn read(&self, index: usize, len: usize) -> io::Result<Vec<f64>> {
        let mut bytes = vec![0; len * 8];
        self.read_at(&mut bytes, (index * self.chunk_len * 8) as u64)?;
        let (numbers, _) = bytes.as_chunks::<8>();
        Ok(numbers.iter().map(|number| f64::from_le_bytes(*number)).collect())
    }

    #[cfg(unix)]
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<()> {
        std::os::unix::fs::FileExt::read_exact_at(&self.file, bytes, offset)
    }

    /// Other systems move the file's cursor, so readers take turns.
    #[cfg(not(unix))]
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<()> {
        use std::io::{Read, Seek, SeekFrom};
        let _turn = self.cursor.lock().map_err(|_| io::Error::other("a reading thread panicked"))?;
        let mut file = &self.file;
        file.seek(SeekFrom::Start(offset))?;
        file.read_exact(bytes)
    }
}
