//! How well the parameters of a hypothesis are known.

use nalgebra::DMatrix;
use pam_artifact::model::{ParameterEntry, ParameterStatus};
use pam_identification::search_space::SearchSpace;
use pam_muscle::effects::Kind;

use crate::joint::JointFit;
use crate::state::{Setting, State};
use crate::track::Track;

/// Standard error of what `each` is with one part after the other left out, by the jackknife; of nothing, it is not a number.
pub(crate) fn jackknife_stderr(each: impl Iterator<Item = f64> + Clone) -> f64 {
    let n = each.clone().count() as f64;
    let mean = each.clone().sum::<f64>() / n;
    let squares: f64 = each.map(|value| (value - mean).powi(2)).sum();
    ((n - 1.0) / n * squares).sqrt()
}

/// Standard errors by the jackknife over folds: base coordinates (in the unit box), then amplitudes (SI).
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// Of each free base parameter, SI.
    pub base: Vec<f64>,
    /// Of each amplitude, SI.
    pub amplitudes: Vec<f64>,
    /// Correlation between the base parameters.
    pub correlation: DMatrix<f64>,
}

impl Uncertainty {
    /// From the fits that each leave one fold out.
    pub fn of(folds: &[JointFit], space: &SearchSpace) -> Self {
        let n_free = space.free.len();
        let n = folds.len() as f64;
        let n_all = folds.first().map_or(0, |fit| fit.x.len());
        let mean: Vec<f64> = (0..n_all).map(|index| folds.iter().map(|fit| fit.x[index]).sum::<f64>() / n).collect();
        let mut covariance = DMatrix::<f64>::zeros(n_all, n_all);
        for fit in folds {
            for row in 0..n_all {
                for column in 0..n_all {
                    covariance[(row, column)] +=
                        (n - 1.0) / n * (fit.x[row] - mean[row]) * (fit.x[column] - mean[column]);
                }
            }
        }
        let stderr = |index: usize| covariance[(index, index)].sqrt();
        let correlation = DMatrix::from_fn(n_free, n_free, |row, column| {
            let scale = stderr(row) * stderr(column);
            if row == column {
                1.0
            } else if scale > 0.0 {
                covariance[(row, column)] / scale
            } else {
                0.0
            }
        });
        let n_amplitudes = folds.first().map_or(0, |fit| fit.amplitudes.len());
        let amplitudes =
            (0..n_amplitudes).map(|index| jackknife_stderr(folds.iter().map(|fit| fit.amplitudes[index]))).collect();
        let base = (0..n_free).map(|index| stderr(index) * (space.ranges[index].1 - space.ranges[index].0)).collect();
        Self { base, amplitudes, correlation }
    }
}

/// Standard error of each shape parameter of effect `index`, from the curvature of the mean square around it; none where the
/// data do not bend it, or by so little that any value in its range is as good.
pub fn shape_errors(setting: &Setting<'_>, state: &State, index: usize, correlated: f64) -> Vec<Option<f64>> {
    let guess = &state.guesses[index];
    let rows = setting.track.n_counted() as f64 / correlated;
    let cost = |shape: &[f64]| -> Option<f64> {
        let mut guesses = state.guesses.clone();
        guesses[index].shape = shape.to_vec();
        setting.fit_near(guesses, state).map(|state| state.fit.mean_square)
    };
    guess
        .effect
        .shape()
        .iter()
        .enumerate()
        .map(|(parameter, shape)| {
            // Which recording is no quantity.
            if guess.effect.kind() == Kind::Event && shape.unit == "1" {
                return None;
            }
            let here = state.fit.mean_square;
            let step = (0.05 * guess.shape[parameter].abs()).max(1e-3 * (shape.range.1 - shape.range.0).min(1.0));
            let at = |value: f64| {
                let mut moved = guess.shape.clone();
                moved[parameter] = value.clamp(shape.range.0, shape.range.1);
                cost(&moved)
            };
            let (below, above) = (at(guess.shape[parameter] - step)?, at(guess.shape[parameter] + step)?);
            let bend = (below + above - 2.0 * here) / (step * step);
            let stderr = (2.0 * here / (rows * bend)).sqrt();
            // What rounding bends is none of the data's.
            (bend > 0.0 && stderr < shape.range.1 - shape.range.0).then_some(stderr)
        })
        .collect()
}

/// Instants that share their residual with one: `1 + 2 Σ ρ`, summed until the correlation dies away.
pub fn correlated_instants(setting: &Setting<'_>, residuals_n: &[f64]) -> f64 {
    correlated(setting.track, residuals_n)
}

/// The same over the instants of `track` that count.
pub(crate) fn correlated(track: &Track, residuals_n: &[f64]) -> f64 {
    let mut sums = vec![0.0; 200];
    let mut counts = vec![0.0; 200];
    for range in &track.recordings {
        for at in range.clone().step_by(3).filter(|&at| track.counted[at]) {
            for lag in 0..sums.len() {
                if at + lag < range.end && track.counted[at + lag] {
                    sums[lag] += residuals_n[at] * residuals_n[at + lag];
                    counts[lag] += 1.0;
                }
            }
        }
    }
    let at = |lag: usize| if counts[lag] > 0.0 { sums[lag] / counts[lag] } else { 0.0 };
    let variance = at(0);
    let mut total = 1.0;
    for lag in 1..sums.len() {
        let correlation = at(lag) / variance.max(f64::MIN_POSITIVE);
        if correlation < 0.05 {
            break;
        }
        total += 2.0 * correlation;
    }
    total
}

/// Entry of an artifact for one parameter, SI.
pub fn entry(name: &str, unit: &str, value: f64, range: (f64, f64), stderr: Option<f64>) -> ParameterEntry {
    let rim = 1e-6 * (range.1 - range.0);
    let at_bound = value <= range.0 + rim || value >= range.1 - rim;
    ParameterEntry {
        name: name.to_owned(),
        value,
        unit: unit.to_owned(),
        stderr,
        status: if at_bound { ParameterStatus::AtBound } else { ParameterStatus::Fitted },
    }
}

/// Entries of an artifact for effect `index`: shapes, then amplitudes from position `first` on.
pub fn entries(
    state: &State,
    index: usize,
    first: usize,
    shape_errors: &[Option<f64>],
    uncertainty: &Uncertainty,
) -> Vec<ParameterEntry> {
    let guess = &state.guesses[index];
    let shapes = guess.effect.shape().iter().zip(&guess.shape).zip(shape_errors).map(|((shape, &value), &stderr)| {
        let found = entry(shape.name, shape.unit, value, shape.range, stderr);
        let status = match found.status {
            // When and where an event happened has no bound of physics.
            _ if guess.effect.kind() == Kind::Event => ParameterStatus::Fitted,
            // At zero, inside its range, because the data do not see it.
            ParameterStatus::Fitted if value == 0.0 && stderr.is_none() => ParameterStatus::Fixed,
            status => status,
        };
        ParameterEntry { status, ..found }
    });
    let amplitudes = guess.amplitudes().iter().enumerate().map(|(offset, amplitude)| {
        let at = first + offset;
        let value = state.fit.amplitudes[at].clamp(amplitude.range.0, amplitude.range.1);
        entry(amplitude.name, amplitude.unit, value, amplitude.range, Some(uncertainty.amplitudes[at]))
    });
    shapes.chain(amplitudes).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    #[test]
    fn a_shape_that_the_recordings_bend_has_an_error_and_neighbors_that_share_noise_count_once() {
        let mut given = Given::of(&["isobaric-triangles", "multisine"], &[("pressure-lag", &[0.15, 0.0], &[])]);
        given.disturb();
        let setting = given.setting();
        let lag = given.guess("pressure-lag", &[0.15, 0.0]);
        let state = setting.fit(vec![lag], &given.start, &given.model).expect("a fit");
        let residuals_n = setting.residuals_n(&state);
        let correlated = correlated_instants(&setting, &residuals_n);
        let error_s = |correlated: f64| shape_errors(&setting, &state, 0, correlated)[0].expect("an error");
        assert!(correlated > 1.0, "{correlated}");
        assert!(error_s(1.0) > 0.0 && error_s(1.0) < 0.05, "{}", error_s(1.0));
        // Four times as many that stand for one: twice the error.
        assert!((error_s(4.0) / error_s(1.0) - 2.0).abs() < 1e-6);
    }
}
