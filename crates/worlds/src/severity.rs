//! How large an effect is beside the sensors, after a linear refit of a generic static map.
//!
//! ```text
//! severity = rms(r_with − r_without) / floor
//! ```
//!
//! `r`: what a least-squares fit leaves of the force without noise. The fit knows nothing of muscles: polynomials of degree 2
//! in pressure times degree 4 in length, friction by the state of the undisturbed braid times 1, p, p^(5/3) and p L, and a
//! constant per recording.

use crate::sensors::Log;

const DEGREE_PRESSURE: usize = 2;
const DEGREE_LENGTH: usize = 4;
/// Samples that a refit looks at, at most.
const SAMPLES: usize = 6000;

/// Chebyshev polynomials 0 to `N − 1` at `x`.
fn chebyshev<const N: usize>(x: f64) -> [f64; N] {
    let mut values = [1.0; N];
    for order in 1..N {
        values[order] = if order == 1 { x } else { 2.0 * x * values[order - 1] - values[order - 2] };
    }
    values
}

/// Scales that bring pressure and length to −1…1.
#[derive(Debug, Clone, Copy)]
pub struct Scales {
    /// Middle and half range of pressure, Pa.
    pub pressure: (f64, f64),
    /// Middle and half range of length, m.
    pub length: (f64, f64),
}

/// What the refit leaves of each sample it looks at; `states` come from a run without the effect.
pub fn residuals(logs: &[Log], states: &[Log], scales: Scales) -> Vec<f64> {
    let total: usize = logs.iter().map(|log| log.true_force_n.len()).sum();
    let stride = total.div_ceil(SAMPLES).max(1);
    let width = (DEGREE_PRESSURE + 1) * (DEGREE_LENGTH + 1) + 4 + logs.len() - 1;
    let mut rows: Vec<f64> = Vec::new();
    let mut right: Vec<f64> = Vec::new();
    for (recording, log) in logs.iter().enumerate() {
        for index in (0..log.true_force_n.len()).step_by(stride) {
            let (pressure_pa, length_m) = log.true_inputs[index];
            let p = (pressure_pa - scales.pressure.0) / scales.pressure.1;
            let l = (length_m - scales.length.0) / scales.length.1;
            let (of_p, of_l) = (chebyshev::<{ DEGREE_PRESSURE + 1 }>(p), chebyshev::<{ DEGREE_LENGTH + 1 }>(l));
            for a in of_p {
                rows.extend(of_l.iter().map(|b| a * b));
            }
            let state = states[recording].state[index.min(states[recording].state.len() - 1)];
            let unit = (pressure_pa / (scales.pressure.0 + scales.pressure.1)).max(0.0);
            rows.extend([state, state * unit, state * unit.powf(5.0 / 3.0), state * unit * l]);
            rows.extend((1..logs.len()).map(|other| if other == recording { 1.0 } else { 0.0 }));
            right.push(log.true_force_n[index]);
        }
    }
    let solution = least_squares(&rows, &right, width);
    rows.chunks_exact(width)
        .zip(&right)
        .map(|(row, right)| right - row.iter().zip(&solution).map(|(a, x)| a * x).sum::<f64>())
        .collect()
}

/// What the best cylinder leaves, N rms: pressure times degree 2 in length, pressure squared, the bladder of an ideal
/// cylinder with a slope, friction in three terms and a constant per recording.
pub fn cylinder_misfit_n(logs: &[Log], scales: Scales, bladder_n: impl Fn(f64) -> f64) -> f64 {
    let total: usize = logs.iter().map(|log| log.true_force_n.len()).sum();
    let stride = total.div_ceil(SAMPLES).max(1);
    let width = 9 + logs.len();
    let (mut rows, mut right) = (Vec::new(), Vec::new());
    for (recording, log) in logs.iter().enumerate() {
        for index in (0..log.true_force_n.len()).step_by(stride) {
            let (pressure_pa, length_m) = log.true_inputs[index];
            let p = pressure_pa / (scales.pressure.0 + scales.pressure.1);
            let l = (length_m - scales.length.0) / scales.length.1;
            let (bladder, z) = (0.02 * bladder_n(length_m), log.state[index]);
            rows.extend([p, p * l, p * l * l, p * p, bladder, bladder * l, z, z * p, z * p.max(0.0).powf(5.0 / 3.0)]);
            rows.extend((0..logs.len()).map(|other| if other == recording { 1.0 } else { 0.0 }));
            right.push(log.true_force_n[index]);
        }
    }
    let solution = least_squares(&rows, &right, width);
    let left: Vec<f64> =
        rows.chunks_exact(width).map(|row| row.iter().zip(&solution).map(|(a, x)| a * x).sum()).collect();
    rms_difference(&left, &right)
}

/// Least squares by normal equations with a trace of ridge, for columns that a protocol does not excite.
fn least_squares(rows: &[f64], right: &[f64], width: usize) -> Vec<f64> {
    let mut normal = vec![0.0; width * width];
    let mut moment = vec![0.0; width];
    for (row, value) in rows.chunks_exact(width).zip(right) {
        for i in 0..width {
            moment[i] += row[i] * value;
            for j in 0..=i {
                normal[i * width + j] += row[i] * row[j];
            }
        }
    }
    for i in 0..width {
        normal[i * width + i] += 1e-9 * right.len() as f64;
    }
    // Cholesky, in place of the lower triangle.
    for i in 0..width {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| normal[i * width + k] * normal[j * width + k]).sum();
            let rest = normal[i * width + j] - sum;
            normal[i * width + j] = if i == j { rest.max(1e-12).sqrt() } else { rest / normal[j * width + j] };
        }
    }
    let mut solution = moment;
    for i in 0..width {
        let sum: f64 = (0..i).map(|k| normal[i * width + k] * solution[k]).sum();
        solution[i] = (solution[i] - sum) / normal[i * width + i];
    }
    for i in (0..width).rev() {
        let sum: f64 = (i + 1..width).map(|k| normal[k * width + i] * solution[k]).sum();
        solution[i] = (solution[i] - sum) / normal[i * width + i];
    }
    solution
}

/// Root mean square of a difference.
pub fn rms_difference(with: &[f64], without: &[f64]) -> f64 {
    let sum: f64 = with.iter().zip(without).map(|(a, b)| (a - b).powi(2)).sum();
    (sum / with.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(extra: impl Fn(f64, f64) -> f64) -> Log {
        let mut log = Log::default();
        for index in 0..4000 {
            let t = f64::from(index) * 0.01;
            let (p, l) = (2e5 + 1e5 * (0.7 * t).sin(), 0.23 + 0.02 * (1.1 * t).cos());
            let state = -(1.1 * t).sin().signum();
            log.true_inputs.push((p, l));
            log.state.push(state);
            log.true_force_n.push(1e-3 * p * (1.0 + 40.0 * (l - 0.25)) - 5e-5 * p * state + extra(p, l));
        }
        log
    }

    const SCALES: Scales = Scales { pressure: (2e5, 1e5), length: (0.23, 0.02) };

    #[test]
    fn what_a_static_map_absorbs_has_no_severity() {
        let plain = [log(|_, _| 0.0)];
        let without = residuals(&plain, &plain, SCALES);
        let absorbed = residuals(&[log(|p, l| 3.0 + 1e-5 * p * l)], &plain, SCALES);
        assert!(rms_difference(&absorbed, &without) < 1e-3);
    }

    #[test]
    fn what_it_cannot_absorb_keeps_its_size() {
        let plain = [log(|_, _| 0.0)];
        let without = residuals(&plain, &plain, SCALES);
        let seen = residuals(&[log(|_, l| 2.0 * (3000.0 * l).sin())], &plain, SCALES);
        assert!(rms_difference(&seen, &without) > 1.0);
    }
}
