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
        } else if let Some(asked) = threads_of_environment(std::env::var(RAYON).ok().as_deref())? {
            rayon::ThreadPoolBuilder::new()
                .num_threads(asked)
                .build_global()
                .with_context(|| format!("cannot start {asked} threads ({RAYON})"))?;
        }
        Ok(Console::new(self.quiet, self.format))
    }
}

/// The variable that the pool of threads looks at where --threads is not given.
const RAYON: &str = "RAYON_NUM_THREADS";
/// Most threads.
const MOST_THREADS: usize = 1024;

/// Threads that the environment asks for; none where it asks for no number, or leaves it to us.
fn threads_of_environment(value: Option<&str>) -> anyhow::Result<Option<usize>> {
    let Some(value) = value.filter(|value| !value.is_empty() && value.bytes().all(|byte| byte.is_ascii_digit())) else {
        return Ok(None);
    };
    let asked = value.parse().unwrap_or(usize::MAX);
    anyhow::ensure!(
        asked <= MOST_THREADS,
        "{RAYON} asks for more than {MOST_THREADS} threads; set it to fewer, or give --threads"
    );
    Ok((asked > 0).then_some(asked))
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

/// A number of any sign and size, infinite ones included, but none that is no number.
///
/// # Errors
/// What was expected instead.
pub fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if !value.is_nan() => Ok(value),
        _ => Err("expected a number".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_environment_that_asks_for_too_many_threads_is_refused() {
        let asked = |value| threads_of_environment(value).map_err(|error| error.to_string());
        assert_eq!(asked(None), Ok(None));
        assert_eq!(asked(Some("few")), Ok(None));
        assert_eq!(asked(Some("0")), Ok(None));
        assert_eq!(asked(Some("3")), Ok(Some(3)));
        let expected = "RAYON_NUM_THREADS asks for more than 1024 threads; set it to fewer, or give --threads";
        for value in ["100000", "99999999999999999999999999"] {
            assert_eq!(asked(Some(value)), Err(expected.to_owned()));
        }
    }

    #[test]
    fn a_limit_is_a_number_above_zero() {
        assert_eq!(positive(" 2.5"), Ok(2.5));
        for text in ["nan", "-1", "0", "inf", "-0", "", "1 N"] {
            assert!(positive(text).is_err(), "{text}");
        }
    }
}
