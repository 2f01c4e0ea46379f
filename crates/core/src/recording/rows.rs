//! From the bytes of a line to the five channels of a row.

use std::ops::Range;

use super::fields::{NumberFault, is_blank, is_comment, number, split, strip_line_end, text};
use super::header::{Plan, Source};
use super::row_fault::RowFault;
use super::samples::MAX_COLUMNS;
use super::wording::clipped;

/// Characters of a field that a message shows.
const TEXT_SHOWN: usize = 40;

/// Largest magnitude in SI that can be a measurement; squares and products of such numbers stay finite.
/// Seconds since 1904, the oldest origin that loggers use, are a three-hundredth of it.
const LARGEST: f64 = 1e12;

/// Channels of a row in SI, in the order of [`super::Quantity::ALL`]; zero where there is none.
pub(crate) type Channels = [f64; MAX_COLUMNS];

/// What a line holds.
#[derive(Debug, PartialEq)]
pub(crate) enum Line {
    Row(Channels),
    Blank,
    Comment,
    /// The field, counted from 1, and what is wrong with it.
    Fault(u64, RowFault),
}

/// Reads rows according to a plan.
#[derive(Debug)]
pub(crate) struct RowParser {
    plan: Plan,
    separator: u8,
    fields: Vec<Range<usize>>,
}

impl RowParser {
    pub(crate) fn new(plan: Plan, separator: u8) -> Self {
        Self { plan, separator, fields: Vec::new() }
    }

    pub(crate) fn plan(&self) -> &Plan {
        &self.plan
    }

    pub(crate) fn into_plan(self) -> Plan {
        self.plan
    }

    /// Reads the first line of `text`, which ends with a line feed; returns its length too.
    ///
    /// # Design
    /// Nearly every line of nearly every file is numbers between separators, and for those one pass is enough:
    /// the number parser itself says where each number ends. Whatever surprises that pass (quotes, decimal commas, a
    /// comment, a fault) is read again with care.
    #[inline]
    pub(crate) fn read(&mut self, text: &[u8]) -> (Line, usize) {
        match self.plain(text) {
            Some((channels, length)) => (Line::Row(channels), length),
            None => self.careful(text),
        }
    }

    #[inline]
    fn plain(&self, text: &[u8]) -> Option<(Channels, usize)> {
        let separator = self.separator;
        let mut slots = [0.0; MAX_COLUMNS];
        let mut rest = text;
        while let [b' ', tail @ ..] = rest {
            rest = tail;
        }
        if rest.first() == Some(&b'#') {
            return None;
        }
        let last = self.plan.fields.len() - 1;
        for (index, slot) in self.plan.fields.iter().enumerate() {
            while let [b' ', tail @ ..] = rest {
                rest = tail;
            }
            match slot {
                Some(slot) => {
                    let (value, length) = fast_float2::parse_partial::<f64, _>(rest).ok()?;
                    *slots.get_mut(*slot)? = value;
                    rest = rest.get(length..)?;
                }
                None => {
                    let end = rest.iter().position(|byte| *byte == separator || matches!(byte, b'\n' | b'"'))?;
                    rest = &rest[end..];
                }
            }
            while let [b' ' | b'\r', tail @ ..] = rest {
                rest = tail;
            }
            let (end, tail) = rest.split_first()?;
            if *end != if index == last { b'\n' } else { separator } {
                return None;
            }
            rest = tail;
        }
        let channels = self.channels(&slots);
        channels.iter().all(|value| value.abs() <= LARGEST).then_some((channels, text.len() - rest.len()))
    }

    #[inline]
    fn channels(&self, slots: &[f64; MAX_COLUMNS]) -> Channels {
        let mut channels = [0.0; MAX_COLUMNS];
        for (channel, source) in channels.iter_mut().zip(&self.plan.sources) {
            *channel = match source {
                Some(Source::Field { slot, gain, bias, unit }) => unit.si(gain * slots[*slot] + bias),
                Some(Source::Fixed(value)) => *value,
                None => 0.0,
            };
        }
        channels
    }

    #[cold]
    fn careful(&mut self, text: &[u8]) -> (Line, usize) {
        let length = text.iter().position(|byte| *byte == b'\n').map_or(text.len(), |end| end + 1);
        let line = strip_line_end(&text[..length]);
        let line = if is_blank(line) {
            Line::Blank
        } else if is_comment(line) {
            Line::Comment
        } else {
            match self.row(line) {
                Ok(channels) => Line::Row(channels),
                Err((column, fault)) => Line::Fault(column, fault),
            }
        };
        (line, length)
    }

    fn row(&mut self, line: &[u8]) -> Result<Channels, (u64, RowFault)> {
        let expected = self.plan.fields.len();
        let n_fields = split(line, self.separator, expected + 1, &mut self.fields)
            .map_err(|quote| (quote.field as u64 + 1, RowFault::OpenQuote))?;
        // Some loggers end every row with a separator.
        let ends_empty = n_fields == expected + 1 && self.fields.last().is_some_and(Range::is_empty);
        if n_fields != expected && !ends_empty {
            let column = n_fields.min(expected) as u64 + 1;
            return Err((column, RowFault::FieldCount { found: n_fields, expected }));
        }
        let mut slots = [0.0; MAX_COLUMNS];
        for (index, slot) in self.plan.fields.iter().enumerate() {
            let Some(slot) = slot else { continue };
            let field = &line[self.fields[index].clone()];
            slots[*slot] = number(field, self.separator != b',').map_err(|fault| {
                let (column, text) = self.shown(index, field);
                let fault = match fault {
                    NumberFault::NotANumber if field.is_empty() => RowFault::EmptyField { column },
                    NumberFault::NotANumber => RowFault::NotANumber { column, text },
                    NumberFault::NotFinite => RowFault::NotFinite { column, text },
                };
                (index as u64 + 1, fault)
            })?;
        }
        let channels = self.channels(&slots);
        for (value, source) in channels.iter().zip(&self.plan.sources) {
            if let Some(Source::Field { slot, .. }) = source
                && (value.is_nan() || value.abs() > LARGEST)
                && let Some(index) = self.plan.fields.iter().position(|field| *field == Some(*slot))
            {
                let (column, text) = self.shown(index, &line[self.fields[index].clone()]);
                return Err((index as u64 + 1, RowFault::Absurd { column, text }));
            }
        }
        Ok(channels)
    }

    fn shown(&self, index: usize, field: &[u8]) -> (String, String) {
        (self.plan.names[index].clone(), clipped(&text(field), TEXT_SHOWN))
    }
}
