//! Correlation of a residual with itself and with the channels, as System Identification's `resid` shows it.
//!
//! ```text
//! r_ee(τ) = Σ e(t) e(t+τ) / Σ e²,   r_ue(τ) = Σ u(t) e(t+τ) / √(Σ u² Σ e²)
//! ```
//!
//! Were the residual white, `r_ee` would stay within `±2.58/√N` in 99 of 100 lags. Were it independent of the channel,
//! `r_ue` would within `±2.58 √(P/N)`, with `P = Σ r_ee(τ) r_uu(τ)` over all lags (Ljung 1999, System Identification, 2nd
//! ed., 16.6). Samples that are not counted take no part, and nothing is correlated across a gap or from one recording to
//! the next. Channels are taken less their mean in each recording.

use rayon::prelude::*;

use super::samples::Samples;
use crate::plot::Timeline;

/// Lags to one side.
const LAGS: usize = 100;
/// Sums that are added up side by side.
const LANES: usize = 8;
/// Longest lag, in s.
const LONGEST_S: f64 = 5.0;
/// Quantile of the normal distribution that 99 % lie within.
const Z: f64 = 2.576;

/// A correlation over lags, with the band of 99 %.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Correlation {
    /// Lag, in s.
    pub(super) lag_s: Vec<f64>,
    /// Correlation, in [-1, 1].
    pub(super) value: Vec<f64>,
    /// Half of the band in which it stays by chance.
    pub(super) band: f64,
}

impl Correlation {
    /// The lag of the largest size, with the value there, lag zero left out where `but_zero`.
    pub(super) fn largest(&self, but_zero: bool) -> (f64, f64) {
        let pairs = self.lag_s.iter().copied().zip(self.value.iter().copied());
        pairs
            .filter(|(lag_s, value)| value.is_finite() && !(but_zero && *lag_s == 0.0))
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
            .unwrap_or((0.0, f64::NAN))
    }
}

/// Samples without a gap, evenly spaced: residual, zero where it is not counted, and channel.
struct Stretch {
    residual: Vec<f64>,
    counts: Vec<f64>,
    channel: Vec<f64>,
    step: usize,
}

/// Correlation of a residual with itself: only lags from zero up.
pub(super) fn autocorrelation<'a>(
    recordings: impl Iterator<Item = &'a Samples> + Clone,
    residual: fn(&Samples) -> &[f64],
) -> Option<Correlation> {
    let (lag_s, stretches) = stretches(recordings, residual, residual)?;
    let of = |lag: usize| sum(&stretches, lag, |stretch| (&stretch.residual, &stretch.residual));
    let counts = counts(&stretches);
    let (square, n) = (of(0), counts[0]);
    if !(square > 0.0 && n > 1.0) {
        return None;
    }
    let value = (0..=LAGS).into_par_iter().map(|lag| normalized(of(lag), counts[lag], square / n)).collect();
    Some(Correlation { lag_s: (0..=LAGS).map(|lag| lag as f64 * lag_s).collect(), value, band: Z / n.sqrt() })
}

/// Correlation of a channel with a residual that follows it by the lag; negative lags show what the residual precedes.
pub(super) fn cross_correlation<'a>(
    recordings: impl Iterator<Item = &'a Samples> + Clone,
    residual: fn(&Samples) -> &[f64],
    channel: fn(&Samples) -> &[f64],
) -> Option<Correlation> {
    let (lag_s, stretches) = stretches(recordings, residual, channel)?;
    let of = |lag: usize, pick: fn(&Stretch) -> (&[f64], &[f64])| sum(&stretches, lag, pick);
    let counts = counts(&stretches);
    let n = counts[0];
    let residuals = of(0, |stretch| (&stretch.residual, &stretch.residual));
    let channels = of(0, |stretch| (&stretch.channel, &stretch.channel));
    let scale = (residuals / n * channels / n).sqrt();
    if !(scale > 0.0 && scale.is_finite() && n > 1.0) {
        return None;
    }
    let preceding = |lag: usize| {
        let sum = of(lag, |stretch| (&stretch.residual, &stretch.channel));
        (-(lag as f64) * lag_s, normalized(sum, counts[lag], scale))
    };
    let following = |lag: usize| {
        let sum = of(lag, |stretch| (&stretch.channel, &stretch.residual));
        (lag as f64 * lag_s, normalized(sum, counts[lag], scale))
    };
    let mut lags: Vec<(f64, f64)> = (0..LAGS).into_par_iter().map(|later| preceding(LAGS - later)).collect();
    lags.par_extend((0..=LAGS).into_par_iter().map(following));
    let step = stretches.iter().map(|stretch| stretch.step).max().unwrap_or(1) as f64;
    let both = |lag: usize| {
        let e = normalized(of(lag, |stretch| (&stretch.residual, &stretch.residual)), counts[lag], residuals / n);
        let u = normalized(of(lag, |stretch| (&stretch.channel, &stretch.channel)), counts[lag], channels / n);
        e * u
    };
    // One after the other, so that the sum is the same with any number of threads.
    let both: Vec<f64> = (1..=LAGS).into_par_iter().map(both).collect();
    let p = 1.0 + 2.0 * step * both.iter().sum::<f64>();
    let (lag_s, value) = lags.into_iter().unzip();
    Some(Correlation { lag_s, value, band: Z * (f64::max(p, 1.0) / n).sqrt() })
}

fn normalized(sum: f64, n: f64, scale: f64) -> f64 {
    if n > 0.0 { sum / n / scale } else { f64::NAN }
}

/// How many pairs of samples count at each lag from zero up.
fn counts(stretches: &[Stretch]) -> Vec<f64> {
    (0..=LAGS).into_par_iter().map(|lag| sum(stretches, lag, |stretch| (&stretch.counts, &stretch.counts))).collect()
}

/// Sum of products of the first with the second of `pick` a lag later; what does not count is zero.
fn sum(stretches: &[Stretch], lag: usize, pick: fn(&Stretch) -> (&[f64], &[f64])) -> f64 {
    stretches.iter().map(|stretch| product(pick(stretch), lag * stretch.step)).sum()
}

/// Sum of products of the first with the second so many rows later, in lanes: one sum after the other would wait for each.
fn product((first, second): (&[f64], &[f64]), later: usize) -> f64 {
    let Some(second) = second.get(later..) else { return 0.0 };
    let (first, first_rest) = first[..second.len()].as_chunks::<LANES>();
    let (second, second_rest) = second.as_chunks::<LANES>();
    let mut lanes = [0.0; LANES];
    for (first, second) in first.iter().zip(second) {
        for lane in 0..LANES {
            lanes[lane] += first[lane] * second[lane];
        }
    }
    let rest: f64 = first_rest.iter().zip(second_rest).map(|(first, second)| first * second).sum();
    lanes.iter().sum::<f64>() + rest
}

/// Lag from one to the next in s, and the stretches; none where no recording has a clock.
fn stretches<'a>(
    recordings: impl Iterator<Item = &'a Samples> + Clone,
    residual: fn(&Samples) -> &[f64],
    channel: fn(&Samples) -> &[f64],
) -> Option<(f64, Vec<Stretch>)> {
    let period = |samples: &Samples| {
        let time_s = samples.time_s();
        let segments = Timeline { time_s }.segments();
        let longest = segments.into_iter().max_by_key(std::ops::Range::len)?;
        let steps = longest.len().checked_sub(1).filter(|steps| *steps > 0)?;
        Some((time_s[longest.end - 1] - time_s[longest.start]) / steps as f64).filter(|period| *period > 0.0)
    };
    let slowest_s = recordings.clone().filter_map(period).fold(0.0, f64::max);
    if slowest_s <= 0.0 {
        return None;
    }
    let lag_s = (LONGEST_S / LAGS as f64).max(slowest_s);
    let mut found = Vec::new();
    for samples in recordings {
        let Some(period_s) = period(samples) else { continue };
        let (residual, channel) = (residual(samples), channel(samples));
        let counts = |row: &usize| samples.settled[*row] && (residual[*row] + channel[*row]).is_finite();
        let counted: Vec<usize> = (0..residual.len()).filter(counts).collect();
        let mean = |values: &[f64]| counted.iter().map(|&row| values[row]).sum::<f64>() / counted.len().max(1) as f64;
        let (residual_mean, channel_mean) = (mean(residual), mean(channel));
        for rows in (Timeline { time_s: samples.time_s() }).segments() {
            let weight = |row: usize| f64::from(u8::from(counts(&row)));
            let less = |values: &[f64], mean: f64| -> Vec<f64> {
                rows.clone().map(|row| if counts(&row) { values[row] - mean } else { 0.0 }).collect()
            };
            found.push(Stretch {
                residual: less(residual, residual_mean),
                counts: rows.clone().map(weight).collect(),
                channel: less(channel, channel_mean),
                step: (lag_s / period_s).round().max(1.0) as usize,
            });
        }
    }
    Some((lag_s, found))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis_page::PageRecording;
    use pam_muscle::Coordinate;

    /// A residual of `e` and a pressure of `u`, at 100 Hz.
    fn samples(n: usize, e: impl Fn(usize) -> f64, u: impl Fn(usize) -> f64) -> Samples {
        let column = |of: &dyn Fn(usize) -> f64| (0..n).map(of).collect::<Vec<f64>>();
        let zeros = vec![0.0; n];
        Samples::new(&PageRecording {
            time_s: column(&|row| 0.01 * row as f64),
            pressure_kpa: column(&u),
            contraction_percent: zeros.clone(),
            speed_mm_per_s: zeros.clone(),
            travel_mm: zeros.clone(),
            rest_s: zeros.clone(),
            cycle: zeros.clone(),
            force_n: column(&e),
            base_force_n: zeros,
            settled: vec![true; n],
            ..PageRecording::default()
        })
        .expect("equal columns")
    }

    fn pressure(samples: &Samples) -> &[f64] {
        samples.column(Coordinate::Pressure)
    }

    /// Noise between -1 and 1 that is the same every time.
    fn noise(row: usize) -> f64 {
        let mixed = (row as u64).wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        (mixed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    #[test]
    fn white_noise_stays_within_the_band() {
        let white = [samples(20_000, noise, |row| noise(row + 50_000))];
        let auto = autocorrelation(white.iter(), |samples| &samples.before_n).expect("a clock");
        assert!((auto.value[0] - 1.0).abs() < 1e-12);
        let outside = auto.value[1..].iter().filter(|value| value.abs() > auto.band).count();
        assert!(outside <= 4, "{outside}");
        let cross = cross_correlation(white.iter(), |samples| &samples.before_n, pressure).expect("a clock");
        assert!(cross.value.iter().filter(|value| value.abs() > cross.band).count() <= 6);
    }

    #[test]
    fn a_residual_that_follows_a_channel_is_found_at_its_lag() {
        // 30 samples of 10 ms later; a lag is 50 ms.
        let late = [samples(20_000, |row| noise(row.wrapping_sub(30)), noise)];
        let cross = cross_correlation(late.iter(), |samples| &samples.before_n, pressure).expect("a clock");
        let (lag_s, value) = cross.largest(false);
        assert!((lag_s - 0.3).abs() < 1e-9 && value > 0.95, "{lag_s} {value}");
    }
}
