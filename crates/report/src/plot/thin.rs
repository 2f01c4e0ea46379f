//! Fewer points that look the same.

/// Indices of at most about `limit` of the samples `y`, in order, such that a line through them looks like
/// the line through all: the ends, and the lowest and the highest sample of each stretch. Samples that are
/// not finite are left out.
pub fn thin(y: &[f64], limit: usize) -> Vec<usize> {
    let limit = limit.max(4);
    if y.len() <= limit {
        return (0..y.len()).filter(|index| y[*index].is_finite()).collect();
    }
    let stretches = limit / 2 - 1;
    let mut kept = Vec::with_capacity(limit);
    let mut keep = |index: usize| {
        if y[index].is_finite() && kept.last() != Some(&index) {
            kept.push(index);
        }
    };
    keep(0);
    for stretch in 0..stretches {
        let range = stretch * y.len() / stretches..(stretch + 1) * y.len() / stretches;
        let (mut lowest, mut highest) = (range.start, range.start);
        for index in range {
            // A NaN at the start of the stretch is left as soon as a number comes.
            if y[index] < y[lowest] || y[lowest].is_nan() {
                lowest = index;
            }
            if y[index] > y[highest] || y[highest].is_nan() {
                highest = index;
            }
        }
        keep(lowest.min(highest));
        keep(lowest.max(highest));
    }
    keep(y.len() - 1);
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_and_ends_survive() {
        let mut y: Vec<f64> = (0..20_000).map(|index| (index as f64 * 0.001).sin()).collect();
        y[7_777] = 9.0;
        y[12_345] = -9.0;
        y[5] = f64::NAN;
        let kept = thin(&y, 500);
        assert!(kept.len() <= 500);
        assert!(kept.windows(2).all(|pair| pair[0] < pair[1]));
        for index in [0, 7_777, 12_345, 19_999] {
            assert!(kept.contains(&index), "{index}");
        }
    }

    #[test]
    fn a_stretch_without_a_number_is_left_out() {
        let mut y = vec![f64::NAN; 1_000];
        assert!(thin(&y, 100).is_empty());
        y[500] = 1.0;
        assert_eq!(thin(&y, 100), [500]);
        assert!(thin(&[], 100).is_empty());
    }
}
