//! Diagnose where a force model and bench recordings differ, and which physics was left out.

mod args;
mod empirical;
mod explain;
mod group;
mod own;
mod page;
mod provenance;
mod run;
mod since;
mod tables;

/// A search makes and frees thousands of matrices of some megabytes: with the system's allocator a third of its time goes into
/// pages that are given back and fetched anew.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> std::process::ExitCode {
    pam_cli::main_with_schema::<args::Args>(pam_artifact::schemas::DIAGNOSIS, run::run)
}
