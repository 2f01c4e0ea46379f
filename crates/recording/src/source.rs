//! Where the bytes come from: a file, standard input, compressed or not; hashed as they pass.

use std::cell::{Cell, RefCell};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read};
use std::path::Path;
use std::rc::Rc;

use flate2::bufread::MultiGzDecoder;
use sha2::{Digest, Sha256};

use super::digest::hexadecimal;
use super::error::ReadErrorKind;
use crate::spelling::unreadable;

/// Bytes asked of the system at once.
const READ_BYTES: usize = 256 * 1024;

/// First bytes of a gzip member.
const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

/// Passes bytes on and takes note of their digest.
struct Hashing {
    inner: Box<dyn Read>,
    digest: Rc<RefCell<Sha256>>,
    n_stored: Rc<Cell<u64>>,
}

impl Read for Hashing {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n_bytes = self.inner.read(buffer)?;
        self.digest.borrow_mut().update(&buffer[..n_bytes]);
        self.n_stored.set(self.n_stored.get() + n_bytes as u64);
        Ok(n_bytes)
    }
}

/// The bytes of a recording, decompressed.
pub(crate) struct ByteSource {
    reader: Decoded,
    digest: Rc<RefCell<Sha256>>,
    /// Bytes taken so far, as they are stored.
    n_stored: Rc<Cell<u64>>,
    /// Bytes of the file.
    n_bytes: Option<u64>,
}

enum Decoded {
    Plain(BufReader<Hashing>),
    Gzip(Box<MultiGzDecoder<BufReader<Hashing>>>),
}

impl ByteSource {
    /// Opens a file, or standard input where `path` is `-`.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadErrorKind> {
        if path.as_os_str() == "-" {
            return Self::over(Box::new(io::stdin()));
        }
        let opened = File::open(path).and_then(|file| Ok((file.metadata()?, file)));
        match opened {
            Ok((metadata, _)) if metadata.is_dir() => Err(ReadErrorKind::Directory),
            Ok((metadata, file)) => {
                let n_bytes = Some(metadata.len()).filter(|_| metadata.is_file());
                Ok(Self { n_bytes, ..Self::over(Box::new(file))? })
            }
            Err(source) => Err(match source.kind() {
                io::ErrorKind::NotFound => ReadErrorKind::NotFound { remedy: unreadable(path, &source) },
                io::ErrorKind::PermissionDenied => ReadErrorKind::PermissionDenied,
                io::ErrorKind::IsADirectory => ReadErrorKind::Directory,
                _ => ReadErrorKind::Unreadable { source },
            }),
        }
    }

    /// Reads from anything.
    pub(crate) fn over(inner: Box<dyn Read>) -> Result<Self, ReadErrorKind> {
        let digest = Rc::new(RefCell::new(Sha256::new()));
        let mut start = Vec::new();
        let mut inner = inner;
        let unreadable = |source| ReadErrorKind::Unreadable { source };
        (&mut inner).take(GZIP_MAGIC.len() as u64).read_to_end(&mut start).map_err(unreadable)?;
        let is_gzip = start == GZIP_MAGIC;
        let whole = Box::new(Cursor::new(start).chain(inner));
        let n_stored = Rc::new(Cell::new(0));
        let hashing = Hashing { inner: whole, digest: Rc::clone(&digest), n_stored: Rc::clone(&n_stored) };
        let buffered = BufReader::with_capacity(READ_BYTES, hashing);
        let reader =
            if is_gzip { Decoded::Gzip(Box::new(MultiGzDecoder::new(buffered))) } else { Decoded::Plain(buffered) };
        Ok(Self { reader, digest, n_stored, n_bytes: None })
    }

    /// Bytes taken so far, as they are stored.
    pub(crate) fn n_stored(&self) -> u64 {
        self.n_stored.get()
    }

    /// Bytes that are stored, where that is known.
    pub(crate) fn n_bytes(&self) -> Option<u64> {
        self.n_bytes
    }

    /// Fills what it can of `buffer`; 0 is the end.
    pub(crate) fn read(&mut self, buffer: &mut [u8]) -> Result<usize, ReadErrorKind> {
        loop {
            let read = match &mut self.reader {
                Decoded::Plain(reader) => reader.read(buffer),
                Decoded::Gzip(reader) => reader.read(buffer),
            };
            return match read {
                Ok(n_bytes) => Ok(n_bytes),
                Err(source) if source.kind() == io::ErrorKind::Interrupted => continue,
                Err(source) if source.kind() == io::ErrorKind::IsADirectory => Err(ReadErrorKind::Directory),
                Err(source) => Err(match self.reader {
                    Decoded::Gzip(_) => ReadErrorKind::DamagedGzip { source },
                    Decoded::Plain(_) => ReadErrorKind::Unreadable { source },
                }),
            };
        }
    }

    /// SHA-256 of the bytes as they were stored, to the end; hexadecimal.
    pub(crate) fn sha256(mut self) -> Result<String, ReadErrorKind> {
        let rest = match &mut self.reader {
            Decoded::Plain(reader) => reader,
            Decoded::Gzip(reader) => reader.get_mut(),
        };
        loop {
            let n_bytes = rest.fill_buf().map_err(|source| ReadErrorKind::Unreadable { source })?.len();
            if n_bytes == 0 {
                break;
            }
            rest.consume(n_bytes);
        }
        Ok(hexadecimal(&self.digest.take().finalize()))
    }
}
