//! Exit codes: 0 accepted, 1 finished but rejected, 2 input or usage.

use std::io::ErrorKind;
use std::process::ExitCode;

use crate::OutputError;
use crate::message::{Format, Message, Said};
use crate::target::is_stdout;

/// What a program that ran to its end thinks of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Done and good: exit code 0.
    Accepted,
    /// Done, but it did not converge, is not explained, or misses a limit: exit code 1.
    Rejected,
}

/// Exit code of a run; an error becomes exactly one line on standard error, `error: ` and the chain of
/// reasons joined by `: `, or its like in JSON, and exit code 2. Where the reader of standard output has left
/// (`| head -1`), it had enough: exit code 2 without a word.
pub fn exit_code(result: anyhow::Result<Verdict>, format: Format) -> ExitCode {
    match result {
        Ok(Verdict::Accepted) => ExitCode::SUCCESS,
        Ok(Verdict::Rejected) => ExitCode::from(1),
        Err(error) if is_unread(&error) => ExitCode::from(2),
        Err(error) => usage_error(&one_line(&error), format),
    }
}

/// Prints the error and gives exit code 2.
pub(crate) fn usage_error(message: &str, format: Format) -> ExitCode {
    // Where standard error is closed too, the exit code has to do.
    Message::Error(Said::new(message)).write(format);
    ExitCode::from(2)
}

/// Whether standard output was closed before everything was written.
fn is_unread(error: &anyhow::Error) -> bool {
    let unread = |output: &OutputError| matches!(output, OutputError::Closed { path } if is_stdout(path));
    error.chain().any(|cause| match cause.downcast_ref::<std::io::Error>() {
        // An output wraps what it says of itself into the error of a writer, which shows it to nobody else.
        Some(reason) => match reason.get_ref() {
            Some(inner) => inner.downcast_ref().is_some_and(unread),
            None => reason.kind() == ErrorKind::BrokenPipe,
        },
        None => cause.downcast_ref().is_some_and(unread),
    })
}

/// The chain of reasons; one that its predecessor has already quoted is left out.
fn one_line(error: &anyhow::Error) -> String {
    let mut line = String::new();
    for cause in error.chain() {
        let text = cause.to_string();
        if line.is_empty() {
            line = text;
        } else if text.starts_with(&line) {
            // A reason that says what could not be done, as its context does.
            line = text;
        } else if !line.ends_with(&text) {
            line.push_str(": ");
            line.push_str(&text);
        }
    }
    line
}

/// `text` on one line: line breaks and the blanks around them become one blank.
pub(crate) fn flatten(text: &str) -> String {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" ")
}

/// `text` with characters that would steer a terminal made visible: names of files and words of artifacts are written by
/// others.
pub(crate) fn visible(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        let steers = character.is_control() && character != '\n' && character != '\t';
        // Marks that turn the direction of writing hide what stands after them.
        let turns = matches!(character, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        if steers || turns {
            shown.extend(character.escape_unicode());
        } else {
            shown.push(character);
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context as _;

    #[test]
    fn a_chain_of_reasons_is_one_line() {
        let error = std::io::Error::other("first\n  second\n");
        let error = Err::<(), _>(error).context("cannot read a.csv").context("cannot identify").unwrap_err();
        assert_eq!(flatten(&one_line(&error)), "cannot identify: cannot read a.csv: first second");
    }

    #[test]
    fn a_reason_that_is_already_quoted_is_not_repeated() {
        let error = anyhow::anyhow!("no such thing").context("cannot open x: no such thing");
        assert_eq!(one_line(&error), "cannot open x: no such thing");
        let error = anyhow::anyhow!("cannot write x: no space").context("cannot write x");
        assert_eq!(one_line(&error), "cannot write x: no space");
    }

    #[test]
    fn nothing_that_is_said_steers_a_terminal() {
        assert_eq!(visible("a\u{1b}[31mb\r\u{7}\u{202e}c\tα\n"), "a\\u{1b}[31mb\\u{d}\\u{7}\\u{202e}c\tα\n");
    }

    #[test]
    fn a_reader_that_left_is_told_from_other_troubles() {
        let closed = |path: &str| anyhow::Error::from(OutputError::Closed { path: path.into() }).context("writing");
        assert!(is_unread(&closed("-")));
        assert!(is_unread(&anyhow::Error::from(std::io::Error::from(ErrorKind::BrokenPipe)).context("writing")));
        let wrapped = std::io::Error::new(ErrorKind::BrokenPipe, OutputError::Closed { path: "-".into() });
        assert!(is_unread(&anyhow::Error::from(wrapped).context("writing")));
        assert!(!is_unread(&closed("fifo")));
        assert!(!is_unread(&anyhow::anyhow!("broken")));
    }
}
