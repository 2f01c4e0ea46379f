//! Step of the force: a clamp slipped or something was knocked, at one instant of one recording.
//!
//! ```text
//! F = F_base + A [t ≥ t₀]   in one recording
//! ```

use super::page::{Confusion, Page, Symbol};
use super::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Seen, Shape};
use crate::artifact::diagnosis::Coordinate;
use crate::muscle::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct ForceStep;

impl Effect for ForceStep {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn role(&self) -> Role {
        Role::Pulls
    }

    fn kind(&self) -> Kind {
        Kind::Event
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape { name: "recording", unit: "1", range: (0.0, 1e6), grid: &[0.0] },
            Shape { name: "instant_s", unit: "s", range: (0.0, 1e7), grid: &[0.0] },
        ]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "step_n", unit: "N", range: (-500.0, 500.0) }]
    }

    /// None: the instant is found by a scan of the residual.
    fn first_shapes(&self, _seen: &Seen) -> Vec<Vec<f64>> {
        Vec::new()
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        // A shape is a number that a file has carried: half a recording is none.
        Box::new(State { recording: shape[0].round() as usize, instant_s: shape[1] })
    }
}

struct State {
    recording: usize,
    instant_s: f64,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, _base: &Base, columns: &mut [f64]) {
        columns[0] = if now.recording == self.recording && now.time_s >= self.instant_s { 1.0 } else { 0.0 };
    }
}

static PAGE: Page = Page {
    id: "force-step",
    name: "step of the force",
    summary: "At one instant the force jumps and stays: a clamp slipped, the cell was knocked or re-zeroed, a strand \
              broke. Everything after that instant is shifted, in that recording alone.",
    equation: "F = F_base + A [t ≥ t₀], in one recording",
    symbols: &[
        Symbol { symbol: "A", unit: "N", meaning: "height of the step, either sign; 0.5 to 50 N" },
        Symbol { symbol: "t₀", unit: "s", meaning: "instant, from the beginning of the recording" },
        Symbol { symbol: "recording", unit: "1", meaning: "which recording, counted from 0" },
    ],
    validity: "A jump within a few samples; a slip that changes the length by more than a fraction of a millimetre acts \
               like another rest length instead.",
    source: "Page (1954), Biometrika 41, for the detection of a change of the mean",
    signature: "The residual has one level before an instant and another one after it, with nothing in pressure or \
                length to go with it.",
    confused_with: &[
        Confusion {
            id: "force-drift",
            because: "a step early in a recording and a short warm-up both shift what follows",
            test: "tare before and after: a step came at once, a drift goes on",
        },
        Confusion {
            id: "mullins-softening",
            because: "a step between the first cycle and the second makes them differ as well",
            test: "repeat the recording with rested rubber: softening shows at the same contraction, a knock does not",
        },
    ],
    test: "vented and slack before and after the recording, and repeat it: a step does not come back",
    protocol: "null",
    coordinate: Coordinate::Time,
};

#[cfg(test)]
mod tests {
    use super::super::moment::tests::{base, pull, still};
    use super::*;
    use crate::muscle::tests::nominal;

    #[test]
    fn it_acts_after_its_instant_in_its_recording() {
        let mut memory = ForceStep.start(&nominal(), &[2.0, 10.0]);
        let mut at = |recording, time_s| pull(&mut *memory, &Moment { recording, time_s, ..still() }, &base())[0];
        assert_eq!([at(2, 9.99), at(2, 10.0), at(2, 1e3), at(1, 20.0)], [0.0, 1.0, 1.0, 0.0]);
    }
}
