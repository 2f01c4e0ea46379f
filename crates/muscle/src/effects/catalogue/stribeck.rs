//! Stribeck effect: friction that is larger at a crawl than in motion.
//!
//! ```text
//! F = F_base - s f_s p π D L h,   dh/dt = (exp(-(|v| / v_s)ⁿ) - h) (|v| / δ + a),   δ = 0.1 mm
//! ```
//!
//! Friction follows the speed with the travel that renews the contacts, and with their age: without any aging a stop from full
//! speed leaves it small until the next move, as a rest does not push; contacts that age at once follow the static curve of
//! Stribeck, whose friction at rest is the largest.

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// Travel over which contacts are renewed, in m: an assumption. It lets friction remember the speed that it came from (the
/// frictional memory of Armstrong-Hélouvry, Dupont and Canudas de Wit, 1994), so that a stop does not push.
const RENEWAL_M: f64 = 1e-4;

/// Rate at which contacts age at once, on the grid of any recording, in 1/s.
const AT_ONCE_PER_S: f64 = 200.0;

/// The effect.
#[derive(Debug)]
pub(super) struct Stribeck;

impl Effect for Stribeck {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape {
                name: "stribeck_speed_m_per_s",
                symbol: "v_s",
                unit: "m/s",
                range: (3e-4, 5e-2),
                grid: &[1e-3, 2e-3, 5e-3, 1e-2, 2e-2],
            },
            Shape { name: "exponent", symbol: "n", unit: "1", range: (0.5, 2.5), grid: &[1.0, 2.0] },
            Shape {
                name: "aging_per_s",
                symbol: "a",
                unit: "1/s",
                range: (0.0, AT_ONCE_PER_S),
                grid: &[0.0, 1.0, AT_ONCE_PER_S],
            },
        ]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "static_friction", symbol: "f_s", unit: "1", range: (0.0, 0.02) }]
    }

    /// The exponent and the aging may.
    fn may_end(&self, index: usize, _end: f64) -> bool {
        index > 0
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { stribeck_speed_m_per_s: shape[0], exponent: shape[1], aging_per_s: shape[2], last: None })
    }
}

struct State {
    stribeck_speed_m_per_s: f64,
    exponent: f64,
    aging_per_s: f64,
    last: Option<Last>,
}

/// The moment before.
struct Last {
    recording: usize,
    slide_m: f64,
    speed_m_per_s: f64,
    /// `h`.
    level: f64,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        let speed_m_per_s = now.slide_speed_m_per_s.abs();
        let crawl = |speed_m_per_s: f64| (-(speed_m_per_s / self.stribeck_speed_m_per_s).powf(self.exponent)).exp();
        let level = match &self.last {
            Some(last) if last.recording == now.recording => {
                // In a step in which it starts or stops, the way is that of its motion.
                let crawl = crawl(speed_m_per_s.max(last.speed_m_per_s));
                let renewed = (now.slide_m - last.slide_m).abs() / RENEWAL_M + self.aging_per_s * now.step_s;
                crawl + (last.level - crawl) * (-renewed).exp()
            }
            _ => crawl(speed_m_per_s),
        };
        self.last = Some(Last { recording: now.recording, slide_m: now.slide_m, speed_m_per_s, level });
        columns[0] = -now.direction * base.normal_n * level;
    }
}

static PAGE: Page = Page {
    id: "stribeck",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "Stribeck effect",
    summary: "Friction of the braid is larger at a crawl than in motion. It falls with the speed over some millimetres \
              per second and breaks away after a rest, which makes slow motion under a soft load jerky.",
    equation: "F = F_base - s f_s p π D L h,  dh/dt = (exp(-(|v| / v_s)ⁿ) - h) (|v| / δ + a),  δ = 0.1 mm",
    symbols: &[
        Symbol {
            symbol: "f_s",
            unit: "1",
            meaning: "friction at a crawl above that in motion, in units of eq. 9; 0.1 to 1 times f'",
        },
        Symbol { symbol: "v_s", unit: "m/s", meaning: "speed at which 63 % of it are gone; 1 to 20 mm/s" },
        Symbol { symbol: "n", unit: "1", meaning: "how steeply it falls: 1 exponentially, 2 as a bell curve" },
        Symbol {
            symbol: "a",
            unit: "1/s",
            meaning: "aging at rest: 0 a stop changes nothing, 200 at once static friction",
        },
        Symbol { symbol: "s", unit: "1", meaning: "direction of motion, kept at standstill" },
        Symbol { symbol: "v", unit: "m/s", meaning: "speed of contraction" },
        Symbol { symbol: "h", unit: "1", meaning: "1 at a crawl, 0 in motion; it follows with travel and age" },
    ],
    validity: "Motion that is long against the pre-sliding distance; static friction that goes on growing for minutes is left out.",
    source: "Tondu and Lopez (2000), IEEE Control Systems 20(2), for threads on threads; Armstrong-Hélouvry, Dupont and \
             Canudas de Wit (1994), Automatica 30(7), for friction with a memory, whose travel δ is an assumption",
    signature: "The residual is odd in the direction and sits at low speed: half the width of an isobaric loop falls \
                with the logarithm of the speed. At one constant rate it is only more friction and leaves nothing.",
    confused_with: &[
        Confusion {
            id: "rate-dependent-hysteresis",
            because: "both change the width of the loop over the logarithm of the speed, with opposite slopes",
            test: "isobaric triangles at five speeds or more: the width falls, or it rises",
        },
        Confusion {
            id: "viscoelastic-relaxation",
            because: "a start after a rest overshoots with both",
            test: "start again after rests of 0.1 to 100 s, once onwards and once backwards: relaxation is there during \
                   the rest already",
        },
        Confusion {
            id: "viscous-damping",
            because: "too large a damping and too small a friction cancel over a narrow range of speeds",
            test: "widen the range of speeds to two decades: a falling and then a rising width show both",
        },
    ],
    test: "isobaric triangles at five speeds from 0.5 to 50 mm/s: the width of the loop falls with the speed",
    protocol: "rate-ladder",
    coordinate: Coordinate::Speed,
    // Half of an f' of 1.2e-3.
    typical: Typical { shapes: &[&[5e-3, 1.0, 0.0]], amplitudes: &[6e-4] },
    regions: &[Coordinate::Speed],
    drivers: &["speed"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    #[test]
    fn it_falls_from_static_friction_to_nothing() {
        let at = |slide_speed_m_per_s| {
            let mut memory = Stribeck.start(&nominal(), &[5e-3, 1.0, 0.0]);
            pull(&mut *memory, &Moment { slide_speed_m_per_s, ..still() }, &base())[0]
        };
        assert_eq!(at(0.0), -base().normal_n);
        assert!((at(5e-3) / at(0.0) - (-1.0_f64).exp()).abs() < 1e-12);
        assert!(at(1.0).abs() < 1e-12);
    }

    #[test]
    fn a_stop_leaves_it_as_it_was_and_a_crawl_renews_it() {
        let mut memory = Stribeck.start(&nominal(), &[5e-3, 1.0, 0.0]);
        let mut at = |slide_m, slide_speed_m_per_s| {
            pull(&mut *memory, &Moment { slide_m, slide_speed_m_per_s, ..still() }, &base())[0] / -base().normal_n
        };
        assert!(at(0.0, 1.0) < 1e-12);
        assert!(at(0.0, 0.0) < 1e-12);
        assert!((at(RENEWAL_M, 0.0) - (1.0 - (-1.0_f64).exp())).abs() < 1e-9);
        assert!(at(30.0 * RENEWAL_M, 0.0) > 1.0 - 1e-9);
        // The way of a step in which it stops is that of its motion.
        assert!(at(60.0 * RENEWAL_M, 1.0) < 1e-12);
        assert!(at(90.0 * RENEWAL_M, 0.0) < 1e-12);
    }

    #[test]
    fn contacts_that_age_follow_the_static_curve_at_rest() {
        for (aging_per_s, expected) in [(0.0, 0.0), (1.0, 1.0 - (-1.0_f64).exp()), (AT_ONCE_PER_S, 1.0)] {
            let mut memory = Stribeck.start(&nominal(), &[5e-3, 1.0, aging_per_s]);
            let mut at = |slide_speed_m_per_s| {
                let now = Moment { slide_speed_m_per_s, step_s: 1.0 / 50.0, ..still() };
                pull(&mut *memory, &now, &base())[0] / -base().normal_n
            };
            at(1.0);
            // The step of the stop belongs to the motion, then 50 steps make a second.
            let level = (0..51).fold(0.0, |_, _| at(0.0));
            assert!((level - expected).abs() < 1e-6, "{aging_per_s}: {level}");
        }
    }

    #[test]
    fn it_opposes_the_motion() {
        let mut memory = Stribeck.start(&nominal(), &[5e-3, 1.0, 0.0]);
        let now = Moment { slide_speed_m_per_s: -1e-3, direction: -1.0, ..still() };
        assert!(pull(&mut *memory, &now, &base())[0] > 0.0);
    }
}
