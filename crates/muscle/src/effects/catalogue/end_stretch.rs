//! Stretch of the ends: a muscle that is clamped at its ends grows a little longer as it pulls, without a name.
//!
//! ```text
//! F = F_base - c F_base ∂F_base/∂L
//! ```
//!
//! Within about a radius of a clamp the strands do not follow the kinematics of a cylinder, and straighten as they are pulled. Muscles of
//! slices in equilibrium, clamped at both ends, show it as a spring in series, which to first order is `F_base(p, L - c F)`, and some
//! tenths of a radius long at the largest force. It is no derived law of ends.

use crate::coordinate::Coordinate;
use crate::effects::page::{Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// It is no effect of the catalogue: every muscle has ends.
#[derive(Debug)]
pub(super) struct EndStretch;

impl Effect for EndStretch {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "stretch_m_per_n", symbol: "c", unit: "m/N", range: (-1e-4, 1e-4) }]
    }

    fn uses_slopes(&self) -> bool {
        true
    }

    fn start(&self, _muscle: &Muscle, _shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State)
    }
}

struct State;

impl Memory for State {
    fn pulls(&mut self, _now: &Moment, base: &Base, columns: &mut [f64]) {
        columns[0] = per_m_per_n(base);
    }
}

/// Force that a metre of stretch per newton adds, in N²/m.
pub fn per_m_per_n(base: &Base) -> f64 {
    -base.static_force_n * base.slope_n_per_m
}

static PAGE: Page = Page {
    id: "end-stretch",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::State,
    name: "stretch of the ends",
    summary: "Within about a radius of its clamps a muscle is no cylinder, and grows a little longer as it pulls. It has no name \
              in physics: a fixture that gives by as little looks alike.",
    equation: "F = F_base - c F_base ∂F_base/∂L",
    symbols: &[
        Symbol {
            symbol: "c",
            unit: "m/N",
            meaning: "stretch per force; at the largest force some tenths of a radius of the muscle",
        },
        Symbol { symbol: "F_base", unit: "N", meaning: "force of eq. 11 without friction" },
    ],
    validity: "A stretch that is small against the way in which the force changes.",
    source: "springs in series, to first order; seen in slices in equilibrium that are clamped at their ends, not derived for them",
    signature: "The residual is static, and goes with the force times the stiffness of the muscle.",
    confused_with: &[],
    test: "a rod in the place of the muscle, pulled from 0 to 500 N while the length is recorded, shows what is the fixture's",
    protocol: "isobaric-triangles",
    coordinate: Coordinate::Force,
    typical: Typical::UNKNOWN,
    regions: &[],
    drivers: &[],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    #[test]
    fn a_muscle_that_is_pulled_longer_is_shorter_than_recorded() {
        let column = pull(&mut *EndStretch.start(&nominal(), &[]), &still(), &base())[0];
        assert!(column < 0.0 && (column + base().static_force_n * base().slope_n_per_m).abs() < 1e-12);
    }
}
