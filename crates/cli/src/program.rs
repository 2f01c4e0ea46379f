//! From the command line to the exit code.

use std::io::Write as _;
use std::process::ExitCode;

use clap::Parser;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::about;
use crate::exit::usage_error;
use crate::message::Format;
use crate::{OutputError, Verdict, exit_code, interrupt, nearest};

/// A whole `main`: parses the arguments, runs, and turns the result into an exit code.
///
/// Mistakes on the command line are one line on standard error, like every other error; `--help` and
/// `--version` go to standard output.
pub fn main<Args: Parser>(run: impl FnOnce(&Args) -> anyhow::Result<Verdict>) -> ExitCode {
    program(run, None)
}

/// Like [`main`](main()), for a program whose artifact has the JSON schema `schema`: `--schema` prints that and stops. It is
/// accepted without the arguments that are required otherwise.
pub fn main_with_schema<Args: Parser>(schema: &str, run: impl FnOnce(&Args) -> anyhow::Result<Verdict>) -> ExitCode {
    program(run, Some(schema))
}

fn print(text: &[u8]) -> Result<(), OutputError> {
    let mut stdout = std::io::stdout().lock();
    stdout.write_all(text).and_then(|()| stdout.flush()).map_err(|reason| OutputError::from_io("-".as_ref(), reason))
}

fn program<Args: Parser>(run: impl FnOnce(&Args) -> anyhow::Result<Verdict>, artifact: Option<&str>) -> ExitCode {
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
        Err(error) => usage_error(&mistake(&error, &command()), format),
    }
}

/// What options are called elsewhere.
const OTHER_NAMES: [(&str, &str); 6] = [
    ("output", "out"),
    ("outfile", "out"),
    ("validation", "holdout"),
    ("hold-out", "holdout"),
    ("plot", "figure"),
    ("jobs", "threads"),
];

/// The message of a command-line error on one line, with the option that was probably meant.
fn mistake(error: &clap::Error, command: &clap::Command) -> String {
    let message = without_usage(&error.render().to_string());
    let unknown = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(word)) if error.kind() == ErrorKind::UnknownArgument => word,
        _ => return message,
    };
    let options: Vec<&str> = command.get_arguments().filter_map(|argument| argument.get_long()).collect();
    let others = OTHER_NAMES.iter().filter(|(_, option)| options.contains(option)).map(|(name, _)| *name);
    let near = nearest(unknown.trim_start_matches('-'), options.iter().copied().chain(others));
    let meant = near.map(|near| OTHER_NAMES.iter().find(|(name, _)| *name == near).map_or(near, |(_, option)| *option));
    match meant {
        Some(near) if unknown.starts_with("--") => {
            format!("unexpected argument '{unknown}' found; did you mean --{near}? See --help")
        }
        // A value that looks like an option stands there as it is, and nobody wants it after "--".
        _ => match message.split_once("; tip: ") {
            Some((message, _)) => format!("{message}; see --help"),
            None => message,
        },
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
        mistake(&Args::try_parse_from(arguments).unwrap_err(), &<Args as clap::CommandFactory>::command())
    }

    #[test]
    fn a_mistake_on_the_command_line_is_one_line_with_the_way_out() {
        assert_eq!(
            message(&["pam-x", "--sed", "1"]),
            "unexpected argument '--sed' found; did you mean --seed? See --help"
        );
        for word in ["--ouput", "--output", "--oput"] {
            let expected = format!("unexpected argument '{word}' found; did you mean --out? See --help");
            assert_eq!(message(&["pam-x", word, "x"]), expected);
        }
        assert_eq!(message(&["pam-x", "--out", "x", "-1"]), "unexpected argument '-1' found; see --help");
        assert_eq!(message(&["pam-x", "--gearbox"]), "unexpected argument '--gearbox' found; see --help");
        assert_eq!(message(&["pam-x"]), "the following required arguments were not provided: --out <OUT>; see --help");
        assert_eq!(
            message(&["pam-x", "--out", "x", "--seed", "few"]),
            "invalid value 'few' for '--seed <N>': invalid digit found in string; see --help"
        );
    }
}
