//! A channel that stops half way and shows one value from there on: a logger that hangs, a cable that came off.
//!
//! A channel that flickers does not show one value for long. Where it does, at neither end of its range (that is a sensor
//! out of range, whose samples are not counted), it is frozen. A channel that is quiet between its steps says nothing.

use std::io;

use pam_core::recording::{Chunk, Recording};

use super::Fault;

/// Rows and time that a run of one value must last.
const ROWS: usize = 50;
const LASTS_S: f64 = 0.25;
/// Share of neighbors outside the run that may be equal, and that must turn from rising faster to rising slower or back:
/// two in three do where noise is white, few do on a smooth path.
const MOST_EQUAL: f64 = 0.3;
const LEAST_TURNS: f64 = 0.3;

type Column = fn(&Chunk) -> &[f64];

/// The longest run of one value within a channel, and how the rest of it flickers.
#[derive(Debug, Default)]
struct Runs {
    lowest: f64,
    highest: f64,
    /// The run that goes on: its value, first row, rows.
    value: f64,
    start: usize,
    rows: usize,
    /// The longest so far that is at no end of the range.
    longest: (f64, usize, usize),
    n: usize,
    equal: usize,
    bends: usize,
    turns: usize,
    before: [f64; 2],
    bend: f64,
}

impl Runs {
    fn push(&mut self, row: usize, value: f64) {
        if row > 0 && value == self.before[1] {
            self.equal += 1;
            self.rows += 1;
        } else {
            self.close();
            (self.value, self.start, self.rows) = (value, row, 1);
        }
        if row > 1 {
            let bend = self.before[0] - 2.0 * self.before[1] + value;
            if bend != 0.0 && self.bend != 0.0 {
                self.bends += 1;
                self.turns += usize::from((bend > 0.0) != (self.bend > 0.0));
            }
            if bend != 0.0 {
                self.bend = bend;
            }
        }
        self.before = [self.before[1], value];
        self.n += 1;
    }

    fn close(&mut self) {
        let at_end = self.value <= self.lowest || self.value >= self.highest;
        if self.rows > self.longest.2 && !at_end {
            self.longest = (self.value, self.start, self.rows);
        }
    }

    /// The run, where the rest of the channel says that it cannot be chance.
    fn frozen(mut self) -> Option<(f64, usize, usize)> {
        self.close();
        let (value, start, rows) = self.longest;
        let rest = (self.n.saturating_sub(rows)) as f64;
        let equal = self.equal.saturating_sub(rows - rows.min(1)) as f64;
        let flickers = rest > ROWS as f64
            && equal < MOST_EQUAL * rest
            && self.turns as f64 > LEAST_TURNS * self.bends as f64
            && self.bends > 20;
        (rows >= ROWS && flickers).then_some((value, start, rows))
    }
}

/// A channel of a recording that froze.
///
/// # Errors
/// Where samples cannot be read back.
pub fn find(recording: &Recording) -> io::Result<Option<Fault>> {
    let columns: [(&'static str, Column, f64, &'static str); 3] = [
        ("force", Chunk::force_n, 1.0, "N"),
        ("pressure", Chunk::pressure_pa, 1e-3, "kPa"),
        ("length", Chunk::length_m, 1e3, "mm"),
    ];
    for (channel, column, scale, unit) in columns {
        let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
        for chunk in recording.samples.chunks() {
            for &value in column(&chunk?) {
                (lowest, highest) = (lowest.min(value), highest.max(value));
            }
        }
        if highest <= lowest {
            continue;
        }
        let mut runs = Runs { lowest, highest, value: f64::NAN, bend: 0.0, ..Runs::default() };
        for chunk in recording.samples.chunks() {
            let chunk = chunk?;
            for (row, &value) in chunk.rows().zip(column(&chunk)) {
                runs.push(row, value);
            }
        }
        let Some((value, start, rows)) = runs.frozen() else { continue };
        let at_s = |row: usize| -> io::Result<f64> {
            let chunk = recording.samples.chunk(row / pam_core::recording::CHUNK_ROWS)?;
            Ok(chunk.time_s()[row - chunk.first_row()])
        };
        let (from_s, to_s) = (at_s(start)?, at_s(start + rows - 1)?);
        if to_s - from_s >= LASTS_S {
            let value = format!("{:.3} {unit}", value * scale);
            return Ok(Some(Fault::Frozen { path: recording.path.clone(), channel, value, from_s, to_s, rows }));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runs(values: &[f64]) -> Option<(f64, usize, usize)> {
        let (lowest, highest) = values
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
        let mut runs = Runs { lowest, highest, value: f64::NAN, ..Runs::default() };
        values.iter().enumerate().for_each(|(row, &value)| runs.push(row, value));
        runs.frozen()
    }

    fn noisy(row: usize) -> f64 {
        300.0 * (0.01 * row as f64).sin() + (row * 7919 % 101) as f64 * 0.1
    }

    #[test]
    fn a_channel_that_flickers_and_then_stands_is_frozen_and_one_that_rests_is_not() {
        let frozen: Vec<f64> = (0..2000).map(|row| noisy(row.min(1200))).collect();
        assert_eq!(runs(&frozen), Some((noisy(1200), 1200, 800)));
        let alive: Vec<f64> = (0..2000).map(noisy).collect();
        assert_eq!(runs(&alive), None);
        // At the end of the range it is a sensor out of range.
        let clipped: Vec<f64> = (0..2000).map(|row| noisy(row).min(200.0)).collect();
        assert_eq!(runs(&clipped), None);
        // A path without noise may rest, and so may a channel with coarse steps.
        let smooth: Vec<f64> = (0..2000).map(|row| (0.003 * row.clamp(300, 900) as f64).sin()).collect();
        assert_eq!(runs(&smooth), None);
        let coarse: Vec<f64> = (0..2000).map(|row| (noisy(row.min(500)) / 40.0).round()).collect();
        assert_eq!(runs(&coarse), None);
    }
}
