//! Pre-sliding hysteresis: friction of the braid builds up over a distance instead of jumping.
//!
//! ```text
//! F_friction = -F_c(p, L) z,   z = Maxwell slip over δ   instead of   z = s
//! ```
//!
//! Where the length stands still, the strands slide under pressure by κ times what their stretch makes (eq. 2); a muscle whose
//! friction is held has κ = 0.

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Page, Symbol, Typical};
use crate::effects::slip::Follower;
use crate::effects::{Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct PreslidingHysteresis;

impl Effect for PreslidingHysteresis {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn role(&self) -> Role {
        Role::Slides
    }

    fn kind(&self) -> Kind {
        Kind::Muscle
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
        ]
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { follower: Follower::new(shape[0]), slide_at_rest: shape[1] })
    }
}

struct State {
    follower: Follower,
    slide_at_rest: f64,
}

impl Memory for State {
    fn slides(&mut self, now: &Moment) -> f64 {
        let slide_m = now.slide_m + (self.slide_at_rest - 1.0) * now.rest_slide_m;
        self.follower.follow(now, slide_m, now.direction)
    }
}

static PAGE: Page = Page {
    id: "presliding-hysteresis",
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
    ],
    validity: "Any path; no rate dependence. In an isometric recording the travel is κ times that of strands that \
               stretch under pressure.",
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
    typical: Typical { shapes: &[&[1e-3, 1.0]], amplitudes: &[] },
    regions: &[Coordinate::TravelSinceReversal],
    drivers: &["travel-since-reversal", "contraction"],
};
