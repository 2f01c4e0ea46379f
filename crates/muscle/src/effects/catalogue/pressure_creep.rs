//! Pressure creep: braid and bladder go on yielding under the gas.
//!
//! ```text
//! F = F_base + Σ g_i [(1 - s) A(L) (p - r_i) + s (f - q_i)],   A = F_gas / p,   f = F_gas(p, L)
//! τ_i dr_i/dt = p - r_i,   τ_i dq_i/dt = f - q_i,   τ_i = τ, 10 τ, 100 τ
//! ```
//!
//! With `s = 0` inflation alone drives it; with `s = 1` so does a change of the length under pressure.

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::prony::Overstress;
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// Pressure below which the force of the gas says nothing of the area that it pulls on, in Pa.
const LEAST_PA: f64 = 1e3;

/// The effect.
#[derive(Debug)]
pub(super) struct PressureCreep;

impl Effect for PressureCreep {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn has_one_sign(&self) -> bool {
        true
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape {
                name: "time_constant_s",
                symbol: "τ",
                unit: "s",
                range: (0.02, 300.0),
                grid: &[0.03, 0.2, 1.0, 6.0],
            },
            Shape { name: "share_of_length", symbol: "s", unit: "1", range: (0.0, 1.0), grid: &[0.0, 1.0] },
        ]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[
            Amplitude { name: "overstress", symbol: "g₁", unit: "1", range: (-0.5, 0.5) },
            Amplitude { name: "slow_overstress", symbol: "g₂", unit: "1", range: (-0.5, 0.5) },
            Amplitude { name: "slowest_overstress", symbol: "g₃", unit: "1", range: (-0.5, 0.5) },
        ]
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        let overstress = Overstress::new(shape[0]);
        Box::new(State { share_of_length: shape[1], area_m2: 0.0, by_pressure: overstress, by_force: overstress })
    }
}

struct State {
    share_of_length: f64,
    /// Force of the gas per pascal.
    area_m2: f64,
    by_pressure: Overstress,
    by_force: Overstress,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        if now.pressure_pa.abs() > LEAST_PA {
            self.area_m2 = base.gas_n / now.pressure_pa;
        }
        let by_pressure = self.by_pressure.follow(now, now.pressure_pa);
        let by_force = self.by_force.follow(now, base.gas_n);
        for ((column, by_pressure), by_force) in columns.iter_mut().zip(by_pressure).zip(by_force) {
            *column = (1.0 - self.share_of_length) * self.area_m2 * by_pressure + self.share_of_length * by_force;
        }
    }
}

static PAGE: Page = Page {
    id: "pressure-creep",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "creep under pressure",
    summary: "Strands under tension stretch on, and the weave settles, for seconds to minutes after each change of \
              what the gas pulls. The force overshoots and comes down at constant pressure and length.",
    equation: "F = F_base + Σ g_i [(1 - s) A (p - r_i) + s (f - q_i)],  τ_i dr_i/dt = p - r_i,  τ_i dq_i/dt = f - q_i,  \
               τ_i = τ, 10 τ, 100 τ",
    symbols: &[
        Symbol { symbol: "f", unit: "N", meaning: "force of the gas in eq. 11" },
        Symbol { symbol: "A", unit: "m²", meaning: "the same per pascal" },
        Symbol {
            symbol: "s",
            unit: "1",
            meaning: "0 where inflation alone drives it, 1 where a change of the length does too",
        },
        Symbol { symbol: "τ", unit: "s", meaning: "shortest time constant; 0.03 to 10 s" },
        Symbol { symbol: "g₁", unit: "1", meaning: "overstress that decays with τ; 0.01 to 0.05 of the gas" },
        Symbol { symbol: "g₂", unit: "1", meaning: "overstress that decays with 10 τ; likewise" },
        Symbol { symbol: "g₃", unit: "1", meaning: "overstress that decays with 100 τ; likewise" },
        Symbol { symbol: "r_i, q_i", unit: "Pa, N", meaning: "what braid and bladder have got used to" },
    ],
    validity: "Pressure measured in the muscle and temperature of the gas settled, that is some seconds after a fast \
               filling; linear viscoelasticity over three decades of time from τ on.",
    source: "Minh, Tjahjowidodo, Ramon and Van Brussel (2010) for creep of pneumatic muscles; Prony series of a \
             generalized Maxwell body (Wiechert 1893)",
    signature: "In holds after a step of the pressure the residual decays, in proportion to what the step changed the force \
                of the gas by; after steps of the length as well where s is 1.",
    confused_with: &[
        Confusion {
            id: "viscoelastic-relaxation",
            because: "both decay in the holds after a step of the length",
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
    typical: Typical { shapes: &[&[3.0, 0.0], &[3.0, 1.0]], amplitudes: &[0.025, 0.025, 0.025] },
    regions: &[],
    drivers: &["pressure", "time-since-pressure-moved", "time-since-last-move"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    #[test]
    fn inflation_overshoots_and_comes_down() {
        for share_of_length in [0.0, 1.0] {
            let mut memory = PressureCreep.start(&nominal(), &[1.0, share_of_length]);
            assert_eq!(pull(&mut *memory, &still(), &base()), [0.0; 3]);
            let pressure_pa = 1.25 * still().pressure_pa;
            let inflated = Base { gas_n: 1.25 * base().gas_n, ..base() };
            let by_n = 0.25 * base().gas_n;
            let now = |time_s, step_s| Moment { time_s, step_s, pressure_pa, ..still() };
            let [fast_n, slow_n, _] = pull(&mut *memory, &now(1e-6, 1e-6), &inflated);
            assert!((fast_n - by_n).abs() < 1e-3 && (slow_n - by_n).abs() < 1e-3);
            let [fast_n, slow_n, _] = pull(&mut *memory, &now(3.0, 3.0), &inflated);
            assert!((fast_n - by_n * (-3.0_f64).exp()).abs() < 1e-3);
            assert!((slow_n - by_n * (-0.3_f64).exp()).abs() < 1e-3);
        }
    }

    #[test]
    fn a_step_of_the_length_shows_as_far_as_it_drives() {
        for share_of_length in [0.0, 1.0] {
            let mut memory = PressureCreep.start(&nominal(), &[1.0, share_of_length]);
            pull(&mut *memory, &still(), &base());
            let shortened = Base { gas_n: base().gas_n - 50.0, ..base() };
            let now = Moment { time_s: 1e-6, step_s: 1e-6, ..still() };
            let [fast_n, ..] = pull(&mut *memory, &now, &shortened);
            assert!((fast_n + share_of_length * 50.0).abs() < 1e-3, "{fast_n}");
        }
    }
}
