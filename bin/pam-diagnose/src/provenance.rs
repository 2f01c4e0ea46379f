//! Provenance of a report.
//!
//! # Design
//! Equal inputs give equal bytes, so the clock stays out: the date is that of `SOURCE_DATE_EPOCH` where it is set, as
//! reproducible builds have it, and else the day on which the newest recording was last changed, which is about the day of the
//! measurement. The command is given without what does not bear on the result: where outputs go, threads, and what is said on
//! the terminal.

use std::ffi::OsString;
use std::path::Path;
use std::time::UNIX_EPOCH;

/// Command and date of a report.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Provenance {
    /// The command as typed, without outputs.
    pub(crate) command: String,
    /// Year, month and day, with what it is the date of; empty where neither is known.
    pub(crate) date: String,
}

impl Provenance {
    /// Of this run, which read `recordings`.
    pub(crate) fn of_this_run<'a>(recordings: impl Iterator<Item = &'a Path>) -> Self {
        let epoch_s = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|text| text.trim().parse::<u64>().ok());
        Self { command: command(std::env::args_os().skip(1)), date: date(epoch_s, recordings) }
    }
}

/// Options whose value says where something goes or how it is said.
const LEFT_OUT: [&str; 6] = ["--out", "--out-model", "--report", "--next-experiment", "--threads", "--format"];

fn command(arguments: impl Iterator<Item = OsString>) -> String {
    let mut words = vec!["pam-diagnose".to_owned()];
    let mut skip = false;
    for argument in arguments {
        let word = argument.to_string_lossy();
        let name = word.split('=').next().unwrap_or(&word);
        if std::mem::take(&mut skip) || word == "--quiet" || word == "-q" {
            continue;
        }
        if LEFT_OUT.contains(&name) {
            skip = name == word;
            continue;
        }
        words.push(quoted(&word));
    }
    words.join(" ")
}

/// A word as a shell takes it back.
fn quoted(word: &str) -> String {
    let plain = |character: char| character.is_alphanumeric() || "-_./=,:+@%".contains(character);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

fn date<'a>(epoch_s: Option<u64>, recordings: impl Iterator<Item = &'a Path>) -> String {
    if let Some(epoch_s) = epoch_s {
        return day(epoch_s);
    }
    let changed = |path: &Path| {
        let since = std::fs::metadata(path).ok()?.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        Some(since.as_secs())
    };
    recordings
        .filter_map(changed)
        .max()
        .map_or(String::new(), |changed_s| format!("{} (newest recording)", day(changed_s)))
}

/// The day of a time since 1970, in UTC (Hinnant 2013, chrono-compatible low-level date algorithms, `civil_from_days`).
fn day(epoch_s: u64) -> String {
    let days = epoch_s / 86_400 + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    // Counted from March, so that the day which some years have is the last.
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn validates_against_known_days() {
        let days = [0, 951_782_400, 1_709_164_800, 4_102_444_800].map(day);
        assert_eq!(days, ["1970-01-01", "2000-02-29", "2024-02-29", "2100-01-01"]);
    }

    #[test]
    fn a_command_is_given_without_outputs_and_can_be_typed_again() {
        let words = [
            "a b.csv",
            "--model",
            "m.json",
            "--out",
            "d.json",
            "--report=r.html",
            "-q",
            "--map",
            "it's=P",
            "--threads",
            "2",
        ];
        let command = command(words.into_iter().map(OsString::from));
        assert_eq!(command, "pam-diagnose 'a b.csv' --model m.json --map 'it'\\''s=P'");
    }

    #[test]
    fn a_date_that_was_set_goes_before_that_of_files() {
        assert_eq!(date(Some(86_400), std::iter::empty()), "1970-01-02");
        assert_eq!(date(None, [Path::new("no such file")].into_iter()), "");
    }
}
