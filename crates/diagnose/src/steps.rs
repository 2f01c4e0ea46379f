//! Instants at which the residual of a recording may have jumped.

use crate::state::{Setting, State};

/// Instants per recording that are tried.
const PER_RECORDING: usize = 3;

/// Shapes (recording, instant in s) of the most likely steps: where the two sides of a cut differ most in their mean.
pub(crate) fn shapes(setting: &Setting<'_>, state: &State) -> Vec<Vec<f64>> {
    let residuals = setting.residuals_n(state);
    let mut shapes = Vec::new();
    for (index, range) in setting.track.recordings.iter().enumerate() {
        let counted: Vec<usize> = range.clone().filter(|&at| setting.track.counted[at]).collect();
        let n = counted.len();
        if n < 40 {
            continue;
        }
        let total: f64 = counted.iter().map(|&at| residuals[at]).sum();
        let mut gains = Vec::with_capacity(n);
        let mut sum = 0.0;
        for (position, &at) in counted.iter().enumerate() {
            let (left, right) = (position as f64, (n - position) as f64);
            let gain = if position >= n / 20 && position + n / 20 < n {
                let difference = sum / left - (total - sum) / right;
                difference * difference * left * right / n as f64
            } else {
                0.0
            };
            gains.push((gain, position));
            sum += residuals[at];
        }
        let mut taken: Vec<usize> = Vec::new();
        gains.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for (gain, position) in gains {
            if taken.len() == PER_RECORDING || gain <= 0.0 {
                break;
            }
            if taken.iter().all(|&other| other.abs_diff(position) > n / 20) {
                taken.push(position);
                shapes.push(vec![index as f64, setting.track.instants[counted[position]].moment.time_s]);
            }
        }
    }
    shapes
}
