//! Diagnose where a force model and bench recordings differ, and which physics was left out.

mod args;
mod explain;
mod page;
mod run;
mod tables;

fn main() -> std::process::ExitCode {
    pam_cli::main_with_schema::<args::Args, pam_core::artifact::DiagnosisArtifact>(run::run)
}
