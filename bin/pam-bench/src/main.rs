//! Record a protocol on a virtual bench.

mod args;
mod run;

use clap::Parser;

fn main() -> std::process::ExitCode {
    run::main(&args::Args::parse())
}
