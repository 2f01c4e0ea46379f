//! Pressure lag: the muscle's pressure follows the gauge's through a tube.
//!
//! ```text
//! τ dp_m/dt = p - p_m
//! ```

use crate::artifact::diagnosis::Coordinate;
use crate::effects::lag::Lag;
use crate::effects::page::{Confusion, Page, Symbol, Typical};
use crate::effects::{Effect, Kind, Memory, Moment, Role, Shape};
use crate::muscle::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct PressureLag;

impl Effect for PressureLag {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn role(&self) -> Role {
        Role::Sees
    }

    fn kind(&self) -> Kind {
        Kind::Muscle
    }

    fn shape(&self) -> &'static [Shape] {
        &[Shape {
            name: "time_constant_s",
            symbol: "τ",
            unit: "s",
            range: (1e-3, 1.0),
            grid: &[0.01, 0.02, 0.04, 0.08, 0.16, 0.32],
        }]
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State { time_constant_s: shape[0], muscle_pa: Lag::default() })
    }
}

struct State {
    time_constant_s: f64,
    muscle_pa: Lag,
}

impl Memory for State {
    fn sees(&mut self, now: &mut Moment) {
        now.pressure_pa = self.muscle_pa.follow(now.pressure_pa, now.step_s, self.time_constant_s);
    }
}

static PAGE: Page = Page {
    id: "pressure-lag",
    name: "lag of the pressure in the tube",
    summary: "The gauge sits at the valve and the muscle behind a tube, so the pressure in the muscle follows what is \
              recorded with a lag.",
    equation: "τ dp_m/dt = p - p_m,  F = F_base(p_m, L)",
    symbols: &[
        Symbol { symbol: "τ", unit: "s", meaning: "time constant; 20 to 150 ms for 1 to 3 m of tube of 2.5 mm bore" },
        Symbol { symbol: "p_m", unit: "Pa", meaning: "gauge pressure in the muscle" },
    ],
    validity: "Pressures that change slowly against sound in the tube; filling and venting alike.",
    source: "Whitmore, Lindsey, Curry and Gilyard (1990), NASA TM-4171, for lags of tubes in the laminar limit",
    signature: "The residual is proportional to the rate of the pressure, zero at rest and at constant pressure, with \
                opposite signs on inflation and deflation; the lag of the phase levels off at high frequency.",
    confused_with: &[
        Confusion {
            id: "channel-delay",
            because: "in slow motion a lag and a delay shift the pressure by the same time",
            test: "an isometric pressure sine from 0.05 to 10 Hz: the phase of a lag levels off, that of a delay grows in \
                   proportion to the frequency",
        },
        Confusion {
            id: "pressure-gauge-hysteresis",
            because: "both open the isometric loop",
            test: "isometric ramps at two rates: a lag opens the loop in proportion to the rate, a gauge does not care",
        },
    ],
    test: "isometric pressure chirp from 0.05 to 10 Hz",
    protocol: "pressure-chirp",
    coordinate: Coordinate::TimeSinceLastMove,
    typical: Typical { shapes: &[&[0.06]], amplitudes: &[] },
    regions: &[],
    drivers: &["pressure"],
};
