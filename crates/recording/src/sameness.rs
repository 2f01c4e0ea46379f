//! Recordings that share samples, whatever their files are called and whatever units they are in.
//!
//! A recording may be there twice as a link, a copy, compressed, in other units, cut or thinned out. Its noise tells: no two
//! runs of a bench have the same. So a few short runs of rows of one recording, where its channels flicker most, are looked
//! for in the other: the rows have to agree to what printing in another unit costs, and the second differences of the force,
//! which are noise, have to be the same as well. Time plays no part, since cut recordings often begin at zero.

use std::io;

use rayon::prelude::*;

use super::{CHUNK_ROWS, Recording};

/// Runs of rows that are looked for, and rows of each.
const PROBES: usize = 24;
const PROBE_ROWS: usize = 24;
/// Places where a run could be, for each that is taken: the one that flickers most.
const CHOICE: usize = 4;
/// Rows of a run that are off its most frequent value, at least: of runs of two values with as many, one in ten million is the same by chance.
const OF_OTHER_VALUES: usize = 10;
/// Half of the last digit that other units leave, as a share of the largest value.
const TOLERANCE: f64 = 1.5e-4;
/// Correlation of second differences beyond which noise is the same.
const SAME_NOISE: f64 = 0.9;
/// Every so-many-th row at most is kept where a recording is thinned out.
const MOST_THINNED: usize = 16;
/// Share of the runs that must be found for two recordings to share samples.
const SHARE: f64 = 0.1;
/// Runs that a recording must have again at one distance for it to repeat itself, and share of neighboring second differences
/// of other signs that noise has, where a smooth path has few: a simulation without noise repeats itself at every cycle.
const REPEATED: usize = 3;
const TURNS: f64 = 0.4;
/// Cells by which a row finds the runs that may begin with it.
const CELLS: usize = 1024;

/// A run of rows: pressure, length, force; the last is zero where none was recorded.
struct Probe {
    /// Its first row.
    start: usize,
    rows: [[f64; 3]; PROBE_ROWS],
}

/// Rows of a recording that stand in it once more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Repeated {
    /// First row of a run that comes again, counted from 0.
    pub row: usize,
    /// Where it comes again.
    pub again: usize,
    /// Share of the recording's runs that come again at this distance, in percent.
    pub percent: usize,
}

/// Stretches of a recording that were appended to it, or pasted into it, once more: a logger that was stopped and wrote its buffer
/// again. None where nothing repeats but the path.
///
/// # Errors
/// Where samples cannot be read back.
pub fn repeats_itself(recording: &Recording) -> io::Result<Option<Repeated>> {
    let mut probes = probes(recording)?;
    probes.retain(Probe::is_noisy);
    // Of each run, the first place where it comes again.
    let found = places(&probes, recording, 1, true)?;
    let mut distances: Vec<(usize, usize)> = probes
        .iter()
        .zip(found)
        .filter_map(|(probe, again)| Some((again?.abs_diff(probe.start), probe.start)))
        .collect();
    distances.sort_unstable();
    let repeated = distances.chunk_by(|left, right| left.0 == right.0).max_by_key(|same| same.len());
    Ok(repeated.filter(|same| same.len() >= REPEATED).map(|same| Repeated {
        row: same[0].1,
        again: same[0].1 + same[0].0,
        percent: 100 * same.len() / probes.len(),
    }))
}

/// The first two of `recordings` that share samples, by index, the earlier one first.
///
/// # Errors
/// The index of a recording whose samples cannot be read back, and why.
pub fn first_shared(recordings: &[&Recording]) -> Result<Option<(usize, usize)>, (usize, io::Error)> {
    let pairs: Vec<(usize, usize)> =
        (0..recordings.len()).flat_map(|second| (0..second).map(move |first| (first, second))).collect();
    let shared: Result<Vec<bool>, (usize, io::Error)> = pairs
        .par_iter()
        .map(|&(first, second)| share_samples(recordings[first], recordings[second]).map_err(|reason| (second, reason)))
        .collect();
    Ok(shared?.into_iter().position(|shared| shared).map(|place| pairs[place]))
}

/// Whether two recordings share samples, enough of them that what is held out is no more held out, and what is fitted
/// counts twice.
///
/// # Errors
/// Where samples cannot be read back.
pub fn share_samples(left: &Recording, right: &Recording) -> io::Result<bool> {
    // An empty digest is none.
    if left.sha256 == right.sha256 && !left.sha256.is_empty() {
        return Ok(true);
    }
    // A recording of another quantity of channels has none in common with either.
    let (short, long) = if left.samples.n_rows() <= right.samples.n_rows() { (left, right) } else { (right, left) };
    let found = |of: &Recording, among: &Recording| -> io::Result<bool> {
        let probes = probes(of)?;
        let needed = ((SHARE * probes.len() as f64).ceil() as usize).max(2);
        Ok(probes.len() >= needed && count_found(&probes, among)? >= needed)
    };
    // What was cut or thinned out has fewer rows, unless what it was cut from was thinned out later.
    Ok(found(short, long)? || (short.samples.n_rows() < long.samples.n_rows() && found(long, short)?))
}

/// Runs spread over a recording, each where it flickers most around its place.
fn probes(recording: &Recording) -> io::Result<Vec<Probe>> {
    let n_rows = recording.samples.n_rows();
    let mut probes = Vec::new();
    let places = PROBES.min(n_rows / PROBE_ROWS);
    for place in 0..places {
        let (first, last) = (place * n_rows / places, (place + 1) * n_rows / places);
        let mut best: Option<(f64, Probe)> = None;
        for choice in 0..CHOICE {
            let start = first + choice * (last - first) / CHOICE;
            let Some(probe) = probe(recording, start)? else { continue };
            let flicker = probe.flicker();
            if probe.tells() && best.as_ref().is_none_or(|best| flicker > best.0) {
                best = Some((flicker, probe));
            }
        }
        probes.extend(best.map(|(_, probe)| probe));
    }
    Ok(probes)
}

/// The run that begins at a row, unless a chunk ends in it.
fn probe(recording: &Recording, start: usize) -> io::Result<Option<Probe>> {
    let chunk = recording.samples.chunk(start / CHUNK_ROWS)?;
    let here = start - chunk.first_row();
    if here + PROBE_ROWS > chunk.n_rows() {
        return Ok(None);
    }
    let force_n = chunk.force_n();
    let rows = std::array::from_fn(|row| {
        let row = here + row;
        [chunk.pressure_pa()[row], chunk.length_m()[row], force_n.get(row).copied().unwrap_or(0.0)]
    });
    Ok(Some(Probe { start, rows }))
}

impl Probe {
    /// Second differences of a channel.
    fn bends(rows: &[[f64; 3]; PROBE_ROWS], channel: usize) -> impl Iterator<Item = f64> + '_ {
        rows.windows(3).map(move |three| three[0][channel] - 2.0 * three[1][channel] + three[2][channel])
    }

    /// The channel that noise is compared in.
    fn noisy_channel(&self) -> usize {
        if Self::bends(&self.rows, 2).any(|bend| bend != 0.0) { 2 } else { 0 }
    }

    /// How much the run flickers, as a share of its largest value.
    fn flicker(&self) -> f64 {
        let channel = self.noisy_channel();
        let largest = self.rows.iter().map(|row| row[channel].abs()).fold(f64::MIN_POSITIVE, f64::max);
        Self::bends(&self.rows, channel).map(|bend| bend * bend).sum::<f64>().sqrt() / largest
    }

    /// Whether its rows are like no others: one value with some spikes in it comes again by chance.
    fn tells(&self) -> bool {
        let values = self.rows.map(|row| row[self.noisy_channel()]);
        let alike = |value: f64| values.iter().filter(|other| **other == value).count();
        PROBE_ROWS - values.into_iter().map(alike).max().unwrap_or(0) >= OF_OTHER_VALUES
    }

    /// Whether it flickers as noise does.
    fn is_noisy(&self) -> bool {
        let bends: Vec<f64> = Self::bends(&self.rows, self.noisy_channel()).collect();
        let turns = bends.windows(2).filter(|two| two[0] * two[1] < 0.0).count();
        turns as f64 > TURNS * (bends.len() - 1) as f64
    }

    /// Whether `rows` are this run.
    fn is(&self, rows: &[[f64; 3]; PROBE_ROWS]) -> bool {
        let channel = self.noisy_channel();
        let (mut cross, mut squares, mut other_squares) = (0.0, 0.0, 0.0);
        for (own, other) in Self::bends(&self.rows, channel).zip(Self::bends(rows, channel)) {
            cross += own * other;
            squares += own * own;
            other_squares += other * other;
        }
        cross > SAME_NOISE * (squares * other_squares).sqrt()
    }
}

/// How many of the runs are in a recording, at any of the strides of a recording that was thinned out.
fn count_found(probes: &[Probe], among: &Recording) -> io::Result<usize> {
    Ok(places(probes, among, MOST_THINNED, false)?.into_iter().flatten().count())
}

/// Where each of the runs is first in a recording, at strides of up to `most_thinned`; where the runs are its own, elsewhere.
fn places(
    probes: &[Probe],
    among: &Recording,
    most_thinned: usize,
    are_its_own: bool,
) -> io::Result<Vec<Option<usize>>> {
    // The channel that rows are sorted into cells by: force, or pressure where there is none.
    let key = if among.samples.has_force() && probes.iter().any(|probe| probe.rows[0][2] != 0.0) { 2 } else { 0 };
    let mut largest = [f64::MIN_POSITIVE; 3];
    for probe in probes {
        for row in &probe.rows {
            (0..3).for_each(|channel| largest[channel] = largest[channel].max(row[channel].abs()));
        }
    }
    let tolerance = largest.map(|value| TOLERANCE * value);
    let agree = |own: &[f64; 3], other: &[f64; 3]| {
        (0..3).all(|channel| (own[channel] - other[channel]).abs() <= tolerance[channel])
    };
    let (lowest, width) = (-1.01 * largest[key], 2.02 * largest[key] / CELLS as f64);
    let cell = |value: f64| ((value - lowest) / width) as usize;
    let mut cells: Vec<Vec<usize>> = vec![Vec::new(); CELLS + 1];
    for (index, probe) in probes.iter().enumerate() {
        let first = probe.rows[0][key];
        let near = cell(first - tolerance[key])..=cell(first + tolerance[key]).min(CELLS);
        cells[near].iter_mut().for_each(|cell| cell.push(index));
    }
    let mut is_found: Vec<Option<usize>> = vec![None; probes.len()];
    // A run may go on in the next chunk.
    let reach = PROBE_ROWS * most_thinned;
    let mut before: Vec<[f64; 3]> = Vec::new();
    let mut first_row = 0;
    let n_chunks = among.samples.n_chunks();
    for chunk_index in 0..n_chunks {
        let chunk = among.samples.chunk(chunk_index)?;
        let force_n = chunk.force_n();
        let new = (0..chunk.n_rows())
            .map(|row| [chunk.pressure_pa()[row], chunk.length_m()[row], force_n.get(row).copied().unwrap_or(0.0)]);
        before.extend(new);
        let is_last = chunk_index + 1 == n_chunks;
        let end = if is_last { before.len() } else { before.len().saturating_sub(reach) };
        for start in 0..end {
            let value = before[start][key];
            if value < lowest {
                continue;
            }
            let Some(candidates) = cells.get(cell(value)) else { continue };
            for &index in candidates {
                let is_itself = are_its_own && (first_row + start).abs_diff(probes[index].start) < PROBE_ROWS;
                if is_found[index].is_none() && !is_itself && agree(&probes[index].rows[0], &before[start]) {
                    let is_here = (1..=most_thinned).any(|stride| {
                        let all = (1..PROBE_ROWS).all(|row| {
                            before.get(start + row * stride).is_some_and(|other| agree(&probes[index].rows[row], other))
                        });
                        all && probes[index].is(&std::array::from_fn(|row| before[start + row * stride]))
                    });
                    is_found[index] = is_here.then_some(first_row + start);
                }
            }
        }
        before.drain(..end);
        first_row += end;
    }
    Ok(is_found)
}

#[cfg(test)]
mod tests;
