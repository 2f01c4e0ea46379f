//! A pressure that stands still, to its last digit, wherever it rests.
//!
//! Whatever a gauge reads flickers, by its noise or between the steps of a converter. What does not has a dead band, in the gauge or
//! in a logger that reports changes alone, or is a set-point that was logged in place of a reading. A force tells little of it: in a
//! muscle that is held at one length, friction of eq. 11 takes up what a play of the gauge is off by.

use pam_recording::Recording;
use pam_recording::quality::RecordingQuality;

use super::and_others;

/// Share of its span that a channel without noise flickers by, for having been computed.
const ROUNDED: f64 = 1e-9;

/// Message about recordings whose pressure stands still while their force does not; none where every pressure flickers.
pub fn words<'a>(recordings: impl Iterator<Item = (&'a Recording, &'a RecordingQuality)>) -> Option<String> {
    let still: Vec<&str> =
        recordings.filter(|(_, quality)| stands_still(quality)).map(|(recording, _)| recording.path.as_str()).collect();
    let path = still.first()?;
    Some(format!(
        "{path}{}: pressure stands still to the last digit wherever it rests: a gauge or a logger with a dead band \
         (pressure-gauge-hysteresis), or a set-point that was logged in place of a reading; where the length is held, friction of \
         eq. 11 takes up what it is off by, and no fit tells how much that is",
        and_others(still.len() - 1)
    ))
}

fn stands_still(quality: &RecordingQuality) -> bool {
    let channel = |name: &str| quality.channel(name).map(|channel| (channel, channel.highest - channel.lowest));
    let moves_at_will =
        channel("pressure").is_some_and(|(channel, span)| span > 0.0 && channel.quantization_step.is_none());
    let flickers = |name: &str| channel(name).is_some_and(|(channel, span)| channel.noise > ROUNDED * span);
    // A simulation without noise has it in no channel.
    moves_at_will && !flickers("pressure") && flickers("force")
}

#[cfg(test)]
mod tests {
    use super::*;

    use pam_recording::Samples;

    use crate::testing::recording;

    /// Pulses of a valve, at 500 Hz, which a gauge reads with a noise and a dead band of so many pascal; the force has noise of its own.
    fn read(noise_pa: f64, band_pa: f64, noise_n: f64) -> Option<String> {
        let noise = |row: usize| (row * 7919 % 1013) as f64 / 506.0 - 1.0;
        let time_s: Vec<f64> = (0..10_000).map(|row| 0.002 * f64::from(row)).collect();
        let true_pa = |t: f64| 1e5 + 1.7e4 * ((t / 0.5).floor() + 1.0 - (-(t % 0.5) / 0.03).exp());
        let mut reads_pa = 0.0_f64;
        let pressure_pa: Vec<f64> = time_s
            .iter()
            .enumerate()
            .map(|(row, &t)| {
                let gauge_pa = true_pa(t) + noise_pa * noise(row);
                reads_pa = reads_pa.clamp(gauge_pa - 0.5 * band_pa, gauge_pa + 0.5 * band_pa);
                reads_pa
            })
            .collect();
        let force_n: Vec<f64> =
            time_s.iter().enumerate().map(|(row, &t)| 1e-3 * true_pa(t) + noise_n * noise(row + 300)).collect();
        let recording = recording("r.csv", Samples::from_columns(&time_s, &pressure_pa, &vec![0.25; 10_000], &force_n));
        let quality = RecordingQuality::of(&recording).expect("a quality");
        words([(&recording, &quality), (&recording, &quality)].into_iter())
    }

    #[test]
    fn a_gauge_that_stands_still_while_the_force_flickers_is_said_with_how_many_do() {
        let said = read(500.0, 6e3, 0.5).expect("words");
        assert!(said.starts_with("r.csv and another: pressure stands still"), "{said}");
    }

    #[test]
    fn a_gauge_that_flickers_and_a_simulation_without_noise_are_not() {
        assert_eq!(read(500.0, 0.0, 0.5), None);
        assert_eq!(read(500.0, 400.0, 0.5), None);
        assert_eq!(read(0.0, 0.0, 0.0), None);
    }
}
