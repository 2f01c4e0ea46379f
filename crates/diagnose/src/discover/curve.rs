//! The curve of a term as a figure shows it, with the band that leaving out stretches of recording gives.

use pam_artifact::diagnosis::EmpiricalCurve;
use pam_muscle::effects::Sentence;
use pam_muscle::effects::sentence::Argument;

use crate::state::{Setting, State};
use crate::uncertainty::jackknife_stderr;

/// Points of a curve.
const POINTS: usize = 121;
/// Standard errors to either side: 95 % for the seven degrees of freedom that eight folds leave.
const STANDARD_ERRORS: f64 = 2.36;

/// Curve of `sentence` with `amplitudes`; `folds` are those of fits that each leave one fold out.
pub(super) fn curve(
    setting: &Setting<'_>,
    state: &State,
    sentence: &Sentence,
    amplitudes: &[f64],
    folds: &[Vec<f64>],
) -> EmpiricalCurve {
    let (mut values, mut acts, mut does) = (Vec::new(), 0.0, 0.0);
    for range in &setting.track.recordings {
        let mut argument = Argument::of(sentence);
        for at in range.clone() {
            let (now, base) = (&state.sheet.seen[at], &state.sheet.base[at]);
            let value = argument.follow(now, base);
            if setting.track.counted[at] && value.is_finite() {
                values.push(value);
                let shape = sentence.value(value, amplitudes);
                acts += shape.powi(2);
                does += (sentence.scale.factor(now, base) * shape).powi(2);
            }
        }
    }
    values.sort_unstable_by(f64::total_cmp);
    // Of the scale where the term acts, since elsewhere it multiplies nothing.
    let typical = if acts > 0.0 { (does / acts).sqrt() } else { 0.0 };
    let (Some(low), Some(high)) = (values.get(values.len() / 500), values.get(values.len() - 1 - values.len() / 500))
    else {
        return EmpiricalCurve::default();
    };
    let along = |amplitudes: &[f64]| -> Vec<f64> {
        let point = |at: usize| low + (high - low) * at as f64 / (POINTS - 1) as f64;
        (0..POINTS).map(|at| typical * sentence.value(point(at), amplitudes)).collect()
    };
    let force_n = along(amplitudes);
    let each: Vec<Vec<f64>> = folds.iter().map(|amplitudes| along(amplitudes)).collect();
    let half = |at: usize| STANDARD_ERRORS * jackknife_stderr(each.iter().map(|curve| curve[at]));
    let band: Vec<f64> = (0..POINTS).map(|at| if each.is_empty() { 0.0 } else { half(at) }).collect();
    EmpiricalCurve {
        unit: sentence.memory.unit(&sentence.driver).to_owned(),
        argument: (0..POINTS).map(|at| low + (high - low) * at as f64 / (POINTS - 1) as f64).collect(),
        low_n: force_n.iter().zip(&band).map(|(force_n, half_n)| force_n - half_n).collect(),
        high_n: force_n.iter().zip(&band).map(|(force_n, half_n)| force_n + half_n).collect(),
        force_n,
        typical_scale: typical,
    }
}
