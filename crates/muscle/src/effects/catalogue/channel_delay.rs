//! Channel delay: the channels were not sampled at the same time.
//!
//! ```text
//! F(t) = F_base(p(t + d_p), L(t + d_L))
//! ```
//!
//! with the delays of pressure and length behind the force. Only two delays of three channels can be found.

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Effect, Kind, Memory, Role, Seen, Shape};
use crate::geometry::Muscle;

/// Delays that a fit tries first, either sign, in s.
const FIRST_S: [f64; 4] = [0.005, 0.01, 0.02, 0.04];

/// The effect.
#[derive(Debug)]
pub(super) struct ChannelDelay;

impl Effect for ChannelDelay {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape {
                name: "pressure_delay_s",
                symbol: "d_p",
                unit: "s",
                range: (-0.2, 0.2),
                grid: &[-0.02, -0.005, 0.0, 0.005, 0.02],
            },
            Shape {
                name: "length_delay_s",
                symbol: "d_L",
                unit: "s",
                range: (-0.2, 0.2),
                grid: &[-0.02, -0.005, 0.0, 0.005, 0.02],
            },
        ]
    }

    fn first_shapes(&self, _seen: &Seen) -> Vec<Vec<f64>> {
        // Pressure alone, length alone, and both, which is the force.
        [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
            .iter()
            .flat_map(|late| {
                let delays_s = FIRST_S.iter().rev().map(|delay_s| -delay_s).chain(FIRST_S);
                delays_s.map(move |delay_s| late.iter().map(|share| share * delay_s).collect())
            })
            .collect()
    }

    fn delays_s(&self, shape: &[f64]) -> [f64; 2] {
        [shape[0], shape[1]]
    }

    fn start(&self, _muscle: &Muscle, _shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State)
    }
}

struct State;

impl Memory for State {}

static PAGE: Page = Page {
    id: "channel-delay",
    role: Role::Shift,
    kind: Kind::Instrument,
    dependence: Dependence::Past,
    name: "delay between the channels",
    summary: "Serial lines, filters and loggers that poll deliver the channels some milliseconds apart. In fast motion \
              the model then computes the force of another instant.",
    equation: "F(t) = F_base(p(t + d_p), L(t + d_L))",
    symbols: &[
        Symbol { symbol: "d_p", unit: "s", meaning: "by how much the pressure lags the force; -50 to 50 ms" },
        Symbol {
            symbol: "d_L",
            unit: "s",
            meaning: "by how much the length lags the force; -50 to 50 ms. Both alike: the force is early",
        },
    ],
    validity: "Delays that do not change; interpolation between samples, so no faster motion than a tenth of the \
               sampling rate.",
    source: "time base of data loggers; Ljung (1999), \"System Identification\", chapter 14, for alignment before fits",
    signature: "Loops open in proportion to the rate with the force's own slope, ∂F/∂p times the rate of the pressure or \
                ∂F/∂L times that of the length, and with either sign; a damping below zero gives it away.",
    confused_with: &[
        Confusion {
            id: "viscous-damping",
            because: "a late length channel gives a force that is late by the stiffness times the speed",
            test: "an isometric pressure chirp: damping vanishes there, a delay between pressure and force does not; for \
                   the length channel, taps at zero pressure",
        },
        Confusion {
            id: "pressure-lag",
            because: "in slow motion a lag and a delay shift the pressure by the same time",
            test: "an isometric pressure sine from 0.05 to 10 Hz: the phase of a lag levels off, that of a delay grows in \
                   proportion to the frequency",
        },
        Confusion {
            id: "inertia",
            because: "a delay of the force in a sine looks like a share of the acceleration at one frequency",
            test: "a length chirp: inertia grows with the square of the frequency, a delay in proportion",
        },
    ],
    test: "a tap that shows in force and length at zero pressure; an isometric pressure chirp from 0.05 to 10 Hz",
    protocol: "pressure-chirp",
    coordinate: Coordinate::Speed,
    typical: Typical { shapes: &[&[0.02, 0.0], &[0.0, 0.02], &[0.02, 0.02]], amplitudes: &[] },
    regions: &[],
    drivers: &["pressure", "speed"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::catalogue::tests::seen;

    #[test]
    fn a_fit_tries_each_channel_early_and_late() {
        let seen = Seen { contraction_ratio: (0.0, 0.2), force_n: (0.0, 900.0), duration_s: 60.0, ..seen() };
        let shapes = ChannelDelay.first_shapes(&seen);
        assert_eq!(shapes.len(), 24);
        for expected in [[0.005, 0.0], [0.0, -0.04], [0.01, 0.01]] {
            assert!(shapes.iter().any(|shape| *shape == expected), "{expected:?}");
        }
        assert_eq!(ChannelDelay.delays_s(&[0.01, -0.02]), [0.01, -0.02]);
    }
}
