//! Words that messages share.

use std::path::Path;

use super::units::Quantity;

pub(super) fn shown_path(path: &Path) -> String {
    if path.as_os_str() == "-" { "standard input".to_owned() } else { clipped(&path.to_string_lossy(), 1000) }
}

pub(super) fn counted(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

pub(super) fn counted_rows(found: usize) -> String {
    match found {
        0 => "there are no rows".to_owned(),
        1 => "there is only one row".to_owned(),
        _ => format!("there are only {found} rows"),
    }
}

pub(super) fn too_few_remedy(found: usize, needed: usize, skipped: u64) -> String {
    match (found, skipped) {
        (0, 0) => "record again, or check that the logger closed the file".to_owned(),
        (0, _) => "check that the columns hold what the header says".to_owned(),
        _ => format!("at least {needed} are needed: record for longer"),
    }
}

/// Remedy for a missing quantity.
pub(super) fn missing_remedy(quantity: Quantity, hint: Option<&str>) -> String {
    let example = quantity.example();
    match (hint, quantity) {
        (Some(hint), _) => format!("name a column {example} in the header or, as it seems to fit, give {hint}"),
        (None, Quantity::Time) => {
            format!("name a column {example} in the header or point to one with --map {example}=COLUMN")
        }
        (None, _) => format!(
            "name a column {example} in the header, point to one with --map {example}=COLUMN, \
             or give a constant with --fixed {example}=VALUE"
        ),
    }
}

/// Conversion of a file of LabVIEW that has no column of time, but a constant rate.
pub(super) fn lvm_as_csv(x_columns: &str) -> &'static str {
    match x_columns {
        "No" => {
            ", or write it as CSV: python3 -c 'import lvm_read, pandas, sys; s = lvm_read.read(sys.argv[1])[0]; \
             d = pandas.DataFrame(s[\"data\"], columns=s[\"Channel names\"][:s[\"Channels\"]]); \
             d.insert(0, \"time_s\", d.index * s[\"Delta_X\"][0]); d.to_csv(sys.argv[2], index=False)' log.lvm log.csv"
        }
        _ => "",
    }
}

pub(super) fn nearest_remedy(nearest: Option<&str>, columns: &[String]) -> String {
    match nearest {
        Some(nearest) => format!("did you mean \"{nearest}\"?"),
        None => format!("it has {}", listed(columns)),
    }
}

/// Remedy for two columns for one quantity; `--map` cannot tell equal names apart.
pub(super) fn twice_remedy(first: &str, second: &str) -> String {
    if first == second {
        "rename one of them in the header".to_owned()
    } else {
        format!("keep one of them, for example with --map {first}={}", shell_quoted(first))
    }
}

/// Names for a message, the first few.
pub(super) fn listed(columns: &[String]) -> String {
    const SHOWN: usize = 8;
    if columns.is_empty() {
        return "no named column".to_owned();
    }
    let names: Vec<&str> = columns.iter().take(SHOWN).map(String::as_str).collect();
    let more = columns.len().saturating_sub(SHOWN);
    if more == 0 { names.join(", ") } else { format!("{} and {more} more", names.join(", ")) }
}

/// `name` as a word on a command line.
pub(super) fn shell_quoted(name: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.');
    if !name.is_empty() && name.chars().all(plain) { name.to_owned() } else { format!("\"{name}\"") }
}

/// Longest name in a message or an artifact, in characters.
const NAME_SHOWN: usize = 80;

/// A name as messages show it.
pub(super) fn shown_name(name: &str) -> String {
    clipped(name, NAME_SHOWN)
}

/// `text` on one line, at most `limit` characters.
pub(super) fn clipped(text: &str, limit: usize) -> String {
    let mut shown = String::new();
    for (index, character) in text.chars().enumerate() {
        if index == limit {
            shown.push('…');
            break;
        }
        if character.is_control() || matches!(character, '\u{2028}' | '\u{2029}') {
            shown.extend(character.escape_debug());
        } else {
            shown.push(character);
        }
    }
    shown
}
