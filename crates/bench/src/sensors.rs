//! What the logger makes of the truth: noise, quantization, clock.
//!
//! Each channel adds noise, rounds to the steps of its converter, saturates at the ends of its range, and
//! is written with as many decimals as those steps are worth.

use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;

use crate::true_muscle::TrueMuscle;

/// Sampling rate for which the correlation of noise is stated.
pub const CORRELATION_RATE_HZ: f64 = 200.0;

/// One channel of the logger, in the unit in which it writes.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Standard deviation of the noise.
    pub noise_rms: f64,
    /// Share of the colored noise that remains after one sample at 200 Hz, in [0, 1): 0 is white.
    pub noise_correlation: f64,
    /// Share of the noise's variance that is colored, in [0, 1]; the rest is white.
    pub colored_share: f64,
    /// Lowest value that the converter can tell.
    pub lowest: f64,
    /// Highest value that the converter can tell.
    pub highest: f64,
    /// Bits of the converter.
    pub bits: u32,
}

impl Channel {
    fn white(noise_rms: f64, lowest: f64, highest: f64) -> Self {
        Self { noise_rms, noise_correlation: 0.0, colored_share: 1.0, lowest, highest, bits: 16 }
    }

    /// Step of the converter.
    pub fn step(&self) -> f64 {
        (self.highest - self.lowest) / (2.0_f64.powi(self.bits.cast_signed()) - 1.0)
    }

    /// Decimals that the step is worth.
    pub fn decimals(&self) -> usize {
        (-self.step().log10()).ceil().clamp(0.0, 9.0) as usize
    }

    /// What the converter makes of a value, as it is written.
    fn convert(&self, value: f64) -> f64 {
        let step = self.step();
        let code = ((value.clamp(self.lowest, self.highest) - self.lowest) / step).round();
        let unit = 10.0_f64.powi(self.decimals().cast_signed() as i32);
        ((self.lowest + code * step) * unit).round() / unit
    }

    /// The channel's readings of a signal, noise from `random`, at a sampling rate.
    pub(crate) fn read(&self, truth: impl Iterator<Item = f64>, rate_hz: f64, random: &mut impl Rng) -> Vec<f64> {
        let correlation = self.noise_correlation.powf(CORRELATION_RATE_HZ / rate_hz);
        let fresh = (1.0 - correlation * correlation).sqrt();
        let (colored, white) = (self.colored_share.sqrt(), (1.0 - self.colored_share).sqrt());
        let mut noise: Option<f64> = None;
        truth
            .map(|value| {
                let draw: f64 = StandardNormal.sample(random);
                let share = noise.map_or(draw, |before| correlation * before + fresh * draw);
                noise = Some(share);
                // Without a white part no number is drawn for it.
                let beside: f64 = if white > 0.0 { StandardNormal.sample(random) } else { 0.0 };
                self.convert(value + self.noise_rms * (colored * share + white * beside))
            })
            .collect()
    }
}

/// How the logger stamps a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// With the time of the sample.
    Ideal,
    /// With whole milliseconds, cut off; above 1 kHz neighboring rows share a stamp.
    Milliseconds,
}

impl Clock {
    /// Stamp of sample `index`, in s.
    pub(crate) fn stamp_s(self, index: u64, rate_hz: f64) -> f64 {
        let time_s = index as f64 / rate_hz;
        match self {
            Self::Ideal => (time_s * 1e6).round() / 1e6,
            // Half a nanosecond keeps stamps that are whole milliseconds from being cut by rounding.
            Self::Milliseconds => (time_s * 1e3 + 5e-7).floor() / 1e3,
        }
    }

    /// Decimals of a stamp: up to six, as few as the rate allows.
    pub(crate) fn decimals(self, rate_hz: f64) -> usize {
        match self {
            Self::Milliseconds => 3,
            Self::Ideal => {
                let exact = |decimals: &usize| {
                    let ticks = 10.0_f64.powi(*decimals as i32) / rate_hz;
                    (ticks - ticks.round()).abs() < 1e-9 && ticks.round() > 0.0
                };
                (0..6).find(exact).unwrap_or(6)
            }
        }
    }
}

/// The sensors of the rig and the clock of its logger.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensors {
    /// Pressure gauge, in kPa.
    pub pressure_kpa: Channel,
    /// Length sensor, in mm.
    pub length_mm: Channel,
    /// Load cell, in N.
    pub force_n: Channel,
    /// Clock.
    pub clock: Clock,
}

impl Sensors {
    /// Sensors with 16-bit converters, chosen from a catalogue (ranges in steps of 1, 2, 5) to suit a muscle:
    /// noise 0.5 kPa, 30 µm and 0.2 N; pressure -50 to 1000 kPa (2000 kPa from 900 kPa on).
    pub fn suited_to(muscle: &TrueMuscle, highest_pressure_pa: f64) -> Self {
        let dimensions = muscle.muscle();
        let longest_mm = range_above(1.1 * dimensions.rest_length_m * 1e3);
        let strongest_n = range_above(1.3 * muscle.force_n(highest_pressure_pa, dimensions.rest_length_m, 0.0));
        let highest_kpa = if highest_pressure_pa < 900e3 { 1000.0 } else { 2000.0 };
        Self {
            pressure_kpa: Channel::white(0.5, -50.0, highest_kpa),
            length_mm: Channel::white(0.030, 0.0, longest_mm),
            force_n: Channel::white(0.2, -0.1 * strongest_n, strongest_n),
            clock: Clock::Ideal,
        }
    }

    /// The noise of every channel times `factor`.
    #[must_use]
    pub fn with_noise_times(mut self, factor: f64) -> Self {
        for channel in [&mut self.pressure_kpa, &mut self.length_mm, &mut self.force_n] {
            channel.noise_rms *= factor;
        }
        self
    }
}

/// The smallest 1, 2 or 5 times a power of ten that is not below `value`.
fn range_above(value: f64) -> f64 {
    let decade = 10.0_f64.powf(value.max(1.0).log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|step| step * decade).find(|range| *range >= value).unwrap_or(10.0 * decade)
}

/// Independent sources of random numbers, one for each purpose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stream {
    Pressure = 1,
    Length = 2,
    Force = 3,
    Protocol = 4,
}

impl Stream {
    /// The generator of this stream: PCG DXSM, whose numbers are the same everywhere.
    pub(crate) fn random(self, seed: u64) -> Pcg64Dxsm {
        let mut root = Pcg64Dxsm::seed_from_u64(seed);
        let state = u128::from(root.next_u64()) << 64 | u128::from(root.next_u64());
        Pcg64Dxsm::new(state, self as u128)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rms(values: &[f64]) -> f64 {
        (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
    }

    fn noise_of(correlation: f64, rate_hz: f64) -> Vec<f64> {
        let mut channel = Channel::white(0.2, -100.0, 100.0);
        channel.noise_correlation = correlation;
        channel.read(std::iter::repeat_n(0.0, 200_000), rate_hz, &mut Stream::Force.random(7))
    }

    #[test]
    fn noise_has_the_stated_rms_whether_white_or_colored() {
        // 200 000 draws: 0.16 % standard error if white, about 0.7 % at a correlation of 0.9.
        assert!((rms(&noise_of(0.0, 200.0)) / 0.2 - 1.0).abs() < 0.007);
        assert!((rms(&noise_of(0.9, 200.0)) / 0.2 - 1.0).abs() < 0.02);
    }

    #[test]
    fn correlation_is_stated_at_200_hz_and_holds_per_second() {
        for (rate_hz, lag) in [(200.0, 1), (400.0, 2), (1000.0, 5)] {
            let noise = noise_of(0.8, rate_hz);
            let product: f64 = noise.iter().zip(&noise[lag..]).map(|(a, b)| a * b).sum();
            let correlation = product / noise.iter().map(|value| value * value).sum::<f64>();
            assert!((correlation - 0.8).abs() < 0.01, "{rate_hz} Hz: {correlation}");
        }
    }

    #[test]
    fn noise_may_be_half_white_and_half_colored() {
        let mut channel = Channel::white(0.2, -100.0, 100.0);
        (channel.noise_correlation, channel.colored_share) = (0.98, 0.5);
        let noise = channel.read(std::iter::repeat_n(0.0, 400_000), 200.0, &mut Stream::Force.random(7));
        // The colored half has 4000 independent values: 2 % standard error of its variance.
        assert!((rms(&noise) / 0.2 - 1.0).abs() < 0.03);
        let product: f64 = noise.iter().zip(&noise[1..]).map(|(a, b)| a * b).sum();
        let correlation = product / noise.iter().map(|value| value * value).sum::<f64>();
        assert!((correlation - 0.5 * 0.98).abs() < 0.04, "{correlation}");
    }

    #[test]
    fn streams_of_one_seed_do_not_resemble_each_other() {
        let draws = |stream: Stream| -> Vec<f64> {
            let mut random = stream.random(1);
            (0..20_000).map(|_| StandardNormal.sample(&mut random)).collect()
        };
        let (a, b) = (draws(Stream::Pressure), draws(Stream::Force));
        let correlation = a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>() / 20_000.0;
        // Five standard errors of 1/√20000.
        assert!(correlation.abs() < 0.036, "{correlation}");
    }

    #[test]
    fn a_converter_saturates_at_its_ends_and_rounds_to_its_steps() {
        let channel = Channel { bits: 2, ..Channel::white(0.0, 0.0, 3.0) };
        assert_eq!([-1.0, 0.4, 0.6, 9.0].map(|value| channel.convert(value)), [0.0, 0.0, 1.0, 3.0]);
    }

    #[test]
    fn a_millisecond_clock_repeats_stamps_above_1_khz() {
        let stamps = |rate_hz| (0..6).map(|index| Clock::Milliseconds.stamp_s(index, rate_hz)).collect::<Vec<_>>();
        assert_eq!(stamps(2000.0), [0.0, 0.0, 0.001, 0.001, 0.002, 0.002]);
        assert_eq!(stamps(200.0), [0.0, 0.005, 0.010, 0.015, 0.020, 0.025]);
    }

    #[test]
    fn stamps_have_as_few_decimals_as_the_rate_allows() {
        assert_eq!([1.0, 100.0, 200.0, 540.0].map(|rate_hz| Clock::Ideal.decimals(rate_hz)), [0, 2, 3, 6]);
    }

    #[test]
    fn ranges_come_in_steps_of_one_two_five() {
        assert_eq!([0.2, 294.0, 500.0, 501.0].map(range_above), [1.0, 500.0, 500.0, 1000.0]);
    }
}
