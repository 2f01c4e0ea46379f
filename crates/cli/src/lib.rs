//! What the programs share, so that they behave alike.
//!
//! A program is its arguments and one function:
//!
//! ```no_run
//! # #[derive(clap::Parser)] struct Args { #[command(flatten)] run: pam_cli::RunArgs, #[arg(long)] out: std::path::PathBuf }
//! use pam_cli::{Output, Verdict};
//!
//! fn run(args: &Args) -> anyhow::Result<Verdict> {
//!     let console = args.run.start()?;
//!     let out = Output::open(&args.out)?; // before computing
//!     console.note("one line on standard error, unless --quiet");
//!     out.commit(b"{}\n")?; // all or nothing
//!     Ok(Verdict::Accepted)
//! }
//!
//! fn main() -> std::process::ExitCode {
//!     pam_cli::main_with_schema::<Args>(pam_artifact::schemas::MODEL, run)
//! }
//! ```
//!
//! In reading order: [`main`](main()) and exit codes, options ([`RunArgs`], [`ReadArgs`],
//! [`write_example`]), what goes to standard
//! error ([`Console`], [`Progress`], [`Message`]), what goes into files ([`Output`]), and what happens on Ctrl-C.

mod about;
mod console;
mod example;
mod exit;
mod interrupt;
mod inverse_of;
mod left_out;
mod message;
mod output;
mod output_error;
mod program;
mod read_args;
mod reading;
mod run_args;
mod style;
mod target;
mod temporary;

pub use console::{Console, Progress};
pub use example::write_example;
pub use exit::{Verdict, exit_code};
pub use interrupt::start;
pub use inverse_of::ensure_inverse_of;
pub use left_out::{for_any_recording, for_the_muscle};
pub use message::{Drawn, Format, Message, Said, Step};
pub use output::{Output, commit_all, finish_all, pretty_json, publish, write_file};
pub use output_error::OutputError;
pub use pam_recording::spelling::nearest;
pub use program::{main, main_with_schema};
pub use read_args::{ReadArgs, ReadAs};
pub use reading::{read_recording, read_recordings};
pub use run_args::{RunArgs, number, positive};
