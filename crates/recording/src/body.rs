//! The rows below the header: checked against the clock, repaired, put away.

use std::ops::Range;

use super::Recording;
use super::clock::{ClockFilter, Row};
use super::error::{Place, ReadErrorKind, Refusal, whole};
use super::header::Source;
use super::options::ReadOptions;
use super::repair::Repairs;
use super::row_fault::RowFault;
use super::rows::{Channels, Line, RowParser};
use super::samples::{CHUNK_ROWS, MAX_COLUMNS, Samples, SamplesBuilder, SpillFailed};
use super::stamps::StampRepair;
use super::units::Quantity;

/// Everything below the header.
pub(super) struct Body {
    pub(super) parser: RowParser,
    skip_bad_rows: bool,
    force_required: bool,
    min_rows: usize,
    sensor_ranges: [Option<[f64; 2]>; MAX_COLUMNS],
    filter: ClockFilter,
    released: Vec<Row>,
    repairs: Repairs,
    blank_lines: u64,
    last_s: f64,
    /// Rows whose stamps are not final, column by column.
    pending: [Vec<f64>; MAX_COLUMNS],
    /// Columns up to the last that is there.
    n_columns: usize,
    /// Pending rows at which the next attempt at their stamps is made.
    attempt_rows: usize,
    stamps: StampRepair,
    samples: SamplesBuilder,
    breaks: Vec<usize>,
    first: Option<Channels>,
    force_varies: bool,
}

impl Body {
    pub(super) fn new(parser: RowParser, options: &ReadOptions) -> Self {
        let plan = parser.plan();
        let plan_has_temperature = plan.has(Quantity::Temperature);
        let samples = SamplesBuilder::new(plan.has(Quantity::Force), plan_has_temperature, options.memory_rows);
        Self {
            parser,
            skip_bad_rows: options.skip_bad_rows,
            force_required: options.force_required,
            min_rows: options.min_rows.max(2),
            sensor_ranges: options.sensor_ranges,
            filter: ClockFilter::default(),
            released: Vec::new(),
            repairs: Repairs::default(),
            blank_lines: 0,
            last_s: f64::NEG_INFINITY,
            pending: std::array::from_fn(|_| Vec::with_capacity(CHUNK_ROWS)),
            n_columns: if plan_has_temperature { MAX_COLUMNS } else { MAX_COLUMNS - 1 },
            attempt_rows: CHUNK_ROWS,
            stamps: StampRepair::default(),
            samples,
            breaks: Vec::new(),
            first: None,
            force_varies: false,
        }
    }

    /// Takes what a line holds.
    pub(super) fn line(&mut self, line: Line, number: u64) -> Result<(), Refusal> {
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
        for (column, value) in self.pending[..self.n_columns].iter_mut().zip(channels) {
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
        for pending in &mut self.pending[..self.n_columns] {
            pending.drain(..settled.n_rows);
        }
        Ok(())
    }

    /// The recording, at the end of the file.
    pub(super) fn finish(mut self, path: String, sha256: String) -> Result<Recording, Refusal> {
        self.filter.finish(&mut self.released, &mut self.repairs);
        for row in std::mem::take(&mut self.released) {
            self.keep(row.channels)?;
        }
        let found = self.samples.n_rows() + self.pending[0].len();
        if found < self.min_rows {
            let skipped = self.repairs.rows_skipped;
            let first_skipped = self.repairs.first_skipped.first().cloned();
            return Err(whole(ReadErrorKind::TooFewRows { found, needed: self.min_rows, skipped, first_skipped }));
        }
        let first = self.first.unwrap_or_default();
        if self.samples.n_rows() == 0 && self.pending[0].iter().all(|time_s| *time_s == first[0]) {
            return Err(whole(ReadErrorKind::TimeNeverVaries { time_s: first[0] }));
        }
        let force_fixed = matches!(self.parser.plan().sources[Quantity::Force as usize], Some(Source::Fixed(_)));
        if self.force_required && !self.force_varies && !force_fixed {
            return Err(whole(ReadErrorKind::ForceNeverVaries { force_n: first[Quantity::Force as usize] }));
        }
        self.settle(true)?;
        let samples = self.samples.finish().map_err(spill_refusal)?.with_sensor_ranges(self.sensor_ranges);
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
