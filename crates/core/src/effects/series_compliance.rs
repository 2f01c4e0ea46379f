//! Series compliance: part of the recorded length is the stretch of the fixture.
//!
//! ```text
//! L_m = L - c F
//! ```
//!
//! In a simulation `F` is the force a moment ago, which settles where `c` times the stiffness of the muscle is
//! below one.

use super::page::{Confusion, Page, Symbol};
use super::{Effect, Kind, Memory, Moment, Role, Shape};
use crate::artifact::diagnosis::Coordinate;
use crate::muscle::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct SeriesCompliance;

impl Effect for SeriesCompliance {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn role(&self) -> Role {
        Role::Sees
    }

    fn is_static(&self) -> bool {
        true
    }

    fn kind(&self) -> Kind {
        Kind::Fixture
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape {
                name: "compliance_m_per_n",
                unit: "m/N",
                range: (1e-7, 1e-4),
                // 800, 400, 200, 100, 50 and 25 N/mm.
                grid: &[1.25e-6, 2.5e-6, 5e-6, 1e-5, 2e-5, 4e-5],
            },
            Shape { name: "sliding_share", unit: "1", range: (0.0, 1.0), grid: &[0.0, 1.0] },
        ]
    }

    fn start(&self, muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        let &[compliance_m_per_n, sliding_share] = shape else { unreachable!("two shape parameters") };
        Box::new(State { compliance_m_per_n, sliding_share, rest_length_m: muscle.rest_length_m, last: None })
    }
}

struct State {
    compliance_m_per_n: f64,
    sliding_share: f64,
    rest_length_m: f64,
    /// Recording, slide in m, and direction of the muscle a moment ago.
    last: Option<(usize, f64, f64)>,
}

/// Travel of the muscle in which its friction turns over, in m: a few deviations of a length sensor, and about what strands take.
const TURN_M: f64 = 1e-4;

impl Memory for State {
    fn sees(&mut self, now: &mut Moment) {
        let stretch_m = self.compliance_m_per_n * now.force_n;
        now.length_m -= stretch_m;
        now.contraction_ratio += stretch_m / self.rest_length_m;
        now.slide_m += stretch_m;
        // The muscle turns where its own length does, not where the recorded one does.
        let turned = match self.last {
            Some((recording, slide_m, direction)) if recording == now.recording => {
                (direction + 2.0 * (now.slide_m - slide_m) / TURN_M).clamp(-1.0, 1.0)
            }
            _ => now.direction,
        };
        self.last = Some((now.recording, now.slide_m, turned));
        now.direction += self.sliding_share * (turned - now.direction);
    }
}

static PAGE: Page = Page {
    id: "series-compliance",
    name: "compliance of the fixture",
    summary: "Load cell, frame and cable stretch with the force, so the muscle is shorter than recorded. A muscle that \
              is held at its ends contracts a little as it pulls.",
    equation: "F = F_base(p, L - c F)",
    symbols: &[
        Symbol {
            symbol: "c",
            unit: "m/N",
            meaning: "compliance in series; 1/c is 200 to 2000 N/mm for cell and frame, 20 to 100 N/mm for a cable",
        },
        Symbol {
            symbol: "s",
            unit: "1",
            meaning: "share of the stretch with which the strands slide: 1 where the muscle turns when its own length does, 0 \
                      where friction follows the recorded length",
        },
        Symbol { symbol: "F", unit: "N", meaning: "force, as measured where it was measured" },
    ],
    validity: "A linear fixture without play; slow against its own resonance. The speed is left as recorded.",
    source: "springs in series",
    signature: "The residual is static, and goes with the force times the stiffness of the muscle: largest at high \
                pressure and small contraction, where the muscle seems too soft.",
    confused_with: &[
        Confusion {
            id: "end-taper",
            because: "both are static and grow with the pressure",
            test: "a rod in the place of the muscle shows the fixture; a photograph of the muscle shows the cones",
        },
        Confusion {
            id: "presliding-hysteresis",
            because: "a soft fixture also makes the slope behind a reversal finite",
            test: "minor loops at several pressures: the slope of a fixture is the same at all of them; or a rod in the \
                   place of the muscle",
        },
        Confusion {
            id: "threshold-pressure",
            because: "without low pressures in the recording both are static and bend the force over the pressure",
            test: "isometric ramps from a vented muscle, slowly up to 120 kPa",
        },
    ],
    test: "a rod in the place of the muscle, pulled from 0 to 500 N while the length is recorded",
    protocol: "isometric-ramps",
    coordinate: Coordinate::Force,
};

#[cfg(test)]
mod tests {
    use super::super::moment::tests::still;
    use super::*;
    use crate::muscle::tests::nominal;

    #[test]
    fn the_muscle_is_shorter_than_recorded() {
        let muscle = nominal();
        let mut now = still();
        // 350 N on 50 N/mm.
        SeriesCompliance.start(&muscle, &[2e-5, 1.0]).sees(&mut now);
        assert!((now.length_m - 0.233).abs() < 1e-12);
        assert!((now.contraction_ratio - muscle.contraction_ratio(0.233)).abs() < 1e-12);
        assert!((now.slide_m - 0.034).abs() < 1e-12);
    }

    #[test]
    fn a_held_muscle_that_pulls_harder_turns_where_friction_follows_its_own_length() {
        for (sliding_share, expected) in [(1.0, 1.0), (0.5, 0.0), (0.0, -1.0)] {
            let mut memory = SeriesCompliance.start(&nominal(), &[2e-5, sliding_share]);
            let mut now = still();
            for force_n in [300.0, 301.0, 304.0, 310.0] {
                now = Moment { force_n, direction: -1.0, ..still() };
                memory.sees(&mut now);
            }
            assert!((now.direction - expected).abs() < 1e-12, "{}", now.direction);
        }
    }
}
