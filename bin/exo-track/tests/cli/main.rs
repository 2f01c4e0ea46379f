//! The executable: a lift from files, and what it says to wrong ones.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic")]

mod folder;
mod lifts;
mod models;
mod outcomes;
