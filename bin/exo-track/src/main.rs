//! Simulate a lift with an elbow exoskeleton.

mod args;
mod figure;
mod network;
mod run;
mod tables;
mod track;

fn main() -> std::process::ExitCode {
    pam_cli::main_with_schema::<args::Args>(pam_artifact::schemas::METRICS, run::run)
}
