//! Units that ranges alone do not show: psi as kPa, pounds as newtons.
//!
//! What a muscle does is written as a sum that needs no search, and its weights tell what the instruments did:
//!
//! ```text
//! F ≈ g p A(ε) - g p₀ A(ε) + b B(ε) + c
//! ```
//!
//! | symbol | meaning                                                                            |
//! |--------|------------------------------------------------------------------------------------|
//! | `A(ε)` | force of the gas per pressure, of an ideal braid                                     |
//! | `B(ε)` | force of a bladder of latex                                                          |
//! | `g`    | gain: 0.6 to 1.3 for every muscle, times that of the force, over that of the pressure |
//! | `p₀`   | pressure below which the muscle does nothing: a zero, or physics                     |
//!
//! A gain that no muscle has and that a pair of units explains is a unit under the wrong name, if the force in the mean is none that a
//! muscle has either.

use nalgebra::{Matrix4, Vector4};
use pam_muscle::Muscle;
use pam_muscle::force::bladder::Bladder;
use pam_muscle::force::gas::Gas;

use super::Fault;
use super::channels::Look;
use crate::prepare::Gated;

/// Gains that a muscle, a gauge and a load cell in order may have together.
const GAINS: (f64, f64) = (0.6, 1.3);
/// Gains beyond which there is something wrong for certain: the largest k₁ of a muscle, 1.1, in pounds is 0.25.
const BEYOND: (f64, f64) = (0.25, 2.7);
/// Times by which the force itself, in the mean, must differ from that of a usual muscle as well: a gauge that lags behind the motion
/// has a gain that no muscle has, at the force of any.
const LEVEL: f64 = 2.0;
/// Standard errors by which a gain must lie beyond.
const SURELY: f64 = 3.0;
/// Rows that share an error with one: what the sum leaves is misfit, not noise.
const CORRELATED: f64 = 25.0;
/// Share of the force that the sum has to explain.
const EXPLAINED: f64 = 0.8;
/// Share of the highest pressure that the pressure must range over. Friction is 2 to 11 % of a muscle's force,
/// either way, and a regulator that sags with the motion turns over as friction does: what lies within says nothing of a gain.
const LEAST_RANGE: f64 = 0.2;
/// Range of a bladder, for the column `B`, in Pa.
const BLADDER_PA: [f64; 2] = [118.4e3, 105.7e3];
/// A vented muscle has no pressure; below this a gauge has its zero elsewhere, in Pa.
const BELOW_ZERO_PA: f64 = -8e3;

/// A unit that stands under the name of another: how many of the one make the other, with what to say.
const FORCES: [(f64, &str); 5] = [
    (4.448, "lbf under a header that says N is a factor of 4.448"),
    (9.807, "kgf under a header that says N is a factor of 9.807"),
    (1.0 / 4.448, "N under a header that says lbf is a factor of 4.448"),
    (1.0 / 9.807, "N under a header that says kgf is a factor of 9.807"),
    (2.205, "lbf under a header that says kgf is a factor of 2.205"),
];
const PRESSURES: [(f64, &str); 8] = [
    (6.895, "psi under a header that says kPa is a factor of 6.895"),
    (1.0 / 6.895, "kPa under a header that says psi is a factor of 6.895"),
    (14.5, "bar under a header that says psi is a factor of 14.5"),
    (1.0 / 14.5, "psi under a header that says bar is a factor of 14.5"),
    (10.0, "bar under a header that says MPa, turned round, is a factor of 10"),
    (0.1, "MPa under a header that says bar, turned round, is a factor of 10"),
    (100.0, "bar under a header that says kPa is a factor of 100"),
    (0.01, "kPa under a header that says bar is a factor of 100"),
];

/// Largest difference between a gain and the ratio of two units that it stands for: more than a load cell is off.
const UNIT_WITHIN: f64 = 0.04;

/// Which units under the wrong name make a force or a pressure read `gain` times what it is.
pub(super) fn unit_words(channel: &str, gain: f64) -> Option<&'static str> {
    let table: &[(f64, &str)] = match channel {
        "force" => &FORCES,
        "pressure" => &PRESSURES,
        _ => return None,
    };
    table.iter().find(|(factor, _)| (gain * factor - 1.0).abs() < UNIT_WITHIN).map(|(_, words)| *words)
}

/// A unit under the wrong name, as a gain that no muscle has, in one recording; or a gauge that falls below zero.
pub fn find(gate: &Gated, look: &Look, muscle: &Muscle) -> Option<Fault> {
    let path = || gate.recording.path.clone();
    if let Some(pressure) = gate.quality.channel("pressure") {
        let low_pa = pressure.lowest + 6.0 * pressure.noise;
        if low_pa < BELOW_ZERO_PA {
            let (lowest_kpa, shift_kpa) = (pressure.lowest * 1e-3, -low_pa * 1e-3);
            return Some(Fault::GaugeZero { path: path(), lowest_kpa, shift_kpa });
        }
    }
    if !moves(look) {
        return None;
    }
    let scale = Scale::of(look, muscle)?;
    let Scale { gain, explained, error, .. } = scale;
    // A pressure that moves little does not tell a gain from a zero.
    let may_be_in_order =
        gain + SURELY * error > BEYOND.0 && gain - SURELY * error < BEYOND.1 || scale.is_at_the_force_of_a_muscle();
    if explained < EXPLAINED || may_be_in_order || gain <= 0.0 {
        return None;
    }
    // A force in a larger unit than its name says is too small, a pressure likewise makes the gain too large.
    let by_force = FORCES.iter().map(|&(factor, words)| (gain * factor, words));
    let by_pressure = PRESSURES.iter().map(|&(factor, words)| (gain / factor, words));
    let guesses: Vec<&str> = by_force
        .chain(by_pressure)
        .filter(|(gain, _)| (GAINS.0..=GAINS.1).contains(gain))
        .map(|(_, words)| words)
        .collect();
    (!guesses.is_empty()).then(|| Fault::Gain { path: path(), gain, guesses: guesses.join("; or ") })
}

/// Whether the pressure moves far enough to tell a gain from friction.
fn moves(look: &Look) -> bool {
    let widen = |(low, high): (f64, f64), (pressure_pa, _, _): (f64, f64, f64)| {
        (f64::min(low, pressure_pa), f64::max(high, pressure_pa))
    };
    let (low, high) = look.rows().fold((f64::INFINITY, f64::NEG_INFINITY), widen);
    high - low > LEAST_RANGE * high.abs()
}

/// What the sum says of a recording.
#[derive(Debug, Clone, Copy)]
struct Scale {
    /// `g` by least squares.
    gain: f64,
    /// Share of the force that the sum explains.
    explained: f64,
    /// Standard error of `g`.
    error: f64,
    /// Force over that of a usual muscle, in the mean; none where that would not pull.
    level: Option<f64>,
}

impl Scale {
    /// Whether the force, in the mean, is that of a usual muscle within [`LEVEL`].
    fn is_at_the_force_of_a_muscle(self) -> bool {
        self.level.is_some_and(|level| (1.0 / LEVEL..=LEVEL).contains(&level))
    }

    /// Of the rows of `look`; none where the force says nothing.
    fn of(look: &Look, muscle: &Muscle) -> Option<Self> {
        let (gas, bladder) = (Gas::new(muscle), Bladder::new(muscle));
        // In bar and per hundred newtons, so that the columns are of one size.
        let columns = |pressure_pa: f64, length_m: f64| {
            let per_bar = 1e-2 * gas.force_n(1e5, muscle.contraction_ratio(length_m), 1.0, 1.05);
            let rubber = 1e-2 * bladder.force_n(length_m, BLADDER_PA[0], BLADDER_PA[1]);
            Vector4::new(1e-5 * pressure_pa * per_bar, per_bar, rubber, 1.0)
        };
        let (mut normal, mut right) = (Matrix4::<f64>::zeros(), Vector4::<f64>::zeros());
        let (mut n, mut sum, mut squares, mut usual_sum) = (0.0, 0.0, 0.0, 0.0);
        // A little of what muscles have, for what the recordings do not say: no zero, rubber of latex.
        let usual = Vector4::new(0.9, 0.0, 1.0, 0.0);
        for (pressure_pa, length_m, force_n) in look.rows() {
            let row = columns(pressure_pa, length_m);
            if row.iter().all(|value| value.is_finite()) && force_n.is_finite() {
                let force = 1e-2 * force_n;
                normal += row * row.transpose();
                right += row * force;
                (n, sum, squares) = (n + 1.0, sum + force, squares + force * force);
                usual_sum += row.dot(&usual);
            }
        }
        let trust = Matrix4::from_diagonal(&Vector4::new(1e-6, 1e-4, 1e-3, 1e-6)) * n;
        let inverse = (normal + trust).try_inverse()?;
        let found = inverse * (right + trust * usual);
        let residual = (squares - 2.0 * found.dot(&right) + (normal * found).dot(&found)).max(0.0);
        let spread = squares - sum * sum / n.max(1.0);
        if n < 16.0 || spread <= 0.0 {
            return None;
        }
        let error = (CORRELATED * residual / n * inverse[(0, 0)]).sqrt();
        let level = (usual_sum > 0.0).then(|| sum / usual_sum);
        Some(Self { gain: found[0], explained: 1.0 - residual / spread, error, level })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loops of a muscle around the pressure `pressure_pa`, which sags by so much while the muscle contracts; the gain that its force
    /// would have.
    fn loops(pressure_pa: f64, sag_pa: f64) -> (Look, Option<f64>) {
        let model = crate::testing::model();
        let rows = (0..2000).map(|row| {
            let (phase, rows) = (f64::from(row % 200), f64::from(row));
            let (along, way) = if phase < 100.0 { (phase / 100.0, 1.0) } else { (2.0 - phase / 100.0, -1.0) };
            let length_m = 0.26 - 0.03 * along;
            let pressure_pa = pressure_pa - 0.5 * sag_pa * way + 20.0 * (0.7 * rows).sin();
            (pressure_pa, length_m, model.force_n(pressure_pa, length_m, 0.0) - 20.0 * way)
        });
        let look = Look::of(rows);
        let gain = Scale::of(&look, model.muscle()).map(|scale| scale.gain);
        (look, gain)
    }

    #[test]
    fn a_gauge_that_lags_has_a_gain_of_none_at_the_force_of_any_muscle() {
        let model = crate::testing::model();
        // The muscle shortens as it is filled, and the gauge says so a fifth of a cycle later; in the unit of the force or another.
        let scale = |factor: f64| {
            let rows = (0..2000).map(|row| {
                let phase = std::f64::consts::TAU * f64::from(row) / 200.0;
                let (length_m, pressure_pa) = (0.25 - 0.012 * phase.sin(), 1.8e5 + 9e4 * phase.sin());
                let late_pa = 1.8e5 + 9e4 * (phase - 1.3).sin();
                (late_pa, length_m, factor * model.force_n(pressure_pa, length_m, 0.0))
            });
            Scale::of(&Look::of(rows), model.muscle()).expect("a force")
        };
        let (own, pounds) = (scale(1.0), scale(1.0 / 4.448));
        assert!(own.gain < BEYOND.0 && own.explained > EXPLAINED, "{own:?}");
        assert!(own.is_at_the_force_of_a_muscle() && !pounds.is_at_the_force_of_a_muscle(), "{own:?} {pounds:?}");
    }

    #[test]
    fn a_regulator_that_sags_with_the_motion_says_nothing_of_a_gain() {
        // Friction that turns over with the sag passes for a gain.
        let (look, gain) = loops(2.4e5, 3e3);
        assert!(gain.is_some_and(|gain| gain > BEYOND.1), "{gain:?}");
        assert!(!moves(&look));
        assert!(moves(&loops(2.4e5, 8e4).0));
    }
}
