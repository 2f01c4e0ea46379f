//! MATLAB files: from the columns that `pam-matlab` finds to a recording.

use std::collections::BTreeMap;

use pam_matlab::{Column, Format, Label, MatError, MatFile, Signals};

use super::Recording;
use super::body::Body;
use super::error::{ReadErrorKind, Refusal, whole};
use super::header::{self, Plan};
use super::lines::LineReader;
use super::options::ReadOptions;
use super::rows::RowParser;
use super::samples::MAX_COLUMNS;
use super::sniff;
use super::units::{Name, Quantity};
use super::wording::shown_name;

/// Times its size that a file may decompress to, beyond [`MIN_EXPANDED_BYTES`]: constant channels shrink to a
/// hundredth, and time beside them to no less than a tenth.
const MAX_EXPANSION: u64 = 256;

/// Bytes that any file may decompress to.
const MIN_EXPANDED_BYTES: u64 = 16 << 20;

/// Rows from one report of progress to the next.
const REPORT_ROWS: usize = 1 << 16;

/// Reads a file of one of MATLAB's formats, or says how to save one that can be read.
pub(super) fn read(
    format: Format,
    mut lines: LineReader,
    path: String,
    options: &ReadOptions,
    observe: &mut dyn FnMut(u64, u64),
) -> Result<Recording, Refusal> {
    let not_read = |found, remedy| Err(whole(ReadErrorKind::NotRead { found, remedy }));
    match format {
        Format::Level5 => {}
        Format::Level4 => {
            return not_read("a MATLAB file of version 4", "load it in MATLAB and save it with save -v7".to_owned());
        }
        Format::Hdf5 => {
            let remedy = format!("save it with save -v7, or {}", sniff::HDF5_AS_CSV);
            return not_read("a MATLAB file of version 7.3 (HDF5)", remedy);
        }
    }
    if options.columns.as_ref().is_some_and(|columns| !columns.if_no_header) {
        return Err(whole(ReadErrorKind::HeaderPresent));
    }
    let limit = |stored: u64| stored.saturating_mul(MAX_EXPANSION).saturating_add(MIN_EXPANDED_BYTES);
    let bytes = lines.rest(limit).map_err(whole)?;
    let sha256 = lines.sha256().map_err(whole)?;
    let unreadable = |error| match error {
        MatError::Damaged { reason } => whole(ReadErrorKind::DamagedMat { reason }),
        MatError::ExpandsTooFar { limit } => whole(ReadErrorKind::ExpandsTooFar { limit }),
    };
    let file = MatFile::open(&bytes, limit(bytes.len() as u64)).map_err(unreadable)?;
    let mut signals = file.signals().map_err(unreadable)?;
    let channels = channels(std::mem::take(&mut signals.columns));
    let asked = options.map.iter().map(|map| &map.original).chain(options.calibrate.iter().map(|c| &c.original));
    let asked: Vec<&str> = asked.map(|name| name.trim()).collect();
    let names = names(&channels, &asked);
    let plan = header::plan(&names, options).map_err(|fault| whole(with_objects(fault.kind, &signals)))?;
    let used = used(&plan, &channels)?;
    let n_samples = used.iter().flatten().map(|column| column.len()).next().unwrap_or(0);
    rows(RowParser::new(plan, b','), &used, n_samples, options, observe)?.finish(path, sha256)
}

/// A column with its names, the best first.
struct Channel<'a> {
    names: Vec<String>,
    column: Column<'a>,
}

/// Columns as a header would name them. Simulink writes the same time beside every signal: one column is enough, under
/// every one of its names.
fn channels(columns: Vec<Column<'_>>) -> Vec<Channel<'_>> {
    let seconds = format!("{}_s", Quantity::Time);
    let mut channels: Vec<Channel<'_>> = Vec::new();
    let mut time = None;
    for column in columns {
        let mut names: Vec<String> = column.labels.iter().filter_map(header_name).collect();
        names.dedup();
        if names.first() == Some(&seconds) {
            let first = *time.get_or_insert(channels.len());
            if let Some(kept) = channels.get_mut(first)
                && column.has_samples_of(&kept.column)
            {
                kept.names.extend(names.into_iter().skip(1));
                continue;
            }
        }
        channels.push(Channel { names, column });
    }
    channels
}

/// The name of a column in a header: the unit beside a name is added where the name has none.
fn header_name(label: &Label) -> Option<String> {
    match label {
        Label::Name(name) => Some(name.clone()),
        Label::WithUnit { name, unit } => {
            matches!(Name::read(name), Name::UnitMissing(_)).then(|| format!("{name}_{unit}"))
        }
        Label::Time { unit } => Quantity::Time.unit(unit).map(|_| format!("{}_{unit}", Quantity::Time)),
    }
}

/// Per channel, the name that one of `wanted` asks for, or else the best that no other channel has.
fn names(channels: &[Channel<'_>], wanted: &[&str]) -> Vec<Option<String>> {
    let asked = |name: &&String| wanted.iter().any(|wanted| wanted.eq_ignore_ascii_case(name));
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for name in channels.iter().flat_map(|channel| &channel.names) {
        *counts.entry(name).or_default() += 1;
    }
    let unique = |name: &&String| counts.get(name.as_str()) == Some(&1);
    channels
        .iter()
        .map(|channel| {
            let mut names = channel.names.iter();
            names.clone().find(asked).or_else(|| names.clone().find(unique)).or(names.next_back()).cloned()
        })
        .collect()
}

/// A channel that is missing is probably in one of the objects, if there are any.
fn with_objects(kind: ReadErrorKind, signals: &Signals<'_>) -> ReadErrorKind {
    match (&kind, signals.objects.first()) {
        (ReadErrorKind::Missing { .. } | ReadErrorKind::NoSuchColumn { .. }, Some(object)) => {
            ReadErrorKind::MatObject { name: shown_name(&object.path), class: shown_name(&object.class) }
        }
        _ => kind,
    }
}

/// Per slot, the column that fills it; all are of one length.
fn used<'s, 'a>(plan: &Plan, channels: &'s [Channel<'a>]) -> Result<[Option<&'s Column<'a>>; MAX_COLUMNS], Refusal> {
    let mut used = [None; MAX_COLUMNS];
    let mut first: Option<(usize, &Column<'_>)> = None;
    for (index, (slot, Channel { column, .. })) in plan.fields.iter().zip(channels).enumerate() {
        let Some(slot) = slot else { continue };
        used[*slot] = Some(column);
        match first {
            None => first = Some((index, column)),
            Some((known, other)) if other.len() != column.len() => {
                return Err(whole(ReadErrorKind::LengthsDiffer {
                    first: plan.names[known].clone(),
                    n_first: other.len(),
                    second: plan.names[index].clone(),
                    n_second: column.len(),
                }));
            }
            Some(_) => {}
        }
    }
    Ok(used)
}

fn rows(
    parser: RowParser,
    used: &[Option<&Column<'_>>; MAX_COLUMNS],
    n_samples: usize,
    options: &ReadOptions,
    observe: &mut dyn FnMut(u64, u64),
) -> Result<Body, Refusal> {
    let mut body = Body::new(parser, options);
    for row in 0..n_samples {
        let slots = used.map(|column| column.map_or(0.0, |column| column.get(row)));
        let line = body.parser.row_of(&slots);
        body.line(line, row as u64 + 1)?;
        if row % REPORT_ROWS == 0 {
            observe(row as u64, n_samples as u64);
        }
    }
    Ok(body)
}
