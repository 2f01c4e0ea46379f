//! Elements: a tag and its data.

use super::format::Endian;

/// Type of an element that is an array.
pub(super) const MATRIX: u32 = 14;
/// Type of an element that holds another, compressed.
pub(super) const COMPRESSED: u32 = 15;

/// Why a file cannot be read on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Damaged(pub(super) &'static str);

/// An element.
#[derive(Debug, Clone, Copy)]
pub(super) struct Element<'a> {
    /// What its data are.
    pub(super) kind: u32,
    /// Its data.
    pub(super) data: &'a [u8],
}

/// Elements one after another.
#[derive(Debug, Clone)]
pub(super) struct Elements<'a> {
    rest: &'a [u8],
    pub(super) endian: Endian,
}

impl<'a> Elements<'a> {
    pub(super) fn new(bytes: &'a [u8], endian: Endian) -> Self {
        Self { rest: bytes, endian }
    }

    /// Whether nothing is left; a few bytes at the end hold no tag and are padding.
    pub(super) fn is_empty(&self) -> bool {
        self.rest.len() < 8
    }

    /// The next element.
    pub(super) fn next(&mut self) -> Result<Element<'a>, Damaged> {
        const SHORT: Damaged = Damaged("it ends within an element");
        let (tag, rest) = self.rest.split_first_chunk::<8>().ok_or(SHORT)?;
        let [a, b, c, d, e, f, g, h] = *tag;
        let word = self.endian.u32([a, b, c, d]);
        // Up to four bytes fit into the tag, whose first half then holds type and length.
        if word >> 16 != 0 {
            let length = (word >> 16) as usize;
            let data = self.rest.get(4..4 + length).filter(|_| length <= 4);
            self.rest = rest;
            return Ok(Element { kind: word & 0xffff, data: data.ok_or(Damaged("a short element is too long"))? });
        }
        let length = self.endian.u32([e, f, g, h]) as usize;
        let data = rest.get(..length).ok_or(SHORT)?;
        // What is compressed is not padded to whole words, and the last element need not be.
        let padded = if word == COMPRESSED { length } else { length.next_multiple_of(8) };
        self.rest = rest.get(padded..).unwrap_or(&[]);
        Ok(Element { kind: word, data })
    }
}
