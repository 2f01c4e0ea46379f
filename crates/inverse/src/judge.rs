//! What a network is worth: errors on points that the training never saw, where the inverse exists.

use pam_artifact::inverse::{ErrorReport, ErrorStatistics, RegionErrors};

use rayon::prelude::*;

use crate::coverage::coverage;
use crate::design::{Draw, Point, points};
use crate::{ExactInverse, InverseNetwork};

/// Bins of pressure and of length.
const BINS: usize = 5;

/// A point and what the network makes of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// The point.
    pub point: Point,
    /// Pressure of the network less that of the point, in Pa.
    pub pressure_error_pa: f64,
    /// Force of the model at the network's pressure less that of the point, in N.
    pub force_error_n: f64,
    /// Whether the network holds the point to be outside its domain, which it should not.
    pub outside: bool,
}

/// Judges a network on `n` independent points.
pub fn judge(network: &InverseNetwork, exact: &ExactInverse, n: usize, seed: u64) -> Vec<Judged> {
    points(exact, n, Draw::Independent, seed)
        .into_par_iter()
        .map(|point| {
            let Point { pressure_pa, length_m, direction, force_n } = point;
            let answer = network.pressure_pa(force_n, length_m, direction);
            Judged {
                point,
                pressure_error_pa: answer.pressure_pa - pressure_pa,
                force_error_n: exact.model().settled_force_n(answer.pressure_pa, length_m, direction) - force_n,
                outside: answer.outside,
            }
        })
        .collect()
}

/// Size of `errors`; none where there is no error to speak of.
pub fn statistics(errors: impl IntoIterator<Item = f64>) -> Option<ErrorStatistics> {
    let errors: Vec<f64> = errors.into_iter().collect();
    let n = errors.len();
    if n == 0 {
        return None;
    }
    let mut sizes: Vec<f64> = errors.iter().map(|error| error.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let quantile = |share: f64| sizes[((n - 1) as f64 * share).round() as usize];
    Some(ErrorStatistics {
        n,
        rmse: (errors.iter().map(|error| error * error).sum::<f64>() / n as f64).sqrt(),
        median: quantile(0.5),
        p95: quantile(0.95),
        max: sizes[n - 1],
        mean: errors.iter().sum::<f64>() / n as f64,
    })
}

/// Errors as an artifact keeps them; none where no point was judged.
pub fn report(judged: &[Judged], exact: &ExactInverse) -> Option<ErrorReport> {
    let inverse_box = exact.inverse_box();
    let pressure_pa = statistics(judged.iter().map(|judged| judged.pressure_error_pa))?;
    let force_n = statistics(judged.iter().map(|judged| judged.force_error_n))?;
    let mut regions = Vec::new();
    let mut cut = |coordinate: &str, [from, to]: [f64; 2], n_bins: usize, of: fn(&Point) -> f64| {
        let edge = |bin: usize| from + (to - from) * bin as f64 / n_bins as f64;
        let bin_of =
            |judged: &&Judged| (((of(&judged.point) - from) / (to - from) * n_bins as f64) as usize).min(n_bins - 1);
        for bin in 0..n_bins {
            let inside = judged.iter().filter(|judged| bin_of(judged) == bin);
            regions.push(RegionErrors {
                coordinate: coordinate.to_owned(),
                from: edge(bin),
                to: edge(bin + 1),
                pressure_pa: statistics(inside.map(|judged| judged.pressure_error_pa)),
            });
        }
    };
    cut("pressure_pa", inverse_box.pressure_pa, BINS, |point| point.pressure_pa);
    cut("length_m", inverse_box.length_m, BINS, |point| point.length_m);
    cut("direction", [-1.0, 1.0], 2, |point| point.direction);
    Some(ErrorReport {
        coverage: coverage(exact),
        pressure_rmse_percent: 100.0 * pressure_pa.rmse / inverse_box.pressure_span_pa(),
        force_rmse_percent: 100.0 * force_n.rmse / inverse_box.force_span_n(),
        pressure_pa,
        force_n,
        regions,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_by_hand() {
        let found = statistics([1.0, -3.0, 2.0]).unwrap();
        assert!((found.rmse - (14.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!((found.n, found.median, found.p95, found.max, found.mean), (3, 2.0, 3.0, 3.0, 0.0));
        assert_eq!(statistics([]), None);
    }
}
