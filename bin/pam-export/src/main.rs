//! Write a muscle's model and its inverse for C, Python, Simulink and MuJoCo.

mod args;
mod run;

fn main() -> std::process::ExitCode {
    pam_cli::main(run::run)
}
