//! What a program prints about itself instead of working: schemas, completions, the manual page.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command};
use pam_artifact::schemas;

/// Option, and kind of schema, of the file that says what columns mean.
const CHANNELS: &str = "channels";

/// Option, and kind of schema, of what has changed since an earlier diagnosis.
const SINCE: &str = "since";
/// Option, and kind of schema, of what the muscles of one rig share.
const GROUP: &str = "group";

/// Option, and kind of schema, of what shards agree on; the summaries of shards have a schema as well.
const AGREEMENT: &str = "agreement";
/// See [`AGREEMENT`].
const SUMMARY: &str = "summary";

/// `command` with the options below; `has_artifact` where the program writes an artifact that has a schema.
pub(crate) fn with_options(command: Command, has_artifact: bool) -> Command {
    let reads = command.get_arguments().any(|argument| argument.get_id() == CHANNELS);
    let has = |id: &str| command.get_arguments().any(|argument| argument.get_id() == id);
    let kinds = [
        ("artifact", has_artifact),
        ("messages", true),
        (CHANNELS, reads),
        (SINCE, has(SINCE)),
        (GROUP, has(GROUP)),
        (SUMMARY, has(AGREEMENT)),
        (AGREEMENT, has(AGREEMENT)),
    ];
    let of: Vec<&str> = kinds.into_iter().filter(|(_, known)| *known).map(|(kind, _)| kind).collect();
    let help = match (has_artifact, reads) {
        (true, true) => {
            "Print the JSON schema of the artifact, of the lines that --format json writes, or of the file of --channels, \
             and stop"
        }
        (true, false) => "Print the JSON schema of the artifact, or of the lines that --format json writes, and stop",
        (false, true) => {
            "Print the JSON schema of the lines that --format json writes, or of the file of --channels, and stop"
        }
        (false, false) => "Print the JSON schema of the lines that --format json writes, and stop",
    };
    let schema = Arg::new("schema")
        .long("schema")
        .value_name("OF")
        .num_args(0..=1)
        .require_equals(true)
        .default_missing_value(of[0])
        .value_parser(PossibleValuesParser::new(of.iter().copied()))
        .exclusive(true)
        .help(help);
    let completions = Arg::new("completions")
        .long("completions")
        .value_name("SHELL")
        .value_parser(clap::value_parser!(clap_complete::Shell))
        .exclusive(true)
        .hide(true)
        .help("Print a script that completes this program's options, and stop");
    let man = Arg::new("man")
        .long("man")
        .action(ArgAction::SetTrue)
        .exclusive(true)
        .hide(true)
        .help("Print the manual page and stop");
    command.args([schema, completions, man])
}

/// What is to be printed, if that is all that is asked for. `command` is the program's, with its options.
pub(crate) fn asked_for(
    matches: &ArgMatches,
    command: impl FnOnce() -> Command,
    artifact: Option<&str>,
) -> Option<Vec<u8>> {
    if let Some(of) = matches.get_one::<String>("schema") {
        let schema = match of.as_str() {
            CHANNELS => schemas::CHANNELS,
            SINCE => schemas::CHANGE,
            GROUP => schemas::GROUP,
            SUMMARY => schemas::SUMMARY,
            AGREEMENT => schemas::AGREEMENT,
            "artifact" => artifact.unwrap_or(schemas::MESSAGES),
            _ => schemas::MESSAGES,
        };
        return Some(schema.as_bytes().to_vec());
    }
    if let Some(shell) = matches.get_one::<clap_complete::Shell>("completions") {
        let mut command = command();
        let name = command.get_name().to_owned();
        let mut script = Vec::new();
        clap_complete::generate(*shell, &mut command, name, &mut script);
        return Some(script);
    }
    if matches.get_flag("man") {
        let mut page = Vec::new();
        // Writing to memory cannot fail.
        let _ = clap_mangen::Man::new(command()).render(&mut page);
        return Some(finished(&String::from_utf8_lossy(&page)).into_bytes());
    }
    None
}

/// The page under the headings that it should have, ragged and without hyphenation so that commands stay as they are
/// typed, and in the characters that every formatter reads.
fn finished(page: &str) -> String {
    let page =
        page.replacen(".SH EXTRA", ".SH EXAMPLES AND EXIT CODES", 1).replacen(".SH NAME", ".ad l\n.nh\n.SH NAME", 1);
    let escaped = |character: char| {
        if character.is_ascii() { character.to_string() } else { format!("\\[u{:04X}]", u32::from(character)) }
    };
    page.chars().map(escaped).collect()
}
