//! Hysteresis of the rubber: a loop without rate that the pressure does not scale.
//!
//! ```text
//! F = F_base - W z,   z = Maxwell slip over δ
//! ```

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::slip::Follower;
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct RubberHysteresis;

impl Effect for RubberHysteresis {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[Shape {
            name: "slip_distance_m",
            symbol: "δ",
            unit: "m",
            range: (DRY_M, 3e-2),
            grid: &[5e-4, 1e-3, 2e-3, 5e-3, 1e-2],
        }]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "width_n", symbol: "W", unit: "N", range: (0.0, 200.0) }]
    }

    fn start(&self, muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { rest_length_m: muscle.rest_length_m, follower: Follower::new(shape[0]) })
    }
}

/// Slip distance below which a loop is that of dry friction: strands turn over within some tenths of a millimetre, rubber is strained by
/// more. Of 21 looked-at names the four with less were wrong, two of them in healthy muscles whose friction has a part that no pressure
/// makes, and of the 17 with more one.
const DRY_M: f64 = 4e-4;

struct State {
    rest_length_m: f64,
    follower: Follower,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, _base: &Base, columns: &mut [f64]) {
        // Rubber that is not stretched has no loop: pressure alone moves nothing.
        let contraction_m = now.contraction_ratio * self.rest_length_m;
        columns[0] = -self.follower.follow(now, contraction_m, now.direction);
    }
}

static PAGE: Page = Page {
    id: "rubber-hysteresis",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "hysteresis of the rubber",
    summary: "Filled rubber, and a bladder that sticks to itself, take another path back than they went, however \
              slowly. The loop has the same height at every pressure, which is what tells it from friction of the \
              braid.",
    equation: "F = F_base - W z,  z = Σ w_i z_i,  z_i ← clamp(z_i + Δx / r_i, -1, 1),  r_i = δ (0.15 … 4.5)",
    symbols: &[
        Symbol { symbol: "W", unit: "N", meaning: "half the height of the loop; 1 to 20 N" },
        Symbol {
            symbol: "δ",
            unit: "m",
            meaning: "slip distance: 63 % of the height are there after it; 0.5 to 10 mm",
        },
        Symbol { symbol: "z", unit: "1", meaning: "share of the full height, in [-1, 1]" },
        Symbol { symbol: "x", unit: "m", meaning: "contraction; of a muscle that is held, 4e-8 m/Pa" },
    ],
    validity: "Any path, slow against relaxation; no dependence on rate, pressure or load.",
    source: "Al-Bender, Lampaert and Swevers (2005), IEEE Trans. Automatic Control 50(11), for the operator; Vo-Minh, \
             Tjahjowidodo, Ramon and Van Brussel (2011), IEEE/ASME Trans. Mechatronics 16(1), for its use in muscles",
    signature: "The residual is odd in the direction of motion, as high at low pressure as at high, and builds up over \
                some millimetres after each reversal; neither speed nor rest changes it.",
    confused_with: &[
        Confusion {
            id: "presliding-hysteresis",
            because: "both are loops without rate that build up over a distance",
            test: "minor loops at two pressures: the loop of the braid grows with the pressure, that of rubber keeps its \
                   height",
        },
        Confusion {
            id: "load-dependent-friction",
            because: "at one pressure and over a short stroke neither the load nor the pressure varies much",
            test: "the same stroke at several pressures: the height follows the force, or it stays",
        },
        Confusion {
            id: "viscoelastic-relaxation",
            because: "a broad spectrum of relaxation times also makes loops that hardly depend on the rate",
            test: "hold for a minute after a step of the length: relaxation decays in the hold, hysteresis does not",
        },
    ],
    test: "minor loops of 10, 5, 2 and 1 mm at low and at high pressure, with holds of ten seconds at the reversals",
    protocol: "minor-loops",
    coordinate: Coordinate::TravelSinceReversal,
    typical: Typical { shapes: &[&[2e-3]], amplitudes: &[5.0] },
    regions: &[],
    drivers: &["contraction", "travel-since-reversal"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    fn moved(contracted_m: f64) -> Moment {
        Moment {
            step_s: 0.1,
            contraction_ratio: still().contraction_ratio + contracted_m / nominal().rest_length_m,
            ..still()
        }
    }

    #[test]
    fn it_opposes_the_motion_by_its_full_height_after_a_long_stroke() {
        let mut memory = RubberHysteresis.start(&nominal(), &[1e-3]);
        assert_eq!(pull(&mut *memory, &still(), &base())[0], -1.0);
        let back = pull(&mut *memory, &moved(-0.02), &base())[0];
        assert!((back - 1.0).abs() < 1e-12);
    }

    #[test]
    fn neither_pressure_nor_time_changes_it() {
        let mut memory = RubberHysteresis.start(&nominal(), &[1e-3]);
        pull(&mut *memory, &still(), &base());
        let before = pull(&mut *memory, &moved(-1e-3), &base());
        let later = Moment { step_s: 100.0, pressure_pa: 1e4, ..moved(-1e-3) };
        assert_eq!(before, pull(&mut *memory, &later, &Base::default()));
    }
}
