//! Shares with their uncertainty, and quantiles.

/// Half the width of a 95 % interval, in standard deviations.
const Z: f64 = 1.959_963_984_540_054;

/// Wilson's 95 % interval of a share, in [0, 1].
pub fn wilson(hits: usize, n: usize) -> (f64, f64) {
    if n == 0 {
        return (0.0, 1.0);
    }
    let n = n as f64;
    let share = hits as f64 / n;
    let center = (share + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
    let half = Z / (1.0 + Z * Z / n) * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
    ((center - half).max(0.0), (center + half).min(1.0))
}

/// Quantile by linear interpolation between order statistics; none of nothing.
pub fn quantile(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    let position = share * last as f64;
    let below = (position.floor() as usize).min(last);
    let above = (below + 1).min(last);
    let part = position - below as f64;
    // An infinite neighbor must not turn a weight of zero into NaN.
    Some(if part == 0.0 { sorted[below] } else { sorted[below] + part * (sorted[above] - sorted[below]) })
}

/// 95 % interval of a quantile from order statistics; none of nothing.
pub fn quantile_interval(values: &[f64], share: f64) -> Option<(f64, f64)> {
    let n = values.len() as f64;
    let half = Z * (share * (1.0 - share) / n).sqrt();
    Some((quantile(values, (share - half).max(0.0))?, quantile(values, (share + half).min(1.0))?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published: 0 of 10 gives 0 to 27.8 %, 8 of 10 gives 49.0 to 94.3 %.
    #[test]
    fn wilson_agrees_with_published_intervals() {
        let (low, high) = wilson(0, 10);
        assert!(low < 1e-12 && (high - 0.278).abs() < 1e-3, "{low} {high}");
        let (low, high) = wilson(8, 10);
        assert!((low - 0.490).abs() < 1e-3 && (high - 0.943).abs() < 1e-3, "{low} {high}");
    }

    #[test]
    fn quantiles_lie_between_order_statistics() {
        let values = [4.0, 1.0, 3.0, 2.0, 5.0];
        assert_eq!(quantile(&values, 0.5), Some(3.0));
        assert_eq!(quantile(&values, 0.9), Some(4.6));
        assert_eq!(quantile(&[], 0.5), None);
    }
}
