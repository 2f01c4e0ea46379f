//! From the bytes of a file to a recording.

use std::io::Read as _;

use flate2::read::ZlibDecoder;

use super::super::Recording;
use super::super::body::Body;
use super::super::error::ReadErrorKind;
use super::super::header::{self, Plan};
use super::super::lines::LineReader;
use super::super::read::{ReadOptions, Refusal, whole};
use super::super::rows::RowParser;
use super::super::samples::MAX_COLUMNS;
use super::super::wording::shown_name;
use super::array::{self, Variable};
use super::element::{COMPRESSED, Damaged, Element, Elements};
use super::signals::{Column, Signals};
use super::version::{Endian, HEADER_BYTES};

/// Times its size that a file may decompress to, beyond [`MIN_EXPANDED_BYTES`]: constant channels shrink to a
/// hundredth, and time beside them to no less than a tenth.
const MAX_EXPANSION: u64 = 256;

/// Bytes that any file may decompress to.
const MIN_EXPANDED_BYTES: u64 = 16 << 20;

/// Rows from one report of progress to the next.
const REPORT_ROWS: usize = 1 << 16;

/// Reads a file of level 5.
pub(in super::super) fn read(
    mut lines: LineReader,
    path: String,
    endian: Endian,
    options: &ReadOptions,
    observe: &mut dyn FnMut(u64, u64),
) -> Result<Recording, Refusal> {
    if options.columns.as_ref().is_some_and(|columns| !columns.if_no_header) {
        return Err(whole(ReadErrorKind::HeaderPresent));
    }
    let limit = |stored: u64| stored.saturating_mul(MAX_EXPANSION).saturating_add(MIN_EXPANDED_BYTES);
    let bytes = lines.rest(limit).map_err(whole)?;
    let sha256 = lines.sha256().map_err(whole)?;
    let damaged = |Damaged(reason)| whole(ReadErrorKind::DamagedMat { reason });
    let body = bytes.get(HEADER_BYTES..).unwrap_or(&[]);
    let expanded = expand(body, endian, limit(bytes.len() as u64)).map_err(whole)?;
    let variables = variables(&expanded, endian).map_err(damaged)?;
    let signals = Signals::of(&variables);
    let asked = options.map.iter().map(|map| &map.original).chain(options.calibrate.iter().map(|c| &c.original));
    let asked: Vec<&str> = asked.map(|name| name.trim()).collect();
    let names = signals.names(&asked);
    let plan = header::plan(&names, options).map_err(|fault| whole(with_objects(fault.kind, &signals)))?;
    let used = used(&plan, &signals)?;
    let n_samples = used.iter().flatten().map(|column| column.n_samples).next().unwrap_or(0);
    rows(RowParser::new(plan, b','), &used, n_samples, options, observe)?.finish(path, sha256)
}

/// The elements of a file: as they lie there, or decompressed.
enum Stored<'a> {
    Plain(Element<'a>),
    Expanded(Vec<u8>),
}

fn expand(body: &[u8], endian: Endian, limit: u64) -> Result<Vec<Stored<'_>>, ReadErrorKind> {
    let mut elements = Elements::new(body, endian);
    let mut stored = Vec::new();
    let mut left = limit;
    while !elements.is_empty() {
        let element = elements.next().map_err(|Damaged(reason)| ReadErrorKind::DamagedMat { reason })?;
        if element.kind != COMPRESSED {
            stored.push(Stored::Plain(element));
            continue;
        }
        let mut expanded = Vec::new();
        ZlibDecoder::new(element.data)
            .take(left.saturating_add(1))
            .read_to_end(&mut expanded)
            .map_err(|_| ReadErrorKind::DamagedMat { reason: "a compressed variable cannot be decompressed" })?;
        left = left.checked_sub(expanded.len() as u64).ok_or(ReadErrorKind::ExpandsTooFar { limit })?;
        stored.push(Stored::Expanded(expanded));
    }
    Ok(stored)
}

fn variables<'a>(stored: &'a [Stored<'a>], endian: Endian) -> Result<Vec<Variable<'a>>, Damaged> {
    let mut variables = Vec::new();
    for stored in stored {
        let element = match stored {
            Stored::Plain(element) => *element,
            Stored::Expanded(bytes) => Elements::new(bytes, endian).next()?,
        };
        variables.extend(array::variable(element, endian)?);
    }
    Ok(variables)
}

/// A channel that is missing is probably in one of the objects, if there are any.
fn with_objects(kind: ReadErrorKind, signals: &Signals<'_>) -> ReadErrorKind {
    match (&kind, signals.objects.first()) {
        (ReadErrorKind::Missing { .. } | ReadErrorKind::NoSuchColumn { .. }, Some((name, class))) => {
            ReadErrorKind::MatObject { name: shown_name(name), class: shown_name(class) }
        }
        _ => kind,
    }
}

/// Per slot, the column that fills it; all are of one length.
fn used<'s, 'a>(plan: &Plan, signals: &'s Signals<'a>) -> Result<[Option<&'s Column<'a>>; MAX_COLUMNS], Refusal> {
    let mut used = [None; MAX_COLUMNS];
    let mut first: Option<(usize, &Column<'_>)> = None;
    for (index, (slot, column)) in plan.fields.iter().zip(&signals.columns).enumerate() {
        let Some(slot) = slot else { continue };
        used[*slot] = Some(column);
        match first {
            None => first = Some((index, column)),
            Some((known, other)) if other.n_samples != column.n_samples => {
                return Err(whole(ReadErrorKind::LengthsDiffer {
                    first: plan.names[known].clone(),
                    n_first: other.n_samples,
                    second: plan.names[index].clone(),
                    n_second: column.n_samples,
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
