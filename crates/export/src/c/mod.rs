//! The model in C99: a header without allocation, and a program that checks it.
//!
//! The header is text of [`parts`], which are C as they stand, under constants of one model. Only the effects that the model
//! has are in it. Names begin with the name of the file, so that headers of several muscles go into one program.

mod check;
mod constants;
mod header;
mod inverse;
mod parts;
mod sentence;

pub use check::check_program;
pub use header::{Header, header, prefix};
