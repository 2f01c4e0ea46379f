//! Step of the force: a clamp slipped or something was knocked, at one instant of one recording.
//!
//! ```text
//! F = F_base + A [t ≥ t₀]   in one recording
//! F = F_base - A [t < t₀]   in it and the recordings before, where it goes on
//! ```
//!
//! It comes on top of what the load cell reads: one that was knocked reads more of a slack muscle as well.
//!
//! Where nobody has set the force to zero since, the step goes on in every recording after it. The model then is that of the muscle
//! and its cell as they are now, and holds for any other recording as it stands.

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kept, Kind, Memory, Moment, Role, Seen, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct ForceStep;

impl Effect for ForceStep {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape { name: "recording", symbol: "recording", unit: "1", range: (0.0, 1e6), grid: &[0.0] },
            Shape { name: "instant_s", symbol: "t₀", unit: "s", range: (0.0, 1e7), grid: &[0.0] },
        ]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[Amplitude { name: "step_n", symbol: "A", unit: "N", range: (-500.0, 500.0) }]
    }

    fn keeps(&self) -> &'static [Kept] {
        &[Kept { name: "past_step", unit: "1", range: (0.0, 1.0), fresh: 0.0 }]
    }

    /// None: the instant is found by a scan of the residual.
    fn first_shapes(&self, _seen: &Seen) -> Vec<Vec<f64>> {
        Vec::new()
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        // A shape is a number that a file has carried: half a recording is none.
        Box::new(State { recording: shape[0].round() as usize, instant_s: shape[1], goes_on: false })
    }
}

struct State {
    recording: usize,
    instant_s: f64,
    goes_on: bool,
}

impl Memory for State {
    /// The step itself, whatever recording it was in.
    fn past(&self) -> Vec<f64> {
        vec![1.0]
    }

    fn go_on(&mut self, past: &[f64]) {
        self.goes_on = !past.is_empty();
    }

    fn pulls(&mut self, now: &Moment, _base: &Base, columns: &mut [f64]) {
        columns[0] = if self.goes_on {
            let is_before =
                now.recording < self.recording || now.recording == self.recording && now.time_s < self.instant_s;
            if is_before { -1.0 } else { 0.0 }
        } else if now.recording == self.recording && now.time_s >= self.instant_s {
            1.0
        } else {
            0.0
        };
    }
}

static PAGE: Page = Page {
    id: "force-step",
    role: Role::Pulls,
    kind: Kind::Event,
    dependence: Dependence::Past,
    name: "step of the force",
    summary: "At one instant the force jumps and stays: a clamp slipped, the cell was knocked or re-zeroed, a strand \
              broke. Everything after that instant is shifted, in that recording alone or, where the step goes on, in all \
              that follow; the model then is that of the muscle after it. What slipped once may slip again: several steps are judged \
              together, and each is one term of the model.",
    equation: "F = F_base + A [t ≥ t₀], in one recording; F = F_base - A [t < t₀] where it goes on",
    symbols: &[
        Symbol { symbol: "A", unit: "N", meaning: "height of the step, either sign; 0.5 to 50 N" },
        Symbol { symbol: "t₀", unit: "s", meaning: "instant, from the beginning of the recording" },
        Symbol { symbol: "recording", unit: "1", meaning: "which recording, counted from 0" },
    ],
    validity: "A jump within a few samples, or a slip within a second or so that is most of what is left; a slip that changes the \
               length by more than a fraction of a millimetre acts like another rest length instead.",
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
    typical: Typical { shapes: &[], amplitudes: &[2.0] },
    regions: &[Coordinate::Time],
    drivers: &["time"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    #[test]
    fn it_acts_after_its_instant_in_its_recording() {
        let mut memory = ForceStep.start(&nominal(), &[2.0, 10.0]);
        let mut at = |recording, time_s| pull(&mut *memory, &Moment { recording, time_s, ..still() }, &base())[0];
        assert_eq!([at(2, 9.99), at(2, 10.0), at(2, 1e3), at(1, 20.0)], [0.0, 1.0, 1.0, 0.0]);
    }

    #[test]
    fn where_it_goes_on_the_model_is_that_of_after() {
        let mut memory = ForceStep.start(&nominal(), &[2.0, 10.0]);
        memory.go_on(&memory.past());
        let mut at = |recording, time_s| pull(&mut *memory, &Moment { recording, time_s, ..still() }, &base())[0];
        assert_eq!([at(1, 20.0), at(2, 9.99), at(2, 10.0), at(3, 0.0)], [-1.0, -1.0, 0.0, 0.0]);
    }
}
