//! The parts that the quality of a recording is made of, so that they can be found where its rows are and put together elsewhere.

use std::io;

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::channel::{ChannelQuality, SAMPLE_ROWS, colored_noise_std, noise_std};
use crate::{CHUNK_ROWS, Chunk, Recording};

pub(super) type Column = fn(&Chunk) -> &[f64];

/// The columns of which a quality speaks: pressure, length and force.
pub(super) const COLUMNS: [Column; 3] = [Chunk::pressure_pa, Chunk::length_m, Chunk::force_n];

/// How many rows there are, and between what they lie.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Extent {
    /// Rows.
    pub n_rows: usize,
    /// First time stamp, in s.
    pub first_s: f64,
    /// Last time stamp, in s.
    pub last_s: f64,
    /// Lowest pressure, length and force, in Pa, m and N.
    pub lowest: [f64; 3],
    /// Highest of each.
    pub highest: [f64; 3],
    /// Largest product of pressure and length, in N/m; never below zero.
    pub largest_pressure_length_n_per_m: f64,
}

impl Extent {
    /// Of all rows of a recording; a force that was not recorded lies nowhere.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn of(recording: &Recording) -> io::Result<Self> {
        let samples = &recording.samples;
        let mut extent = Self {
            n_rows: samples.n_rows(),
            first_s: 0.0,
            last_s: 0.0,
            lowest: [f64::INFINITY; 3],
            highest: [f64::NEG_INFINITY; 3],
            largest_pressure_length_n_per_m: 0.0,
        };
        for chunk in samples.chunks() {
            let chunk = chunk?;
            for (index, column) in COLUMNS.iter().enumerate() {
                for &value in column(&chunk) {
                    extent.lowest[index] = extent.lowest[index].min(value);
                    extent.highest[index] = extent.highest[index].max(value);
                }
            }
            let largest = &mut extent.largest_pressure_length_n_per_m;
            for (pressure_pa, length_m) in chunk.pressure_pa().iter().zip(chunk.length_m()) {
                *largest = largest.max(pressure_pa * length_m);
            }
            if chunk.first_row() == 0 {
                extent.first_s = chunk.time_s()[0];
            }
            extent.last_s = chunk.time_s().last().copied().unwrap_or(extent.last_s);
        }
        Ok(extent)
    }

    /// Of these rows and of the `next` ones.
    #[must_use]
    pub fn joined(&self, next: &Self) -> Self {
        Self {
            n_rows: self.n_rows + next.n_rows,
            first_s: self.first_s,
            last_s: next.last_s,
            lowest: std::array::from_fn(|index| self.lowest[index].min(next.lowest[index])),
            highest: std::array::from_fn(|index| self.highest[index].max(next.highest[index])),
            largest_pressure_length_n_per_m: self
                .largest_pressure_length_n_per_m
                .max(next.largest_pressure_length_n_per_m),
        }
    }
}

/// Share of the rows in which a channel reads as in the row before, beyond which it stands still wherever it rests: 0.6 of a gauge whose
/// noise is half of its step, 0.93 of one with a dead band of eight steps.
const STANDS_STILL: f64 = 0.8;

/// Chunks that noise and quantization are estimated on.
pub(super) struct Sample {
    pub(super) chunks: Vec<Chunk>,
    pub(super) first_s: f64,
    pub(super) period_s: f64,
}

/// Indices of the chunks of a recording of `n_rows` that stand for all of them: spread over it, so that a long hold at its
/// start does not.
pub fn sampled_chunks(n_rows: usize) -> impl Iterator<Item = usize> {
    let n_chunks = n_rows.div_ceil(CHUNK_ROWS);
    let wanted = (SAMPLE_ROWS / CHUNK_ROWS).max(1);
    (0..n_chunks).step_by(n_chunks.div_ceil(wanted).max(1))
}

impl Sample {
    pub(super) fn of(recording: &Recording) -> io::Result<Self> {
        let samples = &recording.samples;
        let chunks: io::Result<Vec<Chunk>> =
            sampled_chunks(samples.n_rows()).map(|index| samples.chunk(index)).collect();
        Ok(Self::of_chunks(chunks?))
    }

    pub(super) fn of_chunks(chunks: Vec<Chunk>) -> Self {
        let mut steps_s: Vec<f64> =
            chunks.iter().flat_map(|chunk| chunk.time_s().windows(2).map(|pair| pair[1] - pair[0])).collect();
        let middle = steps_s.len() / 2;
        let period_s = if steps_s.is_empty() { 0.0 } else { *steps_s.select_nth_unstable_by(middle, f64::total_cmp).1 };
        let first_s = chunks.first().and_then(|chunk| chunk.time_s().first().copied()).unwrap_or(0.0);
        Self { chunks, first_s, period_s }
    }

    /// White noise of a column, and noise of any color, steps or not.
    pub(super) fn flicker(&self, column: Column) -> [f64; 2] {
        let (mut squares, mut colored_squares, mut rows) = (0.0, 0.0, 0.0);
        for chunk in &self.chunks {
            let noise = noise_std(column(chunk));
            let colored = colored_noise_std(column(chunk), self.period_s).unwrap_or(noise);
            squares += noise * noise * chunk.n_rows() as f64;
            colored_squares += colored * colored * chunk.n_rows() as f64;
            rows += chunk.n_rows() as f64;
        }
        [squares, colored_squares].map(|squares| (squares / f64::max(rows, 1.0)).sqrt())
    }

    /// Whether the channel `index`, which is `channel`, can be told to be stuck: only one that flickers between its steps can, and
    /// one without steps that does not stand still, as one with a dead band does, wherever it rests.
    pub(super) fn tells_stuck(&self, index: usize, channel: &ChannelQuality) -> bool {
        let tells = match channel.quantization_step {
            Some(step) => self.flicker(COLUMNS[index])[0] > 0.5 * step,
            None => !self.stands_still(COLUMNS[index], channel),
        };
        channel.highest > channel.lowest && tells
    }

    /// Whether values of a column that are at neither end of `channel` are nearly always those of the row before.
    fn stands_still(&self, column: Column, channel: &ChannelQuality) -> bool {
        let is_within = |value: f64| value > channel.lowest && value < channel.highest;
        let pairs = self.chunks.iter().flat_map(|chunk| column(chunk).windows(2));
        let (mut within, mut still) = (0_usize, 0_usize);
        for pair in pairs.filter(|pair| is_within(pair[0]) && is_within(pair[1])) {
            within += 1;
            still += usize::from(pair[0] == pair[1]);
        }
        still as f64 > STANDS_STILL * within as f64
    }
}
