//! Load-dependent friction: a share of the tension itself, as over a capstan.
//!
//! ```text
//! F = F_base - s (μΘ + μΘ' ε) max(F_static, 0)
//! ```
//!
//! The angle of wrap changes where a cable winds onto a pulley as the muscle contracts, or off it.

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct LoadDependentFriction;

impl Effect for LoadDependentFriction {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[
            Amplitude { name: "friction_per_load", symbol: "μΘ", unit: "1", range: (0.0, 1.0) },
            Amplitude { name: "friction_per_load_and_contraction", symbol: "μΘ'", unit: "1", range: (-4.0, 4.0) },
        ]
    }

    /// Before it could change, the angle of wrap was one.
    fn unless_stated(&self, index: usize) -> Option<f64> {
        (index == 1).then_some(0.0)
    }

    fn start(&self, _muscle: &Muscle, _shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State)
    }
}

struct State;

impl Memory for State {
    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        columns[0] = -now.direction * base.static_force_n.max(0.0);
        columns[1] = columns[0] * now.contraction_ratio;
    }
}

static PAGE: Page = Page {
    id: "load-dependent-friction",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::Direction,
    name: "friction that grows with the load",
    summary: "Friction that the tension itself presses on: of strands that bend around the ends, or of a cable over a \
              pulley or in a sheath. The force on the way in and on the way out have the same quotient at every pressure, \
              and at every length as well where the angle of wrap does not change.",
    equation: "F = F_base - s (μΘ + μΘ' ε) max(F_static, 0)",
    symbols: &[
        Symbol {
            symbol: "μΘ",
            unit: "1",
            meaning: "coefficient of friction times angle of wrap; 0.01 to 0.06 in a muscle, up to 0.4 over a cable",
        },
        Symbol {
            symbol: "μΘ'",
            unit: "1",
            meaning: "by how much that grows with the contraction, where a cable winds onto a pulley: μ L₀ over its radius, 0.5 to 2; below \
                      zero where it winds off, 0 for one angle",
        },
        Symbol { symbol: "ε", unit: "1", meaning: "contraction ratio" },
        Symbol { symbol: "s", unit: "1", meaning: "direction of motion, kept at standstill" },
        Symbol { symbol: "F_static", unit: "N", meaning: "force without friction" },
    ],
    validity: "μΘ small against 1, where exp(-s μΘ) is 1 - s μΘ; sliding, not the millimetre after a reversal.",
    source: "Euler (1762) and Eytelwein (1808) for the capstan; Al Saaideh and Al Janaideh (2022) for hysteresis of \
             pneumatic muscles that depends on the load",
    signature: "The residual is odd in the direction and proportional to the force: largest at small contraction, gone \
                where the muscle pulls no more, however high the pressure.",
    confused_with: &[
        Confusion {
            id: "presliding-hysteresis",
            because: "at one contraction the force and the pressure rise together, so both friction laws have one shape",
            test: "loops at the same pressure around several contractions: friction of the braid hardly changes, that of \
                   the load falls with the force",
        },
        Confusion {
            id: "viscous-damping",
            because: "in triangles of one speed a damping that grows with the pressure looks alike",
            test: "the same triangle at two speeds: damping grows, friction does not",
        },
        Confusion {
            id: "rubber-hysteresis",
            because: "over a short stroke at one pressure the force varies little",
            test: "the same stroke at several pressures: the height follows the force, or it stays",
        },
    ],
    test: "pressure triangles under several constant loads: the width of the loop follows the load",
    protocol: "isotonic",
    coordinate: Coordinate::Force,
    typical: Typical { shapes: &[&[]], amplitudes: &[0.03, 0.0] },
    regions: &[],
    drivers: &["force", "pressure"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    #[test]
    fn it_is_a_share_of_the_load_against_the_motion() {
        let mut memory = LoadDependentFriction.start(&nominal(), &[]);
        let inward = pull(&mut *memory, &still(), &base())[0];
        let outward = pull(&mut *memory, &Moment { direction: -1.0, ..still() }, &base())[0];
        assert_eq!((inward, outward), (-base().static_force_n, base().static_force_n));
    }

    #[test]
    fn a_cable_that_winds_up_rubs_more_the_more_the_muscle_has_contracted() {
        let mut memory = LoadDependentFriction.start(&nominal(), &[]);
        let [near, far] =
            [0.0, 0.2].map(|contraction_ratio| pull(&mut *memory, &Moment { contraction_ratio, ..still() }, &base()));
        assert!(near[1].abs() < f64::EPSILON && (far[1] - 0.2 * far[0]).abs() < 1e-9 && far[0] == near[0]);
    }

    #[test]
    fn a_muscle_that_pushes_presses_nothing_on() {
        let mut memory = LoadDependentFriction.start(&nominal(), &[]);
        let pushing = Base { static_force_n: -5.0, ..base() };
        assert!(pull(&mut *memory, &still(), &pushing)[0].abs() < f64::EPSILON);
    }
}
