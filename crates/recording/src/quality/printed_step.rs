//! The step of a converter behind digits that do not hold it: steps of 7.84 N in whole newtons are 7 or 8 N apart.
//!
//! Values are printed as multiples of a power of ten `u`. A channel that never shows two values `u` apart, whatever it does,
//! has steps `s` of more than that, and its values are those of `v₀ + k s` rounded to `u`:
//!
//! ```text
//! |v - (v₀ + k s)| ≤ u / 2
//! ```
//!
//! The step is fitted to more and more of its values, the lowest first, so that no `k` is mistaken.

/// Distinct values that tell a step.
const LEAST_VALUES: usize = 16;
/// Values that the first fit sees.
const FIRST: usize = 8;
/// Share of the values that the step has to explain: some are spikes.
const EXPLAINED: f64 = 0.98;
/// Largest distance from a step, in printed units: a half, and what the fit adds to it.
const WITHIN: f64 = 0.6;
/// Powers of ten that digits end at, in SI.
const UNITS: std::ops::RangeInclusive<i32> = -9..=6;

/// The step behind the digits of ascending values; none where their digits hold it, or where there is none.
pub(super) fn behind_digits(sorted: &[f64]) -> Option<f64> {
    let mut values = sorted.to_vec();
    values.dedup();
    if values.len() < LEAST_VALUES {
        return None;
    }
    let unit = printed_unit(&values)?;
    let in_units: Vec<f64> = values.iter().map(|value| (value / unit).round()).collect();
    let gaps = || in_units.windows(2).map(|pair| pair[1] - pair[0]);
    let smallest = gaps().fold(f64::INFINITY, f64::min);
    if smallest < 2.0 {
        return None;
    }
    let single: Vec<f64> = gaps().filter(|gap| *gap <= smallest + 1.0).collect();
    let mut step = single.iter().sum::<f64>() / single.len() as f64;
    let mut offset = 0.0;
    let mut seen = FIRST;
    loop {
        let known = &in_units[..seen.min(in_units.len())];
        (step, offset) = fitted(known, step, offset)?;
        if seen >= in_units.len() {
            break;
        }
        seen *= 2;
    }
    let is_near = |value: &&f64| {
        let from = *value - in_units[0] - offset;
        (from - (from / step).round() * step).abs() <= WITHIN
    };
    let near = in_units.iter().filter(is_near).count();
    (near as f64 >= EXPLAINED * in_units.len() as f64).then_some(step * unit)
}

/// The largest power of ten that all of `values` are multiples of.
fn printed_unit(values: &[f64]) -> Option<f64> {
    UNITS.rev().map(|power| 10.0_f64.powi(power)).find(|unit| {
        values.iter().all(|value| {
            let multiple = value / unit;
            (multiple - multiple.round()).abs() < 1e-6
        })
    })
}

/// Step and offset of the lowest value, fitted to `values` whose multiples are those of the step and offset so far.
fn fitted(values: &[f64], step: f64, offset: f64) -> Option<(f64, f64)> {
    let n = values.len() as f64;
    let pairs = values.iter().map(|value| {
        let from = value - values[0];
        (((from - offset) / step).round(), from)
    });
    let (mut multiples, mut froms, mut squares, mut products) = (0.0, 0.0, 0.0, 0.0);
    for (multiple, from) in pairs {
        multiples += multiple;
        froms += from;
        squares += multiple * multiple;
        products += multiple * from;
    }
    let spread = squares - multiples * multiples / n;
    if spread <= 0.0 {
        return None;
    }
    let step = (products - multiples * froms / n) / spread;
    Some((step, (froms - step * multiples) / n))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    /// Values that a converter with steps of `step` prints in multiples of `unit`, of values between 0 and 1000.
    fn printed(step: f64, unit: f64, n: usize) -> Vec<f64> {
        let mut generator = rand_pcg::Pcg64::seed_from_u64(11);
        let mut values: Vec<f64> = (0..n)
            .map(|_| {
                let code = (generator.random_range(0.0..1000.0) / step).round();
                ((3.3 + code * step) / unit).round() * unit
            })
            .collect();
        values.sort_unstable_by(f64::total_cmp);
        values
    }

    #[test]
    fn steps_that_the_digits_do_not_hold_are_found() {
        for (step, unit) in [(7.84, 1.0), (3.91, 1.0), (2.93, 1.0), (0.293, 0.1), (23.4, 10.0)] {
            // Three times as many values as levels, of which one in twenty is not seen.
            for n in [(3000.0 / step) as usize, 20_000] {
                let Some(found) = behind_digits(&printed(step, unit, n)) else { panic!("{step} {unit} {n}") };
                assert!((found / step - 1.0).abs() < 0.01, "{step} {unit} {n}: {found}");
            }
        }
    }

    #[test]
    fn digits_alone_are_no_step() {
        // Every digit is used, or there are too few values to tell.
        assert_eq!(behind_digits(&printed(0.1, 1.0, 20_000)), None);
        assert_eq!(behind_digits(&printed(1.2, 1.0, 20_000)), None);
        assert_eq!(behind_digits(&[3.0, 10.0, 18.0, 26.0]), None);
        let mut generator = rand_pcg::Pcg64::seed_from_u64(3);
        let mut sparse: Vec<f64> = (0..60).map(|_| generator.random_range(0.0_f64..1e4).round()).collect();
        sparse.sort_unstable_by(f64::total_cmp);
        assert_eq!(behind_digits(&sparse), None);
        let mut fine: Vec<f64> = (0..500).map(|_| generator.random_range(0.0..1.0)).collect();
        fine.sort_unstable_by(f64::total_cmp);
        assert_eq!(behind_digits(&fine), None);
    }
}
