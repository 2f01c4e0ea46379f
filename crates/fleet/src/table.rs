//! The table of recordings: one row per file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use pam_recording::spelling::{nearest, unreadable};

use crate::error::{TableError, TableErrorKind};

/// Columns that every table has.
const REQUIRED: [&str; 5] = ["path", "muscle", "rig", "date", "role"];
/// Columns that a table may have.
const OPTIONAL: [&str; 2] = ["make", "dimensions"];

/// What a recording is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Parameters and effects are fitted to it.
    Estimation,
    /// Models are judged on it.
    Holdout,
}

/// One recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// Line in the table, counted from 1; the header is line 1.
    pub line: u64,
    /// File, as the working directory sees it.
    pub path: PathBuf,
    /// Name of the muscle.
    pub muscle: String,
    /// Name of the rig.
    pub rig: String,
    /// Date of the recording, ISO 8601.
    pub date: String,
    /// What the recording is for.
    pub role: Role,
    /// Make of the muscle; muscles are compared with those of their own make. Empty where the table does not say.
    pub make: String,
    /// Muscle file with the dimensions, as the working directory sees it.
    pub dimensions: PathBuf,
}

/// Reads a table of recordings; paths in it are relative to its folder. `dimensions` is the muscle file of those rows that
/// name none.
///
/// # Errors
/// [`TableError`] names line, column and remedy: a column that is missing or unknown, an empty name, a date that is none,
/// a file that stands there twice, a muscle without dimensions.
pub fn read_table(path: &Path, dimensions: Option<&Path>) -> Result<Vec<Row>, TableError> {
    let refuse = |line: u64, column: u64, kind| TableError { path: path.to_owned(), line, column, kind };
    let bytes = std::fs::read(path)
        .map_err(|reason| refuse(0, 0, TableErrorKind::Unreadable { reason: unreadable(path, &reason) }))?;
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
    let mut reader =
        csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).flexible(true).from_reader(bytes);
    let not_csv = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        refuse(line, 1, TableErrorKind::NotText)
    };
    let header = reader.headers().map_err(not_csv)?.clone();
    let columns = columns(&header).map_err(|(column, kind)| refuse(1, column, kind))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut rows: Vec<Row> = Vec::new();
    let mut seen: BTreeMap<PathBuf, u64> = BTreeMap::new();
    for record in reader.records() {
        let record = record.map_err(not_csv)?;
        let line = record.position().map_or(1, csv::Position::line);
        let at = |name: &str| columns.get(name).copied();
        let refuse = |name: &str, kind| refuse(line, at(name).map_or(1, |column| column as u64 + 1), kind);
        let given = |name: &str| at(name).and_then(|column| record.get(column)).unwrap_or("");
        if let Some(empty) = REQUIRED.iter().find(|name| given(name).is_empty()) {
            return Err(refuse(empty, TableErrorKind::Empty { name: empty }));
        }
        let role = match given("role") {
            "estimation" => Role::Estimation,
            "holdout" => Role::Holdout,
            other => return Err(refuse("role", TableErrorKind::UnknownRole { found: other.to_owned() })),
        };
        if !is_date(given("date")) {
            return Err(refuse("date", TableErrorKind::NoDate { found: given("date").to_owned() }));
        }
        let recording = folder.join(given("path"));
        // `./log.csv` is `log.csv`, and a link leads where it leads; what is not there has its name alone.
        let file = std::fs::canonicalize(&recording).unwrap_or_else(|_| recording.clone());
        if let Some(first) = seen.insert(file, line) {
            return Err(refuse("path", TableErrorKind::Twice { first }));
        }
        let dimensions = match given("dimensions") {
            "" => dimensions.ok_or_else(|| refuse("dimensions", TableErrorKind::NoDimensions))?.to_owned(),
            named => folder.join(named),
        };
        rows.push(Row {
            line,
            path: recording,
            muscle: given("muscle").to_owned(),
            rig: given("rig").to_owned(),
            date: given("date").to_owned(),
            role,
            make: given("make").to_owned(),
            dimensions,
        });
    }
    if rows.is_empty() { Err(refuse(1, 1, TableErrorKind::NoRows)) } else { Ok(rows) }
}

/// Where each column stands, or the place and the kind of what is wrong with the header.
fn columns(header: &csv::StringRecord) -> Result<BTreeMap<&str, usize>, (u64, TableErrorKind)> {
    let mut columns = BTreeMap::new();
    for (index, name) in header.iter().enumerate() {
        let place = index as u64 + 1;
        let known = || REQUIRED.iter().chain(&OPTIONAL).copied();
        if !known().any(|known| known == name) {
            let near = nearest(name, known()).map(str::to_owned);
            return Err((place, TableErrorKind::UnknownColumn { found: name.to_owned(), near }));
        }
        if columns.insert(name, index).is_some() {
            return Err((place, TableErrorKind::ColumnTwice { name: name.to_owned() }));
        }
    }
    match REQUIRED.iter().find(|name| !columns.contains_key(*name)) {
        Some(name) => Err((1, TableErrorKind::NoColumn { name })),
        None => Ok(columns),
    }
}

/// Whether a text is a date as ISO 8601 writes it, `2026-03-01`, with a time of day or without: such dates sort as text.
fn is_date(text: &str) -> bool {
    let bytes = text.as_bytes();
    let digits =
        |range: std::ops::Range<usize>| bytes.get(range).is_some_and(|part| part.iter().all(u8::is_ascii_digit));
    let within = |range: std::ops::Range<usize>, from, to| {
        text.get(range).and_then(|part| part.parse::<u32>().ok()).is_some_and(|value| (from..=to).contains(&value))
    };
    let shaped =
        digits(0..4) && bytes.get(4) == Some(&b'-') && digits(5..7) && bytes.get(7) == Some(&b'-') && digits(8..10);
    let rest = bytes.get(10);
    let number = |range: std::ops::Range<usize>| text.get(range).and_then(|part| part.parse::<u32>().ok()).unwrap_or(0);
    let year = number(0..4);
    let is_leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let days = match number(5..7) {
        2 => 28 + u32::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    shaped
        && within(5..7, 1, 12)
        && within(8..10, 1, days)
        && (rest.is_none() || rest == Some(&b'T') || rest == Some(&b' '))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> String {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("table.csv");
        std::fs::write(&path, text).expect("a file");
        let error = read_table(&path, Some("m.toml".as_ref())).expect_err("a refusal");
        error.to_string().replace(&format!("{}/", folder.path().display()), "")
    }

    #[test]
    fn what_is_wrong_in_a_table_is_named_with_its_place() {
        let header = "path,muscle,rig,date,role\n";
        let refusals = [
            "path,muscel,rig,date,role\n".to_owned(),
            "path,muscle,rig,role\n".to_owned(),
            header.to_owned(),
            format!("{header}a.csv,m1,,2026-03-01,estimation\n"),
            format!("{header}a.csv,m1,r1,01.03.2026,estimation\n"),
            format!("{header}a.csv,m1,r1,2026-02-29,estimation\n"),
            format!("{header}a.csv,m1,r1,2026-03-01,fit\n"),
            format!("{header}a.csv,m1,r1,2026-03-01,estimation\na.csv,m2,r1,2026-03-01,estimation\n"),
        ]
        .map(|text| refusal(&text));
        insta::assert_snapshot!(refusals.join("\n"), @r#"
        table.csv:1:2: column "muscel" is unknown; did you mean muscle?
        table.csv:1:1: column date is missing; a table has path, muscle, rig, date, role and may have make, dimensions
        table.csv:1:1: the table has no rows; give one for each recording
        table.csv:2:3: rig is empty; name it
        table.csv:2:4: "01.03.2026" is no date; write it as 2026-03-01
        table.csv:2:4: "2026-02-29" is no date; write it as 2026-03-01
        table.csv:2:5: role is "fit", expected estimation or holdout
        table.csv:3:1: the same recording stands in line 2; keep one of the two
        "#);
    }

    #[test]
    fn paths_are_relative_to_the_table() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("table.csv");
        let text = "# of March\nrole,date,rig,muscle,path,dimensions\nholdout,2026-03-01,r,m,logs/a.csv,m.toml\n";
        std::fs::write(&path, text).expect("a file");
        let rows = read_table(&path, None).expect("a table");
        assert_eq!(rows[0].path, folder.path().join("logs/a.csv"));
        assert_eq!(
            (rows[0].dimensions.clone(), rows[0].role, rows[0].line),
            (folder.path().join("m.toml"), Role::Holdout, 3)
        );
    }
}
