//! Rows in which a sensor is out of its range: it says that the true value lies beyond, and not where.

use std::io;
use std::ops::Range;

use super::{ChannelQuality, RecordingQuality};
use crate::recording::{Chunk, Recording};

/// Tare that a load cell may have, in N: a slack muscle is read as flat at it, which is physics and not a range.
const TARE_N: f64 = 20.0;
/// What is left out to either side, in s: what a smooth value there is averaged over.
const GUARD_S: f64 = 0.025;

/// Values below and above which a channel is lost.
type Limits = (f64, f64);
/// A channel of a chunk.
type Column = fn(&Chunk) -> &[f64];

impl ChannelQuality {
    /// Whether the low end that the channel is stuck at is the end of its range, rather than where the muscle itself
    /// leaves it: slack, or vented.
    pub fn ends_low(&self) -> bool {
        self.clipped_low_share > 0.0 && self.name == "force" && self.lowest < -TARE_N
    }

    /// Whether the high end that the channel is stuck at is the end of its range. A length rests where it is held.
    pub fn ends_high(&self) -> bool {
        self.clipped_high_share > 0.0 && self.name != "length"
    }
}

impl RecordingQuality {
    /// Stretches of rows in which the load cell or the pressure gauge is out of its range, ascending; neighbors may
    /// overlap.
    ///
    /// # Errors
    /// Where the samples cannot be read back.
    pub fn out_of_range(&self, recording: &Recording) -> io::Result<Vec<Range<usize>>> {
        let limits = |name: &str| -> Option<Limits> {
            let channel = self.channel(name)?;
            let low = if channel.ends_low() { channel.lowest } else { f64::NEG_INFINITY };
            let high = if channel.ends_high() { channel.highest } else { f64::INFINITY };
            (low.is_finite() || high.is_finite()).then_some((low, high))
        };
        let columns: [(&str, Column); 2] = [("pressure", Chunk::pressure_pa), ("force", Chunk::force_n)];
        let watched: Vec<_> = columns.iter().filter_map(|(name, column)| Some((limits(name)?, column))).collect();
        let mut found: Vec<Range<usize>> = Vec::new();
        if watched.is_empty() {
            return Ok(found);
        }
        let guard = if self.period_s > 0.0 { (GUARD_S / self.period_s).ceil() as usize } else { 0 };
        for chunk in recording.samples.chunks() {
            let chunk = chunk?;
            for row in chunk.rows() {
                let here = row - chunk.first_row();
                let lost = |((low, high), column): &(Limits, &Column)| {
                    let value = column(&chunk)[here];
                    value <= *low || value >= *high
                };
                if !watched.iter().any(lost) {
                    continue;
                }
                let around = row.saturating_sub(guard)..(row + guard + 1).min(self.n_rows);
                match found.last_mut() {
                    Some(last) if last.end >= around.start => last.end = around.end,
                    _ => found.push(around),
                }
            }
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Repairs, Samples};

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
        RecordingQuality::of(recording).unwrap().out_of_range(recording).unwrap()
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
    fn a_muscle_that_is_flat_at_a_tare_is_left_alone() {
        assert!(lost(&clipped(-8.0)).is_empty());
        assert!(lost(&clipped(-400.0)).is_empty());
    }
}
