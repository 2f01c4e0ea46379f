//! Samples that leap from their neighbors and back: a loose plug, a bit that flipped in the logger.
//!
//! One such sample among ten thousand makes an RMSE of tens of newtons, and looks like physics to whom looks at sums. A
//! sample is a spike where it is off the median of those around it by far more than these are off one another, and by a good
//! part of the range of the channel; nothing that has mass moves so. Spikes are not counted; one that leaps by several times what all
//! others range makes every range meaningless, and the recording is refused.

use std::io;

use pam_recording::quality::RecordingQuality;
use pam_recording::{Chunk, Recording};

use super::Fault;
use crate::prepare::Gated;

/// Samples on either side that the median is taken over, and how many in a row may be a spike.
const AROUND: usize = 4;
const LONGEST: usize = 2;
/// How often the spread of the neighbors, and what share of the range of all others, a spike leaps at least.
const TIMES_SPREAD: f64 = 15.0;
const SHARE_OF_RANGE: f64 = 0.15;
/// How often the noise: a channel that is held has no range but its noise.
const TIMES_NOISE: f64 = 20.0;
/// How often the range of all others a spike leaps that makes every range of the recording meaningless.
const GROSS: f64 = 3.0;
/// Spikes that are named.
const NAMED: usize = 3;

type Column = fn(&Chunk) -> &[f64];

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Rows that leap by more than `least`, of those of a chunk.
fn leaps(values: &[f64], least: f64, found: &mut Vec<usize>) {
    let mut window = [0.0; 2 * AROUND];
    for row in AROUND..values.len().saturating_sub(AROUND) {
        // Most rows do not move by as much from one to the next.
        let step = (values[row] - values[row - 1]).abs().max((values[row] - values[row + 1]).abs());
        if step <= least {
            continue;
        }
        window[..AROUND].copy_from_slice(&values[row - AROUND..row]);
        window[AROUND..].copy_from_slice(&values[row + 1..=row + AROUND]);
        let middle = median(&mut window);
        let mut off = window.map(|value| (value - middle).abs());
        // Three quarters of the neighbors are near one another; the others may be spikes, too.
        off.sort_unstable_by(f64::total_cmp);
        let spread = off[off.len() - 1 - LONGEST];
        let leap = (values[row] - middle).abs();
        if leap > least && leap > TIMES_SPREAD * spread {
            found.push(row);
        }
    }
}

/// A spike.
#[derive(Debug, Clone, PartialEq)]
struct Spike {
    row: usize,
    channel: &'static str,
    /// Its value and place, in words.
    words: String,
    /// Whether it leaps by several times what all others range, so that no range of the recording means anything.
    is_gross: bool,
}

/// The channels that are looked at: name, values, and what a message multiplies them by and calls them.
const CHANNELS: [(&str, Column, f64, &str); 3] = [
    ("force", Chunk::force_n, 1.0, "N"),
    ("pressure", Chunk::pressure_pa, 1e-3, "kPa"),
    ("length", Chunk::length_m, 1e3, "mm"),
];

/// How far a sample of a channel must leap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leap {
    /// To be a spike, in SI.
    pub least: f64,
    /// To make every range meaningless.
    pub gross: f64,
}

impl Leap {
    /// From values spread over a channel and its noise; none where they are too few or never vary.
    pub fn of(mut spread: Vec<f64>, noise: f64) -> Option<Self> {
        if spread.len() < 4 * AROUND {
            return None;
        }
        spread.sort_unstable_by(f64::total_cmp);
        // A hundredth on either side may be spikes.
        let cut = spread.len() / 100 + 1;
        let range = spread[spread.len() - 1 - cut] - spread[cut];
        let least = (SHARE_OF_RANGE * range).max(TIMES_NOISE * noise);
        (least > 0.0).then(|| Self { least, gross: GROSS * range.max(least) })
    }
}

/// Every how many rows of a chunk stand for the range of a recording of `n_rows`.
pub fn spread_stride(n_rows: usize) -> usize {
    (n_rows / 4096).max(1)
}

/// Whether `n_spikes` of a channel are so many that they are how the muscle is driven.
pub fn are_many(n_spikes: usize, n_rows: usize) -> bool {
    200 * n_spikes > n_rows
}

/// Rows of a chunk, counted from its first, whose force, pressure and length leap.
pub fn leaping(chunk: &Chunk, leaps_by: &[Option<f64>; 3]) -> [Vec<usize>; 3] {
    std::array::from_fn(|index| {
        let mut rows = Vec::new();
        if let Some(least) = leaps_by[index] {
            leaps(CHANNELS[index].1(chunk), least, &mut rows);
        }
        rows
    })
}

/// Force, pressure and length of a row of a chunk, counted from its first, in SI.
pub fn values(chunk: &Chunk, row: usize) -> [f64; 3] {
    CHANNELS.map(|(_, column, ..)| column(chunk)[row])
}

/// White noise of force, pressure and length.
pub fn noises(quality: &RecordingQuality) -> [f64; 3] {
    CHANNELS.map(|(name, ..)| quality.channel(name).map_or(0.0, |channel| channel.noise))
}

/// Spikes of a recording.
fn all(recording: &Recording, quality: &RecordingQuality) -> io::Result<Vec<Spike>> {
    let mut spikes = Vec::new();
    let noises = noises(quality);
    for (index, (channel, column, scale, unit)) in CHANNELS.into_iter().enumerate() {
        let mut values: Vec<f64> = Vec::new();
        for chunk in recording.samples.chunks() {
            values.extend(column(&chunk?).iter().step_by(spread_stride(recording.samples.n_rows())));
        }
        let Some(Leap { least, gross }) = Leap::of(values, noises[index]) else { continue };
        let mut found = Vec::new();
        for chunk in recording.samples.chunks() {
            let chunk = chunk?;
            let (mut rows, mut gross_rows) = (Vec::new(), Vec::new());
            leaps(column(&chunk), least, &mut rows);
            leaps(column(&chunk), gross, &mut gross_rows);
            for here in rows {
                let row = chunk.first_row() + here;
                let (value, time_s) = (column(&chunk)[here] * scale, chunk.time_s()[here]);
                let words = format!("{value:.3} {unit} at {time_s:.3} s (row {})", row + 1);
                found.push(Spike { row, channel, words, is_gross: gross_rows.contains(&here) });
            }
        }
        if !are_many(found.len(), recording.samples.n_rows()) {
            spikes.extend(found);
        }
    }
    Ok(spikes)
}

/// The first of them, and how many more.
fn named(spikes: &[&Spike]) -> String {
    let words: Vec<&str> = spikes.iter().take(NAMED).map(|spike| spike.words.as_str()).collect();
    let others = spikes.len() - words.len();
    if others > 0 { format!("{} and {others} more", words.join(", ")) } else { words.join(", ") }
}

/// Spikes beyond the range of everything else.
///
/// # Errors
/// Where samples cannot be read back.
pub fn find(Gated { recording, quality }: &Gated) -> io::Result<Option<Fault>> {
    let spikes = all(recording, quality)?;
    let Some(first) = spikes.iter().find(|spike| spike.is_gross) else { return Ok(None) };
    let channel = first.channel;
    let of_channel: Vec<&Spike> = spikes.iter().filter(|spike| spike.is_gross && spike.channel == channel).collect();
    Ok(Some(Fault::Spikes { path: recording.path.clone(), channel, rows: named(&of_channel) }))
}

/// Rows that are spikes, which count nowhere.
///
/// # Errors
/// Where samples cannot be read back.
pub fn rows(recording: &Recording, quality: &RecordingQuality) -> io::Result<Vec<usize>> {
    Ok(all(recording, quality)?.into_iter().map(|spike| spike.row).collect())
}

/// Message about the spikes of a recording; nothing where it has none.
///
/// # Errors
/// Where samples cannot be read back.
pub fn warning(recording: &Recording, quality: &RecordingQuality) -> io::Result<Option<String>> {
    let spikes = all(recording, quality)?;
    let named = named(&spikes.iter().collect::<Vec<_>>());
    Ok((!spikes.is_empty()).then(|| {
        format!(
            "{}: {} {} from the neighbors and back, and {} not counted: {named}; look at plugs and at the logger",
            recording.path,
            if spikes.len() == 1 { "a sample".to_owned() } else { format!("{} samples", spikes.len()) },
            if spikes.len() == 1 { "leaps" } else { "leap" },
            if spikes.len() == 1 { "is" } else { "are" },
        )
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(values: &[f64]) -> Vec<usize> {
        let mut found = Vec::new();
        leaps(values, 90.0, &mut found);
        found
    }

    #[test]
    fn one_or_two_samples_that_leap_and_come_back_are_spikes_and_a_step_is_none() {
        let noisy = |row: usize| 300.0 * (0.01 * row as f64).sin() + (row * 7919 % 101) as f64 * 0.02;
        let mut values: Vec<f64> = (0..2000).map(noisy).collect();
        assert!(found(&values).is_empty());
        values[700] = 5000.0;
        values[1500] = -900.0;
        values[1501] = -900.0;
        assert_eq!(found(&values), [700, 1500, 1501]);
        let step: Vec<f64> = (0..2000).map(|row| noisy(row) + if row < 900 { 0.0 } else { 400.0 }).collect();
        assert!(found(&step).is_empty());
        let knock: Vec<f64> = (0..2000)
            .map(|row| noisy(row) + if row < 900 { 0.0 } else { 400.0 * (-0.2 * (row - 900) as f64).exp() })
            .collect();
        assert!(found(&knock).is_empty());
    }
}
