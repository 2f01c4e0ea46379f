//! A channel that stops half way and shows one value from there on: a logger that hangs, a cable that came off.
//!
//! A channel that flickers does not show one value for long. Where it does, at neither end of its range (that is a sensor
//! out of range, whose samples are not counted), it froze, or it rests: a valve that is shut, steps coarser than the noise and a
//! slow filter make the same run of equal values. The other two channels tell. A [smooth map](super::smooth_map) of them is
//! fitted to the rest of the recording. What it leaves of the force wanders as friction and misfit make it, and wanders much
//! further along a channel that froze while the muscle went on. A run along which nothing moves is harmless, whatever made it.
//! A force that stands at the low end of its range is slack, or a load cell whose plug came off: the map says whether the muscle
//! should have pulled there.

use std::io;
use std::ops::Range;

use pam_recording::{Chunk, Recording};

use super::Fault;
use super::smooth_map::{SmoothMap, Sums};

/// Rows and time that a run of one value must last.
const ROWS: usize = 50;
const LASTS_S: f64 = 0.25;
/// Share of neighbors outside the run that may be equal, and that must turn from rising faster to rising slower or back:
/// two in three do where noise is white, few do on a smooth path.
const MOST_EQUAL: f64 = 0.3;
const LEAST_TURNS: f64 = 0.3;

/// How often as far as elsewhere the residual wanders along a run that froze. Between 1.1, where the pressure of a file froze
/// that a valve held, and 7.5, the least of 28 other halves of files that froze: any limit in between tells the same. Runs of coarse or
/// filtered channels in order come to 0.05 and 0.23.
const WANDERS: f64 = 3.0;
/// Share of the largest force that a muscle must have along a run at the low end of a force, for that to be no slack.
const PULLS: f64 = 0.12;
/// Samples of a run that are looked at, about, and shares of them left out at either end: spikes and noise.
const LOOKED_AT: usize = 64;
const LEFT_OUT: f64 = 0.05;

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
    /// The longest so far that is at no end of the range, and the longest at its low end.
    longest: (f64, usize, usize),
    lowest_run: (f64, usize, usize),
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
        if self.rows > self.lowest_run.2 && self.value <= self.lowest {
            self.lowest_run = (self.value, self.start, self.rows);
        }
    }

    /// The run, where the rest of the channel says that it cannot be chance.
    fn frozen(&self) -> Option<(f64, usize, usize)> {
        self.beside(self.longest)
    }

    /// That at the low end of the range, likewise.
    fn frozen_low(&self) -> Option<(f64, usize, usize)> {
        self.beside(self.lowest_run)
    }

    fn beside(&self, (value, start, rows): (f64, usize, usize)) -> Option<(f64, usize, usize)> {
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
        runs.close();
        let at_s = |row: usize| -> io::Result<f64> {
            let chunk = recording.samples.chunk(row / pam_recording::CHUNK_ROWS)?;
            Ok(chunk.time_s()[row - chunk.first_row()])
        };
        // At its low end a force is slack, unless pressure and length say that the muscle pulls.
        let low = runs.frozen_low().filter(|_| channel == "force");
        for (run, is_low) in [(runs.frozen(), false), (low, true)] {
            let Some((value, start, rows)) = run else { continue };
            let (from_s, to_s) = (at_s(start)?, at_s(start + rows - 1)?);
            if to_s - from_s >= LASTS_S && moved(recording, start..start + rows, is_low.then_some(highest))? {
                let value = format!("{:.3} {unit}", value * scale);
                return Ok(Some(Fault::Frozen { path: recording.path.clone(), channel, value, from_s, to_s, rows }));
            }
        }
    }
    Ok(None)
}

/// The smooth map of every so-many-th row of `recording` outside `run`; none where nothing varies.
fn map_beside(recording: &Recording, run: &Range<usize>, stride: usize) -> io::Result<Option<SmoothMap>> {
    let (mut highest_pa, mut shortest_m, mut longest_m) = (0.0_f64, f64::INFINITY, f64::NEG_INFINITY);
    for chunk in recording.samples.chunks() {
        let chunk = chunk?;
        highest_pa = chunk.pressure_pa().iter().copied().fold(highest_pa, f64::max);
        shortest_m = chunk.length_m().iter().copied().fold(shortest_m, f64::min);
        longest_m = chunk.length_m().iter().copied().fold(longest_m, f64::max);
    }
    let mut sums = Sums::new(highest_pa, [shortest_m, longest_m]);
    for chunk in recording.samples.chunks() {
        let chunk = chunk?;
        for row in chunk.rows().filter(|row| row.is_multiple_of(stride) && !run.contains(row)) {
            let here = row - chunk.first_row();
            sums.push(chunk.pressure_pa()[here], chunk.length_m()[here], chunk.force_n()[here]);
        }
    }
    Ok(sums.map())
}

/// How far `values` spread, but for a few at either end; they are sorted.
fn spread(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let out = (LEFT_OUT * values.len() as f64) as usize;
    values.get(values.len().saturating_sub(out + 1)).zip(values.get(out)).map_or(0.0, |(high, low)| high - low)
}

/// Whether the force, beside pressure and length, says that the muscle moved along `run`, of which one channel saw nothing; where
/// its largest force is given, also whether it pulled, as it did elsewhere at such pressures.
fn moved(recording: &Recording, run: Range<usize>, largest_n: Option<f64>) -> io::Result<bool> {
    let stride = (run.len() / LOOKED_AT).max(1);
    let Some(map) = map_beside(recording, &run, stride)? else { return Ok(false) };
    let rows = recording.samples.n_rows();
    // Before and after the run, windows as long as it is, or as long as there are.
    let most_elsewhere = run.start.max(rows - run.end);
    let window = run.len().min(most_elsewhere);
    let (mut along_n, mut windowed_n, mut elsewhere_n) = (Vec::new(), Vec::new(), 0.0_f64);
    let mut in_window = 0;
    let (mut expected_n, mut along_pa, mut elsewhere_pa) = (Vec::new(), 0.0_f64, 0.0_f64);
    for chunk in recording.samples.chunks() {
        let chunk = chunk?;
        for row in chunk.rows() {
            let pressure_pa = chunk.pressure_pa()[row - chunk.first_row()];
            let highest_pa = if run.contains(&row) { &mut along_pa } else { &mut elsewhere_pa };
            *highest_pa = highest_pa.max(pressure_pa);
            let residual_n = row.is_multiple_of(stride).then(|| {
                let here = row - chunk.first_row();
                map.residual_n(chunk.pressure_pa()[here], chunk.length_m()[here], chunk.force_n()[here])
            });
            if run.contains(&row) {
                along_n.extend(residual_n);
                expected_n.extend(residual_n.map(|residual_n| chunk.force_n()[row - chunk.first_row()] - residual_n));
                windowed_n.clear();
                in_window = 0;
                continue;
            }
            windowed_n.extend(residual_n);
            in_window += 1;
            if in_window == window {
                elsewhere_n = elsewhere_n.max(spread(&mut windowed_n));
                windowed_n.clear();
                in_window = 0;
            }
        }
    }
    let pulls = largest_n.is_none_or(|largest_n| {
        expected_n.sort_unstable_by(f64::total_cmp);
        let median_n = expected_n.get(expected_n.len() / 2).copied().unwrap_or(0.0);
        along_pa <= elsewhere_pa && median_n > PULLS * largest_n
    });
    Ok(pulls && spread(&mut along_n) > WANDERS * elsewhere_n)
}

#[cfg(test)]
mod tests;
