//! Options of `pam-bench`.

use std::path::PathBuf;

use clap::{Parser, ValueEnum};

/// Record a protocol on a virtual bench.
#[derive(Debug, Parser)]
#[command(version)]
pub(crate) struct Args {
    /// Muscle file.
    #[arg(long, value_name = "M.toml", required_unless_present = "list_protocols")]
    pub(crate) muscle: Option<PathBuf>,
    /// Protocol by name.
    #[arg(long, value_name = "NAME", required_unless_present = "list_protocols")]
    pub(crate) protocol: Option<String>,
    /// Seed.
    #[arg(long, default_value_t = 0)]
    pub(crate) seed: u64,
    /// Sampling rate.
    #[arg(long, default_value_t = 200.0)]
    pub(crate) rate: f64,
    /// Duration relative to that in the catalogue.
    #[arg(long, default_value_t = 1.0)]
    pub(crate) duration_scale: f64,
    /// Factor on the noise of every channel.
    #[arg(long, default_value_t = 1.0)]
    pub(crate) noise: f64,
    /// Clock of the logger.
    #[arg(long, default_value = "ideal")]
    pub(crate) clock: Clock,
    /// Parameter of the true muscle.
    #[arg(long, value_name = "NAME=VALUE")]
    pub(crate) set: Vec<String>,
    /// Log to write; - is standard output.
    #[arg(long, value_name = "LOG.csv", required_unless_present = "list_protocols")]
    pub(crate) out: Option<PathBuf>,
    /// List the protocols.
    #[arg(long)]
    pub(crate) list_protocols: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum Clock {
    Ideal,
    Ms,
}
