//! A whole recording: its clock, its channels, and what they excite.

use std::io;

use rayon::prelude::*;
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::channel::{ChannelQuality, quantization_step, rest_noise_std};
use super::parts::{COLUMNS, Column, Extent, Sample};
use super::stuck::StuckRuns;
use crate::{Chunk, Recording, Repairs, Samples};

/// What a recording looks like before anything is fitted to it; SI throughout.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
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
        let extent = Extent::of(recording)?;
        let sample = Sample::of(recording)?;
        let mut quality = Self::of_parts(recording, &extent, &sample);
        let stuck: io::Result<Vec<Option<(f64, f64)>>> =
            quality.channels.par_iter().map(|channel| stuck_shares(recording, channel, &sample)).collect();
        for (channel, shares) in quality.channels.iter_mut().zip(stuck?) {
            if let Some((low, high)) = shares {
                (channel.clipped_low_share, channel.clipped_high_share) = (low, high);
            }
        }
        let rates = quality.fastest(recording)?;
        (quality.length_rate_m_per_s, quality.pressure_rate_pa_per_s) = (rates.length_m_per_s, rates.pressure_pa_per_s);
        Ok(quality)
    }

    /// What `extent` and `sample` of a recording say: all but stuck samples and rates, which are zero.
    fn of_parts(recording: &Recording, extent: &Extent, sample: &Sample) -> Self {
        let names = if recording.samples.has_force() { &NAMES[..] } else { &NAMES[..2] };
        let channels = names.par_iter().enumerate().map(|(index, _)| channel(index, extent, sample)).collect();
        Self {
            path: recording.path.clone(),
            n_rows: extent.n_rows,
            duration_s: extent.last_s - sample.first_s,
            period_s: sample.period_s,
            repairs: recording.repairs.clone(),
            channels,
            length_rate_m_per_s: 0.0,
            pressure_rate_pa_per_s: 0.0,
            largest_pressure_length_n_per_m: extent.largest_pressure_length_n_per_m,
        }
    }

    /// Quality of a recording whose rows are elsewhere: its name and repairs are those of `recording`, its rows have that
    /// `extent`, `sampled` are those of its [`sampled_chunks`](super::parts::sampled_chunks) one after the other, and `stuck`
    /// its runs, channel by channel. Rates are zero.
    ///
    /// # Errors
    /// Where samples cannot be read back.
    pub fn of_elsewhere(
        recording: &Recording,
        extent: &Extent,
        sampled: &Samples,
        stuck: &[StuckRuns; 3],
    ) -> io::Result<Self> {
        let chunks: io::Result<Vec<Chunk>> = sampled.chunks().collect();
        let sample = Sample::of_chunks(chunks?);
        let mut quality = Self::of_parts(recording, extent, &sample);
        for (index, channel) in quality.channels.iter_mut().enumerate() {
            if sample.tells_stuck(index, channel) {
                (channel.clipped_low_share, channel.clipped_high_share) =
                    stuck[index].shares(channel.lowest, channel.highest);
            }
        }
        Ok(quality)
    }

    /// Fastest changes within the chunks of `recording`, with the noise and the clock that are here.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn fastest(&self, recording: &Recording) -> io::Result<Rates> {
        let noise = |name: &str| self.channel(name).map_or(0.0, |channel| channel.noise);
        Ok(Rates {
            length_m_per_s: fastest(recording, Chunk::length_m, noise("length"), self.period_s)?,
            pressure_pa_per_s: fastest(recording, Chunk::pressure_pa, noise("pressure"), self.period_s)?,
        })
    }

    /// The channel called `pressure`, `length` or `force`.
    pub fn channel(&self, name: &str) -> Option<&ChannelQuality> {
        self.channels.iter().find(|channel| channel.name == name)
    }
}

/// The names of [`COLUMNS`], and their units.
const NAMES: [(&str, &str); 3] = [("pressure", "Pa"), ("length", "m"), ("force", "N")];

/// Fastest changes over 50 ms.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Rates {
    /// Of the length, in m/s.
    pub length_m_per_s: f64,
    /// Of the pressure, in Pa/s.
    pub pressure_pa_per_s: f64,
}

/// What the channel `index` looks like; nothing is said of stuck samples.
fn channel(index: usize, extent: &Extent, sample: &Sample) -> ChannelQuality {
    let column = COLUMNS[index];
    // A chunk at rest shows no step.
    let moves = |chunk: &&Chunk| column(chunk).iter().any(|&value| value != column(chunk)[0]);
    let step = sample.chunks.iter().find(moves).and_then(|chunk| quantization_step(column(chunk)));
    let [flicker, colored] = sample.flicker(column);
    // A channel at rest between two steps shows no noise at all, and yet is known to a step only.
    let [noise, colored_noise] =
        [flicker, colored].map(|noise| step.map_or(noise, |step| noise.max(step / 12.0_f64.sqrt())));
    let rests: Vec<f64> = sample
        .chunks
        .iter()
        .filter_map(|chunk| rest_noise_std(column(chunk), sample.period_s, noise.max(colored_noise)))
        .collect();
    let rest_noise = rests.iter().copied().reduce(f64::min).unwrap_or(0.0);
    let (name, unit) = NAMES[index];
    ChannelQuality {
        name: name.to_owned(),
        unit: unit.to_owned(),
        lowest: extent.lowest[index],
        highest: extent.highest[index],
        noise,
        colored_noise,
        rest_noise,
        quantization_step: step,
        clipped_low_share: 0.0,
        clipped_high_share: 0.0,
    }
}

/// Shares of samples stuck at either end of a channel; none where it cannot be told to be stuck.
fn stuck_shares(recording: &Recording, channel: &ChannelQuality, sample: &Sample) -> io::Result<Option<(f64, f64)>> {
    let index = NAMES.iter().position(|(name, _)| *name == channel.name).unwrap_or(0);
    if !sample.tells_stuck(index, channel) {
        return Ok(None);
    }
    let mut runs = StuckRuns::default();
    for chunk in recording.samples.chunks() {
        COLUMNS[index](&chunk?).iter().for_each(|&value| runs.push(value, channel.lowest, channel.highest));
    }
    Ok(Some(runs.shares(channel.lowest, channel.highest)))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CHUNK_ROWS;
    use crate::quality::parts::sampled_chunks;

    #[test]
    fn parts_found_apart_make_the_quality_of_the_whole() {
        let n = 5 * CHUNK_ROWS + 77;
        let noise = |row: usize, salt: usize| ((row * 7919 + salt) % 1013) as f64 / 506.0 - 1.0;
        let time_s: Vec<f64> = (0..n).map(|row| 0.002 * row as f64).collect();
        let wave = |row: usize| (0.003 * row as f64).sin();
        let pressure_pa: Vec<f64> = (0..n).map(|row| 2e5 + 1e5 * wave(row) + 300.0 * noise(row, 1)).collect();
        let length_m: Vec<f64> = (0..n).map(|row| 0.25 + 0.01 * wave(row) + 1e-5 * noise(row, 2)).collect();
        // A cell that ends at 250 N.
        let force_n: Vec<f64> = (0..n).map(|row| (300.0 * wave(row) + noise(row, 3)).min(250.0)).collect();
        let recording = |rows: std::ops::Range<usize>| Recording {
            path: "r.csv".to_owned(),
            sha256: String::new(),
            samples: Samples::from_columns(
                &time_s[rows.clone()],
                &pressure_pa[rows.clone()],
                &length_m[rows.clone()],
                &force_n[rows.clone()],
            ),
            segments: std::iter::once(0..rows.len()).collect(),
            repairs: Repairs::default(),
            ignored_columns: Vec::new(),
        };
        let whole = recording(0..n);
        let mut expected = RecordingQuality::of(&whole).unwrap();
        assert!(expected.channel("force").unwrap().clipped_high_share > 0.1);
        let pieces = [0..30_001, 30_001..30_003, 30_003..n].map(recording);
        let extents = pieces.each_ref().map(|piece| Extent::of(piece).unwrap());
        let extent = extents[0].joined(&extents[1]).joined(&extents[2]);
        let mut stuck: [StuckRuns; 3] = Default::default();
        for piece in &pieces {
            let next = StuckRuns::of(piece, &extent).unwrap();
            stuck.iter_mut().zip(&next).enumerate().for_each(|(index, (stuck, next))| {
                stuck.join(next, extent.lowest[index], extent.highest[index]);
            });
        }
        let rows: Vec<usize> =
            sampled_chunks(n).flat_map(|index| index * CHUNK_ROWS..((index + 1) * CHUNK_ROWS).min(n)).collect();
        let some = |values: &[f64]| rows.iter().map(|&row| values[row]).collect::<Vec<f64>>();
        let sampled = Samples::from_columns(&some(&time_s), &some(&pressure_pa), &some(&length_m), &some(&force_n));
        (expected.length_rate_m_per_s, expected.pressure_rate_pa_per_s) = (0.0, 0.0);
        assert_eq!(RecordingQuality::of_elsewhere(&whole, &extent, &sampled, &stuck).unwrap(), expected);
    }
}
