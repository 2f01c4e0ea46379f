//! The program as a person meets it: diagnoses of concealed effects, messages, exit codes, files that are there or not.

#![expect(clippy::unwrap_used, reason = "a test that fails may panic, and says what it measured")]

mod desk;
mod effects;
mod given;
mod mistakes;
mod real_muscles;
mod terms;
