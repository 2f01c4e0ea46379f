//! Where the length stands still, and where the pressure moves while it does.

use std::ops::Range;

use nalgebra::Vector3;

use super::turn::fit;

/// How long the length must stand still before pressure takes its place, in s.
pub const STANDSTILL_S: f64 = 1.0;

/// A shorter rest, in s, and how much less the length moves in it: so that neither is a crawl.
const SHORT_S: f64 = 0.4;
/// See [`SHORT_S`].
const SHORT_SHARE: f64 = 0.4;

/// Stretches of at least [`STANDSTILL_S`] in which the values stay within a `threshold`, and shorter ones in which they stay
/// within less; in order, none within another.
pub(super) fn standstills(time_s: &[f64], values: &[f64], threshold: f64) -> Vec<Range<usize>> {
    let mut found = within(time_s, values, threshold, STANDSTILL_S);
    let short = within(time_s, values, SHORT_SHARE * threshold, SHORT_S);
    let apart = |short: &Range<usize>| found.iter().all(|long| short.end <= long.start || long.end <= short.start);
    let short: Vec<Range<usize>> = short.into_iter().filter(apart).collect();
    found.extend(short);
    found.sort_by_key(|still| still.start);
    found
}

/// Stretches of at least `least_s` in which the values stay within a `threshold`.
fn within(time_s: &[f64], values: &[f64], threshold: f64, least_s: f64) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = 0;
    let (mut low, mut high) = (values[0], values[0]);
    for index in 0..=values.len() {
        if index < values.len() {
            low = low.min(values[index]);
            high = high.max(values[index]);
            if high - low <= threshold {
                continue;
            }
        }
        if time_s[index - 1] - time_s[start] >= least_s {
            found.push(start..index);
        }
        if index < values.len() {
            (start, low, high) = (index, values[index], values[index]);
        }
    }
    found
}

/// Share of the play that a length which never rests goes through at least: less is what frame and cord give.
const LEAST_SWING: f64 = 0.5;
/// Deviations by which a parabola must describe it better than a rest does.
const SURELY: f64 = 3.0;

/// Whether `values`, which stay within `threshold`, never rest: whether a parabola, a turn or a crawl, describes them better than a
/// level with a motion before and after it, which has as many weights. `noise` is the deviation of a value.
pub(super) fn never_rests(values: &[f64], threshold: f64, noise: f64) -> bool {
    let half = 0.5 * (values.len() as f64 - 1.0);
    let along = |at: f64| at / half - 1.0;
    let parabola = |u: f64| Vector3::new(1.0, u, u * u);
    let rest = |u: f64| Vector3::new(1.0, (u + 0.5).min(0.0), (u - 0.5).max(0.0));
    let fitted = |row: &dyn Fn(f64) -> Vector3<f64>| fit(values, 1, values[0], |at| row(along(at)));
    let Some(((bent, weights), (level, _))) = fitted(&parabola).zip(fitted(&rest)) else { return false };
    let vertex = (-0.5 * weights[1] / weights[2]).clamp(-1.0, 1.0);
    let reached = [-1.0, if vertex.is_finite() { vertex } else { 0.0 }, 1.0].map(|u| weights.dot(&parabola(u)));
    level - bent > (SURELY * noise).powi(2) && range(&reached) > LEAST_SWING * threshold
}

/// Deviations of a length that rests beyond which it moves.
const MOVES: f64 = 3.0;

/// Where in the standstill `index` of `stills` the pressure moves while the length rests; none where it does not.
///
/// The end of a motion and the beginning of the next are within a threshold as well. A pressure that settles together with the
/// length, or sets off with it, moves no strand that the length does not: those rows are left to the length. `noise_m` is the
/// deviation of `contraction` at rest.
pub(super) fn pushed(
    stills: &[Range<usize>],
    index: usize,
    contraction: &[f64],
    noise_m: f64,
    pressure: &[f64],
    threshold_pa: f64,
) -> Option<Range<usize>> {
    let still = &stills[index];
    let n = still.len();
    let (level, moves_m) = rest_and_motion(contraction, still, noise_m);
    let after_motion = still.start > 0 && (index == 0 || stills[index - 1].end < still.start);
    let before_motion =
        still.end < contraction.len() && stills.get(index + 1).is_none_or(|next| next.start > still.end);
    let deviation_m = |row: usize| (contraction[row] - level).abs();
    let (first, last) = (still.start, still.end - 1);
    let mut rest = still.clone();
    if after_motion {
        rest.start += moving_rows(n, moves_m, threshold_pa, &|at| (deviation_m(first + at), pressure[first + at]));
    }
    if before_motion {
        rest.end -= moving_rows(n, moves_m, threshold_pa, &|at| (deviation_m(last - at), pressure[last - at]));
    }
    (rest.start < rest.end && range(&pressure[rest.clone()]) > threshold_pa).then_some(rest)
}

/// Where in a standstill the length rests, without the end of the motion before it and the beginning of the next.
pub(super) fn held(still: &Range<usize>, contraction: &[f64], noise_m: f64) -> Range<usize> {
    let (level, moves_m) = rest_and_motion(contraction, still, noise_m);
    let rests = |row: &usize| (contraction[*row] - level).abs() <= moves_m;
    let first = still.clone().find(rests).unwrap_or(still.end);
    let end = still.clone().rev().find(rests).map_or(first, |last| last + 1);
    first..end
}

/// Level on which `contraction` rests in a standstill, and how far from it it moves.
fn rest_and_motion(contraction: &[f64], still: &Range<usize>, noise_m: f64) -> (f64, f64) {
    let (level, spread) = rests_within(contraction, still);
    (level, MOVES * noise_m.max(spread))
}

/// Mean and deviation of `values` in the middle half of a standstill.
pub(super) fn rests_within(values: &[f64], still: &Range<usize>) -> (f64, f64) {
    let margin = still.len() / 4;
    let middle = &values[still.start + margin..still.end - margin];
    let n = middle.len() as f64;
    let level = middle.iter().sum::<f64>() / n;
    (level, (middle.iter().map(|value| (value - level).powi(2)).sum::<f64>() / n).sqrt())
}

/// How many of `n` rows of a standstill, counted inwards from one of its ends, belong to the motion beyond that end. `row` gives
/// how far the length is from where it rests, and the pressure.
fn moving_rows(n: usize, moves_m: f64, threshold_pa: f64, row: &dyn Fn(usize) -> (f64, f64)) -> usize {
    let Some(rest) = (0..n).find(|&at| row(at).0 <= moves_m) else { return n };
    let Some(far) = (0..rest).rev().find(|&at| row(at).0 > 3.0 * moves_m) else { return rest };
    let rest_pa = row(rest).1;
    let step_pa = rest_pa - row(far).1;
    // The length has half of that way left, and the pressure with it; a settling that is not quite in step takes twice that.
    let most_pa = step_pa.abs() + threshold_pa;
    let (mut farthest_pa, mut farthest_at) = (0.0, rest);
    for at in rest..n {
        let along_pa = (row(at).1 - rest_pa) * step_pa.signum();
        if along_pa > most_pa {
            return rest;
        }
        if along_pa > farthest_pa {
            (farthest_pa, farthest_at) = (along_pa, at);
        }
        if farthest_pa - along_pa > threshold_pa {
            return farthest_at;
        }
    }
    n
}

fn range(values: &[f64]) -> f64 {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for &value in values {
        low = low.min(value);
        high = high.max(value);
    }
    high - low
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a length of 300 rows with so much noise, in m, never rests.
    fn moves(truth: &dyn Fn(f64) -> f64, noise_m: f64) -> bool {
        let noise = |row: u32| noise_m * 12f64.sqrt() * (f64::from(row * 7919 % 1013) / 1013.0 - 0.5);
        let values: Vec<f64> = (0..300).map(|row| truth(f64::from(row) / 299.0) + noise(row)).collect();
        never_rests(&values, 5.0 * noise_m, noise_m)
    }

    #[test]
    fn a_slow_turn_and_a_crawl_never_rest() {
        assert!(moves(&|along| 16e-5 * (along - 0.5).powi(2), 1e-5), "turn");
        assert!(moves(&|along| 5e-5 * along, 1e-5), "crawl");
    }

    #[test]
    fn what_moves_only_at_its_ends_rests_and_so_does_what_only_gives_a_little() {
        assert!(!moves(&|_| 0.0, 1e-5), "noise");
        assert!(!moves(&|along| 5e-4 * (along - 0.9).max(0.0), 1e-5), "end of a motion");
        assert!(!moves(&|along| 2e-5 * along, 1e-5), "give");
    }
}
