//! Many muscles beside one another: which of them, which rig and which date differs.

mod args;
mod page;
mod run;

fn main() -> std::process::ExitCode {
    pam_cli::main_with_schema::<args::Args>(pam_artifact::schemas::FLEET_PLAN, run::run)
}
