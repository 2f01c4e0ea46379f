//! Channels that are swapped or turned.

use pam_muscle::Muscle;
use pam_recording::Recording;

use super::Fault;
use crate::prepare::Gated;

/// Samples looked at, about, spread over a recording.
const LOOKS: usize = 4096;

/// A few thousand samples of a recording, in SI.
#[derive(Debug)]
pub struct Look {
    pressure_pa: Vec<f64>,
    length_m: Vec<f64>,
    force_n: Vec<f64>,
}

impl Look {
    /// Every so-many-th sample.
    ///
    /// # Errors
    /// Where samples cannot be read back.
    pub fn at(recording: &Recording) -> std::io::Result<Self> {
        let stride = (recording.samples.n_rows() / LOOKS).max(1);
        let mut look = Self { pressure_pa: Vec::new(), length_m: Vec::new(), force_n: Vec::new() };
        for chunk in recording.samples.chunks() {
            let chunk = chunk?;
            let first = chunk.first_row().next_multiple_of(stride) - chunk.first_row();
            for here in (first..chunk.n_rows()).step_by(stride) {
                look.pressure_pa.push(chunk.pressure_pa()[here]);
                look.length_m.push(chunk.length_m()[here]);
                look.force_n.push(chunk.force_n()[here]);
            }
        }
        Ok(look)
    }

    /// Of samples that are at hand.
    #[cfg(test)]
    pub(super) fn of(rows: impl Iterator<Item = (f64, f64, f64)>) -> Self {
        let mut look = Self { pressure_pa: Vec::new(), length_m: Vec::new(), force_n: Vec::new() };
        for (pressure_pa, length_m, force_n) in rows {
            look.pressure_pa.push(pressure_pa);
            look.length_m.push(length_m);
            look.force_n.push(force_n);
        }
        look
    }

    /// Pressure, length and force of each sample.
    pub(super) fn rows(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let forces = self.pressure_pa.iter().zip(&self.length_m).zip(&self.force_n);
        forces.map(|((&pressure_pa, &length_m), &force_n)| (pressure_pa, length_m, force_n))
    }
}

/// Correlation between `force` and an ideal muscle's; free of scale, so that a unit slip does not matter.
fn ideal_correlation(muscle: &Muscle, pressure: &[f64], length_m: &[f64], force: &[f64]) -> f64 {
    let gas = pam_muscle::force::gas::Gas::new(muscle);
    let ideal: Vec<f64> = pressure
        .iter()
        .zip(length_m)
        .map(|(&pressure, &length)| gas.force_n(pressure, muscle.contraction_ratio(length), 1.0, 1.0))
        .collect();
    correlation(&ideal, force)
}

fn correlation(left: &[f64], right: &[f64]) -> f64 {
    let n = left.len().max(1) as f64;
    let (mean_left, mean_right) = (left.iter().sum::<f64>() / n, right.iter().sum::<f64>() / n);
    let (mut cross, mut squares_left, mut squares_right) = (0.0, 0.0, 0.0);
    for (left, right) in left.iter().zip(right) {
        cross += (left - mean_left) * (right - mean_right);
        squares_left += (left - mean_left).powi(2);
        squares_right += (right - mean_right).powi(2);
    }
    let scale = (squares_left * squares_right).sqrt();
    if scale > 0.0 { cross / scale } else { 0.0 }
}

/// Lengths in m if the numbers of a channel were millimeters under its name: the scale that brings them
/// nearest to the rest length.
fn as_length_m(values: &[f64], muscle: &Muscle) -> Option<Vec<f64>> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    (-8..=3)
        .map(|power| 10_f64.powi(power))
        .find(|scale| (0.55..1.08).contains(&(mean * scale / muscle.rest_length_m)))
        .map(|scale| values.iter().map(|value| value * scale).collect())
}

/// Channels that follow an ideal muscle only after two of them are exchanged.
pub fn swapped(gate: &Gated, look: &Look, muscle: &Muscle) -> Option<Fault> {
    let as_is = ideal_correlation(muscle, &look.pressure_pa, &look.length_m, &look.force_n);
    if as_is.is_finite() && as_is.abs() > 0.7 && lengths_fit(&look.length_m, muscle) {
        return None;
    }
    let mut candidates: Vec<(&'static str, &'static str, f64)> = Vec::new();
    if lengths_fit(&look.length_m, muscle) {
        candidates.push((
            "pressure",
            "force",
            ideal_correlation(muscle, &look.force_n, &look.length_m, &look.pressure_pa),
        ));
    } else {
        // A length that is one of this muscle is no other channel: forces of 200 to 260 N could be millimeters of it as well, and in
        // a short piece of a small loop the correlations of both are chance.
        if let Some(length_m) = as_length_m(&look.pressure_pa, muscle) {
            candidates.push((
                "pressure",
                "length",
                ideal_correlation(muscle, &look.length_m, &length_m, &look.force_n),
            ));
        }
        if let Some(length_m) = as_length_m(&look.force_n, muscle) {
            candidates.push((
                "length",
                "force",
                ideal_correlation(muscle, &look.pressure_pa, &length_m, &look.length_m),
            ));
        }
    }
    let mut best: Option<(&'static str, &'static str, f64)> = None;
    for candidate in candidates {
        if candidate.2 > 0.9 && best.is_none_or(|best| candidate.2 > best.2) {
            best = Some(candidate);
        }
    }
    let (first, second, swapped) = best?;
    let as_is = if as_is.is_finite() { as_is } else { 0.0 };
    Some(Fault::Swapped { path: gate.recording.path.clone(), first, second, as_is, swapped })
}

fn lengths_fit(length_m: &[f64], muscle: &Muscle) -> bool {
    length_m.iter().all(|&length| (-0.1..0.5).contains(&muscle.contraction_ratio(length)))
}

/// A force that falls where an ideal muscle's rises.
pub fn wrong_sign(gate: &Gated, look: &Look, muscle: &Muscle) -> Option<Fault> {
    let correlation = ideal_correlation(muscle, &look.pressure_pa, &look.length_m, &look.force_n);
    (correlation < -0.6).then(|| Fault::WrongSign {
        path: gate.recording.path.clone(),
        correlation,
        remedy: "force_N = -1 * force_N",
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::prepare::gate;
    use pam_recording::{Repairs, Samples};

    #[test]
    fn millimeters_under_the_name_of_newtons_are_found() {
        let model = crate::testing::model();
        let pressure_pa: Vec<f64> = (0..400).map(|row| 3e5 + 40.0 * f64::from(row * 7919 % 101)).collect();
        let length_m: Vec<f64> = (0..400).map(|row| 0.24 + 1e-3 * (0.015 * f64::from(row)).sin()).collect();
        let force_n: Vec<f64> = length_m.iter().map(|length_m| model.force_n(3e5, *length_m, 0.0) - 60.0).collect();
        let time_s: Vec<f64> = (0..400).map(|row| 0.01 * f64::from(row)).collect();
        let as_length_m: Vec<f64> = force_n.iter().map(|n| 1e-3 * n).collect();
        let as_force_n: Vec<f64> = length_m.iter().map(|m| 1e3 * m).collect();
        let samples = Samples::from_columns(&time_s, &pressure_pa, &as_length_m, &as_force_n);
        let segments = vec![0..samples.n_rows(); 1];
        let (sha256, repairs) = (String::new(), Repairs::default());
        let path = "loop.csv".to_owned();
        let recording = Recording { path, sha256, samples, segments, repairs, ignored_columns: Vec::new() };
        let gate = gate(vec![recording]).unwrap().remove(0);
        let found = swapped(&gate, &Look::at(&gate.recording).unwrap(), model.muscle());
        assert!(matches!(found, Some(Fault::Swapped { first: "length", second: "force", .. })), "{found:?}");
    }
}
