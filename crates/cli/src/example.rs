//! Configuration files to begin with.

use std::path::Path;

use crate::{Console, Output, RunArgs};

/// Writes a configuration that the program accepts as it is, to `out` or else to standard output; with `--check`
/// nothing.
///
/// # Errors
/// [`OutputError`](crate::OutputError) where it cannot be written.
pub fn write_example(text: &str, out: Option<&Path>, run: &RunArgs, console: &Console) -> anyhow::Result<()> {
    if run.check {
        return Ok(());
    }
    let output = Output::open(out.unwrap_or("-".as_ref()))?;
    let path = output.path().display().to_string();
    output.commit(text)?;
    if path != "-" {
        console.note(format!("wrote {path}; fill in what you measured"));
    }
    Ok(())
}
