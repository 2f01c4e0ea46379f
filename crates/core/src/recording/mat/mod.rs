//! MATLAB files of level 5, as MATLAB (`save -v6`, `save -v7`), Simulink and dSPACE ControlDesk write them.
//!
//! A file is a header of 128 bytes and elements, each a tag (type, number of bytes) and its data, compressed (zlib)
//! or not; an array is an element of elements: flags, dimensions, name, and numbers or further arrays. Source: The
//! MathWorks, "MAT-File Format", 2019, chapter 1.
//!
//! In reading order: `version` tells what lies before us; `element` walks over tags; `array` makes values of them,
//! which borrow from the file; `signals` finds columns and their names among the values; `read` takes their rows.
//!
//! No byte makes the reader panic: every length is checked against what is there, and what a compressed element may
//! grow to is bounded by the size of the file.

mod array;
mod element;
mod read;
mod signals;
mod version;

pub(super) use read::read;
pub(super) use version::{Kind, kind};
