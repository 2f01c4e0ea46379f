//! From the bytes of a file to its variables.

use std::io::Read as _;

use flate2::read::ZlibDecoder;

use super::array::{self, Variable};
use super::element::{COMPRESSED, Damaged, Element, Elements};
use super::format::{Endian, HEADER_BYTES, level_5};
use super::signals::Signals;

/// Why a file cannot be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum MatError {
    /// The file contradicts itself or ends early.
    #[error("the MATLAB file is damaged or cut off ({reason})")]
    Damaged {
        /// The fault that was met first.
        reason: &'static str,
    },
    /// Compressed elements grow beyond the limit.
    #[error("the compressed data grows beyond {limit} bytes")]
    ExpandsTooFar {
        /// Bytes that all elements together may decompress to.
        limit: u64,
    },
}

impl From<Damaged> for MatError {
    fn from(Damaged(reason): Damaged) -> Self {
        Self::Damaged { reason }
    }
}

/// The elements of a file of level 5, decompressed.
#[derive(Debug)]
pub struct MatFile<'a> {
    endian: Endian,
    stored: Vec<Stored<'a>>,
}

/// An element as it lies in the file, or decompressed.
#[derive(Debug)]
enum Stored<'a> {
    Plain(Element<'a>),
    Expanded(Vec<u8>),
}

impl<'a> MatFile<'a> {
    /// Takes the elements out of `bytes`, a whole file; what is compressed may grow to `limit` bytes.
    ///
    /// # Errors
    /// A header of another format, an element that ends beyond the file, data that cannot be decompressed or that
    /// grow beyond the limit.
    pub fn open(bytes: &'a [u8], limit: u64) -> Result<Self, MatError> {
        let endian = level_5(bytes).ok_or(Damaged("it has no header of level 5"))?;
        let mut elements = Elements::new(bytes.get(HEADER_BYTES..).unwrap_or(&[]), endian);
        let mut stored = Vec::new();
        let mut left = limit;
        while !elements.is_empty() {
            let element = elements.next()?;
            if element.kind != COMPRESSED {
                stored.push(Stored::Plain(element));
                continue;
            }
            let mut expanded = Vec::new();
            ZlibDecoder::new(element.data)
                .take(left.saturating_add(1))
                .read_to_end(&mut expanded)
                .map_err(|_| Damaged("a compressed variable cannot be decompressed"))?;
            left = left.checked_sub(expanded.len() as u64).ok_or(MatError::ExpandsTooFar { limit })?;
            stored.push(Stored::Expanded(expanded));
        }
        Ok(Self { endian, stored })
    }

    /// The columns of numbers in the file.
    ///
    /// # Errors
    /// An array that contradicts itself.
    pub fn signals(&self) -> Result<Signals<'_>, MatError> {
        Ok(Signals::of(&self.variables()?))
    }

    fn variables(&self) -> Result<Vec<Variable<'_>>, Damaged> {
        let mut variables = Vec::new();
        for stored in &self.stored {
            let element = match stored {
                Stored::Plain(element) => *element,
                Stored::Expanded(bytes) => Elements::new(bytes, self.endian).next()?,
            };
            variables.extend(array::variable(element, self.endian)?);
        }
        Ok(variables)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn another_format_is_no_file_of_level_5() {
        let reason = "it has no header of level 5";
        assert_eq!(MatFile::open(b"time_s,force_N\n", 1 << 10).unwrap_err(), MatError::Damaged { reason });
    }

    proptest! {
        #[test]
        fn any_bytes_below_a_header_get_an_answer(
            words in prop::collection::vec(prop_oneof![0_u32..20, any::<u32>()], 0..60),
        ) {
            let mut bytes = [vec![b' '; 124].as_slice(), b"\0\x01IM"].concat();
            bytes.extend(words.into_iter().flat_map(u32::to_le_bytes));
            let limit = 1 << 16;
            match MatFile::open(&bytes, limit).as_ref().map(MatFile::signals) {
                Ok(Ok(signals)) => prop_assert!(signals.columns.iter().all(|column| column.len() as u64 <= limit)),
                Ok(Err(error)) => prop_assert!(error.to_string().contains("damaged")),
                Err(error) => prop_assert!(error.to_string().len() < 200),
            }
        }
    }
}
