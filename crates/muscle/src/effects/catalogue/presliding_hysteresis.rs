//! Pre-sliding hysteresis: friction of the braid builds up over a distance instead of jumping.
//!
//! ```text
//! F_friction = -F_c(p, L) z,   z = Maxwell slip over δ   instead of   z = s
//! ```
//!
//! Where the length stands still, the strands slide under pressure by κ times what their stretch makes (eq. 2), and turn over by the
//! share σ of what the model's own law of friction at standstill says; a muscle whose friction is held has κ = σ = 0.

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::slip::Follower;
use crate::effects::{Effect, Kind, Memory, Moment, Role, Seen, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct PreslidingHysteresis;

impl Effect for PreslidingHysteresis {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape {
                name: "slip_distance_m",
                symbol: "δ",
                unit: "m",
                range: (2e-4, 2e-2),
                grid: &[2e-4, 5e-4, 1e-3, 2e-3, 4e-3, 8e-3],
            },
            Shape { name: "slide_at_rest", symbol: "κ", unit: "1", range: (0.0, 20.0), grid: &[0.0, 1.0] },
            Shape { name: "turns_at_rest", symbol: "σ", unit: "1", range: (0.0, 1.0), grid: &[0.0, 1.0] },
        ]
    }

    /// Under pressure either the stretch of the strands moves the braid or the law of the model does.
    fn first_shapes(&self, _seen: &Seen) -> Vec<Vec<f64>> {
        let [distances, at_rest] = [0, 1].map(|index| self.shape()[index].grid);
        let laws = at_rest.iter().map(|&slide| [slide, 0.0]).chain([[0.0, 1.0]]);
        laws.flat_map(|law| distances.iter().map(move |&distance_m| vec![distance_m, law[0], law[1]])).collect()
    }

    /// It turns over as the model's friction does, wholly.
    fn may_end(&self, index: usize, end: f64) -> bool {
        index == 2 && end == 1.0
    }

    /// Models that do not say know κ alone.
    fn unless_stated(&self, index: usize) -> Option<f64> {
        (index == 2).then_some(0.0)
    }

    fn start(&self, muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State {
            follower: Follower::new(shape[0]),
            slide_at_rest: shape[1],
            turns_at_rest: shape[2],
            rest_length_m: muscle.rest_length_m,
            last: None,
        })
    }
}

struct State {
    follower: Follower,
    slide_at_rest: f64,
    turns_at_rest: f64,
    rest_length_m: f64,
    /// When anything last moved.
    last: Option<Moved>,
}

/// Where the braid was when anything moved, and which way friction acted then.
#[derive(Clone, Copy, PartialEq)]
struct Moved {
    recording: usize,
    contraction_ratio: f64,
    rest_slide_m: f64,
    direction: f64,
}

impl State {
    /// How far pressure has turned the model's friction over since anything last moved, where it is pressure that moves now. A turn is
    /// dated to where the pressure turned, which is before its noise lets it move again.
    fn turned_by_pressure(&mut self, now: &Moment) -> f64 {
        let &Moment { recording, contraction_ratio, rest_slide_m, direction, .. } = now;
        let moved = Moved { recording, contraction_ratio, rest_slide_m, direction };
        match self.last {
            Some(last) if last.recording == recording => {
                let pressed = rest_slide_m != last.rest_slide_m;
                if pressed || contraction_ratio != last.contraction_ratio {
                    self.last = Some(moved);
                }
                if pressed { direction - last.direction } else { 0.0 }
            }
            _ => {
                self.last = Some(moved);
                0.0
            }
        }
    }
}

impl Memory for State {
    fn slides(&mut self, now: &Moment) -> f64 {
        let turned = self.turned_by_pressure(now);
        self.follower.turn(now, self.turns_at_rest * turned);
        // Not the slide of the moment, whose two parts start and stop beyond the noise of both.
        let slide_m = now.contraction_ratio * self.rest_length_m + self.slide_at_rest * now.rest_slide_m;
        self.follower.follow(now, slide_m, now.direction)
    }
}

static PAGE: Page = Page {
    id: "presliding-hysteresis",
    role: Role::Slides,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "pre-sliding hysteresis of the braid",
    summary: "Strands that rub against one another bend before they slide, so after each reversal the friction \
              builds up over a distance of the order of a millimetre instead of jumping at once. Its full value grows \
              with the pressure.",
    equation: "F = F_static(p, L) - F_c(p, L) z,  z = Σ w_i z_i,  z_i ← clamp(z_i + Δx / r_i, -1, 1),  r_i = δ (0.15 … 4.5)",
    symbols: &[
        Symbol {
            symbol: "δ",
            unit: "m",
            meaning: "slip distance: 63 % of the friction are there after it; 0.2 to 5 mm",
        },
        Symbol { symbol: "z", unit: "1", meaning: "share of the full friction, in [-1, 1]" },
        Symbol { symbol: "F_c", unit: "N", meaning: "friction of eq. 11 while sliding" },
        Symbol { symbol: "x", unit: "m", meaning: "travel of the braid, rising while the muscle contracts" },
        Symbol {
            symbol: "κ",
            unit: "1",
            meaning: "slide under pressure at standstill, in units of what the stretch of the strands makes (eq. 2); 0 where \
                      friction is held",
        },
        Symbol {
            symbol: "σ",
            unit: "1",
            meaning: "share of the turn that the model's law of friction at standstill makes under pressure; 0 where friction \
                      is held or κ says it",
        },
    ],
    validity: "Any path; no rate dependence. In an isometric recording the travel is κ times that of strands that \
               stretch under pressure, or the friction turns over as the model's does.",
    source: "Vo-Minh, Tjahjowidodo, Ramon and Van Brussel (2011), IEEE/ASME Trans. Mechatronics 16(1); Al-Bender, \
             Lampaert and Swevers (2005), IEEE Trans. Automatic Control 50(11)",
    signature: "The residual sits in the first millimetres after every reversal and changes sign with the kind of \
                reversal; it does not depend on speed, nor on how long the muscle rested; minor loops are lenses that \
                return to where they turned.",
    confused_with: &[
        Confusion {
            id: "rubber-hysteresis",
            because: "both are loops without rate",
            test: "minor loops at two pressures: friction of the braid grows with the pressure, that of rubber does not",
        },
        Confusion {
            id: "series-compliance",
            because: "a soft fixture also makes the slope after a reversal finite",
            test: "minor loops at several pressures: the slope of a fixture is the same at all of them; or a rod in the \
                   place of the muscle",
        },
    ],
    test: "nested minor loops of 10, 5, 2 and 1 mm at constant pressure, at two speeds",
    protocol: "minor-loops",
    coordinate: Coordinate::TravelSinceReversal,
    typical: Typical { shapes: &[&[1e-3, 1.0, 0.0]], amplitudes: &[] },
    regions: &[Coordinate::TravelSinceReversal],
    drivers: &["travel-since-reversal", "contraction"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::still;
    use crate::geometry::tests::nominal;

    /// Shares of the full friction along moments that have contracted by so much, in m, with the pressure's slide and the direction
    /// of the model's friction.
    fn shares(shape: [f64; 3], path: &[(f64, f64, f64)]) -> Vec<f64> {
        let muscle = nominal();
        let mut memory = PreslidingHysteresis.start(&muscle, &shape);
        let mut share = |&(contraction_m, rest_slide_m, direction): &(f64, f64, f64)| {
            let contraction_ratio = contraction_m / muscle.rest_length_m;
            memory.slides(&Moment { contraction_ratio, rest_slide_m, direction, came: true, ..still() })
        };
        path.iter().map(&mut share).collect()
    }

    #[test]
    fn friction_builds_up_over_the_slip_distance_and_not_at_once() {
        let path: Vec<(f64, f64, f64)> = (0..=40).map(|step| (1e-4 * f64::from(step), 0.0, 1.0)).collect();
        let turned: Vec<(f64, f64, f64)> = path.iter().map(|&(x_m, _, _)| (4e-3 - x_m, 0.0, -1.0)).collect();
        let all = shares([1e-3, 0.0, 0.0], &[path, turned].concat());
        assert!((all[40] - 1.0).abs() < 1e-12);
        // A millimetre after the turn 63 % of the way to the other side are done, nearly.
        let done = 0.5 * (all[40] - all[51]);
        assert!((0.55..0.7).contains(&done), "{done}");
    }

    #[test]
    fn pressure_turns_friction_over_at_rest_as_the_model_says_or_by_the_stretch_of_strands_or_not_at_all() {
        // Contracted, held, and then the pressure falls: the model's friction follows it at once.
        let mut path =
            vec![(0.0, 0.0, 1.0), (1e-2, 0.0, 1.0), (1e-2, 0.0, -1.0), (1e-2, -1e-5, -1.0), (1e-2, -2e-5, -1.0)];
        let last = |shape, path: &[(f64, f64, f64)]| *shares(shape, path).last().expect("a share");
        assert!((last([1e-3, 0.0, 1.0], &path) + 1.0).abs() < 1e-12);
        assert!((last([1e-3, 0.0, 0.5], &path)).abs() < 1e-12);
        assert!((last([1e-3, 0.0, 0.0], &path) - 1.0).abs() < 1e-12);
        let slid = last([1e-3, 10.0, 0.0], &path);
        assert!(slid < 0.9 && slid > 0.5, "{slid}");
        // A turn of the length is none of the pressure's, whenever it is dated.
        path = vec![(0.0, 0.0, 1.0), (1e-2, 0.0, 1.0), (1e-2 - 1e-5, 0.0, -1.0), (1e-2 - 2e-5, 0.0, -1.0)];
        assert!(last([1e-3, 0.0, 1.0], &path) > 0.9);
    }

    #[test]
    fn what_the_noise_of_length_and_pressure_leaves_of_the_slide_of_the_braid_turns_nothing_over() {
        let muscle = nominal();
        let mut memory = PreslidingHysteresis.start(&muscle, &[2e-4, 0.0, 0.0]);
        let mut share = |contraction_m: f64, slide_m: f64| {
            let contraction_ratio = contraction_m / muscle.rest_length_m;
            memory.slides(&Moment { contraction_ratio, slide_m, direction: 1.0, came: true, ..still() })
        };
        share(0.0, 0.0);
        share(1e-2, 1e-2);
        let last = (0..200).map(|step| share(1e-2, 1e-2 - 5e-5 * f64::from(step % 2))).last().expect("a share");
        assert!((last - 1.0).abs() < 1e-12);
    }
}
