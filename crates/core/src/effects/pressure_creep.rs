//! Pressure creep: braid and bladder go on yielding under the gas.
//!
//! ```text
//! F = F_base + Σ g_i (f - q_i),   τ_i dq_i/dt = f - q_i,   f = F_gas(p, L),   τ_i = τ, 10 τ, 100 τ
//! ```

use super::page::{Confusion, Page, Symbol};
use super::prony::Overstress;
use super::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::artifact::diagnosis::Coordinate;
use crate::muscle::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct PressureCreep;

impl Effect for PressureCreep {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn role(&self) -> Role {
        Role::Pulls
    }

    fn kind(&self) -> Kind {
        Kind::Muscle
    }

    fn shape(&self) -> &'static [Shape] {
        &[Shape { name: "time_constant_s", unit: "s", range: (0.02, 300.0), grid: &[0.03, 0.1, 0.3, 1.0, 3.0, 10.0] }]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[
            Amplitude { name: "overstress", unit: "1", range: (0.0, 0.5) },
            Amplitude { name: "slow_overstress", unit: "1", range: (0.0, 0.5) },
            Amplitude { name: "slowest_overstress", unit: "1", range: (0.0, 0.5) },
        ]
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        Box::new(State(Overstress::new(shape[0])))
    }
}

struct State(Overstress);

impl Memory for State {
    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        columns.copy_from_slice(&self.0.follow(now, base.gas_n));
    }
}

static PAGE: Page = Page {
    id: "pressure-creep",
    name: "creep under pressure",
    summary: "Strands under tension stretch on, and the weave settles, for seconds to minutes behind each change of \
              what the gas pulls. The force overshoots and comes down at constant pressure and length.",
    equation: "F = F_base + Σ g_i (f - q_i),  τ_i dq_i/dt = f - q_i,  τ_i = τ, 10 τ, 100 τ",
    symbols: &[
        Symbol { symbol: "f", unit: "N", meaning: "force of the gas in eq. 11" },
        Symbol { symbol: "τ", unit: "s", meaning: "shortest time constant; 0.03 to 10 s" },
        Symbol { symbol: "g₁", unit: "1", meaning: "overstress that decays with τ; 0.01 to 0.05 of the gas" },
        Symbol { symbol: "g₂", unit: "1", meaning: "overstress that decays with 10 τ; likewise" },
        Symbol { symbol: "g₃", unit: "1", meaning: "overstress that decays with 100 τ; likewise" },
        Symbol { symbol: "q_i", unit: "N", meaning: "what braid and bladder have got used to" },
    ],
    validity: "Pressure measured in the muscle and temperature of the gas settled, that is some seconds behind a fast \
               filling; linear viscoelasticity over three decades of time from τ on.",
    source: "Minh, Tjahjowidodo, Ramon and Van Brussel (2010) for creep of pneumatic muscles; Prony series of a \
             generalized Maxwell body (Wiechert 1893)",
    signature: "In holds behind a step the residual decays, in proportion to what the step changed the force of the gas \
                by: behind steps of the pressure as behind steps of the length.",
    confused_with: &[
        Confusion {
            id: "viscoelastic-relaxation",
            because: "both decay in the holds behind a step of the length",
            test: "steps of the pressure at fixed length: relaxation of the bladder does not show there",
        },
        Confusion {
            id: "pressure-lag",
            because: "time constants below half a second look like a tube",
            test: "steps of the pressure: a lag fills up to the final force from below, creep comes down to it from above",
        },
        Confusion {
            id: "force-drift",
            because: "a single long hold shows one slow decay, which a drifting load cell makes as well",
            test: "steps up and down with holds of a minute: creep changes its sign with the step, drift does not",
        },
    ],
    test: "isometric steps of the pressure up and down, with holds of a minute, and the valve closed",
    protocol: "pressure-steps",
    coordinate: Coordinate::TimeSinceLastMove,
};

#[cfg(test)]
mod tests {
    use super::super::moment::tests::{base, pull, still};
    use super::*;
    use crate::muscle::tests::nominal;

    #[test]
    fn inflation_overshoots_and_comes_down() {
        let mut memory = PressureCreep.start(&nominal(), &[1.0]);
        assert_eq!(pull(&mut *memory, &still(), &base()), [0.0; 3]);
        let inflated = Base { gas_n: base().gas_n + 100.0, ..base() };
        let now = |time_s, step_s| Moment { time_s, step_s, ..still() };
        let [fast_n, slow_n, _] = pull(&mut *memory, &now(1e-6, 1e-6), &inflated);
        assert!((fast_n - 100.0).abs() < 1e-3 && (slow_n - 100.0).abs() < 1e-3);
        let [fast_n, slow_n, _] = pull(&mut *memory, &now(3.0, 3.0), &inflated);
        assert!((fast_n - 100.0 * (-3.0_f64).exp()).abs() < 1e-3);
        assert!((slow_n - 100.0 * (-0.3_f64).exp()).abs() < 1e-3);
    }
}
