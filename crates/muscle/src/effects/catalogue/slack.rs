//! Slack: a cable or a soft muscle cannot push, so the load cell reads a floor.
//!
//! ```text
//! F_read = F_floor + h,   h - w³ / h² = F - F_floor,   max(F, F_floor) where w = 0
//! ```
//!
//! A slack muscle is a column with a bow. Under a load `h` beyond its buckling load the bow shrinks as `1/h` (Timoshenko and
//! Gere, 1961, "Theory of Elastic Stability"), and with its square the length that it takes from the muscle between its ends.

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Effect, Kind, Memory, Role, Seen, Shape};
use crate::geometry::Muscle;

/// Lowest and highest floor, in N: what is hung on the cell, with its tare.
const RANGE_N: (f64, f64) = (-50.0, 50.0);

/// Softnesses that are tried when every effect is named, in N.
const SOFTNESSES_N: [f64; 4] = [2.0, 5.0, 10.0, 20.0];

/// So many times the softness above or below the floor, `h` is its limit to nine digits or more.
const FAR: f64 = 1e6;

/// Below it the end is sharp, in N.
const SHARP_N: f64 = 1e-3;

/// The effect.
#[derive(Debug)]
pub(super) struct Slack;

impl Effect for Slack {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape { name: "floor_n", symbol: "F_floor", unit: "N", range: RANGE_N, grid: &[0.0] },
            Shape { name: "softness_n", symbol: "w", unit: "N", range: (0.0, 60.0), grid: &[0.0] },
        ]
    }

    fn first_shapes(&self, seen: &Seen) -> Vec<Vec<f64>> {
        let lowest_n = seen.force_n.0.clamp(RANGE_N.0, RANGE_N.1);
        if lowest_n == 0.0 { vec![vec![0.0; 2]] } else { vec![vec![lowest_n, 0.0], vec![0.0; 2]] }
    }

    fn details(&self, shape: &[f64]) -> Vec<Vec<f64>> {
        SOFTNESSES_N.map(|softness_n| vec![shape[0], softness_n]).into()
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { floor_n: shape[0], softness_n: shape[1] })
    }
}

struct State {
    floor_n: f64,
    softness_n: f64,
}

impl Memory for State {
    fn reads(&mut self, force_n: f64) -> f64 {
        self.floor_n + taut_n(force_n - self.floor_n, self.softness_n)
    }

    fn slope(&self, force_n: f64) -> f64 {
        let above_n = force_n - self.floor_n;
        if self.softness_n < SHARP_N {
            return f64::from(u8::from(above_n >= 0.0));
        }
        let taut_n = taut_n(above_n, self.softness_n);
        taut_n / (3.0 * taut_n - 2.0 * above_n)
    }
}

/// `h` where `h - w³ / h²` is `above_n`.
fn taut_n(above_n: f64, softness_n: f64) -> f64 {
    // Beyond the length of the strands a model has no force, which is no floor either.
    if above_n.is_nan() {
        return above_n;
    }
    if softness_n < SHARP_N {
        return above_n.max(0.0);
    }
    if above_n < -FAR * softness_n {
        return softness_n * (softness_n / -above_n).sqrt();
    }
    if above_n > FAR * softness_n {
        return above_n;
    }
    // From above, where the cubic is convex: every step of Newton's stays above.
    let ratio = softness_n / above_n.abs();
    let mut taut_n = softness_n
        * if above_n > 0.0 { above_n / softness_n + (ratio * ratio).min(1.0) } else { ratio.sqrt().min(1.0) };
    loop {
        let left = taut_n * taut_n * (taut_n - above_n) - softness_n.powi(3);
        let step_n = left / (taut_n * (3.0 * taut_n - 2.0 * above_n));
        taut_n -= step_n;
        if step_n <= 1e-12 * taut_n {
            return taut_n;
        }
    }
}

static PAGE: Page = Page {
    id: "slack",
    role: Role::Reads,
    kind: Kind::Muscle,
    dependence: Dependence::PartOfState,
    name: "slack",
    summary: "A cable goes slack and a soft muscle buckles before either pushes, so the load cell reads its floor \
              wherever the model has the muscle push.",
    equation: "F = F_floor + h,  h - w³ / h² = F_base - F_floor,  max(F_base, F_floor) where w = 0",
    symbols: &[
        Symbol {
            symbol: "F_floor",
            unit: "N",
            meaning: "what the cell reads of a slack muscle: tare and hung weight less the buckling load; on two Festo \
                      muscles (10 mm) -9 and -10 N",
        },
        Symbol {
            symbol: "w",
            unit: "N",
            meaning: "softness: a bent muscle straightens bit by bit; 0 for a cable, 11 and 15 N measured on two Festo \
                      muscles (10 mm; 30 and 20 cm)",
        },
    ],
    validity: "A cable without mass; dead length that has to be taken up again is left out.",
    source: "unilateral contact; Fichter (1966), NASA TN D-3466, for inflated tubes that buckle",
    signature: "The force is flat while pressure or length move, at low pressure or large contraction, and the residual \
                there is the negative force of the model.",
    confused_with: &[
        Confusion {
            id: "threshold-pressure",
            because: "both leave no force at low pressure",
            test: "isometric ramps from zero at several lengths: slack ends where the model's force becomes positive, a \
                   threshold at one pressure",
        },
        Confusion {
            id: "braid-lockup",
            because: "at large contraction and low pressure the force ends in both",
            test: "large contraction at high pressure, where the muscle still pulls: slack does not show there",
        },
    ],
    test: "vent the muscle at every length and watch for a force that stays flat; keep a preload and it is gone",
    protocol: "isometric-ramps",
    coordinate: Coordinate::Force,
    typical: Typical { shapes: &[&[0.0, 0.0]], amplitudes: &[] },
    regions: &[Coordinate::Force, Coordinate::Pressure],
    drivers: &["contraction", "force"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::catalogue::tests::seen;
    use crate::geometry::tests::nominal;

    #[test]
    fn it_reads_a_pull_and_no_push() {
        let mut memory = Slack.start(&nominal(), &[-1.5, 0.0]);
        assert_eq!([memory.reads(20.0), memory.reads(-1.0), memory.reads(-30.0)], [20.0, -1.0, -1.5]);
        assert!(memory.cuts(-30.0) && !memory.cuts(-1.0));
    }

    #[test]
    fn a_soft_end_is_smooth_and_straightens_as_a_bow_does() {
        let mut soft = Slack.start(&nominal(), &[2.0, 5.0]);
        // The model's force of a muscle whose bow has shrunk to what the reading leaves of it.
        for taut_n in [1e-3_f64, 0.3, 5.0, 8.0, 60.0, 900.0] {
            let force_n = 2.0 + taut_n - 125.0 / (taut_n * taut_n);
            assert!((soft.reads(force_n) - 2.0 - taut_n).abs() < 1e-9 * taut_n, "{taut_n}");
        }
        assert!((soft.reads(2.0) - 7.0).abs() < 1e-12);
        for force_n in [-20.0, 1.0, 2.0, 15.0] {
            let slope = (soft.reads(force_n + 1e-4) - soft.reads(force_n - 1e-4)) / 2e-4;
            assert!((soft.slope(force_n) - slope).abs() < 1e-6);
        }
        assert_eq!([soft.reads(f64::NEG_INFINITY), soft.reads(f64::INFINITY)], [2.0, f64::INFINITY]);
        assert!((soft.reads(5000.0) - 5000.0).abs() < 1e-4);
        assert_eq!(soft.reads(1e200), 1e200);
    }

    #[test]
    fn what_is_no_force_is_read_as_none() {
        for softness_n in [0.0, 1e-9, 5.0] {
            let mut memory = Slack.start(&nominal(), &[2.0, softness_n]);
            assert!(memory.reads(f64::NAN).is_nan(), "softness {softness_n} N");
        }
    }

    #[test]
    fn a_fit_looks_at_the_lowest_force_and_at_zero() {
        let seen = Seen { contraction_ratio: (0.0, 0.2), force_n: (-2.5, 900.0), duration_s: 60.0, ..seen() };
        assert_eq!(Slack.first_shapes(&seen), [[-2.5, 0.0], [0.0, 0.0]]);
        assert!(Slack.details(&[-2.5, 0.0]).iter().all(|shape| shape[0] == -2.5 && shape[1] > 0.0));
    }
}
