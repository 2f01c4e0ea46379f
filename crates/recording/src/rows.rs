//! From the bytes of a line to the five channels of a row.

use super::date::stamp_s;
use super::fields::{NumberFault, Splitter, is_blank, is_comment, number};
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

/// Content of a line.
#[derive(Debug, PartialEq)]
pub(crate) enum Line {
    Row(Channels),
    Blank,
    Comment,
    /// The field, counted from 1, and what is wrong with it.
    Fault(u64, RowFault),
}

/// Reads rows according to a plan.
#[derive(Debug, Clone)]
pub(crate) struct RowParser {
    plan: Plan,
    splitter: Splitter,
    decimal_comma: bool,
}

impl RowParser {
    pub(crate) fn new(plan: Plan, separator: u8) -> Self {
        Self { plan, splitter: Splitter::new(separator), decimal_comma: separator != b',' }
    }

    pub(crate) fn plan(&self) -> &Plan {
        &self.plan
    }

    pub(crate) fn into_plan(self) -> Plan {
        self.plan
    }

    /// Reads the first line of `text`, which ends with a line feed; returns its length too.
    pub(crate) fn read(&mut self, text: &[u8]) -> (Line, usize) {
        let length = memchr::memchr(b'\n', text).map_or(text.len(), |end| end + 1);
        let line = &text[..length];
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
        let plan = &self.plan;
        let expected = plan.fields.len();
        let fields = self.splitter.split(line).map_err(|quote| (quote.field as u64 + 1, RowFault::OpenQuote))?;
        let n_fields = fields.len();
        // Some loggers end every row with a separator.
        let ends_empty = n_fields == expected + 1 && fields.get(expected).is_empty();
        if n_fields != expected && !ends_empty {
            let column = n_fields.min(expected) as u64 + 1;
            return Err((column, RowFault::FieldCount { found: n_fields, expected }));
        }
        let mut slots = [0.0; MAX_COLUMNS];
        for (index, slot) in plan.fields.iter().enumerate() {
            let Some(slot) = slot else { continue };
            let field = fields.get(index);
            if let Some((dates, from_s)) = plan.dates
                && dates == *slot
            {
                let Some(stamp_s) = stamp_s(field) else {
                    let (column, text) = shown(plan, index, field);
                    return Err((index as u64 + 1, RowFault::NotADate { column, text }));
                };
                slots[*slot] = stamp_s - from_s;
                continue;
            }
            slots[*slot] = number(field, self.decimal_comma).map_err(|fault| {
                let (column, text) = shown(plan, index, field);
                let fault = match fault {
                    NumberFault::NotANumber if field.is_empty() => RowFault::EmptyField { column },
                    NumberFault::NotANumber => RowFault::NotANumber { column, text },
                    NumberFault::NotFinite => RowFault::NotFinite { column, text },
                };
                (index as u64 + 1, fault)
            })?;
        }
        let channels = channels(plan, &slots);
        match absurd(plan, &channels) {
            Some((index, _)) => {
                let (column, text) = shown(plan, index, fields.get(index));
                Err((index as u64 + 1, RowFault::Absurd { column, text }))
            }
            None => Ok(channels),
        }
    }

    /// The row of numbers that need no reading.
    pub(crate) fn row_of(&self, slots: &[f64; MAX_COLUMNS]) -> Line {
        let plan = &self.plan;
        let channels = channels(plan, slots);
        let Some((index, slot)) = absurd(plan, &channels) else { return Line::Row(channels) };
        let (column, text) = shown(plan, index, slots[slot].to_string().as_bytes());
        let fault = if slots[slot].is_finite() {
            RowFault::Absurd { column, text }
        } else {
            RowFault::NotFinite { column, text }
        };
        Line::Fault(index as u64 + 1, fault)
    }
}

/// The first field, and its slot, whose value no measurement has.
fn absurd(plan: &Plan, channels: &Channels) -> Option<(usize, usize)> {
    channels.iter().zip(&plan.sources).find_map(|(value, source)| match source {
        Some(Source::Field { slot, .. }) if value.is_nan() || value.abs() > LARGEST => {
            let index = plan.fields.iter().position(|field| *field == Some(*slot))?;
            Some((index, *slot))
        }
        _ => None,
    })
}

fn channels(plan: &Plan, slots: &[f64; MAX_COLUMNS]) -> Channels {
    let mut channels = [0.0; MAX_COLUMNS];
    for (channel, source) in channels.iter_mut().zip(&plan.sources) {
        *channel = match source {
            Some(Source::Field { slot, gain, bias, unit }) => unit.si(gain * slots[*slot] + bias),
            Some(Source::Fixed(value)) => *value,
            None => 0.0,
        };
    }
    channels
}

/// The column's name and what it holds, for a message.
fn shown(plan: &Plan, index: usize, field: &[u8]) -> (String, String) {
    (plan.names[index].clone(), clipped(&String::from_utf8_lossy(field), TEXT_SHOWN))
}
