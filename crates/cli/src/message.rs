//! What goes to standard error, for people and for machines.

use std::io::Write as _;

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::Serialize;

use crate::exit::{flatten, visible};
use crate::style;

/// How standard error is written.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// Lines and tables for people.
    #[default]
    Text,
    /// One JSON object per line for machines.
    Json,
}

impl Format {
    /// The format that a command line asks for, right in all else or not.
    pub(crate) fn of_command_line() -> Self {
        let words = arguments();
        let pairs = words.windows(2).any(|pair| pair[0] == "--format" && pair[1] == "json");
        if pairs || words.iter().any(|word| word == "--format=json") { Self::Json } else { Self::Text }
    }
}

/// One line on standard error with `--format json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(tag = "level", rename_all = "lowercase")]
#[cfg_attr(feature = "schemas", schemars(title = "pam-messages/1"))]
pub enum Message {
    /// Worth knowing: what was assumed, found or written.
    Note(Said),
    /// May change what is done next: what was repaired, dropped or is doubtful, and why a result is rejected.
    Warning(Said),
    /// Why there is no result; the last line, with exit code 2.
    Error(Said),
    /// A result as drawn for people, in several lines; what programs need of it is in the artifact.
    Table(Drawn),
    /// How far a piece of work has come that takes over a second; at most one a second.
    Progress(Step),
}

/// Words, and the place that they are about.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
pub struct Said {
    /// The line that a person would read, without its level.
    pub message: String,
    /// File, as given on the command line.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// Line of the file, counted from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<u64>,
    /// Field or character of the line, counted from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<u64>,
}

/// A table.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
pub struct Drawn {
    /// Its lines.
    pub message: String,
}

/// How far a piece of work has come.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
pub struct Step {
    /// What is being done.
    pub task: String,
    /// Steps done.
    pub done: u64,
    /// Steps altogether.
    pub total: u64,
    /// Time left at the pace so far, in s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds_left: Option<f64>,
}

impl Said {
    /// `text` on one line, with the place that it begins with.
    pub(crate) fn new(text: &str) -> Self {
        let message = visible(&flatten(text));
        let (path, line, column) = place(&message, &arguments());
        Self { message, path, line, column }
    }
}

impl Message {
    /// Writes the message in one piece; a closed standard error must not end a run.
    pub(crate) fn write(&self, format: Format) {
        let mut text = match (format, self) {
            (Format::Json, message) => serde_json::to_string(message).unwrap_or_default(),
            (Format::Text, Self::Note(said)) => format!("{} {}", style::level("note:", style::DIM), said.message),
            (Format::Text, Self::Warning(said)) => {
                format!("{} {}", style::level("warning:", style::YELLOW), said.message)
            }
            (Format::Text, Self::Error(said)) => format!("{} {}", style::level("error:", style::RED), said.message),
            (Format::Text, Self::Table(drawn)) => style::table(&drawn.message),
            (Format::Text, Self::Progress(_)) => return,
        };
        text.push('\n');
        let _ = std::io::stderr().lock().write_all(text.as_bytes());
    }
}

fn arguments() -> Vec<String> {
    std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect()
}

/// The place that a message begins with, `path:line:column: ` or `path: `, where the path is one of `arguments`.
fn place(message: &str, arguments: &[String]) -> (Option<String>, Option<u64>, Option<u64>) {
    let openings = ["cannot read muscle file ", "cannot read ", "cannot write "];
    let rest = openings.iter().find_map(|opening| message.strip_prefix(opening)).unwrap_or(message);
    let named = arguments.iter().map(|word| match word.split_once('=') {
        Some((option, value)) if option.starts_with("--") => (visible(value), value),
        _ => (visible(word), word.as_str()),
    });
    // As messages show it, and as it is given.
    let found = named
        .chain([("standard input".to_owned(), "-"), ("standard output".to_owned(), "-")])
        .filter(|(shown, _)| !shown.is_empty() && !shown.starts_with("--"))
        .filter(|(shown, _)| rest.strip_prefix(shown.as_str()).is_some_and(|rest| rest.starts_with(':')));
    let Some((shown, path)) = found.max_by_key(|(shown, _)| shown.len()) else { return (None, None, None) };
    let mut fields = rest[shown.len() + 1..].splitn(3, ':');
    let mut number = || fields.next().and_then(|field| field.parse::<u64>().ok());
    match (number(), number()) {
        (Some(line), Some(column)) => (Some(path.to_owned()), Some(line), Some(column)),
        _ => (Some(path.to_owned()), None, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place_of(message: &str) -> (Option<String>, Option<u64>, Option<u64>) {
        let words = ["a.csv", "--muscle=m.toml", "--out", "a.csv:2", "b c.csv", ""].map(str::to_owned);
        place(message, &words)
    }

    #[test]
    fn a_place_is_read_where_the_message_begins_with_a_path_of_the_command_line() {
        let path = |path: &str| Some(path.to_owned());
        assert_eq!(place_of("a.csv:3:14: no number"), (path("a.csv"), Some(3), Some(14)));
        assert_eq!(place_of("a.csv: no such file"), (path("a.csv"), None, None));
        assert_eq!(place_of("a.csv:2:3:4: no number"), (path("a.csv:2"), Some(3), Some(4)));
        assert_eq!(place_of("m.toml:3:1: unknown"), (path("m.toml"), Some(3), Some(1)));
        assert_eq!(place_of("cannot write b c.csv: full"), (path("b c.csv"), None, None));
        assert_eq!(place_of("standard input:2:1: empty"), (path("-"), Some(2), Some(1)));
        assert_eq!(place_of("--max-rmse-n: negative"), (None, None, None));
        assert_eq!(place_of("12 a.csv: what"), (None, None, None));
    }
}
