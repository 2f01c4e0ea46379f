//! One column of a recording: range, noise, quantization, clipping.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a channel looks like, in SI.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ChannelQuality {
    /// `pressure`, `length` or `force`.
    pub name: String,
    /// SI unit of the figures here.
    pub unit: String,
    /// Lowest value.
    pub lowest: f64,
    /// Highest value.
    pub highest: f64,
    /// Standard deviation of the white part of the noise, quantization included.
    pub noise: f64,
    /// Standard deviation of the noise within [`WITHIN_S`], its colored part and hum included, quantization included;
    /// 0 in models that do not say.
    #[serde(default)]
    pub colored_noise: f64,
    /// Standard deviation of averages over [`AVERAGED_S`] while the channel rests: what is left of noise that a moving average
    /// does not take; 0 where it never rests, and in models that do not say.
    #[serde(default)]
    pub rest_noise: f64,
    /// Smallest step between values, where the channel has one.
    pub quantization_step: Option<f64>,
    /// Share of samples stuck at the lowest value, where the noise says that they should flicker.
    pub clipped_low_share: f64,
    /// Share of samples stuck at the highest value, likewise.
    pub clipped_high_share: f64,
}

impl ChannelQuality {
    /// Standard deviation of the noise, colored or not; models of before say nothing of its color.
    pub fn any_noise(&self) -> f64 {
        self.noise.max(self.colored_noise)
    }

    /// Whether the channel moves by more than its noise explains.
    pub fn varies(&self) -> bool {
        // White noise covers some ten standard deviations in a million samples.
        self.highest - self.lowest > 12.0 * self.any_noise()
    }

    /// Five times the noise, colored or not: by how much a channel must turn back before it counts as turned.
    pub fn play_threshold(&self) -> f64 {
        PLAY * self.any_noise()
    }

    /// What averages of the channel at rest wander within, from peak to peak; none where it never rests.
    pub fn wanders_within(&self) -> Option<f64> {
        (self.rest_noise > 0.0).then_some(PEAK_TO_PEAK * self.rest_noise)
    }
}

/// Standard deviations of its noise by which a channel must turn back before it counts as turned.
pub const PLAY: f64 = 5.0;

/// Values that the estimates of noise and quantization look at.
pub(super) const SAMPLE_ROWS: usize = 1 << 16;

/// Standard deviation of white noise on a smooth signal, from second differences (variance `6 σ²`), which
/// straight lines leave at zero. Differences beyond four of their standard deviations belong to the
/// signal and are left out.
pub fn noise_std(values: &[f64]) -> f64 {
    let squares: Vec<f64> = values
        .windows(3)
        .map(|window| {
            let difference = window[0] - 2.0 * window[1] + window[2];
            difference * difference
        })
        .collect();
    if squares.is_empty() {
        return 0.0;
    }
    let mut mean = squares.iter().sum::<f64>() / squares.len() as f64;
    for _ in 0..20 {
        let (mut sum, mut count) = (0.0, 0usize);
        for &square in &squares {
            if square <= 16.0 * mean {
                sum += square;
                count += 1;
            }
        }
        let kept = if count > 0 { sum / count as f64 } else { 0.0 };
        if (kept - mean).abs() <= 1e-9 * mean {
            break;
        }
        mean = kept;
    }
    let noise = (mean / 6.0).sqrt();
    // White noise is everywhere: where stretches that a cubic describes show far less, the differences were a motion that a
    // slow clock hardly follows.
    match quiet_std(values, LEAST_IN_WINDOW) {
        Some(quiet) if quiet > 0.0 && quiet < MOTION * noise => quiet,
        _ => noise,
    }
}

/// Share of what second differences show below which quiet stretches say that a motion made them.
const MOTION: f64 = 0.5;

/// Time within which noise is told from a signal, in s: muscles and valves are slower.
pub const WITHIN_S: f64 = 0.3;
/// Values that a window holds at least.
const LEAST_IN_WINDOW: usize = 12;
/// Parameters of the cubic that stands for the signal within a window.
const CUBIC: usize = 4;
/// Share of the windows that are quiet in any recording.
const QUIET: f64 = 0.2;
/// Where a standard normal variable has that share below it.
const QUIET_NORMAL: f64 = -0.8416;

/// Standard deviation of noise of any color: what a cubic leaves within [`WITHIN_S`], in the quietest fifth of the windows,
/// corrected for that choice as if the noise were white (Wilson and Hilferty's approximation of χ²). None where a window of
/// that length holds too few values at a `period_s`.
pub fn colored_noise_std(values: &[f64], period_s: f64) -> Option<f64> {
    let n = (WITHIN_S / period_s).round() as usize;
    if n < LEAST_IN_WINDOW { None } else { quiet_std(values, n) }
}

/// Times the white part that noise within [`WITHIN_S`] must have to be called colored.
const COLORED: f64 = 1.15;

/// Standard deviation of noise, however long its values share it: that of a first-order autoregression whose second differences
/// show `noise`, and whose windows of [`WITHIN_S`] show `colored` beside a cubic. Noise that is white stays what it is.
pub fn whole_noise_std(noise: f64, colored: f64, period_s: f64) -> f64 {
    let n = (WITHIN_S / period_s).round() as usize;
    if n < LEAST_IN_WINDOW || !(noise > 0.0 && colored > COLORED * noise) {
        return colored.max(noise);
    }
    let basis = cubic(n);
    // What white differences and the quietest fifth of the windows show of a noise of one, of which neighbors share so much.
    let shares = |shared: f64| {
        let second_differences = (6.0 - 8.0 * shared + 2.0 * shared * shared) / 6.0;
        let (trace, square) = beside_cubic(&basis, shared);
        let freedom = (n - CUBIC) as f64;
        let quiet = quiet_share(trace * trace / square) / quiet_share(freedom);
        [second_differences, quiet * trace / freedom]
    };
    let wanted = (colored / noise).powi(2);
    // The ratio rises with what neighbors share.
    let (mut low, mut high) = (0.0, MOST_SHARED);
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        let [white, within] = shares(middle);
        if within / white < wanted { low = middle } else { high = middle }
    }
    (noise / shares(low)[0].sqrt()).min(MOST_BEYOND * colored)
}

/// Trace, and trace of the square, of the covariance of what the columns of `basis` leave of a first-order autoregression of
/// variance one, of which neighbors share `shared`.
fn beside_cubic(basis: &[Vec<f64>], shared: f64) -> (f64, f64) {
    let n = basis[0].len();
    let powers: Vec<f64> = (0..n)
        .scan(1.0, |power, _| {
            let here = *power;
            *power *= shared;
            Some(here)
        })
        .collect();
    let covariance = |row: usize, column: usize| powers[row.abs_diff(column)];
    // (1 - P) C (1 - P) with P = Σ q qᵀ: the columns C q, and qᵀ C q between them.
    let seen: Vec<Vec<f64>> = basis
        .iter()
        .map(|q| (0..n).map(|row| (0..n).map(|column| covariance(row, column) * q[column]).sum()).collect())
        .collect();
    let between = |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(left, right)| left * right).sum::<f64>();
    let core: Vec<Vec<f64>> = basis.iter().map(|q| seen.iter().map(|seen| between(q, seen)).collect()).collect();
    let (mut trace, mut square) = (0.0, 0.0);
    for row in 0..n {
        for column in 0..=row {
            let mut value = covariance(row, column);
            for (k, q) in basis.iter().enumerate() {
                value -= q[row] * seen[k][column] + seen[k][row] * q[column];
                for (l, other) in basis.iter().enumerate() {
                    value += q[row] * core[k][l] * other[column];
                }
            }
            if row == column {
                trace += value;
                square += value * value;
            } else {
                square += 2.0 * value * value;
            }
        }
    }
    (trace, square)
}

/// Times what windows of [`WITHIN_S`] show that noise can be told to have: what it shares for longer, they hardly see.
const MOST_BEYOND: f64 = 1.75;
/// Most that neighbors share of a noise that any recording tells from a signal.
const MOST_SHARED: f64 = 0.98;

/// Orthonormal polynomials up to a cubic over `n` values.
fn cubic(n: usize) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(CUBIC);
    for degree in 0..CUBIC as i32 {
        let mut column: Vec<f64> = (0..n).map(|at| (2.0 * at as f64 / (n - 1) as f64 - 1.0).powi(degree)).collect();
        for other in &basis {
            let product: f64 = column.iter().zip(other).map(|(left, right)| left * right).sum();
            column.iter_mut().zip(other).for_each(|(value, other)| *value -= product * other);
        }
        let size = column.iter().map(|value| value * value).sum::<f64>().sqrt();
        column.iter_mut().for_each(|value| *value /= size);
        basis.push(column);
    }
    basis
}

/// Standard deviation of what a cubic leaves of `n` values in a row, in the quietest fifth of the windows, corrected for that
/// choice. None where there is no window.
fn quiet_std(values: &[f64], n: usize) -> Option<f64> {
    if values.len() < n {
        return None;
    }
    let basis = cubic(n);
    let freedom = (n - CUBIC) as f64;
    let variances: Vec<f64> = values
        .chunks_exact(n)
        .map(|window| {
            let mean = window.iter().sum::<f64>() / n as f64;
            let squares: f64 = window.iter().map(|value| (value - mean).powi(2)).sum();
            let fitted: f64 = basis
                .iter()
                .skip(1)
                .map(|column| {
                    column.iter().zip(window).map(|(entry, value)| entry * (value - mean)).sum::<f64>().powi(2)
                })
                .sum();
            (squares - fitted).max(0.0) / freedom
        })
        .collect();
    quiet_fifth(variances, freedom)
}

/// Standard deviation where the quietest fifth of `variances` ends, each of so many degrees of `freedom`, corrected for that
/// choice as if the values were independent (Wilson and Hilferty's approximation of χ²). None where there are none.
fn quiet_fifth(mut variances: Vec<f64>, freedom: f64) -> Option<f64> {
    let place = (QUIET * variances.len().checked_sub(1)? as f64).round() as usize;
    let quiet = *variances.select_nth_unstable_by(place, f64::total_cmp).1;
    Some((quiet / quiet_share(freedom)).sqrt())
}

/// Where the quietest fifth of means of so many independent squares ends, in units of their mean.
fn quiet_share(freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom);
    (1.0 - spread + QUIET_NORMAL * spread.sqrt()).powi(3)
}

/// Over what a channel is averaged before its direction is read, in s.
pub const AVERAGED_S: f64 = 0.05;
/// From peak to peak, in standard deviations, what a thousand independent normal values span at most but once in twenty.
const PEAK_TO_PEAK: f64 = 8.0;
/// Time that a rest is looked for in, in s: longer than noise remembers.
const RESTING_S: f64 = 1.0;
/// Times the noise that a channel at rest wanders by at most; a motion is a hundred times faster.
const RESTS_WITHIN: f64 = 4.0;

/// Standard deviation of averages over [`AVERAGED_S`] around a line within [`RESTING_S`], in the quietest fifth of the windows
/// and corrected for that choice. None where the channel does not rest there to within some times its `noise`.
pub fn rest_noise_std(values: &[f64], period_s: f64, noise: f64) -> Option<f64> {
    let averaged = ((AVERAGED_S / period_s).round() as usize).max(1);
    let means: Vec<f64> =
        values.chunks_exact(averaged).map(|part| part.iter().sum::<f64>() / averaged as f64).collect();
    let n = (RESTING_S / (averaged as f64 * period_s)).round() as usize;
    if n < LEAST_IN_WINDOW {
        return None;
    }
    let variance = |window: &[f64]| {
        let middle = 0.5 * (n - 1) as f64;
        let mean = window.iter().sum::<f64>() / n as f64;
        let (mut rise, mut spread, mut squares) = (0.0, 0.0, 0.0);
        for (at, value) in window.iter().enumerate() {
            let place = at as f64 - middle;
            rise += place * value;
            spread += place * place;
            squares += (value - mean).powi(2);
        }
        (squares - rise * rise / spread).max(0.0) / (n - 2) as f64
    };
    let rest = quiet_fifth(means.chunks_exact(n).map(variance).collect(), (n - 2) as f64)?;
    (rest < RESTS_WITHIN * noise).then_some(rest)
}

/// The step of a quantized channel: the smallest distance between two of its values, if all distances are
/// multiples of it and it is not just the last printed digit of a fine channel.
pub fn quantization_step(values: &[f64]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let span = sorted.last()? - sorted.first()?;
    let tiny = 1e-9 * span;
    let gaps: Vec<f64> = sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|&gap| gap > tiny).collect();
    let step = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    if !step.is_finite() {
        return None;
    }
    // Printed digits round each value, so that the smallest gap may be off by a few per mille.
    let multiples =
        gaps.iter().filter(|&&gap| (gap / step - (gap / step).round()).abs() < 0.05 * (gap / step).clamp(1.0, 4.0));
    let few_values = span / step < 70_000.0;
    let explained = few_values && multiples.count() as f64 > 0.98 * gaps.len() as f64;
    explained.then_some(step).or_else(|| super::printed_step::behind_digits(&sorted))
}

#[cfg(test)]
mod tests;
