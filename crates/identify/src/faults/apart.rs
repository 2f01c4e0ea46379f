//! One recording of several whose instrument reads otherwise than in the others.
//!
//! A gauge that is absolute in one recording and not in the others fits no muscle, and eq. 11 spreads what contradicts itself over
//! all of them: parameters leave where muscles are, and no recording looks worse than another. So each recording in turn is taken to
//! have one channel with a zero or a gain of its own, and all are fitted together once more. Where that leaves about what the
//! sensors' noise leaves, and less than half of the residual beyond it, the recording and the instrument are named.
//!
//! A tare that is set anew between recordings is everyday, and is said; the others make the fit worthless, and it is not accepted.

use std::io;

use pam_muscle::force::columns::ForceColumns;

use super::reading::{Reading, Wrong};
use super::zero::{Sample, fitted_n, samples_of, stride, summary_of};
use crate::identify::Identified;

/// Times the noise floor that a fit must leave for its recordings to be taken apart, and that may be left then.
const LEAVES: f64 = 3.0;
const TIMES_FLOOR: f64 = 2.5;
/// Share of the RMSE that may be left beyond the noise floor; and of it altogether, where that is above the limit of the floor: what
/// friction does at standstill is judged before anything is known to contradict, and a wrong judgement leaves some newtons.
const LEFT: f64 = 0.5;
const LEFT_ALTOGETHER: f64 = 1.0 / 3.0;
/// Readings that leave at most so many times what the best one leaves are said beside it.
const ALIKE: f64 = 1.5;
const SAID: usize = 3;
/// Below the atmosphere by so much, no gauge in order reads, in Pa.
const BELOW_ZERO_PA: f64 = -15e3;
/// The fault looked for: zero of a pressure in Pa, of a length in rest lengths, of a force in N; logarithm of gains.
const PRESSURE_ZERO_PA: f64 = 120e3;
const LENGTH_ZERO: f64 = 0.05;
const FORCE_ZERO_N: f64 = 100.0;
const GAIN: f64 = 0.7;
/// Steps of the first look to either side of nothing, and halvings of the pitch after it.
const STEPS: i32 = 6;
const HALVINGS: usize = 8;

/// A channel, how far off it is looked for, and what that would be.
type Hypothesis = (&'static str, f64, fn(f64) -> Wrong);

/// Recordings and instruments that would each explain what contradicts itself.
#[derive(Debug, Clone, PartialEq)]
pub struct Apart {
    /// Path of the recording and what its instrument would read wrong, the likeliest first.
    pub readings: Vec<(String, Reading)>,
    /// RMSE of the fit to all as they are, in N.
    pub as_is_n: f64,
}

impl Apart {
    /// Its message.
    pub fn words(&self) -> String {
        let said = self.readings.iter().take(SAID);
        let each: Vec<String> = said.map(|(path, reading)| format!("in {path} {}", reading.words())).collect();
        format!(
            "the recordings contradict one another: against the others, {} ({:.2} N would be left instead of {:.2} N)",
            each.join(", or "),
            self.readings[0].1.left_n,
            self.as_is_n
        )
    }

    /// Whether it is no more than a tare.
    pub fn is_tare(&self) -> bool {
        self.readings.iter().any(|(_, reading)| reading.channel == "force" && matches!(reading.wrong, Wrong::Zero(_)))
    }
}

/// A recording whose instrument reads otherwise than in the others; none where they agree, or nothing explains why not.
///
/// # Errors
/// Where samples cannot be read back.
pub fn find(found: &Identified) -> io::Result<Option<Apart>> {
    let fitted = found.estimation_fit.together.as_ref().map_or(0.0, |together| together.rmse_n);
    if found.estimation.len() < 2 || fitted <= LEAVES * found.noise_floor_n {
        return Ok(None);
    }
    let stride = stride(found);
    let each: io::Result<Vec<Vec<Sample>>> =
        found.estimation.iter().map(|prepared| samples_of(prepared, stride)).collect();
    let each = each?;
    let largest_n_per_m =
        each.concat().iter().map(|sample| (sample.0 + PRESSURE_ZERO_PA) * sample.1).fold(0.0, f64::max);
    let columns =
        ForceColumns::new(&found.muscle, found.model.strand_modulus_pa(), found.model.form(), largest_n_per_m);
    let as_is_n = fitted_n(found, &columns, &summary_of(&columns, each.concat().into_iter()));
    let excess = |rmse_n: f64| (rmse_n * rmse_n - found.noise_floor_n.powi(2)).max(0.0);
    let explains = |left_n: f64| {
        left_n <= (TIMES_FLOOR * found.noise_floor_n).max(LEFT_ALTOGETHER * as_is_n)
            && excess(left_n) < LEFT * LEFT * excess(as_is_n)
    };
    let mut readings = Vec::new();
    for (index, samples) in each.iter().enumerate() {
        let others = each.iter().enumerate().filter(|(other, _)| *other != index).flat_map(|(_, samples)| samples);
        let others = summary_of(&columns, others.copied());
        let left_n = |channel: &str, wrong: Wrong| {
            let mut summary = summary_of(&columns, samples.iter().map(|&sample| truly(sample, channel, wrong)));
            summary.merge(&others);
            fitted_n(found, &columns, &summary)
        };
        let lowest_pa = samples.iter().map(|sample| sample.0).fold(f64::INFINITY, f64::min);
        let length_zero_m = LENGTH_ZERO * found.muscle.rest_length_m;
        let hypotheses: [Hypothesis; 5] = [
            ("pressure", PRESSURE_ZERO_PA, Wrong::Zero),
            ("pressure", GAIN, |x| Wrong::Gain(x.exp())),
            ("length", length_zero_m, Wrong::Zero),
            ("force", FORCE_ZERO_N, Wrong::Zero),
            ("force", GAIN, |x| Wrong::Gain(x.exp())),
        ];
        for (channel, reach, wrong) in hypotheses {
            let is_possible = |wrong: Wrong| !matches!(wrong, Wrong::Zero(zero_pa) if channel == "pressure" && lowest_pa - zero_pa < BELOW_ZERO_PA);
            let (best, left_n) =
                least(
                    reach,
                    as_is_n,
                    |x| {
                        if is_possible(wrong(x)) { left_n(channel, wrong(x)) } else { f64::INFINITY }
                    },
                );
            if best != 0.0 && explains(left_n) {
                let path = found.estimation[index].recording.path.clone();
                readings.push((path, Reading { channel, wrong: wrong(best), left_n }));
            }
        }
    }
    readings.sort_by(|left, right| left.1.left_n.total_cmp(&right.1.left_n));
    let Some(best_n) = readings.first().map(|(_, reading)| reading.left_n) else { return Ok(None) };
    readings.retain(|(_, reading)| reading.left_n <= ALIKE * best_n);
    Ok(Some(Apart { readings, as_is_n }))
}

/// A sample with the true value of a channel that reads wrong.
fn truly((pressure_pa, length_m, sign, force_n): Sample, channel: &str, wrong: Wrong) -> Sample {
    let of = |value: f64| match wrong {
        Wrong::Zero(zero) => value - zero,
        Wrong::Gain(gain) => value / gain,
        Wrong::Late(_) | Wrong::Backward => value,
    };
    match channel {
        "pressure" => (of(pressure_pa), length_m, sign, force_n),
        "length" => (pressure_pa, of(length_m), sign, force_n),
        _ => (pressure_pa, length_m, sign, of(force_n)),
    }
}

/// Where `left_n` is least within `reach` of zero, where it is `as_is_n`.
fn least(reach: f64, as_is_n: f64, left_n: impl Fn(f64) -> f64) -> (f64, f64) {
    let mut best = (0.0, as_is_n);
    let mut take = |x: f64| {
        let candidate = (x, if x.abs() <= reach { left_n(x) } else { f64::INFINITY });
        if candidate.1 < best.1 {
            best = candidate;
        }
        best.0
    };
    let mut pitch = reach / f64::from(STEPS);
    for step in (-STEPS..=STEPS).filter(|step| *step != 0) {
        take(f64::from(step) * pitch);
    }
    for _ in 0..HALVINGS {
        pitch *= 0.5;
        let here = take(f64::INFINITY);
        take(here - pitch);
        take(here + pitch);
    }
    best
}
