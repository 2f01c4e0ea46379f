//! Inertia: mass between muscle and load cell takes force to accelerate.
//!
//! ```text
//! F = F_base - m a,   a = acceleration of contraction
//! ```

use super::page::{Confusion, Page, Symbol};
use super::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::artifact::diagnosis::Coordinate;
use crate::muscle::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct Inertia;

impl Effect for Inertia {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn role(&self) -> Role {
        Role::Pulls
    }

    fn kind(&self) -> Kind {
        Kind::Fixture
    }

    fn shape(&self) -> &'static [Shape] {
        &[]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "mass_kg", unit: "kg", range: (-5.0, 5.0) }]
    }

    fn start(&self, _muscle: &Muscle, _shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State)
    }
}

struct State;

impl Memory for State {
    fn pulls(&mut self, now: &Moment, _base: &Base, columns: &mut [f64]) {
        columns[0] = -now.acceleration_m_per_s2;
    }
}

static PAGE: Page = Page {
    id: "inertia",
    name: "inertia of what moves",
    summary: "A load cell on the moving end reads the force of the muscle less what its own mount and a third of the \
              muscle take to be accelerated.",
    equation: "F = F_base - m a",
    symbols: &[
        Symbol {
            symbol: "m",
            unit: "kg",
            meaning: "mass between muscle and cell, 0.1 to 1.5 kg; negative where the acceleration is that of a frame \
                      which moves the other way",
        },
        Symbol { symbol: "a", unit: "m/s²", meaning: "acceleration of contraction, -d²L/dt²" },
    ],
    validity: "A rigid fixture, well below its resonance. With the cell at the fixed end some 30 g are all there is.",
    source: "Newton's second law",
    signature: "The residual is proportional to the acceleration, in phase with the length in a sine, and grows with the \
                square of the frequency; nothing in slow triangles but at their turns.",
    confused_with: &[
        Confusion {
            id: "channel-delay",
            because: "a delay of the force in a sine looks like a share of the acceleration at one frequency",
            test: "a length chirp: inertia grows with the square of the frequency, a delay in proportion; inertia does \
                   not depend on the pressure",
        },
        Confusion {
            id: "viscous-damping",
            because: "both grow with the frequency of a sine",
            test: "a length chirp: damping is in phase with the speed, inertia with the length",
        },
    ],
    test: "isobaric length chirp from 0.05 to 8 Hz at two pressures; or the fixture without the muscle",
    protocol: "length-chirp",
    coordinate: Coordinate::Speed,
};

#[cfg(test)]
mod tests {
    use super::super::moment::tests::{base, pull, still};
    use super::*;
    use crate::muscle::tests::nominal;

    #[test]
    fn a_kilogram_takes_a_newton_per_unit_of_acceleration() {
        let mut memory = Inertia.start(&nominal(), &[]);
        let now = Moment { acceleration_m_per_s2: 2.5, ..still() };
        assert_eq!(pull(&mut *memory, &now, &base())[0], -2.5);
    }
}
