//! Train the inverse of an identified muscle: force, length and direction to pressure.

mod args;
mod figure;
mod run;
mod tables;

fn main() -> std::process::ExitCode {
    pam_cli::main_with_schema::<args::Args>(pam_artifact::schemas::INVERSE, run::run)
}
