//! Options that every program takes.

use anyhow::Context as _;

use crate::{Console, Format, interrupt};

/// Options that every program takes; flatten it into the program's own.
#[derive(Debug, Clone, clap::Args)]
pub struct RunArgs {
    /// Say nothing on standard error but errors.
    #[arg(long, short)]
    pub quiet: bool,
    /// What standard error is written as: text for people, or one JSON object per line for machines.
    #[arg(long, value_name = "FORMAT", default_value = "text")]
    pub format: Format,
    /// Seed of every random draw.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Threads to work with; 0 takes every core. Results do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1024))]
    pub threads: u32,
    /// Check the inputs, write nothing and stop.
    #[arg(long)]
    pub check: bool,
}

impl RunArgs {
    /// Prepares the process: Ctrl-C, the pool of threads, and what may go to standard error. Call it once,
    /// before any parallel work.
    ///
    /// # Errors
    /// Where the system refuses the threads.
    pub fn start(&self) -> anyhow::Result<Console> {
        interrupt::start();
        if self.threads > 0 {
            rayon::ThreadPoolBuilder::new()
                .num_threads(self.threads as usize)
                .build_global()
                .with_context(|| format!("cannot start {} threads", self.threads))?;
        }
        Ok(Console::new(self.quiet, self.format))
    }
}

/// A number above zero, as limits are.
///
/// # Errors
/// What was expected instead.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a number above 0".to_owned()),
    }
}
