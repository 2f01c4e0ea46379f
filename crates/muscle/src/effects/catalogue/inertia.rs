//! Inertia: mass between muscle and load cell takes force to accelerate.
//!
//! ```text
//! F = F_base - m b,   d²b/dt² = ω² (a - b) - 2 ω db/dt,   ω = 2 π f
//! ```
//!
//! `a` is the acceleration of contraction, `b` that of a mass which hangs on it by a critically damped mount.

use std::f64::consts::TAU;

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// Beyond which a mount is rigid, in Hz.
const RIGID_HZ: f64 = 200.0;

/// The effect.
#[derive(Debug)]
pub(super) struct Inertia;

impl Effect for Inertia {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        // Below, a mount is so soft that its mass looks like damping.
        &[Shape { name: "mount_hz", symbol: "f", unit: "Hz", range: (12.0, RIGID_HZ), grid: &[25.0, RIGID_HZ] }]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "mass_kg", symbol: "m", unit: "kg", range: (-30.0, 30.0) }]
    }

    /// A rigid mount.
    fn may_end(&self, _index: usize, end: f64) -> bool {
        end == RIGID_HZ
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { mount: Mount::new(shape[0]) })
    }
}

struct State {
    mount: Mount,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, _base: &Base, columns: &mut [f64]) {
        columns[0] = -self.mount.follow(now.acceleration_m_per_s2, now.step_s);
    }
}

/// A critically damped mount: what hangs on it follows late, and smoothly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mount {
    rad_per_s: f64,
    /// Value and its rate; none before the first step.
    state: Option<(f64, f64)>,
}

impl Mount {
    /// At rest, with a natural frequency in Hz.
    pub fn new(natural_hz: f64) -> Self {
        Self { rad_per_s: TAU * natural_hz, state: None }
    }

    /// The value behind the mount, `step_s` later, where `driven` is the one before it all that time; exact. Settled at the
    /// first step, and where `step_s` is 0.
    pub fn follow(&mut self, driven: f64, step_s: f64) -> f64 {
        let (value, rate) = match self.state {
            Some((value, rate)) if step_s > 0.0 => {
                let (ahead, decay) = (value - driven, (-self.rad_per_s * step_s).exp());
                let slide = rate + self.rad_per_s * ahead;
                (driven + (ahead + slide * step_s) * decay, (rate - slide * self.rad_per_s * step_s) * decay)
            }
            _ => (driven, 0.0),
        };
        self.state = Some((value, rate));
        value
    }
}

static PAGE: Page = Page {
    id: "inertia",
    role: Role::Pulls,
    kind: Kind::Fixture,
    dependence: Dependence::Past,
    name: "inertia of what moves",
    summary: "A load cell on the moving end reads the force of the muscle less what its own mount and a third of the \
              muscle take to be accelerated.",
    equation: "F = F_base - m b, d²b/dt² = ω² (a - b) - 2 ω db/dt, ω = 2 π f",
    symbols: &[
        Symbol {
            symbol: "m",
            unit: "kg",
            meaning: "mass between muscle and cell, 0.1 to 1.5 kg, more with a sled; negative on a frame that moves \
                      the other way",
        },
        Symbol { symbol: "a", unit: "m/s²", meaning: "acceleration of contraction, -d²L/dt²" },
        Symbol { symbol: "b", unit: "m/s²", meaning: "acceleration of the mass" },
        Symbol {
            symbol: "f",
            unit: "Hz",
            meaning: "natural frequency of the critically damped mount; rigid at 200 Hz",
        },
    ],
    validity: "One resonance, well damped. With the cell at the fixed end some 30 g are all there is.",
    source: "Newton's second law",
    signature: "The residual is proportional to the acceleration, in phase with the length in a sine, and grows with the \
                square of the frequency; where a drive starts, stops or turns, the load cell is knocked.",
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
    typical: Typical { shapes: &[&[25.0]], amplitudes: &[0.5] },
    regions: &[],
    drivers: &["speed"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    #[test]
    fn a_kilogram_takes_a_newton_per_unit_of_acceleration() {
        let mut memory = Inertia.start(&nominal(), &[25.0]);
        let now = Moment { acceleration_m_per_s2: 2.5, ..still() };
        assert_eq!(pull(&mut *memory, &now, &base())[0], -2.5);
        assert_eq!(pull(&mut *memory, &Moment { step_s: 0.005, ..now }, &base())[0], -2.5);
    }

    #[test]
    fn a_mount_follows_its_equation() {
        const FINE_S: f64 = 1e-6;
        let (mut coarse, natural_hz) = (Mount::new(20.0), 20.0);
        let (mut value, mut rate) = (0.0, 0.0);
        let rad_per_s = TAU * natural_hz;
        coarse.follow(0.0, 0.0);
        for driven in [1.0, -2.0, 0.5] {
            for _ in 0..5000 {
                let bend = rad_per_s * (rad_per_s * (driven - value) - 2.0 * rate);
                rate += bend * FINE_S;
                value += rate * FINE_S;
            }
            assert!((coarse.follow(driven, 0.005) - value).abs() < 1e-3);
        }
    }
}
