//! Centers, spreads and limits that a few odd values do not move.

/// Expected false alarms of a whole family of comparisons, where nothing differs and values are normal.
pub const FALSE_ALARMS: f64 = 0.05;
/// A standard deviation over the median absolute deviation of a normal sample.
const MAD_SCALE: f64 = 1.4826;
/// Share of the deviations that a spread reaches to, too, so that long tails are no outliers: fewer values than the rest may be odd.
const TAIL: f64 = 0.9;
/// Deviation, in standard deviations, below which that share of a normal sample lies.
const TAIL_SCALE: f64 = 1.6449;
/// Fewest values that have a tail to look at: of as many, two may be odd.
const TAILED: usize = 30;
/// Relative efficiency of the median absolute deviation at the normal distribution: n values tell as much of the spread
/// as this share of them would with squares. (Huber and Ronchetti, Robust Statistics, 2009, section 5.1.)
const EFFICIENCY: f64 = 0.37;
/// Standard error of a median over that of a mean, normal sample: √(π/2).
pub const MEDIAN_PENALTY: f64 = 1.2533;

/// Median and spread, the latter scaled to a standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Location {
    /// Median.
    pub center: f64,
    /// Of the absolute deviations from it, what the median or the ninth decile says of a standard deviation, whichever is more.
    pub spread: f64,
    /// Values behind both.
    pub n: usize,
}

/// Center and spread of values; none for none. Values must be numbers.
pub fn location(values: &[f64]) -> Option<Location> {
    let center = median(&mut values.to_vec())?;
    let mut deviations: Vec<f64> = values.iter().map(|value| (value - center).abs()).collect();
    let spread = MAD_SCALE * median(&mut deviations)?;
    let n = values.len();
    let tail = if n < TAILED { 0.0 } else { deviations[(TAIL * (n - 1) as f64) as usize] / TAIL_SCALE };
    Some(Location { center, spread: spread.max(tail), n })
}

/// Median; none for none.
pub fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let n = values.len();
    match n {
        0 => None,
        _ if n % 2 == 1 => Some(values[n / 2]),
        _ => Some(0.5 * (values[n / 2 - 1] + values[n / 2])),
    }
}

/// How many spreads a value may lie from the center, where a spread comes from `n` values and `comparisons` values are
/// looked at altogether: Student's quantile at [`FALSE_ALARMS`] shared among them (Bonferroni), and never below 3.
pub fn limit(n: usize, comparisons: usize) -> f64 {
    let freedom = (EFFICIENCY * n.saturating_sub(1) as f64).max(1.0);
    student_quantile(freedom, FALSE_ALARMS / comparisons.max(1) as f64).max(3.0)
}

/// The `t` that Student's distribution of `freedom` degrees exceeds in size with probability `tail`.
///
/// With `t = √ν cot φ` the density is `sin^{ν-1} φ` on `(0, π/2)`, which Simpson's rule integrates well.
fn student_quantile(freedom: f64, tail: f64) -> f64 {
    let half_turn = 0.5 * std::f64::consts::PI;
    let whole = sine_power(freedom - 1.0, half_turn);
    let (mut low, mut high) = (0.0, half_turn);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if sine_power(freedom - 1.0, middle) < tail * whole {
            low = middle;
        } else {
            high = middle;
        }
    }
    freedom.sqrt() / low.max(f64::MIN_POSITIVE).tan()
}

/// `∫₀^to sin^power φ dφ`.
fn sine_power(power: f64, to: f64) -> f64 {
    const PIECES: usize = 400;
    let step = to / PIECES as f64;
    let weight = |index: usize| match index {
        0 | PIECES => 1.0,
        _ if index % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=PIECES).map(|index| weight(index) * (index as f64 * step).sin().powf(power)).sum::<f64>() * step / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Quantiles of Student's distribution, two-sided, as printed in every table of it.
    #[test]
    fn validates_against_tables_of_students_distribution() {
        for (freedom, tail, expected) in
            [(1.0, 0.05, 12.706), (5.0, 0.05, 2.571), (10.0, 0.01, 3.169), (30.0, 0.001, 3.646), (1e4, 0.05, 1.960)]
        {
            let quantile = student_quantile(freedom, tail);
            // The tables have three decimals.
            assert!((quantile - expected).abs() < 6e-4, "{freedom} degrees, {tail}: {quantile}");
        }
    }

    #[test]
    fn odd_values_do_not_move_center_and_spread_far() {
        let mut values: Vec<f64> = (0..99).map(|index| f64::from(index % 11)).collect();
        let clean = location(&values).expect("values");
        values[..9].fill(1e9);
        let odd = location(&values).expect("values");
        assert!(
            (odd.center - clean.center).abs() <= 1.0 && (odd.spread - clean.spread).abs() <= 1.5,
            "{clean:?} {odd:?}"
        );
        assert_eq!(location(&[]), None);
    }

    #[test]
    fn a_long_tail_widens_the_spread() {
        // Quantiles of a log-normal sample, whose logarithms have a standard deviation of 1.
        let normal = |share: f64| (2.0 * share - 1.0).signum() * (-2.0 * (1.0 - (2.0 * share - 1.0).abs()).ln()).sqrt();
        let values: Vec<f64> = (0..200).map(|index| normal((f64::from(index) + 0.5) / 200.0).exp()).collect();
        let all = location(&values).expect("values");
        let mut deviations: Vec<f64> = values.iter().map(|value| (value - all.center).abs()).collect();
        assert!(all.spread > 1.3 * MAD_SCALE * median(&mut deviations).expect("values"), "{all:?}");
    }

    #[test]
    fn limits_widen_with_comparisons_and_with_fewer_values() {
        assert!(limit(1000, 12_000) > limit(1000, 12) && limit(10, 120) > limit(1000, 120));
        assert_eq!(limit(100_000, 1), 3.0);
    }
}
