//! Reading a recording from its first byte to its last.

use std::ops::Range;
use std::path::Path;

use super::Recording;
use super::clock::{ClockFilter, Row};
use super::error::{Place, ReadError, ReadErrorKind, RowFault};
use super::fields::{is_blank, is_comment, number, split, strip_line_end, text};
use super::header;
use super::lines::{LineReader, Lines, MAX_LINE_BYTES};
use super::options::{Calibration, ColumnMap, Columns, FixedChannel};
use super::repair::Repairs;
use super::rows::{Channels, Line, RowParser};
use super::samples::{CHUNK_ROWS, MAX_COLUMNS, MEMORY_ROWS, Samples, SamplesBuilder, SpillFailed};
use super::sniff::{self, Layout};
use super::source::ByteSource;
use super::stamps::StampRepair;
use super::units::Quantity;

/// How to read a recording.
#[derive(Debug, Clone)]
pub struct ReadOptions {
    /// Names of the columns of a file without a header.
    pub columns: Option<Columns>,
    /// Other names for columns.
    pub map: Vec<ColumnMap>,
    /// Channels that were constant and not recorded.
    pub fixed: Vec<FixedChannel>,
    /// Channels computed from a transducer's reading.
    pub calibrate: Vec<Calibration>,
    /// Drop and count rows that cannot be used, instead of refusing the file.
    pub skip_bad_rows: bool,
    /// Refuse a recording without force, or whose force never varies.
    pub force_required: bool,
    /// Fewest rows that are enough; two at least.
    pub min_rows: usize,
    /// Rows that stay in memory; the others go to a temporary file.
    pub memory_rows: usize,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            columns: None,
            map: Vec::new(),
            fixed: Vec::new(),
            calibrate: Vec::new(),
            skip_bad_rows: false,
            force_required: true,
            min_rows: 2,
            memory_rows: MEMORY_ROWS,
        }
    }
}

/// Reads a recording; `-` is standard input. Compressed files (gzip) are recognised by their content.
///
/// # Errors
/// [`ReadError`] says where and why the file is refused, and what to do.
pub fn read_recording(source: &Path, options: &ReadOptions) -> Result<Recording, ReadError> {
    read(source, options).map_err(|(place, kind)| ReadError { path: source.to_owned(), place, kind: Box::new(kind) })
}

/// A reason and, unless it concerns the whole file, its place.
type Refusal = (Option<Place>, ReadErrorKind);

fn whole(kind: ReadErrorKind) -> Refusal {
    (None, kind)
}

fn read(path: &Path, options: &ReadOptions) -> Result<Recording, Refusal> {
    let mut lines = LineReader::new(ByteSource::open(path).map_err(whole)?);
    let start = lines.peek(MAX_LINE_BYTES).map_err(whole)?;
    let n_mark = sniff::check_text(start).map_err(whole)?;
    let n_columns = options.columns.as_ref().map(|columns| columns.names.len());
    let layout = sniff::layout(&start[n_mark..], n_columns);
    lines.skip(n_mark);
    let mut reading = Reading::new(layout, options);
    loop {
        match lines.next().map_err(whole)? {
            Lines::Whole(text) => reading.take(text)?,
            Lines::TooLong => reading.too_long()?,
            Lines::End => break,
        }
    }
    let sha256 = lines.sha256().map_err(whole)?;
    reading.finish(path.to_string_lossy().into_owned(), sha256)
}

/// The state between two lines.
struct Reading<'a> {
    options: &'a ReadOptions,
    layout: Layout,
    /// Lines taken so far.
    line: u64,
    body: Option<Body>,
}

impl<'a> Reading<'a> {
    fn new(layout: Layout, options: &'a ReadOptions) -> Self {
        Self { options, layout, line: 0, body: None }
    }

    /// Takes whole lines.
    fn take(&mut self, text: &[u8]) -> Result<(), Refusal> {
        let mut rest = text;
        while self.body.is_none() {
            if rest.is_empty() {
                return Ok(());
            }
            let length = rest.iter().position(|byte| *byte == b'\n').map_or(rest.len(), |end| end + 1);
            let (line, tail) = rest.split_at(length);
            self.line += 1;
            if !is_blank(line) && !is_comment(line) {
                let header_is_row = self.begin(strip_line_end(line))?;
                if header_is_row {
                    self.line -= 1;
                    break;
                }
            }
            rest = tail;
        }
        let Some(body) = &mut self.body else { return Ok(()) };
        while !rest.is_empty() {
            self.line += 1;
            let (line, length) = body.parser.read(rest);
            body.line(line, self.line)?;
            rest = &rest[length..];
        }
        Ok(())
    }

    /// Passes over a line of absurd length.
    fn too_long(&mut self) -> Result<(), Refusal> {
        self.line += 1;
        let place = Place { line: self.line, column: 1 };
        match &mut self.body {
            Some(body) => body.line(Line::Fault(1, RowFault::TooLong { limit: MAX_LINE_BYTES }), self.line),
            None => Err((Some(place), ReadErrorKind::LineTooLong { limit: MAX_LINE_BYTES })),
        }
    }

    /// Takes the first line that is neither blank nor a comment; true where it is a row already.
    fn begin(&mut self, line: &[u8]) -> Result<bool, Refusal> {
        let at = |column: usize| Some(Place { line: self.line, column: column as u64 + 1 });
        let separator = self.layout.separator;
        if self.layout.space_separated {
            return Err((at(0), ReadErrorKind::SpaceSeparated));
        }
        let mut ranges = Vec::new();
        split(line, separator, usize::MAX, &mut ranges).map_err(|quote| (at(quote.field), ReadErrorKind::OpenQuote))?;
        let fields: Vec<&[u8]> = ranges.into_iter().map(|range| &line[range]).collect();
        let is_number = |field: &&&[u8]| number(field, separator != b',').is_ok();
        let n_numbers = fields.iter().filter(is_number).count();
        let n_filled = fields.iter().filter(|field| !field.is_empty()).count();
        let columns = self.options.columns.as_ref();
        let names: Vec<Option<String>> = match columns {
            Some(columns) => {
                if n_numbers == 0 && n_filled > 1 && !self.options.skip_bad_rows {
                    return Err((at(0), ReadErrorKind::HeaderPresent));
                }
                let (given, found) = (columns.names.len(), self.layout.n_fields);
                if given != found {
                    return Err(whole(ReadErrorKind::ColumnsCount { given, found }));
                }
                columns.names.clone()
            }
            None if n_numbers > 0 && 2 * n_numbers >= n_filled => {
                return Err((at(0), ReadErrorKind::NoHeader { example: example_columns(self.layout.n_fields) }));
            }
            None => {
                let mut names: Vec<_> = fields.iter().map(|field| Some(text(field).into_owned())).collect();
                // A separator at the end of the header names no column.
                while names.len() > 1 && names.last().is_some_and(|name| name.as_deref() == Some("")) {
                    names.pop();
                }
                names
            }
        };
        let plan = header::plan(&names, self.options)
            .map_err(|fault| (fault.field.filter(|_| columns.is_none()).and_then(at), fault.kind))?;
        self.body = Some(Body::new(RowParser::new(plan, separator), self.options));
        Ok(columns.is_some())
    }

    fn finish(self, path: String, sha256: String) -> Result<Recording, Refusal> {
        match self.body {
            Some(body) => body.finish(path, sha256),
            None => Err(whole(ReadErrorKind::Empty)),
        }
    }
}

/// Names for as many columns as a file has.
fn example_columns(n_fields: usize) -> String {
    let names = ["time_s", "pressure_kPa", "length_mm", "force_N"];
    let example: Vec<&str> = (0..n_fields.clamp(1, 12)).map(|index| names.get(index).copied().unwrap_or("-")).collect();
    example.join(",")
}

/// Everything below the header.
struct Body {
    parser: RowParser,
    skip_bad_rows: bool,
    force_required: bool,
    min_rows: usize,
    filter: ClockFilter,
    released: Vec<Row>,
    repairs: Repairs,
    blank_lines: u64,
    last_s: f64,
    /// Rows whose stamps are not final, column by column.
    pending: [Vec<f64>; MAX_COLUMNS],
    /// Pending rows at which the next attempt at their stamps is made.
    attempt_rows: usize,
    stamps: StampRepair,
    samples: SamplesBuilder,
    breaks: Vec<usize>,
    first: Option<Channels>,
    force_varies: bool,
}

impl Body {
    fn new(parser: RowParser, options: &ReadOptions) -> Self {
        let plan = parser.plan();
        let samples =
            SamplesBuilder::new(plan.has(Quantity::Force), plan.has(Quantity::Temperature), options.memory_rows);
        Self {
            parser,
            skip_bad_rows: options.skip_bad_rows,
            force_required: options.force_required,
            min_rows: options.min_rows.max(2),
            filter: ClockFilter::default(),
            released: Vec::new(),
            repairs: Repairs::default(),
            blank_lines: 0,
            last_s: f64::NEG_INFINITY,
            pending: Default::default(),
            attempt_rows: CHUNK_ROWS,
            stamps: StampRepair::default(),
            samples,
            breaks: Vec::new(),
            first: None,
            force_varies: false,
        }
    }

    fn line(&mut self, line: Line, number: u64) -> Result<(), Refusal> {
        match line {
            Line::Row(channels) => self.row(channels, number),
            Line::Comment => Ok(()),
            Line::Blank => {
                self.blank_lines += 1;
                Ok(())
            }
            Line::Fault(_, fault) if self.skip_bad_rows => {
                self.repairs.skip(number, &fault);
                Ok(())
            }
            Line::Fault(column, fault) => Err((Some(Place { line: number, column }), ReadErrorKind::Row { fault })),
        }
    }

    fn row(&mut self, channels: Channels, line: u64) -> Result<(), Refusal> {
        // Blank lines at the end of a file are no news.
        self.repairs.blank_lines = self.blank_lines;
        if self.skip_bad_rows {
            self.filter.admit(Row { line, channels }, &mut self.released, &mut self.repairs);
            let mut released = std::mem::take(&mut self.released);
            for row in released.drain(..) {
                self.keep(row.channels)?;
            }
            self.released = released;
            return Ok(());
        }
        if channels[0] < self.last_s {
            let place = Place { line, column: self.parser.plan().time_column() };
            let fault = RowFault::ClockRunsBack { before_s: self.last_s, time_s: channels[0] };
            return Err((Some(place), ReadErrorKind::Row { fault }));
        }
        self.last_s = channels[0];
        self.keep(channels)
    }

    /// Keeps a row whose clock is in order.
    fn keep(&mut self, channels: Channels) -> Result<(), Refusal> {
        let first = self.first.get_or_insert(channels);
        self.force_varies |= channels[Quantity::Force as usize] != first[Quantity::Force as usize];
        for (column, value) in self.pending.iter_mut().zip(channels) {
            column.push(value);
        }
        if self.pending[0].len() >= self.attempt_rows {
            self.settle(false)?;
            self.attempt_rows = self.pending[0].len() + CHUNK_ROWS;
        }
        Ok(())
    }

    /// Passes rows on whose stamps are final.
    fn settle(&mut self, last: bool) -> Result<(), Refusal> {
        let settled = self.stamps.settle(&mut self.pending[0], last).map_err(whole)?;
        let n_before = self.samples.n_rows();
        self.breaks.extend(settled.breaks.iter().map(|row| n_before + row));
        self.repairs.gaps += settled.breaks.len() as u64;
        self.repairs.longest_gap_s = self.repairs.longest_gap_s.max(settled.longest_gap_s);
        self.repairs.repeated_stamps_spread += settled.n_spread;
        let plan = self.parser.plan();
        let mut columns: [&[f64]; MAX_COLUMNS] = [&[]; MAX_COLUMNS];
        for ((column, pending), quantity) in columns.iter_mut().zip(&self.pending).zip(Quantity::ALL) {
            if plan.has(quantity) {
                *column = &pending[..settled.n_rows];
            }
        }
        self.samples.extend(columns).map_err(spill_refusal)?;
        for pending in &mut self.pending {
            pending.drain(..settled.n_rows);
        }
        Ok(())
    }

    fn finish(mut self, path: String, sha256: String) -> Result<Recording, Refusal> {
        self.filter.finish(&mut self.released, &mut self.repairs);
        for row in std::mem::take(&mut self.released) {
            self.keep(row.channels)?;
        }
        let found = self.samples.n_rows() + self.pending[0].len();
        if found < self.min_rows {
            let skipped = self.repairs.rows_skipped;
            return Err(whole(ReadErrorKind::TooFewRows { found, needed: self.min_rows, skipped }));
        }
        let first = self.first.unwrap_or_default();
        if self.samples.n_rows() == 0 && self.pending[0].iter().all(|time_s| *time_s == first[0]) {
            return Err(whole(ReadErrorKind::TimeNeverVaries { time_s: first[0] }));
        }
        let force_fixed =
            matches!(self.parser.plan().sources[Quantity::Force as usize], Some(header::Source::Fixed(_)));
        if self.force_required && !self.force_varies && !force_fixed {
            return Err(whole(ReadErrorKind::ForceNeverVaries { force_n: first[Quantity::Force as usize] }));
        }
        self.settle(true)?;
        let samples = self.samples.finish().map_err(spill_refusal)?;
        let segments = segments(&self.breaks, &samples);
        let ignored_columns = self.parser.into_plan().ignored;
        Ok(Recording { path, sha256, samples, segments, repairs: self.repairs, ignored_columns })
    }
}

fn segments(breaks: &[usize], samples: &Samples) -> Vec<Range<usize>> {
    let starts = [0].into_iter().chain(breaks.iter().copied());
    let ends = breaks.iter().copied().chain([samples.n_rows()]);
    starts.zip(ends).map(|(start, end)| start..end).collect()
}

fn spill_refusal(failed: SpillFailed) -> Refusal {
    whole(ReadErrorKind::Spill { directory: failed.directory, source: failed.source })
}
