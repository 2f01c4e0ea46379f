//! The error of one instrument with which a model would follow a recording that it misses.
//!
//! A model is known, so that each fault of an instrument is one number: the hypothesis is that the recorded channel `y` is not
//! the true one `x`, and the number is the one that leaves least of the force.
//!
//! | fault     | equation         | looked for in                                                            |
//! |-----------|------------------|--------------------------------------------------------------------------|
//! | gain      | `y = g x`        | force: any; pressure: 1/20 to 20; length: 0.7 to 1.4                     |
//! | zero      | `y = x + z`      | force: any; pressure: ±150 kPa; length: ±0.3 rest lengths                |
//! | lag       | `y(t) = x(t - τ)`| ±0.5 s                                                                   |
//! | backward  | rows turned round| friction has the wrong sign                                              |
//!
//! A fault is said where it explains most of what the model misses beyond what it missed of its own recordings, and leaves about
//! as much as that; faults that explain as much are said beside it. Where none does, it is the muscle that is another, or physics
//! that the model lacks.

use pam_artifact::{InputRole, ModelArtifact};
use pam_muscle::effects::AugmentedModel;
use pam_muscle::force::ForceModel;

use super::noise;
use super::scale::unit_words;
use crate::error::IdentifyError;
use crate::evaluate::noise_floor_n;
use crate::prepare::Prepared;
use crate::trace::{Trace, trace_augmented};

/// Times what the model missed of its own recordings, or what sensors or a refit leave, beyond which it misses one: half as much
/// again. To its own recordings a model is within a percent of its refit; a gain of 2 % makes ten times as much.
pub const MISSES: f64 = 1.5;

/// Times the worst of its own recordings: a fit to the same samples by another law of standstill moves that by some percent.
const WORST: f64 = 1.1;

/// Share of the RMSE beyond that on the model's own recordings that may be left.
const LEFT: f64 = 0.5;
/// How often the RMSE on the model's own recordings may be left: recordings of one muscle differ by about two.
const TIMES_OWN: f64 = 2.5;
/// Faults that leave at most so many times what the best one leaves are said beside it.
const ALIKE: f64 = 1.2;
/// Samples that take part, about.
const SAMPLES: usize = 2000;
/// Gains of a pressure, as powers of the pitch, and of a length.
const PRESSURE_GAIN_PITCH: f64 = 1.05;
const PRESSURE_GAIN_STEPS: i32 = 61;
const LENGTH_GAINS: (f64, f64) = (0.7, 1.4);
/// Zero of a pressure, in Pa, and of a length, in rest lengths.
const PRESSURE_ZERO_PA: f64 = 150e3;
const LENGTH_ZERO: f64 = 0.3;
/// Largest lag, in s.
const LARGEST_LAG_S: f64 = 0.5;
/// Points of a first look, and halvings of the pitch after it.
const POINTS: usize = 61;
const HALVINGS: usize = 12;

/// A channel's fault.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wrong {
    /// Times the true value.
    Gain(f64),
    /// Added to the true value, in SI.
    Zero(f64),
    /// Later than the other channels, in s.
    Late(f64),
    /// Rows in the reverse order.
    Backward,
}

/// A fault that would explain a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// `force`, `pressure`, `length` or `time`.
    pub channel: &'static str,
    /// Its fault.
    pub wrong: Wrong,
    /// RMSE that it leaves, in N.
    pub left_n: f64,
}

impl Reading {
    /// The fault in words, with the unit that would be behind it.
    pub fn words(&self) -> String {
        let channel = self.channel;
        match self.wrong {
            Wrong::Gain(gain) if gain < 0.0 => {
                format!("the {channel} reads {gain:.3} times what it should: its sign is turned")
            }
            Wrong::Gain(gain) => {
                let unit = unit_words(channel, gain).map_or(String::new(), |words| format!(" ({words})"));
                format!("the {channel} reads {gain:.3} times what it should{unit}")
            }
            Wrong::Zero(zero) => {
                let (scale, unit) = match channel {
                    "pressure" => (1e-3, "kPa"),
                    "length" => (1e3, "mm"),
                    _ => (1.0, "N"),
                };
                let word = if zero > 0.0 { "much" } else { "little" };
                format!("the {channel} reads {:.2} {unit} too {word}", zero.abs() * scale)
            }
            Wrong::Late(late_s) => {
                let word = if late_s > 0.0 { "late" } else { "early" };
                format!("the {channel} comes {:.0} ms {word}", late_s.abs() * 1e3)
            }
            Wrong::Backward => "time runs backward".to_owned(),
        }
    }
}

/// Whether `model` misses a recording by `rmse_n`, of which the sensors alone leave `floor_n`: by half as much again as its own
/// recordings together, and by more than the one of them that it follows worst.
pub fn is_missed(model: &ModelArtifact, rmse_n: f64, floor_n: f64) -> bool {
    let n_fitted = model.inputs.iter().filter(|input| input.role == InputRole::Estimation).count();
    let each = model.fit.recordings.iter().take(n_fitted).map(|recording| recording.statistics.rmse_n);
    rmse_n > MISSES * own_n(model).max(floor_n) && rmse_n > WORST * each.fold(0.0, f64::max)
}

/// Message about a recording that `model`, with the effects and memories of `artifact`, misses by `rmse_n`; nothing where it
/// follows it as it followed its own.
///
/// # Errors
/// [`IdentifyError::Samples`] where samples cannot be read back.
pub fn missed(
    prepared: &Prepared,
    artifact: &ModelArtifact,
    model: &AugmentedModel,
    rmse_n: f64,
) -> Result<Option<String>, IdentifyError> {
    let floor_n = noise_floor_n(std::slice::from_ref(prepared), model.base())?;
    let floor_n = if noise::is_noise(floor_n, rmse_n) { floor_n } else { 0.0 };
    // A worse sensor is no other muscle.
    if !is_missed(artifact, rmse_n, floor_n) {
        return Ok(None);
    }
    let own_n = own_n(artifact).max(floor_n);
    let trace = trace_augmented(prepared, model, artifact.direction, 0)?;
    let reason = match said(&explain(&[trace], model.base(), own_n)) {
        Some(instrument) => format!("{instrument}, or it is of another muscle"),
        None => "it is of another muscle, or of more physics than the model has: pam-diagnose tells".to_owned(),
    };
    Ok(Some(format!(
        "{}: the model misses this recording by {rmse_n:.2} N, and those that it was identified on by {:.2} N: {reason}",
        prepared.recording.path, artifact.fit.estimation.rmse_n
    )))
}

/// RMSE of `model` on its own recordings, never below what their sensors leave, in N.
pub fn own_n(model: &ModelArtifact) -> f64 {
    model.fit.estimation.rmse_n.max(model.fit.noise_floor_n)
}

/// Faults that would each explain `traces`, in words, with what they leave.
pub fn said(readings: &[Reading]) -> Option<String> {
    let words: Vec<String> = readings.iter().map(Reading::words).collect();
    let left_n = readings.first()?.left_n;
    Some(format!("{} ({left_n:.2} N would be left)", words.join(", or ")))
}

/// Samples of a model's misses, with the force of the base at other readings.
struct Misses<'a> {
    traces: &'a [Trace],
    model: &'a ForceModel,
    /// Of each sample that takes part: trace, index, force of the effects.
    samples: Vec<(usize, usize, f64)>,
}

/// Faults of instruments that would explain why `model` (with effects, as the traces have it) misses `traces`, the likeliest
/// first; `own_n` is what it missed of its own recordings, in N.
pub fn explain(traces: &[Trace], model: &ForceModel, own_n: f64) -> Vec<Reading> {
    let misses = Misses::of(traces, model);
    let as_is_n = misses.rmse_n(|pressure_pa, length_m, _, _| (pressure_pa, length_m));
    let mut found = vec![misses.force_gain(), misses.force_zero(), misses.backward()];
    let pitch = PRESSURE_GAIN_PITCH.ln() * f64::from(PRESSURE_GAIN_STEPS);
    found.push(misses.search("pressure", (-pitch, pitch), |x| Wrong::Gain(x.exp())));
    found.push(misses.search("length", (LENGTH_GAINS.0.ln(), LENGTH_GAINS.1.ln()), |x| Wrong::Gain(x.exp())));
    found.push(misses.search("pressure", (-PRESSURE_ZERO_PA, PRESSURE_ZERO_PA), Wrong::Zero));
    let zero_m = LENGTH_ZERO * model.muscle().rest_length_m;
    found.push(misses.search("length", (-zero_m, zero_m), Wrong::Zero));
    for channel in ["force", "pressure", "length"] {
        found.push(misses.search(channel, (-LARGEST_LAG_S, LARGEST_LAG_S), Wrong::Late));
    }
    let excess_n = |rmse_n: f64| (rmse_n * rmse_n - own_n * own_n).max(0.0).sqrt();
    let explains = |left_n: f64| left_n <= TIMES_OWN * own_n && excess_n(left_n) < LEFT * excess_n(as_is_n);
    found.retain(|reading| explains(reading.left_n));
    found.sort_by(|left, right| left.left_n.total_cmp(&right.left_n));
    if let Some(&best) = found.first() {
        found.retain(|reading| reading.left_n <= ALIKE * best.left_n.max(own_n));
    }
    found
}

impl<'a> Misses<'a> {
    fn of(traces: &'a [Trace], model: &'a ForceModel) -> Self {
        let n: usize = traces.iter().map(|trace| trace.settled.iter().filter(|settled| **settled).count()).sum();
        let stride = n.div_ceil(SAMPLES).max(1);
        let settled = traces.iter().enumerate().flat_map(|(index, trace)| {
            trace.settled.iter().enumerate().filter(|(_, settled)| **settled).map(move |(at, _)| (index, at))
        });
        let samples = settled
            .step_by(stride)
            .map(|(index, at)| {
                let trace = &traces[index];
                let base_n = model.force_n(trace.pressure_pa[at], trace.length_m[at], trace.direction[at]);
                (index, at, trace.model_n[at] - base_n)
            })
            .collect();
        Self { traces, model, samples }
    }

    /// RMSE where pressure and length truly were what `truly` makes of them, of trace and index.
    fn rmse_n(&self, truly: impl Fn(f64, f64, &Trace, usize) -> (f64, f64)) -> f64 {
        self.rms(|trace, at, effects_n| {
            let (pressure_pa, length_m) = truly(trace.pressure_pa[at], trace.length_m[at], trace, at);
            trace.force_n[at] - self.model.force_n(pressure_pa, length_m, trace.direction[at]) - effects_n
        })
    }

    fn rms(&self, residual_n: impl Fn(&Trace, usize, f64) -> f64) -> f64 {
        let squares = self.samples.iter().map(|&(index, at, effects_n)| {
            let residual_n = residual_n(&self.traces[index], at, effects_n);
            residual_n * residual_n
        });
        let mean = squares.sum::<f64>() / self.samples.len().max(1) as f64;
        if mean.is_finite() { mean.sqrt() } else { f64::INFINITY }
    }

    fn sum(&self, of: impl Fn(f64, f64) -> f64) -> f64 {
        let both = |&(index, at, _): &(usize, usize, f64)| {
            let trace: &Trace = &self.traces[index];
            of(trace.force_n[at], trace.model_n[at])
        };
        self.samples.iter().map(both).sum()
    }

    fn force_gain(&self) -> Reading {
        let gain = self.sum(|force_n, model_n| force_n * model_n) / self.sum(|_, model_n| model_n * model_n);
        let left_n = self.rms(|trace, at, _| trace.force_n[at] - gain * trace.model_n[at]);
        // In the unit of the model's force: a force in a unit a thousand times too small leaves nothing by itself.
        let left_n = left_n / gain.abs().min(1.0);
        Reading { channel: "force", wrong: Wrong::Gain(gain), left_n }
    }

    fn force_zero(&self) -> Reading {
        let zero_n = self.sum(|force_n, model_n| force_n - model_n) / self.samples.len().max(1) as f64;
        let left_n = self.rms(|trace, at, _| trace.force_n[at] - zero_n - trace.model_n[at]);
        Reading { channel: "force", wrong: Wrong::Zero(zero_n), left_n }
    }

    /// Friction opposes motion, and the rows say the opposite of where it went.
    fn backward(&self) -> Reading {
        let left_n = self.rms(|trace, at, effects_n| {
            let model_n = self.model.force_n(trace.pressure_pa[at], trace.length_m[at], -trace.direction[at]);
            trace.force_n[at] - model_n - effects_n
        });
        Reading { channel: "time", wrong: Wrong::Backward, left_n }
    }

    /// The value between `low` and `high` that leaves least: on a grid, then by halves of its pitch.
    fn search(&self, channel: &'static str, (low, high): (f64, f64), wrong: impl Fn(f64) -> Wrong) -> Reading {
        let at = |x: f64| Reading { channel, wrong: wrong(x), left_n: self.left_n(channel, wrong(x)) };
        let mut pitch = (high - low) / (POINTS - 1) as f64;
        let mut best = (0.0, at(0.0));
        let mut take = |x: f64| {
            let candidate = at(x);
            if candidate.left_n < best.1.left_n {
                best = (x, candidate);
            }
            best
        };
        for point in 0..POINTS {
            take(low + point as f64 * pitch);
        }
        for _ in 0..HALVINGS {
            pitch *= 0.5;
            let (here, _) = take(0.0);
            take(here - pitch);
            take(here + pitch);
        }
        best.1
    }

    fn left_n(&self, channel: &str, wrong: Wrong) -> f64 {
        match (channel, wrong) {
            ("pressure", Wrong::Gain(gain)) => {
                self.rmse_n(|pressure_pa, length_m, _, _| (pressure_pa / gain, length_m))
            }
            ("length", Wrong::Gain(gain)) => self.rmse_n(|pressure_pa, length_m, _, _| (pressure_pa, length_m / gain)),
            ("pressure", Wrong::Zero(zero)) => {
                self.rmse_n(|pressure_pa, length_m, _, _| (pressure_pa - zero, length_m))
            }
            ("length", Wrong::Zero(zero)) => self.rmse_n(|pressure_pa, length_m, _, _| (pressure_pa, length_m - zero)),
            ("pressure", Wrong::Late(late_s)) => self.rmse_n(|_, length_m, trace, at| {
                (interpolated(&trace.time_s, &trace.pressure_pa, at, late_s), length_m)
            }),
            ("length", Wrong::Late(late_s)) => self.rmse_n(|pressure_pa, _, trace, at| {
                (pressure_pa, interpolated(&trace.time_s, &trace.length_m, at, late_s))
            }),
            ("force", Wrong::Late(late_s)) => {
                self.rms(|trace, at, _| interpolated(&trace.time_s, &trace.force_n, at, late_s) - trace.model_n[at])
            }
            _ => f64::INFINITY,
        }
    }
}

/// `values` later than row `at` by `after_s`, between rows in a straight line; at the ends what is there.
fn interpolated(time_s: &[f64], values: &[f64], at: usize, after_s: f64) -> f64 {
    let when_s = time_s[at] + after_s;
    let next = time_s.partition_point(|time_s| *time_s < when_s);
    if next == 0 || next == time_s.len() {
        return values[next.saturating_sub(1)];
    }
    let share = (when_s - time_s[next - 1]) / (time_s[next] - time_s[next - 1]);
    values[next - 1] + share * (values[next] - values[next - 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    use pam_muscle::Muscle;
    use pam_muscle::force::{BaseParameters, Form};

    use crate::testing::model;

    /// Pressure and length that wander apart from one another, read by instruments that do `wrong` to them and to the force.
    fn read(wrong: impl Fn(f64, [f64; 3]) -> [f64; 3]) -> Trace {
        let model = model();
        let truth = |t: f64| {
            let pressure_pa = 2.5e5 + 1.5e5 * (1.3 * t).sin();
            let length_m = 0.24 + 0.02 * (0.7 * t + 1.0).sin();
            let direction = if (0.7 * t + 1.0).cos() < 0.0 { 1.0 } else { -1.0 };
            ([pressure_pa, length_m, model.force_n(pressure_pa, length_m, direction)], direction)
        };
        let mut trace = Trace::default();
        for row in 0..4000_i32 {
            let time_s = 0.01 * f64::from(row);
            let ([pressure_pa, length_m, force_n], direction) = truth(time_s);
            let noise_n = f64::from(row * 7919 % 101) * 0.01 - 0.5;
            let [pressure_pa, length_m, force_n] = wrong(time_s, [pressure_pa, length_m, force_n + noise_n]);
            trace.time_s.push(time_s);
            trace.pressure_pa.push(pressure_pa);
            trace.length_m.push(length_m);
            trace.force_n.push(force_n);
            trace.model_n.push(model.force_n(pressure_pa, length_m, direction));
            trace.direction.push(direction);
            trace.settled.push(true);
        }
        trace
    }

    fn first(wrong: impl Fn(f64, [f64; 3]) -> [f64; 3]) -> Option<String> {
        explain(&[read(wrong)], &model(), 0.3).first().map(Reading::words)
    }

    #[test]
    fn a_gain_or_a_zero_of_each_channel_is_found_with_its_size() {
        assert_eq!(first(|_, channels| channels), None);
        assert_eq!(first(|_, [p, l, f]| [p, l, 1.15 * f]).unwrap(), "the force reads 1.150 times what it should");
        assert_eq!(first(|_, [p, l, f]| [1.2 * p, l, f]).unwrap(), "the pressure reads 1.200 times what it should");
        assert_eq!(first(|_, [p, l, f]| [p, 1.02 * l, f]).unwrap(), "the length reads 1.020 times what it should");
        assert_eq!(first(|_, [p, l, f]| [p, l, f - 20.0]).unwrap(), "the force reads 20.00 N too little");
        assert_eq!(first(|_, [p, l, f]| [p + 20e3, l, f]).unwrap(), "the pressure reads 20.00 kPa too much");
        assert_eq!(first(|_, [p, l, f]| [p, l - 6e-3, f]).unwrap(), "the length reads 6.00 mm too little");
    }

    #[test]
    fn a_unit_under_the_wrong_name_is_named() {
        let said = first(|_, [p, l, f]| [p, l, f / 4.448]).unwrap();
        assert!(said.contains("lbf under a header that says N"), "{said}");
        let said = first(|_, [p, l, f]| [p / 6.895, l, f]).unwrap();
        assert!(said.contains("psi under a header that says kPa"), "{said}");
        let said = first(|_, [p, l, f]| [p, l, -f]).unwrap();
        assert!(said.contains("its sign is turned"), "{said}");
    }

    #[test]
    fn a_channel_that_comes_late_is_found() {
        let late = read(|t, [p, l, f]| [if t < 0.2 { p } else { 2.5e5 + 1.5e5 * (1.3 * (t - 0.2)).sin() }, l, f]);
        let found = explain(&[late], &model(), 0.3);
        let Some(Reading { channel: "pressure", wrong: Wrong::Late(late_s), .. }) = found.first() else {
            panic!("{found:?}")
        };
        assert!((late_s - 0.2).abs() < 5e-3, "{late_s}");
    }

    #[test]
    fn another_muscle_is_no_fault_of_an_instrument() {
        let other = Muscle { braid_angle_rad: 30.0_f64.to_radians(), ..model().muscle().clone() };
        let parameters = BaseParameters { theta: [0.8, 1.2, -3.0, 300e3, 20e3, 1.0 / 1e9, 4e-3, 0.0] };
        let other = ForceModel::new(&other, 3e9, Form::Corrected, parameters);
        let mut trace = read(|_, channels| channels);
        for at in 0..trace.force_n.len() {
            trace.force_n[at] = other.force_n(trace.pressure_pa[at], trace.length_m[at], trace.direction[at]);
        }
        let found = explain(&[trace], &model(), 0.3);
        assert!(found.is_empty(), "{found:?}");
    }
}
