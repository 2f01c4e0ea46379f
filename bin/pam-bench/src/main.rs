//! Record a protocol on a virtual bench.

mod args;
mod muscle_file;
mod run;
mod truth;

fn main() -> std::process::ExitCode {
    pam_cli::main_with_schema::<args::Args>(pam_artifact::schemas::BENCH_TRUTH, run::run)
}
