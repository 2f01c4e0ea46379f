//! Identify a force model of a pneumatic muscle from bench recordings.

mod args;
mod figure;
mod run;
mod shard_args;
mod shards;
mod tables;

fn main() -> std::process::ExitCode {
    pam_cli::main_with_schema::<args::Args>(pam_artifact::schemas::MODEL, run::run)
}
