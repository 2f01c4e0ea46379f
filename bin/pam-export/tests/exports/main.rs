//! The program and what it writes.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

mod agreement;
mod cli;
mod desk;
