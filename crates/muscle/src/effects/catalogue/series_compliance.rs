//! Series compliance: part of the recorded length is the stretch of the fixture.
//!
//! ```text
//! L_m = L - c ln(1 + q F) / q
//! ```
//!
//! In a simulation `F` is the force a moment ago, which settles where `c` times the stiffness of the muscle is
//! below one.

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct SeriesCompliance;

impl Effect for SeriesCompliance {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape {
                name: "compliance_m_per_n",
                symbol: "c",
                unit: "m/N",
                range: (1e-7, 1e-4),
                // 800, 400, 200, 100, 50 and 25 N/mm.
                grid: &[1.25e-6, 2.5e-6, 5e-6, 1e-5, 2e-5, 4e-5],
            },
            Shape { name: "sliding_share", symbol: "s", unit: "1", range: (0.0, 1.0), grid: &[0.0, 1.0] },
            // Linear, and a cable that is twice as stiff under 100 N.
            Shape { name: "hardening_per_n", symbol: "q", unit: "1/N", range: (0.0, 0.1), grid: &[0.0, 0.01] },
        ]
    }

    /// All of the muscle's own motion may slide the braid.
    fn may_end(&self, index: usize, end: f64) -> bool {
        index == 1 && end == 1.0
    }

    fn start(&self, muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        let &[compliance_m_per_n, sliding_share, hardening_per_n] = shape else {
            unreachable!("three shape parameters")
        };
        let rest_length_m = muscle.rest_length_m;
        Box::new(State { compliance_m_per_n, sliding_share, hardening_per_n, rest_length_m, last: None })
    }
}

struct State {
    compliance_m_per_n: f64,
    sliding_share: f64,
    hardening_per_n: f64,
    rest_length_m: f64,
    /// Recording, slide in m, and direction of the muscle a moment ago.
    last: Option<(usize, f64, f64)>,
}

/// Travel of the muscle in which its friction turns over, in m: a few deviations of a length sensor, and about what strands take.
const TURN_M: f64 = 1e-4;

impl State {
    /// Stretch of the fixture, in m, whose stiffness rises in proportion to `1 + q F` under tension; linear under compression.
    fn stretch_m(&self, force_n: f64) -> f64 {
        let hardened = self.hardening_per_n * force_n.max(0.0);
        let softer = if hardened > 1e-9 { hardened.ln_1p() / hardened } else { 1.0 };
        self.compliance_m_per_n * force_n * softer
    }
}

impl Memory for State {
    fn sees(&mut self, now: &mut Moment) {
        let stretch_m = self.stretch_m(now.force_n);
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
    role: Role::Sees,
    kind: Kind::Fixture,
    dependence: Dependence::State,
    name: "compliance of the fixture",
    summary: "Load cell, frame and cable stretch with the force, so the muscle is shorter than recorded. A muscle that \
              is held at its ends contracts a little as it pulls.",
    equation: "F = F_base(p, L - c ln(1 + q F) / q)",
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
        Symbol {
            symbol: "q",
            unit: "1/N",
            meaning: "hardening: the stiffness is (1 + q F) / c, that of a cable or a thread that settles as it straightens; 0 \
                      for a linear fixture, 0.002 to 0.05 for a cable",
        },
        Symbol { symbol: "F", unit: "N", meaning: "force, as measured where it was measured" },
    ],
    validity: "A fixture without play; slow against its own resonance. The speed is left as recorded. What gives by less than about \
               1.3 radii of the muscle at the largest force may be the ends of the muscle itself, and gets no name.",
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
            because: "a soft fixture also makes the slope after a reversal finite",
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
    // 100 N/mm.
    typical: Typical { shapes: &[&[1e-5, 1.0, 0.0]], amplitudes: &[] },
    regions: &[],
    drivers: &["force"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::still;
    use crate::geometry::tests::nominal;

    #[test]
    fn the_muscle_is_shorter_than_recorded() {
        let muscle = nominal();
        let mut now = still();
        // 350 N on 50 N/mm.
        SeriesCompliance.start(&muscle, &[2e-5, 1.0, 0.0]).sees(&mut now);
        assert!((now.length_m - 0.233).abs() < 1e-12);
        assert!((now.contraction_ratio - muscle.contraction_ratio(0.233)).abs() < 1e-12);
        assert!((now.slide_m - 0.034).abs() < 1e-12);
    }

    #[test]
    fn a_cable_hardens_as_it_straightens() {
        let stretch_m = |hardening_per_n, force_n| {
            let mut now = Moment { force_n, ..still() };
            SeriesCompliance.start(&nominal(), &[2e-5, 0.0, hardening_per_n]).sees(&mut now);
            still().length_m - now.length_m
        };
        // 100 N on a cable of 50 N/mm that doubles its stiffness there: ln 2 of what a linear one gives.
        assert!((stretch_m(0.01, 100.0) - 2e-3 * 2.0_f64.ln()).abs() < 1e-12);
        let slope_m_per_n = (stretch_m(0.01, 100.5) - stretch_m(0.01, 99.5)) / 1.0;
        assert!((slope_m_per_n / 1e-5 - 1.0).abs() < 1e-4);
        assert!((stretch_m(1e-12, 100.0) - stretch_m(0.0, 100.0)).abs() < 1e-12);
        assert!((stretch_m(0.01, -5.0) - stretch_m(0.0, -5.0)).abs() < 1e-15);
    }

    #[test]
    fn a_held_muscle_that_pulls_harder_turns_where_friction_follows_its_own_length() {
        for (sliding_share, expected) in [(1.0, 1.0), (0.5, 0.0), (0.0, -1.0)] {
            let mut memory = SeriesCompliance.start(&nominal(), &[2e-5, sliding_share, 0.0]);
            let mut now = still();
            for force_n in [300.0, 301.0, 304.0, 310.0] {
                now = Moment { force_n, direction: -1.0, ..still() };
                memory.sees(&mut now);
            }
            assert!((now.direction - expected).abs() < 1e-12, "{}", now.direction);
        }
    }
}
