//! MATLAB files of level 5, as MATLAB (`save -v6`, `save -v7`), Simulink and dSPACE ControlDesk write them.
//!
//! A file is a header of 128 bytes and elements, each a tag (type, number of bytes) and its data, compressed (zlib)
//! or not; an array is an element of elements: flags, dimensions, name, and numbers or further arrays. Source: The
//! MathWorks, "MAT-File Format", 2019, chapter 1.
//!
//! [`format_of`] recognizes the formats of MATLAB by their first bytes; a [`MatFile`] holds the elements of one of
//! level 5, and its [`Signals`] are the columns of numbers in it, each with [`Label`]s. In reading order: `format`,
//! `element` (tags), `file` (decompression), `array` (values, which borrow from the file) and `signals` (columns).
//!
//! No byte makes the reader panic: every length is checked against the bytes that are there, and the caller bounds
//! the size that compressed elements may grow to.
//!
//! # Design
//! A crate of its own, because nothing here knows a muscle or a unit. The published alternatives lack parts that logs
//! of Simulink and dSPACE consist of: `matfile` 0.5 reads numeric arrays alone (no structure, cell or text) and
//! decompresses without a bound; `matio-rs` wraps a C library, which a user would have to install.

mod array;
mod element;
mod file;
mod format;
mod signals;

pub use file::{MatError, MatFile};
pub use format::{Format, format_of};
pub use signals::{Column, Label, Object, Signals};
