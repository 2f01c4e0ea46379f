//! Viscous damping: a force against the motion that grows with its speed.
//!
//! ```text
//! F = F_base - (c₀ + c₁ p / p_ref) v
//! ```

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// Pressure at which the coefficient is stated, in Pa.
const REFERENCE_PA: f64 = 3e5;

/// The effect.
#[derive(Debug)]
pub(super) struct ViscousDamping;

impl Effect for ViscousDamping {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[
            Amplitude { name: "damping_n_s_per_m", symbol: "c₀", unit: "N s/m", range: (0.0, 5e3) },
            Amplitude { name: "damping_with_pressure_n_s_per_m", symbol: "c₁", unit: "N s/m", range: (0.0, 5e3) },
        ]
    }

    fn start(&self, _muscle: &Muscle, _shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State)
    }
}

struct State;

impl Memory for State {
    fn pulls(&mut self, now: &Moment, _base: &Base, columns: &mut [f64]) {
        columns[0] = -now.speed_m_per_s;
        columns[1] = -now.speed_m_per_s * now.pressure_pa / REFERENCE_PA;
    }
}

static PAGE: Page = Page {
    id: "viscous-damping",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "viscous damping",
    summary: "Rubber and lubricated strands resist motion in proportion to its speed.",
    equation: "F = F_base - (c₀ + c₁ p / p_ref) v,  p_ref = 0.3 MPa",
    symbols: &[
        Symbol { symbol: "c₀", unit: "N s/m", meaning: "damping without pressure; c₀ + c₁ is 20 to 500 N s/m" },
        Symbol { symbol: "c₁", unit: "N s/m", meaning: "what 0.3 MPa add to it" },
        Symbol { symbol: "v", unit: "m/s", meaning: "speed of contraction" },
    ],
    validity: "Speeds below 0.2 m/s.",
    source: "Reynolds, Repperger, Phillips and Bandry (2003), Annals of Biomedical Engineering 31(3)",
    signature: "The residual is proportional to the speed of contraction, with the opposite sign; loops widen in \
                proportion to the rate and vanish in slow motion and in isometric recordings.",
    confused_with: &[Confusion {
        id: "channel-delay",
        because: "a late length channel gives a force that is late by the stiffness times the speed",
        test: "an isometric pressure chirp: damping vanishes there, a delay between pressure and force does not; for the \
               length channel, taps at zero pressure",
    }],
    test: "isobaric triangles at five speeds from 0.5 to 50 mm/s: the width of the loop grows in proportion to the speed",
    protocol: "rate-ladder",
    coordinate: Coordinate::Speed,
    typical: Typical { shapes: &[&[]], amplitudes: &[100.0, 100.0] },
    regions: &[],
    drivers: &["speed"],
};
