//! Reading a recording from its first byte to its last.

use std::path::Path;

use rayon::prelude::*;

use super::Recording;
use super::body::Body;
use super::error::{Place, ReadError, ReadErrorKind, Refusal, whole};
use super::fields::{is_blank, is_comment, strip_line_end};
use super::lines::{LineReader, Lines, MAX_LINE_BYTES};
use super::lvm;
use super::matlab;
use super::opening::{self, Comment, Opened, Seen};
use super::options::ReadOptions;
use super::row_fault::RowFault;
use super::rows::{Line, RowParser};
use super::sniff::{self, Layout};
use super::source::ByteSource;

/// Reads a recording; `-` is standard input. Compressed files (gzip) are recognised by their content.
///
/// # Errors
/// [`ReadError`] says where and why the file is refused, and what to do.
pub fn read_recording(source: &Path, options: &ReadOptions) -> Result<Recording, ReadError> {
    read_recording_observed(source, options, &mut |_, _| {})
}

/// As [`read_recording`]; `observe` is told, now and then, how much of how much has been read, in bytes or
/// samples; not where nobody knows how much there is, as of standard input.
///
/// # Errors
/// As [`read_recording`].
pub fn read_recording_observed(
    source: &Path,
    options: &ReadOptions,
    observe: &mut dyn FnMut(u64, u64),
) -> Result<Recording, ReadError> {
    read(source, options, observe).map_err(|(place, kind)| ReadError {
        path: source.to_owned(),
        place,
        kind: Box::new(kind),
    })
}

fn read(path: &Path, options: &ReadOptions, observe: &mut dyn FnMut(u64, u64)) -> Result<Recording, Refusal> {
    let mut lines = LineReader::new(ByteSource::open(path).map_err(whole)?);
    let start = lines.peek(MAX_LINE_BYTES).map_err(whole)?;
    if let Some(format) = pam_matlab::format_of(start) {
        return matlab::read(format, lines, path.to_string_lossy().into_owned(), options, observe);
    }
    let n_mark = sniff::check_text(start).map_err(whole)?;
    let lvm = lvm::header(&start[n_mark..]).transpose().map_err(whole)?;
    let (n_skipped, n_lines) = lvm.as_ref().map_or((n_mark, 0), |header| (n_mark + header.n_bytes, header.n_lines));
    let table = &start[n_skipped..];
    let n_columns = options.columns.as_ref().map(|columns| columns.names.len());
    let mut layout = sniff::layout(table, n_columns);
    if let Some(header) = &lvm {
        layout = Layout { separator: header.separator, ..layout };
    }
    let seen = Seen { layout, hints: sniff::hints(table, layout), lvm };
    lines.skip(n_skipped);
    let mut reading = Reading::new(seen, n_lines, options);
    loop {
        if let Some((done, all)) = lines.progress() {
            observe(done, all);
        }
        match lines.next().map_err(whole)? {
            Lines::Whole(text) => reading.take(text)?,
            Lines::TooLong => reading.too_long()?,
            Lines::End => break,
        }
    }
    let sha256 = lines.sha256().map_err(whole)?;
    reading.finish(path.to_string_lossy().into_owned(), sha256)
}

/// Bytes of a piece, about: large enough that handing it to a thread costs nothing beside reading it.
const PIECE_BYTES: usize = 1 << 17;

/// Cuts whole lines into pieces of whole lines.
fn pieces(text: &[u8]) -> Vec<&[u8]> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while rest.len() > PIECE_BYTES {
        let Some(end) = rest[PIECE_BYTES..].iter().position(|byte| *byte == b'\n') else { break };
        let (piece, tail) = rest.split_at(PIECE_BYTES + end + 1);
        pieces.push(piece);
        rest = tail;
    }
    if !rest.is_empty() {
        pieces.push(rest);
    }
    pieces
}

/// Kind of each line of `text`.
fn lines_of(parser: &mut RowParser, text: &[u8]) -> Vec<Line> {
    // As many as there are lines as short as the first.
    let first = memchr::memchr(b'\n', text).map_or(text.len(), |end| end + 1);
    let mut lines = Vec::with_capacity(text.len() / first.max(1) + 1);
    let mut rest = text;
    while !rest.is_empty() {
        let (line, length) = parser.read(rest);
        lines.push(line);
        rest = &rest[length..];
    }
    lines
}

/// The state between two lines.
struct Reading<'a> {
    options: &'a ReadOptions,
    seen: Seen,
    /// Whether the row of units under the header is still to come.
    units_ahead: bool,
    /// Lines taken so far.
    line: u64,
    /// The last comment before the first row.
    comment: Option<Comment>,
    body: Option<Body>,
}

impl<'a> Reading<'a> {
    fn new(seen: Seen, line: u64, options: &'a ReadOptions) -> Self {
        Self { options, seen, units_ahead: false, line, comment: None, body: None }
    }

    /// Takes whole lines.
    fn take(&mut self, text: &[u8]) -> Result<(), Refusal> {
        let mut rest = text;
        while self.body.is_none() || self.units_ahead {
            let Some(end) = rest.iter().position(|byte| *byte == b'\n') else { return Ok(()) };
            let (line, tail) = rest.split_at(end + 1);
            if self.open(strip_line_end(line))? == Opened::OnRow {
                break;
            }
            rest = tail;
        }
        let Some(body) = &mut self.body else { return Ok(()) };
        // Numbers are what takes time, and a line needs no other: pieces in parallel, then everything that
        // depends on what came before, in order.
        let parser = &body.parser;
        let pieces: Vec<Vec<Line>> = pieces(rest).into_par_iter().map_init(|| parser.clone(), lines_of).collect();
        for line in pieces.into_iter().flatten() {
            self.line += 1;
            body.line(line, self.line)?;
        }
        Ok(())
    }

    /// Takes a line before the first row; where it turns out to be that row, it is left to be read as one.
    fn open(&mut self, line: &[u8]) -> Result<Opened, Refusal> {
        self.line += 1;
        if is_comment(line) {
            self.comment = Some(Comment { line: self.line, text: line.to_vec() });
        }
        if is_blank(line) || is_comment(line) {
            return Ok(Opened::OnHeader);
        }
        if self.units_ahead {
            self.units_ahead = false;
            return Ok(Opened::OnHeader);
        }
        let comment = self.comment.as_ref();
        let (plan, opened) = opening::plan(line, self.line, comment, &self.seen, self.options)?;
        self.body = Some(Body::new(RowParser::new(plan, self.seen.layout.separator), self.options));
        self.units_ahead = opened == Opened::OnHeader && self.seen.hints.units.is_some();
        if opened == Opened::OnRow {
            self.line -= 1;
        }
        Ok(opened)
    }

    /// Passes over a line of absurd length.
    fn too_long(&mut self) -> Result<(), Refusal> {
        self.line += 1;
        let limit = MAX_LINE_BYTES;
        match &mut self.body {
            Some(body) => body.line(Line::Fault(1, RowFault::TooLong { limit }), self.line),
            None => Err((Some(Place { line: self.line, column: 1 }), ReadErrorKind::LineTooLong { limit })),
        }
    }

    fn finish(self, path: String, sha256: String) -> Result<Recording, Refusal> {
        match self.body {
            Some(body) => body.finish(path, sha256),
            None => Err(whole(ReadErrorKind::Empty)),
        }
    }
}
