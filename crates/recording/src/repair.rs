//! What was repaired or left out while reading, for people and for artifacts.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::row_fault::RowFault;

/// Skipped rows that are remembered one by one.
const REMEMBERED: usize = 5;

/// What was repaired or left out while reading.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Repairs {
    /// Rows that were moved in time because the clock gave them the stamp of the row above.
    pub repeated_stamps_spread: u64,
    /// Rows that were dropped.
    pub rows_skipped: u64,
    /// The first of the rows dropped.
    pub first_skipped: Vec<SkippedRow>,
    /// Gaps in time that split the recording.
    pub gaps: u64,
    /// The longest of the gaps, in s.
    pub longest_gap_s: f64,
    /// Blank lines between rows.
    pub blank_lines: u64,
}

/// A row that was dropped.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SkippedRow {
    /// Line of the file, counted from 1.
    pub line: u64,
    /// What was wrong with it.
    pub reason: String,
}

impl Repairs {
    /// Whether the file was used as it is.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Counts a row that is dropped.
    pub(crate) fn skip(&mut self, line: u64, fault: &RowFault) {
        self.rows_skipped += 1;
        let position = self.first_skipped.partition_point(|row| row.line < line);
        if position < REMEMBERED {
            self.first_skipped.insert(position, SkippedRow { line, reason: fault.to_string() });
            self.first_skipped.truncate(REMEMBERED);
        }
    }

    /// One sentence per kind of repair; none where the file was used as it is.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.repeated_stamps_spread > 0 {
            let rows = counted(self.repeated_stamps_spread, "row");
            let were = if self.repeated_stamps_spread == 1 { "was" } else { "were" };
            notes.push(format!(
                "{rows} had the time stamp of the row above and {were} spread evenly up to the next stamp"
            ));
        }
        if self.rows_skipped > 0 {
            let first: Vec<String> =
                self.first_skipped.iter().map(|row| format!("line {}: {}", row.line, row.reason)).collect();
            let more = self.rows_skipped - self.first_skipped.len() as u64;
            let more = if more == 0 { String::new() } else { format!("; and {more} more") };
            let were = if self.rows_skipped == 1 { "was" } else { "were" };
            notes.push(format!(
                "{} {were} dropped ({}{more})",
                counted(self.rows_skipped, "bad row"),
                first.join("; ")
            ));
        }
        if self.gaps > 0 {
            let (split, longest) = if self.gaps == 1 {
                ("splits", format!("of {} s", shown_s(self.longest_gap_s)))
            } else {
                ("split", format!("of up to {} s", shown_s(self.longest_gap_s)))
            };
            let (gaps, segments) = (counted(self.gaps, "gap"), self.gaps + 1);
            notes.push(format!("{gaps} in time {longest} {split} the recording into {segments} segments"));
        }
        if self.blank_lines > 0 {
            let were = if self.blank_lines == 1 { "was" } else { "were" };
            notes.push(format!("{} between rows {were} passed over", counted(self.blank_lines, "blank line")));
        }
        notes
    }
}

fn counted(n: u64, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

/// Three digits are enough for a gap.
fn shown_s(value: f64) -> String {
    let digits = if value >= 100.0 {
        0
    } else if value >= 1.0 {
        2
    } else {
        4
    };
    format!("{value:.digits$}")
}
