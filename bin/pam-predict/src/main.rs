//! Predict the force of a pneumatic muscle from its model.

mod args;
mod figure;
mod metrics;
mod run;

fn main() -> std::process::ExitCode {
    pam_cli::main_with_schema::<args::Args>(pam_artifact::schemas::PREDICTION, run::run)
}
