//! Compare two models of a muscle on the same recordings.

mod args;
mod run;
mod tables;

fn main() -> std::process::ExitCode {
    pam_cli::main_with_schema::<args::Args>(pam_artifact::schemas::COMPARISON, run::run)
}
