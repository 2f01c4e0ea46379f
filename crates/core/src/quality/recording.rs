//! A whole recording: its clock, its channels, and what they excite.

use std::io;

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::channel::{
    ChannelQuality, SAMPLE_ROWS, StuckCounter, colored_noise_std, noise_std, quantization_step, rest_noise_std,
};
use crate::recording::{Chunk, Recording, Repairs};

/// What a recording looks like before anything is fitted to it; SI throughout.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RecordingQuality {
    /// Path as given.
    pub path: String,
    /// Rows.
    pub n_rows: usize,
    /// From the first stamp to the last, gaps included, in s.
    pub duration_s: f64,
    /// Median time between rows, in s.
    pub period_s: f64,
    /// What was repaired or left out while reading.
    pub repairs: Repairs,
    /// Pressure, length and, where recorded, force.
    pub channels: Vec<ChannelQuality>,
    /// Fastest change of length over 50 ms, in m/s.
    pub length_rate_m_per_s: f64,
    /// Fastest change of pressure over 50 ms, in Pa/s.
    pub pressure_rate_pa_per_s: f64,
    /// Largest product of pressure and length, in N/m: what stretches the strands.
    pub largest_pressure_length_n_per_m: f64,
}

impl RecordingQuality {
    /// Looks at a recording.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn of(recording: &Recording) -> io::Result<Self> {
        let columns: &[Column] = if recording.samples.has_force() {
            &[Chunk::pressure_pa, Chunk::length_m, Chunk::force_n]
        } else {
            &[Chunk::pressure_pa, Chunk::length_m]
        };
        let mut extremes = vec![(f64::INFINITY, f64::NEG_INFINITY); columns.len()];
        let mut largest = 0.0_f64;
        for chunk in recording.samples.chunks() {
            let chunk = chunk?;
            for ((low, high), column) in extremes.iter_mut().zip(columns) {
                for &value in column(&chunk) {
                    *low = low.min(value);
                    *high = high.max(value);
                }
            }
            for (pressure_pa, length_m) in chunk.pressure_pa().iter().zip(chunk.length_m()) {
                largest = largest.max(pressure_pa * length_m);
            }
        }
        let sample = Sample::of(recording)?;
        let channels: io::Result<Vec<ChannelQuality>> = columns
            .par_iter()
            .enumerate()
            .map(|(index, column)| channel(recording, index, *column, extremes[index], &sample))
            .collect();
        let channels = channels?;
        let noise = |index: usize| channels[index].noise;
        Ok(Self {
            path: recording.path.clone(),
            n_rows: recording.samples.n_rows(),
            duration_s: sample.duration_s,
            period_s: sample.period_s,
            repairs: recording.repairs.clone(),
            length_rate_m_per_s: fastest(recording, Chunk::length_m, noise(1), sample.period_s)?,
            pressure_rate_pa_per_s: fastest(recording, Chunk::pressure_pa, noise(0), sample.period_s)?,
            largest_pressure_length_n_per_m: largest,
            channels,
        })
    }

    /// The channel called `pressure`, `length` or `force`.
    pub fn channel(&self, name: &str) -> Option<&ChannelQuality> {
        self.channels.iter().find(|channel| channel.name == name)
    }
}

type Column = fn(&Chunk) -> &[f64];

/// Chunks that noise and quantization are estimated on: the first rows, and the clock over all of them.
struct Sample {
    chunks: Vec<Chunk>,
    duration_s: f64,
    period_s: f64,
}

impl Sample {
    fn of(recording: &Recording) -> io::Result<Self> {
        let samples = &recording.samples;
        let mut chunks = Vec::new();
        // Spread over the recording, so that a long hold at its start does not stand for all of it.
        let wanted = (SAMPLE_ROWS / crate::recording::CHUNK_ROWS).max(1);
        let stride = samples.n_chunks().div_ceil(wanted).max(1);
        for index in (0..samples.n_chunks()).step_by(stride) {
            chunks.push(samples.chunk(index)?);
        }
        let mut steps_s: Vec<f64> =
            chunks.iter().flat_map(|chunk| chunk.time_s().windows(2).map(|pair| pair[1] - pair[0])).collect();
        let middle = steps_s.len() / 2;
        let period_s = if steps_s.is_empty() { 0.0 } else { *steps_s.select_nth_unstable_by(middle, f64::total_cmp).1 };
        let first_s = chunks.first().and_then(|chunk| chunk.time_s().first().copied()).unwrap_or(0.0);
        let last = samples.n_chunks().checked_sub(1).map(|index| samples.chunk(index)).transpose()?;
        let last_s = last.and_then(|chunk| chunk.time_s().last().copied()).unwrap_or(first_s);
        Ok(Self { chunks, duration_s: last_s - first_s, period_s })
    }
}

const NAMES: [(&str, &str); 3] = [("pressure", "Pa"), ("length", "m"), ("force", "N")];

fn channel(
    recording: &Recording,
    index: usize,
    column: Column,
    (lowest, highest): (f64, f64),
    sample: &Sample,
) -> io::Result<ChannelQuality> {
    // A chunk at rest shows no step.
    let moves = |chunk: &&Chunk| column(chunk).iter().any(|&value| value != column(chunk)[0]);
    let step = sample.chunks.iter().find(moves).and_then(|chunk| quantization_step(column(chunk)));
    let (mut squares, mut colored_squares, mut rows) = (0.0, 0.0, 0.0);
    for chunk in &sample.chunks {
        let noise = noise_std(column(chunk));
        let colored = colored_noise_std(column(chunk), sample.period_s).unwrap_or(noise);
        squares += noise * noise * chunk.n_rows() as f64;
        colored_squares += colored * colored * chunk.n_rows() as f64;
        rows += chunk.n_rows() as f64;
    }
    let [flicker, colored] = [squares, colored_squares].map(|squares| (squares / f64::max(rows, 1.0)).sqrt());
    // A channel at rest between two steps shows no noise at all, and yet is known to a step only.
    let [noise, colored_noise] =
        [flicker, colored].map(|noise| step.map_or(noise, |step| noise.max(step / 12.0_f64.sqrt())));
    let rests: Vec<f64> = sample
        .chunks
        .iter()
        .filter_map(|chunk| rest_noise_std(column(chunk), sample.period_s, noise.max(colored_noise)))
        .collect();
    let rest_noise = rests.iter().copied().reduce(f64::min).unwrap_or(0.0);
    let mut shares = (0.0, 0.0);
    // Only a channel that flickers between its steps can be told to be stuck.
    if highest > lowest && step.is_none_or(|step| flicker > 0.5 * step) {
        let mut counter = StuckCounter::new(lowest, highest);
        for chunk in recording.samples.chunks() {
            column(&chunk?).iter().for_each(|&value| counter.push(value));
        }
        shares = counter.shares();
    }
    let (name, unit) = NAMES[index];
    Ok(ChannelQuality {
        name: name.to_owned(),
        unit: unit.to_owned(),
        lowest,
        highest,
        noise,
        colored_noise,
        rest_noise,
        quantization_step: step,
        clipped_low_share: shares.0,
        clipped_high_share: shares.1,
    })
}

/// Fastest change over 50 ms, less what noise alone would show.
fn fastest(recording: &Recording, column: Column, noise: f64, period_s: f64) -> io::Result<f64> {
    let lag = if period_s > 0.0 { ((0.05 / period_s).round() as usize).max(1) } else { 1 };
    let mut fastest = 0.0_f64;
    for chunk in recording.samples.chunks() {
        let chunk = chunk?;
        let (time_s, values) = (chunk.time_s(), column(&chunk));
        for index in lag..values.len() {
            let span_s = time_s[index] - time_s[index - lag];
            // A gap is no motion.
            if span_s <= 4.0 * lag as f64 * period_s {
                let moved = ((values[index] - values[index - lag]).abs() - 6.0 * noise).max(0.0);
                fastest = fastest.max(moved / span_s);
            }
        }
    }
    Ok(fastest)
}
