//! Rows in which a sensor is out of its range: it says that the true value lies beyond, and not where.

use std::io;
use std::ops::Range;

use super::{ChannelQuality, RecordingQuality};
use crate::{Chunk, Quantity, Recording};

/// Tare that a load cell may have, in N: a slack muscle is read as flat at it, which is physics and not a range.
const TARE_N: f64 = 20.0;
/// What is left out to either side, in s: what a smooth value there is averaged over.
const GUARD_S: f64 = 0.025;

/// A channel that flickers by so many of its steps is not at one value for long by chance.
const STEPS: f64 = 2.0;

impl ChannelQuality {
    fn flickers(&self) -> bool {
        self.quantization_step.is_none_or(|step| self.noise > STEPS * step)
    }

    /// Whether the low end that the channel is stuck at is the end of its range, rather than where the muscle itself
    /// leaves it: slack, or vented.
    pub fn ends_low(&self) -> bool {
        self.clipped_low_share > 0.0 && self.flickers() && self.name == "force" && self.lowest < -TARE_N
    }

    /// Whether the high end that the channel is stuck at is the end of its range. A length rests where it is held.
    pub fn ends_high(&self) -> bool {
        self.clipped_high_share > 0.0 && self.flickers() && self.name != "length"
    }
}

/// The ends of the ranges of load cells and pressure gauges, as far as recordings show them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SensorEnds {
    /// Name of a channel and its lowest value.
    low: Vec<(String, f64)>,
    /// Name of a channel and its highest value.
    high: Vec<(String, f64)>,
}

impl SensorEnds {
    /// Those that show in any of `recordings`: another one may touch them for a moment only.
    pub fn of<'a>(recordings: impl Iterator<Item = &'a RecordingQuality>) -> Self {
        let mut ends = Self::default();
        for channel in recordings.flat_map(|recording| &recording.channels) {
            if channel.ends_low() {
                ends.low.push((channel.name.clone(), channel.lowest));
            }
            if channel.ends_high() {
                ends.high.push((channel.name.clone(), channel.highest));
            }
        }
        ends
    }

    /// Stretches of rows of `recording` in which a sensor is at its end, ascending; `quality` is that of the recording.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn reached(&self, recording: &Recording, quality: &RecordingQuality) -> io::Result<Vec<Range<usize>>> {
        self.reached_from(0, recording, quality)
    }

    /// The same where `recording` holds rows from `first_row` on of the one that `quality` is of; rows are counted in that one.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn reached_from(
        &self,
        first_row: usize,
        recording: &Recording,
        quality: &RecordingQuality,
    ) -> io::Result<Vec<Range<usize>>> {
        let has =
            |ends: &[(String, f64)], name: &str, value: f64| ends.iter().any(|end| end.0 == name && end.1 == value);
        let columns: [(Quantity, Column); 2] =
            [(Quantity::Pressure, Chunk::pressure_pa), (Quantity::Force, Chunk::force_n)];
        let watched: Vec<(f64, f64, Column)> = columns
            .iter()
            .filter_map(|&(quantity, column)| {
                let name = quantity.name();
                let channel = quality.channel(name)?;
                let mut low = if has(&self.low, name, channel.lowest) { channel.lowest } else { f64::NEG_INFINITY };
                let mut high = if has(&self.high, name, channel.highest) { channel.highest } else { f64::INFINITY };
                if let Some([told_low, told_high]) = recording.samples.sensor_range(quantity) {
                    high = high.min(told_high);
                    // A vented gauge and a slack muscle rest at zero, which is no end of a range.
                    if quantity == Quantity::Force && told_low < -TARE_N {
                        low = low.max(told_low);
                    }
                }
                (low.is_finite() || high.is_finite()).then_some((low, high, column))
            })
            .collect();
        let mut found: Vec<Range<usize>> = Vec::new();
        if watched.is_empty() {
            return Ok(found);
        }
        let guard = if quality.period_s > 0.0 { (GUARD_S / quality.period_s).ceil() as usize } else { 0 };
        for chunk in recording.samples.chunks() {
            let chunk = chunk?;
            let columns: Vec<(f64, f64, &[f64])> =
                watched.iter().map(|&(low, high, column)| (low, high, column(&chunk))).collect();
            for row in chunk.rows() {
                let here = row - chunk.first_row();
                if columns.iter().all(|(low, high, column)| column[here] > *low && column[here] < *high) {
                    continue;
                }
                let row = first_row + row;
                let around = row.saturating_sub(guard)..(row + guard + 1).min(quality.n_rows);
                match found.last_mut() {
                    Some(last) if last.end >= around.start => last.end = around.end,
                    _ => found.push(around),
                }
            }
        }
        Ok(found)
    }
}

type Column = fn(&Chunk) -> &[f64];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Repairs, Samples};

    /// 10 s at 200 Hz; the force is a noisy sine between -300 and 300 N, read by a cell that ends at `low_n`.
    fn clipped(low_n: f64) -> Recording {
        let n = 2000;
        let time_s: Vec<f64> = (0..n).map(|row| f64::from(row) * 0.005).collect();
        let flicker = |row: usize| ((row * 7919 % 101) as f64 - 50.0) * 0.01;
        let force_n: Vec<f64> =
            time_s.iter().enumerate().map(|(row, t)| (300.0 * t.sin() + flicker(row)).max(low_n)).collect();
        let samples = Samples::from_columns(&time_s, &vec![2e5; 2000], &vec![0.25; 2000], &force_n);
        Recording {
            path: "r.csv".to_owned(),
            sha256: String::new(),
            samples,
            segments: std::iter::once(0..2000).collect(),
            repairs: Repairs::default(),
            ignored_columns: Vec::new(),
        }
    }

    fn lost(recording: &Recording) -> Vec<Range<usize>> {
        let quality = RecordingQuality::of(recording).unwrap();
        SensorEnds::of(std::iter::once(&quality)).reached(recording, &quality).unwrap()
    }

    #[test]
    fn rows_at_the_end_of_a_load_cell_are_found_with_a_guard_around() {
        let recording = clipped(-200.0);
        // The sine is below -200 N from pi + asin(2/3) = 3.871 s to 5.553 s.
        let found = lost(&recording);
        assert_eq!(found.len(), 1);
        assert!(found[0].start.abs_diff(774 - 5) <= 1 && found[0].end.abs_diff(1111 + 6) <= 1, "{found:?}");
    }

    #[test]
    fn an_end_that_another_recording_shows_is_one_here() {
        let (long, mut short) = (clipped(-200.0), clipped(-400.0));
        // Three samples at the end are no proof by themselves.
        let quality = |recording: &Recording| RecordingQuality::of(recording).unwrap();
        let force_n: Vec<f64> =
            (0..2000).map(|row| if (500..503).contains(&row) { -200.0 } else { (row % 89) as f64 }).collect();
        let time_s: Vec<f64> = (0..2000).map(|row| f64::from(row) * 0.005).collect();
        short.samples = Samples::from_columns(&time_s, &vec![2e5; 2000], &vec![0.25; 2000], &force_n);
        assert!(lost(&short).is_empty());
        let ends = SensorEnds::of([&quality(&long), &quality(&short)].into_iter());
        assert_eq!(ends.reached(&short, &quality(&short)).unwrap(), std::iter::once(494..509).collect::<Vec<_>>());
    }

    #[test]
    fn a_gauge_whose_noise_is_half_of_its_step_is_at_an_end_where_it_is_clipped_between_two_steps() {
        let mut held = clipped(-1e3);
        let noise = |row: i32| f64::from(row * 7919 % 1013) / 506.0 - 1.0;
        let read = |row: i32| ((1e5 + 50.0 * f64::from(row.min(1500)) + 600.0 * noise(row)) / 760.0).round() * 760.0;
        let pressure_pa: Vec<f64> = (0..2000).map(|row| read(row).min(1.402e5)).collect();
        let chunk = held.samples.chunk(0).unwrap();
        held.samples = Samples::from_columns(chunk.time_s(), &pressure_pa, chunk.length_m(), chunk.force_n());
        let quality = RecordingQuality::of(&held).unwrap();
        let pressure = quality.channel("pressure").unwrap();
        assert!(pressure.clipped_high_share > 0.2, "{pressure:?}");
    }

    #[test]
    fn a_gauge_that_stands_still_wherever_it_rests_is_at_no_end() {
        let mut held = clipped(-1e3);
        let level_pa = |pulse: i32| 1e5 + 4e4 * f64::from(pulse.min(8)).sqrt();
        let rising = |row: i32| f64::from((row % 200).min(20)) / 20.0;
        let pressure_pa = (0..2000)
            .map(|row| level_pa(row / 200) + rising(row) * (level_pa(row / 200 + 1) - level_pa(row / 200)))
            .collect::<Vec<f64>>();
        let chunk = held.samples.chunk(0).unwrap();
        held.samples = Samples::from_columns(chunk.time_s(), &pressure_pa, chunk.length_m(), chunk.force_n());
        let quality = RecordingQuality::of(&held).unwrap();
        let pressure = quality.channel("pressure").unwrap();
        assert!(!pressure.ends_high(), "{pressure:?}");
    }

    #[test]
    fn a_muscle_that_is_flat_at_a_tare_is_left_alone() {
        assert!(lost(&clipped(-8.0)).is_empty());
        assert!(lost(&clipped(-400.0)).is_empty());
    }
}
