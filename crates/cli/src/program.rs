//! From the command line to the exit code.

use std::io::Write as _;
use std::process::ExitCode;

use clap::Parser;
use clap::error::ErrorKind;
use schemars::JsonSchema;

use crate::about::{self, Schema};
use crate::exit::usage_error;
use crate::message::Format;
use crate::{OutputError, Verdict, exit_code, interrupt};

/// A whole `main`: parses the arguments, runs, and turns the result into an exit code.
///
/// Mistakes on the command line are one line on standard error, like every other error; `--help` and
/// `--version` go to standard output.
pub fn main<Args: Parser>(run: impl FnOnce(&Args) -> anyhow::Result<Verdict>) -> ExitCode {
    program(run, None)
}

/// Like [`main`](main()), for a program whose artifact is an `Artifact`: `--schema` prints the artifact's JSON
/// schema and stops. It is accepted without the arguments that are required otherwise.
pub fn main_with_schema<Args: Parser, Artifact: JsonSchema>(
    run: impl FnOnce(&Args) -> anyhow::Result<Verdict>,
) -> ExitCode {
    program(run, Some(about::schema::<Artifact>))
}

fn print(text: &[u8]) -> Result<(), OutputError> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(text).and_then(|()| stdout.flush()).map_err(|reason| OutputError::from_io("-".as_ref(), reason))
}

fn program<Args: Parser>(run: impl FnOnce(&Args) -> anyhow::Result<Verdict>, artifact: Option<Schema>) -> ExitCode {
    interrupt::end_on_panic();
    interrupt::start();
    let command = || about::with_options(Args::command(), artifact.is_some());
    let format = Format::of_command_line();
    let printed = |text: &[u8]| exit_code(print(text).map(|()| Verdict::Accepted).map_err(Into::into), format);
    let parsed = command().try_get_matches().and_then(|matches| match about::asked_for(&matches, command, artifact) {
        Some(text) => Ok(Err(text)),
        None => Args::from_arg_matches(&matches).map(Ok),
    });
    match parsed {
        Ok(Ok(args)) => exit_code(run(&args), format),
        Ok(Err(text)) => printed(&text),
        Err(error) if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) => {
            printed(error.render().to_string().as_bytes())
        }
        Err(error) => usage_error(&without_usage(&error.render().to_string()), format),
    }
}

/// The message of a command-line error without the usage lines below it, on one line.
fn without_usage(rendered: &str) -> String {
    let message = rendered.split("\nUsage:").next().unwrap_or(rendered);
    let message = message.split("\nFor more information").next().unwrap_or(message);
    let message = message.strip_prefix("error: ").unwrap_or(message);
    let paragraphs: Vec<String> =
        message.split("\n\n").map(crate::exit::flatten).filter(|paragraph| !paragraph.is_empty()).collect();
    format!("{}; see --help", paragraphs.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Parser)]
    struct Args {
        #[arg(long)]
        out: String,
        #[command(flatten)]
        run: crate::RunArgs,
    }

    fn message(arguments: &[&str]) -> String {
        without_usage(&Args::try_parse_from(arguments).unwrap_err().render().to_string())
    }

    #[test]
    fn a_mistake_on_the_command_line_is_one_line_with_the_way_out() {
        assert_eq!(
            message(&["pam-x", "--sed", "1"]),
            "unexpected argument '--sed' found; tip: a similar argument exists: '--seed'; see --help"
        );
        assert_eq!(message(&["pam-x"]), "the following required arguments were not provided: --out <OUT>; see --help");
        assert_eq!(
            message(&["pam-x", "--out", "x", "--seed", "few"]),
            "invalid value 'few' for '--seed <N>': invalid digit found in string; see --help"
        );
    }
}
