//! Drift of the load cell: its zero wanders, at first faster while it warms up.
//!
//! ```text
//! F = F_base + d t + w (1 - exp(-t / τ))
//! ```

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct ForceDrift;

impl Effect for ForceDrift {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[Shape { name: "warm_up_s", symbol: "τ", unit: "s", range: (20.0, 4e3), grid: &[30.0, 120.0, 400.0] }]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[
            Amplitude { name: "drift_n_per_s", symbol: "d", unit: "N/s", range: (-0.5, 0.5) },
            Amplitude { name: "warm_up_n", symbol: "w", unit: "N", range: (-50.0, 50.0) },
        ]
    }

    /// It drifts evenly, whatever warms up.
    fn may_end(&self, _index: usize, _end: f64) -> bool {
        true
    }

    fn outlasts(&self) -> bool {
        true
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { warm_up_s: shape[0] })
    }
}

struct State {
    warm_up_s: f64,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, _base: &Base, columns: &mut [f64]) {
        columns[0] = now.time_s;
        columns[1] = -(-now.time_s / self.warm_up_s).exp_m1();
    }
}

static PAGE: Page = Page {
    id: "force-drift",
    role: Role::Pulls,
    kind: Kind::Instrument,
    dependence: Dependence::Past,
    name: "drift of the load cell",
    summary: "The zero of the load cell wanders with its temperature: evenly over hours, and faster in the first minutes \
              after switching on. Whatever the muscle does, the drift goes on.",
    equation: "F = F_base + d t + w (1 - exp(-t / τ))",
    symbols: &[
        Symbol { symbol: "d", unit: "N/s", meaning: "even drift, either sign; 0.1 to 1 N per hour for a good cell" },
        Symbol { symbol: "w", unit: "N", meaning: "drift of warming up, either sign; 0.1 to 5 N" },
        Symbol { symbol: "τ", unit: "s", meaning: "time constant of warming up; 30 to 400 s" },
        Symbol { symbol: "t", unit: "s", meaning: "time since the recording began" },
    ],
    validity: "Each recording starts with the zero of eq. 11; the same drift in all of them.",
    source: "OIML R 60 for creep and zero return of load cells",
    signature: "The residual is a slow slope over time, the same at every pressure, length and direction, and it does not \
                start anew after a step.",
    confused_with: &[
        Confusion {
            id: "fatigue-wear",
            because: "at one pressure level both are a slow slope over time",
            test: "cycles at two pressures in turn: wear follows the pressure, drift does not; a vented and slack muscle \
                   before and after shows drift alone",
        },
        Confusion {
            id: "thermal-softening",
            because: "a working muscle warms up over the same minutes",
            test: "a vented and slack muscle before and after: there only the load cell differs; or log the temperature",
        },
        Confusion {
            id: "viscoelastic-relaxation",
            because: "a single long hold shows one slow decay",
            test: "steps up and down with holds of a minute: relaxation changes its sign with the step, drift does not",
        },
        Confusion {
            id: "pressure-creep",
            because: "a single long hold shows one slow decay",
            test: "steps up and down with holds of a minute: creep changes its sign with the step, drift does not",
        },
        Confusion {
            id: "force-step",
            because: "a step early in a recording and a short warm-up both shift what follows",
            test: "tare before and after: a step came at once, a drift goes on",
        },
    ],
    test: "ten minutes with the muscle vented and slack, before and after the recordings",
    protocol: "null",
    coordinate: Coordinate::Time,
    // 1 N per hour and 2 N.
    typical: Typical { shapes: &[&[120.0]], amplitudes: &[1.0 / 3600.0, 2.0] },
    regions: &[Coordinate::Time],
    drivers: &["time"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    #[test]
    fn it_starts_at_zero_and_goes_on_with_the_time() {
        let mut memory = ForceDrift.start(&nominal(), &[120.0]);
        assert_eq!(pull(&mut *memory, &still(), &base()), [0.0; 3]);
        let later = Moment { time_s: 120.0, step_s: 120.0, ..still() };
        let [even, warm_up, _] = pull(&mut *memory, &later, &Base::default());
        assert_eq!(even, 120.0);
        assert!((warm_up - (1.0 - (-1.0_f64).exp())).abs() < 1e-12);
    }
}
