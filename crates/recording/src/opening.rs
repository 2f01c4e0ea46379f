//! The first line that is neither blank nor a comment: a header, or a row whose columns are named elsewhere.

use super::date::stamp_s;
use super::error::{Place, ReadErrorKind, Refusal, whole};
use super::fields::{Fields, Splitter, decoded, number};
use super::header::{self, Plan};
use super::lvm::{self, LvmHeader};
use super::options::ReadOptions;
use super::sniff::{Hints, Layout};
use super::units::{ISO, Name, Quantity, with_unit};

/// Kind of the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Opened {
    /// A header, or nothing that counts.
    OnHeader,
    /// A row.
    OnRow,
}

/// A comment and where it stands.
#[derive(Debug)]
pub(super) struct Comment {
    pub(super) line: u64,
    pub(super) text: Vec<u8>,
}

/// Names of the columns, and the line that gave them.
struct Named {
    names: Vec<Option<String>>,
    line: Option<u64>,
    opened: Opened,
}

/// How to read the rows of a file whose first line is `line`; `comment` is the last one before it.
pub(super) fn plan(
    line: &[u8],
    number: u64,
    comment: Option<&Comment>,
    seen: &Seen,
    options: &ReadOptions,
) -> Result<(Plan, Opened), Refusal> {
    let mut named = names(line, number, comment, seen.layout, options)?;
    if named.opened == Opened::OnHeader {
        if let Some(header) = &seen.lvm {
            named.names = lvm::names(named.names, header);
        }
        if let Some(units) = &seen.hints.units {
            for (name, unit) in named.names.iter_mut().zip(units) {
                *name = name.take().map(|name| with_unit(&name, unit));
            }
        }
    }
    dated(&mut named.names, &seen.hints.stamps_s, options);
    let mut plan = header::plan(&named.names, options).map_err(|fault| {
        let place = named.line.zip(fault.field).map(|(line, field)| Place { line, column: field as u64 + 1 });
        (place, fault.kind)
    })?;
    plan.count_from(&seen.hints.stamps_s);
    Ok((plan, named.opened))
}

/// Findings of the first look at a file.
#[derive(Debug)]
pub(super) struct Seen {
    pub(super) layout: Layout,
    pub(super) hints: Hints,
    pub(super) lvm: Option<LvmHeader>,
}

/// Marks a column of time that holds dates and has no unit, where no other gives time.
fn dated(names: &mut [Option<String>], stamps_s: &[Option<f64>], options: &ReadOptions) {
    let is_time =
        |name: &Option<String>| matches!(name.as_deref().map(Name::read), Some(Name::Channel(Quantity::Time, _)));
    if options.supply(Quantity::Time) || names.iter().any(is_time) {
        return;
    }
    for (name, stamp_s) in names.iter_mut().zip(stamps_s) {
        if let Some(text) = name
            && stamp_s.is_some()
            && Name::read(text).lacks_unit(Quantity::Time)
        {
            *text = format!("{} [{ISO}]", text.trim());
            return;
        }
    }
}

fn names(
    line: &[u8],
    line_number: u64,
    comment: Option<&Comment>,
    layout: Layout,
    options: &ReadOptions,
) -> Result<Named, Refusal> {
    let at = |field: usize| Some(Place { line: line_number, column: field as u64 + 1 });
    if layout.space_separated {
        return Err((at(0), ReadErrorKind::SpaceSeparated));
    }
    let mut splitter = Splitter::new(layout.separator);
    let fields = splitter.split(line).map_err(|quote| (at(quote.field), ReadErrorKind::OpenQuote))?;
    let is_value = |field: &&[u8]| number(field, layout.separator != b',').is_ok() || stamp_s(field).is_some();
    let n_numbers = fields.iter().filter(is_value).count();
    let n_filled = fields.iter().filter(|field| !field.is_empty()).count();
    let is_header = n_numbers == 0 && n_filled > 1;
    if let Some(columns) = options.columns.as_ref().filter(|columns| !(is_header && columns.if_no_header)) {
        if is_header && !options.skip_bad_rows {
            return Err((at(0), ReadErrorKind::HeaderPresent));
        }
        let (given, found) = (columns.names.len(), layout.n_fields);
        if given != found {
            return Err(whole(ReadErrorKind::ColumnsCount { given, found }));
        }
        return Ok(Named { names: columns.names.clone(), line: None, opened: Opened::OnRow });
    }
    if n_numbers == 0 || 2 * n_numbers < n_filled {
        return Ok(Named { names: column_names(fields), line: Some(line_number), opened: Opened::OnHeader });
    }
    if let Some(comment) = comment
        && let Some(names) = names_in_comment(&comment.text, layout)
    {
        return Ok(Named { names, line: Some(comment.line), opened: Opened::OnRow });
    }
    Err((at(0), ReadErrorKind::NoHeader { example: example_columns(layout.n_fields) }))
}

/// Fields of a header. A separator at its end names no column.
fn column_names(fields: Fields<'_>) -> Vec<Option<String>> {
    let n_named = (0..fields.len()).rposition(|index| !fields.get(index).is_empty()).map_or(1, |last| last + 1);
    fields.iter().take(n_named).map(|field| Some(decoded(field))).collect()
}

/// A header behind `#`, as numpy writes it: as many names as the rows have fields, one of them a quantity.
fn names_in_comment(comment: &[u8], layout: Layout) -> Option<Vec<Option<String>>> {
    let line = comment.trim_ascii_start().strip_prefix(b"#")?;
    let names = column_names(Splitter::new(layout.separator).split(line).ok()?);
    let is_channel = |name: &Option<String>| matches!(name.as_deref().map(Name::read), Some(Name::Channel(..)));
    (names.len() == layout.n_fields && names.iter().any(is_channel)).then_some(names)
}

/// Names for as many columns as a file has.
fn example_columns(n_fields: usize) -> String {
    let names = ["time_s", "pressure_kPa", "length_mm", "force_N"];
    let example: Vec<&str> = (0..n_fields.clamp(1, 12)).map(|index| names.get(index).copied().unwrap_or("-")).collect();
    example.join(",")
}
