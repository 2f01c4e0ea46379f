//! The program as a person meets it: messages, exit codes, files that are there or not.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

mod bench;
mod fits;
mod instruments;
mod mistakes;
mod outputs;
mod shards;
