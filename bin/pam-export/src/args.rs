//! Command line of `pam-export`.

use std::path::PathBuf;

use clap::Parser;
use pam_cli::{ReadArgs, RunArgs};

/// Write a muscle's model and its inverse for C, Python, Simulink and MuJoCo.
///
/// The C header allocates nothing: a state, a step function with the effects and their memories, the inverse network, and
/// kinematics from a pressure and a length as they are measured. A program that checks it stands beside it.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Examples: a header for a microcontroller, checked on this computer\n  \
                  pam-export --model model.json --inverse inverse.json --c muscle.h\n  \
                  cc -std=c99 -O2 -o check muscle_check.c -lm && ./check\n\
                  Everything that pam-predict computes along a recording, and the header against it\n  \
                  pam-export run3.csv --model model.json --vectors vectors.csv && ./check vectors.csv\n  \
                  pam-export log.lvm --channels bench.toml --model model.json --vectors vectors.csv\n\
                  A Python module that reads model.json and inverse.json, tables for Simulink, a scene for MuJoCo\n  \
                  pam-export --model model.json --python pam_muscle.py --simulink muscle.m --mujoco muscle.xml\n\n\
                  Exit codes: 0 done; 2 input or usage."
)]
pub(crate) struct Args {
    /// Recording for --vectors; - is standard input.
    #[arg(value_name = "LOG", requires = "vectors")]
    pub(crate) log: Option<PathBuf>,

    /// Model that pam-identify or pam-diagnose wrote.
    #[arg(long, value_name = "MODEL.json")]
    pub(crate) model: PathBuf,

    /// Its inverse, which pam-train-inverse wrote, for --c and --simulink.
    #[arg(long, value_name = "INVERSE.json")]
    pub(crate) inverse: Option<PathBuf>,

    /// C99 header to write, and beside it the program that checks it: MUSCLE_check.c.
    #[arg(long, value_name = "MUSCLE.h")]
    pub(crate) c: Option<PathBuf>,

    /// Python module to write; it reads model and inverse itself, and needs NumPy alone.
    #[arg(long, value_name = "MODULE.py")]
    pub(crate) python: Option<PathBuf>,

    /// MATLAB script to write: breakpoints and tables for the n-D Lookup Table block.
    #[arg(long, value_name = "MUSCLE.m")]
    pub(crate) simulink: Option<PathBuf>,

    /// MuJoCo scene to write: a general actuator on a tendon, without a plugin.
    #[arg(long, value_name = "MUSCLE.xml")]
    pub(crate) mujoco: Option<PathBuf>,

    /// Test vectors to write (CSV, every digit): what the model sees and its force, along LOG or else a path through the operating
    /// range.
    #[arg(long, value_name = "VECTORS.csv")]
    pub(crate) vectors: Option<PathBuf>,

    /// Leave out effects of sensors and bench, as an inverse and a lift do; without it all are in it, as in pam-predict.
    #[arg(long)]
    pub(crate) muscle_only: bool,

    /// Go on where ranges or correlations of LOG say that an instrument is wrong, or that it is of another muscle.
    #[arg(long)]
    pub(crate) accept_implausible: bool,

    #[command(flatten)]
    pub(crate) read: ReadArgs,

    #[command(flatten)]
    pub(crate) run: RunArgs,
}
