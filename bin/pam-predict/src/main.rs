//! Predict the force of a pneumatic muscle from its model.

mod args;
mod run;

fn main() -> std::process::ExitCode {
    pam_cli::main(run::run)
}
