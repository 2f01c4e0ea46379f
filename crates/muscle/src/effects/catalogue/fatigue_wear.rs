//! Wear: every metre of sliding costs a little of the gas force, and changes the friction that it slides against.
//!
//! ```text
//! F = F_base - (d F_gas - e p π D L sgn v) (s / s_ref)^γ,   s = ∫ |dx|
//! ```
//!
//! Strands that run in rub less (`e > 0`), strands that fray rub more.

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kept, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// `s_ref`, in m: some thousand cycles of 50 mm.
const REFERENCE_M: f64 = 100.0;
/// Half the play in the count of travel, in m; noise at rest stays inside it.
const HALF_PLAY_M: f64 = 1.5e-4;

/// Change of the coefficient of friction over `s_ref`, at most: all of a large one, 0.03, within the first ten metres of a run-in that
/// slows down.
const MOST_FRICTION: f64 = 0.1;

/// The effect.
#[derive(Debug)]
pub(super) struct FatigueWear;

impl Effect for FatigueWear {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[Shape { name: "exponent", symbol: "γ", unit: "1", range: (0.2, 1.5), grid: &[0.5, 1.0] }]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[
            Amplitude { name: "loss_per_reference_travel", symbol: "d", unit: "1", range: (0.0, 1.0) },
            Amplitude {
                name: "friction_loss_per_reference_travel",
                symbol: "e",
                unit: "1",
                range: (-MOST_FRICTION, MOST_FRICTION),
            },
        ]
    }

    /// Before it had a loss of friction, it had none.
    fn unless_stated(&self, index: usize) -> Option<f64> {
        (index == 2).then_some(0.0)
    }

    fn outlasts(&self) -> bool {
        true
    }

    fn keeps(&self) -> &'static [Kept] {
        &[Kept { name: "past_travel_m", unit: "m", range: (0.0, 1e9), fresh: 0.0 }]
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { exponent: shape[0], travel_m: 0.0, follower_m: 0.0 })
    }
}

struct State {
    exponent: f64,
    /// Travel so far, that in gaps left out.
    travel_m: f64,
    /// Behind the slide by up to half the play.
    follower_m: f64,
}

impl Memory for State {
    fn past(&self) -> Vec<f64> {
        vec![self.travel_m]
    }

    fn go_on(&mut self, past: &[f64]) {
        if let &[travel_m] = past {
            self.travel_m = travel_m;
        }
    }

    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        if now.step_s == 0.0 {
            self.follower_m = now.slide_m;
        } else {
            let followed_m = self.follower_m.clamp(now.slide_m - HALF_PLAY_M, now.slide_m + HALF_PLAY_M);
            self.travel_m += (followed_m - self.follower_m).abs();
            self.follower_m = followed_m;
        }
        let worn = (self.travel_m / REFERENCE_M).powf(self.exponent);
        columns[0] = -base.gas_n * worn;
        columns[1] = now.direction * base.normal_n * worn;
    }
}

static PAGE: Page = Page {
    id: "fatigue-wear",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "fatigue and wear",
    summary: "Strands abrade, the weave opens and the ends creep, so that over hundreds of cycles the muscle pulls less \
              at the same pressure and length. Within the first of them the strands run in: friction falls, by up to a \
              third. Nothing of it recovers.",
    equation: "F = F_base - (d F_gas - e p π D L sgn v) (s / s_ref)^γ,  s = ∫ |dx|,  s_ref = 100 m",
    symbols: &[
        Symbol {
            symbol: "d",
            unit: "1",
            meaning: "share of the gas force lost after 100 m of travel; 0.01 to 0.05, more while a muscle is new",
        },
        Symbol {
            symbol: "e",
            unit: "1",
            meaning: "by how much the coefficient of friction falls over 100 m, below zero where it rises; up to a third of it in a \
                      run-in",
        },
        Symbol { symbol: "γ", unit: "1", meaning: "exponent; 1 for steady wear, 0.5 for a run-in that slows down" },
        Symbol { symbol: "x", unit: "m", meaning: "travel of the braid; counted outside a play of 0.3 mm" },
        Symbol { symbol: "F_gas", unit: "N", meaning: "force of the gas in eq. 11" },
        Symbol { symbol: "sgn v", unit: "1", meaning: "direction of motion, kept at standstill" },
    ],
    validity: "Far from failure; the travel before the first recording counts as none.",
    source: "Klute and Hannaford (1998), \"Fatigue characteristics of McKibben artificial muscle actuators\", IROS; \
             Durante (2021) for straight-fibre muscles",
    signature: "The residual falls with the count of cycles and never returns; it is a share of the gas force, so larger \
                at high pressure and small contraction, and nothing at all without pressure. Of a run-in, loops get narrower \
                with the count of cycles, most of all in the first ones.",
    confused_with: &[
        Confusion {
            id: "force-drift",
            because: "at one pressure level both are a slow slope over time",
            test: "cycles at two pressures in turn: wear follows the pressure, drift does not; a vented and slack muscle \
                   before and after shows drift alone",
        },
        Confusion {
            id: "thermal-softening",
            because: "both change the force over minutes of cycling, with opposite signs",
            test: "rest for half an hour and probe: warmth is gone, wear is still there",
        },
        Confusion {
            id: "mullins-softening",
            because: "both separate the first cycles from the later ones",
            test: "the difference between early and late cycles at two pressures: softening of the bladder has one size, \
                   wear follows the pressure",
        },
        Confusion {
            id: "stribeck",
            because: "where the slow motion comes first, friction that falls with the travel looks like one that falls with the speed",
            test: "the slow triangles once more at the end: run-in friction stays small",
        },
    ],
    test: "three hundred cycles at two pressures in turn, with a vented and slack pause before and after",
    protocol: "endurance",
    coordinate: Coordinate::Time,
    typical: Typical { shapes: &[&[0.5], &[1.0]], amplitudes: &[0.02, 0.005] },
    regions: &[],
    drivers: &["cycle", "time"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    fn cycled(memory: &mut dyn Memory, stroke_m: f64, n_turns: usize) -> f64 {
        let mut column_n = pull(memory, &still(), &base())[0];
        assert!(column_n.abs() < 1e-12);
        for index in 0..n_turns {
            let slide_m = still().slide_m + if index % 2 == 0 { -stroke_m } else { 0.0 };
            column_n = pull(memory, &Moment { step_s: 1.0, slide_m, ..still() }, &base())[0];
        }
        column_n
    }

    #[test]
    fn a_hundred_metres_cost_the_share() {
        let mut memory = FatigueWear.start(&nominal(), &[1.0]);
        let column_n = cycled(&mut *memory, 0.05, 2000);
        // The play takes 0.3 mm of every 50 mm.
        assert!((column_n / -base().gas_n - 0.994).abs() < 1e-3, "{column_n}");
    }

    #[test]
    fn friction_that_runs_in_pulls_with_the_motion_and_comes_to_nothing_without_pressure() {
        let mut memory = FatigueWear.start(&nominal(), &[1.0]);
        let worn = cycled(&mut *memory, 0.05, 2000) / -base().gas_n;
        for direction in [1.0, -1.0] {
            let moment = Moment { direction, ..still() };
            let before_n = pull(&mut *FatigueWear.start(&nominal(), &[1.0]), &moment, &base())[1];
            assert!(before_n.abs() < 1e-12);
            let column_n = pull(&mut *memory, &moment, &base())[1];
            assert!((column_n / (direction * worn * base().normal_n) - 1.0).abs() < 1e-12, "{column_n}");
            let vented = Base { gas_n: 0.0, normal_n: 0.0, ..base() };
            assert!(pull(&mut *memory, &moment, &vented).iter().all(|column| column.abs() < 1e-12));
        }
    }

    #[test]
    fn noise_at_rest_is_no_travel_and_a_gap_keeps_the_count() {
        let mut memory = FatigueWear.start(&nominal(), &[0.5]);
        assert!(cycled(&mut *memory, 1.4e-4, 100_000).abs() < 1e-12);
        let mut memory = FatigueWear.start(&nominal(), &[0.5]);
        let before_n = cycled(&mut *memory, 0.05, 100);
        let mut next = FatigueWear.start(&nominal(), &[0.5]);
        next.go_on(&memory.past());
        assert!((pull(&mut *next, &still(), &base())[0] - before_n).abs() < 1e-12);
        let after_gap = Moment { slide_m: 0.0, ..still() };
        assert!((pull(&mut *memory, &after_gap, &base())[0] - before_n).abs() < 1e-12);
    }
}
