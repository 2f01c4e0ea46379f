//! Thermal softening: friction warms the bladder, and warm rubber is softer.
//!
//! ```text
//! F = F_base - d f T - (e f + g F_gas) Θ,   τ dT/dt = P / P_ref - T,   τ_w dΘ/dt = θ - Θ
//! P = p π D L |v|,   f = V_r dW/dL of latex
//! ```

use crate::coordinate::Coordinate;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Amplitude, Base, Effect, Kind, Memory, Moment, Role, Seen, Shape};
use crate::geometry::Muscle;

/// `P_ref`, in W per unit of `f'`: 1 W of friction where `f'` is 1e-3.
const REFERENCE_W: f64 = 1e3;

/// Softening by lasting work at `P_ref`, at most: friction of `f'` = 0.03 makes 30 W of it, a thin muscle in still air warms by
/// 50 K per watt, rubber loses 0.8 % per kelvin, and a bladder may be three times as stiff as latex.
const MOST: f64 = 40.0;

/// Softening per kelvin of a logged temperature, at most: 0.8 % of a bladder three times as stiff as latex.
const MOST_PER_K: f64 = 0.025;

/// Share of the gas force that a kelvin of a logged temperature takes, at most: what a gauge of bare silicon loses of its sensitivity, ten
/// times what a good load cell does. Nothing that is known takes more of the force of the gas.
const MOST_OF_GAS_PER_K: f64 = 2e-3;

/// Lag of a wall that is as warm as the thermometer says.
const AT_ONCE: f64 = 0.0;

/// The effect.
#[derive(Debug)]
pub(super) struct ThermalSoftening;

impl Effect for ThermalSoftening {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape { name: "time_constant_s", symbol: "τ", unit: "s", range: (20.0, 3e3), grid: &[60.0, 200.0, 600.0] },
            Shape { name: "wall_lag_s", symbol: "τ_w", unit: "s", range: (AT_ONCE, 60.0), grid: &[AT_ONCE, 5.0] },
        ]
    }

    fn amplitudes(&self) -> &'static [Amplitude] {
        &[
            Amplitude { name: "softening_per_kilowatt", symbol: "d", unit: "1", range: (-MOST, MOST) },
            Amplitude { name: "softening_per_kelvin", symbol: "e", unit: "1/K", range: (-MOST_PER_K, MOST_PER_K) },
            Amplitude {
                name: "gas_force_loss_per_kelvin",
                symbol: "g",
                unit: "1/K",
                range: (-MOST_OF_GAS_PER_K, MOST_OF_GAS_PER_K),
            },
        ]
    }

    /// Where none was logged nothing is behind it.
    fn first_shapes(&self, seen: &Seen) -> Vec<Vec<f64>> {
        let [time_constants, lags] = [0, 1].map(|index: usize| self.shape()[index].grid);
        let lags = if seen.warmth_k.1 > seen.warmth_k.0 { lags } else { &lags[..1] };
        time_constants
            .iter()
            .flat_map(|&time_constant_s| lags.iter().map(move |&lag_s| vec![time_constant_s, lag_s]))
            .collect()
    }

    /// A thermometer may be as fast as the wall.
    fn may_end(&self, index: usize, end: f64) -> bool {
        (index, end) == (1, AT_ONCE)
    }

    /// Before the wall could be behind the thermometer, and the gas force follow it, neither was.
    fn unless_stated(&self, index: usize) -> Option<f64> {
        [1, 4].contains(&index).then_some(0.0)
    }

    fn outlasts(&self) -> bool {
        true
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        let (time_constant_s, wall_lag_s) = (shape[0], shape[1]);
        Box::new(State { time_constant_s, wall_lag_s, warmth: 0.0, wall_k: 0.0, power: 0.0, last_s: None })
    }
}

struct State {
    time_constant_s: f64,
    wall_lag_s: f64,
    /// `T`: temperature above the surroundings, in units of what `P_ref` would end at.
    warmth: f64,
    /// `Θ`; that of the thermometer as a recording begins.
    wall_k: f64,
    /// `P / P_ref` a moment ago.
    power: f64,
    last_s: Option<f64>,
}

impl Memory for State {
    fn pulls(&mut self, now: &Moment, base: &Base, columns: &mut [f64]) {
        let power = base.normal_n.max(0.0) * now.speed_m_per_s.abs() / REFERENCE_W;
        if let Some(last_s) = self.last_s {
            // Nothing is known of the power in a gap: the muscle is taken to have cooled.
            let heating = if now.step_s > 0.0 { 0.5 * (power + self.power) } else { 0.0 };
            let later_s = (now.time_s - last_s).max(0.0);
            self.warmth += (self.warmth - heating) * (-later_s / self.time_constant_s).exp_m1();
            let behind = if self.wall_lag_s > 0.0 { (-later_s / self.wall_lag_s).exp() } else { 0.0 };
            self.wall_k = now.warmth_k + (self.wall_k - now.warmth_k) * behind;
        } else {
            self.wall_k = now.warmth_k;
        }
        self.power = power;
        self.last_s = Some(now.time_s);
        columns[0] = -base.latex_n() * self.warmth;
        columns[1] = -base.latex_n() * self.wall_k;
        columns[2] = -base.gas_n * self.wall_k;
    }
}

static PAGE: Page = Page {
    id: "thermal-softening",
    role: Role::Pulls,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "thermal softening of the bladder",
    summary: "Friction and hysteresis warm a muscle that works, over minutes, and its bladder resists less. Rest cools \
              it down again. Where a temperature was logged, the bladder follows that as well, and with it what of the force of \
              the gas does.",
    equation: "F = F_base - d f T - (e f + g F_gas) Θ,  τ dT/dt = P / P_ref - T,  τ_w dΘ/dt = θ - Θ,  P = p π D L |v|,  P_ref = 1 kW",
    symbols: &[
        Symbol {
            symbol: "d",
            unit: "1",
            meaning: "softening, in units of f, that lasting work at P_ref (1 W of heat where f' is 1e-3) ends at; 0.02 to \
                      0.2 for each 1e-3 of f'",
        },
        Symbol { symbol: "τ", unit: "s", meaning: "time constant of warming; 200 to 900 s, less for thin muscles" },
        Symbol {
            symbol: "f",
            unit: "N",
            meaning: "force of a bladder of latex, C₁₀ + C₀₁ = 0.22 MPa, whatever the fitted bladder is",
        },
        Symbol { symbol: "P", unit: "W", meaning: "power of the friction per unit of f'" },
        Symbol {
            symbol: "T",
            unit: "1",
            meaning: "temperature above that at the start, in units of what P_ref ends at",
        },
        Symbol {
            symbol: "e",
            unit: "1/K",
            meaning: "softening per kelvin of the logged temperature, in units of f; 0.002 to 0.008, below zero for rubber \
                      that stiffens; zero where none was logged",
        },
        Symbol {
            symbol: "g",
            unit: "1/K",
            meaning: "share of the gas force that a kelvin of the logged temperature takes, either sign: 0.0002 where the load \
                      cell or the gauge follows it, more where the braid does; zero where none was logged",
        },
        Symbol { symbol: "F_gas", unit: "N", meaning: "force of the gas in eq. 11" },
        Symbol { symbol: "θ", unit: "K", meaning: "logged temperature above 20 °C" },
        Symbol { symbol: "Θ", unit: "K", meaning: "that of the wall, which follows it" },
        Symbol {
            symbol: "τ_w",
            unit: "s",
            meaning: "time by which the wall is behind the thermometer: none, or some seconds for a few millimetres of rubber",
        },
    ],
    validity: "A recording that begins cold, in surroundings of constant temperature or with a logged one; some kelvin, where the rubber \
               softens in proportion. Unfilled rubber may stiffen a little instead, which this leaves out.",
    source: "Doumit and Pardoel (2017) for the heat of working muscles; first-order balance of heat",
    signature: "Over minutes of cycling the force drifts upwards in proportion to the bladder's force, at every pressure \
                alike, faster under faster motion, and comes back in rest.",
    confused_with: &[
        Confusion {
            id: "fatigue-wear",
            because: "both drift while the muscle cycles",
            test: "rest for half an hour and probe: warmth is gone, wear is still there; at two pressures: wear follows \
                   the pressure, warmth does not",
        },
        Confusion {
            id: "force-drift",
            because: "a load cell drifts over the same minutes",
            test: "a vented and slack muscle before and after: there only the load cell differs; or log the temperature",
        },
        Confusion {
            id: "mullins-softening",
            because: "both soften the bladder while the muscle works",
            test: "rest for half an hour and repeat: warm rubber has cooled down, softened rubber has not healed",
        },
    ],
    test: "twenty minutes of cycling, then half an hour of rest with a probing cycle every five minutes, temperature \
           logged",
    protocol: "endurance",
    coordinate: Coordinate::Time,
    typical: Typical { shapes: &[&[400.0, AT_ONCE]], amplitudes: &[0.1, 0.0, 0.0] },
    regions: &[],
    drivers: &["time", "cycle"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::catalogue::tests::seen;
    use crate::effects::moment::tests::{base, pull, still};
    use crate::geometry::tests::nominal;

    /// One kilowatt of `p π D L |v|`.
    fn working(time_s: f64) -> Moment {
        Moment { time_s, step_s: 1.0, speed_m_per_s: -REFERENCE_W / base().normal_n, ..still() }
    }

    #[test]
    fn a_logged_temperature_acts_on_the_bladder_and_on_the_gas_at_once() {
        let mut memory = ThermalSoftening.start(&nominal(), &[60.0, AT_ONCE]);
        let base = base();
        let [_, bladder_n, gas_n] = pull(&mut *memory, &Moment { warmth_k: 5.0, ..still() }, &base);
        assert!((bladder_n + 5.0 * base.latex_n()).abs() < 1e-9 && bladder_n > 0.0);
        assert!((gas_n + 5.0 * base.gas_n).abs() < 1e-9 && gas_n < 0.0);
        assert_eq!(pull(&mut *memory, &still(), &base)[1..], [0.0, 0.0]);
    }

    #[test]
    fn the_wall_is_behind_the_thermometer_from_where_both_began() {
        let mut memory = ThermalSoftening.start(&nominal(), &[60.0, 4.0]);
        let mut at = |time_s: f64, warmth_k: f64| {
            let moment = Moment { time_s, step_s: 1.0, warmth_k, ..still() };
            pull(&mut *memory, &moment, &base())[1] / -base().latex_n()
        };
        assert_eq!(at(0.0, 3.0), 3.0);
        assert!((at(4.0, 13.0) - (13.0 - 10.0 * (-1.0_f64).exp())).abs() < 1e-12);
        assert!((at(4e3, 13.0) - 13.0).abs() < 1e-9);
    }

    #[test]
    fn a_lag_is_looked_for_where_a_temperature_was_logged() {
        let seen = seen();
        let lags =
            |seen: &Seen| -> Vec<f64> { ThermalSoftening.first_shapes(seen).iter().map(|shape| shape[1]).collect() };
        assert_eq!(lags(&seen), [AT_ONCE; 3]);
        assert_eq!(lags(&Seen { warmth_k: (1.0, 9.0), ..seen }).iter().filter(|lag| **lag > 0.0).count(), 3);
    }

    #[test]
    fn lasting_work_ends_at_one_and_rest_cools() {
        let mut memory = ThermalSoftening.start(&nominal(), &[60.0, AT_ONCE]);
        assert_eq!(pull(&mut *memory, &Moment { step_s: 0.0, ..working(0.0) }, &base())[0], 0.0);
        let mut column_n = 0.0;
        for second in 1..=60 {
            column_n = pull(&mut *memory, &working(f64::from(second)), &base())[0];
        }
        let expected_n = -base().latex_n() * (1.0 - (-1.0_f64).exp());
        assert!((column_n - expected_n).abs() < 1e-9, "{column_n} {expected_n}");
        // A gap of one time constant.
        let after = Moment { time_s: 120.0, ..still() };
        let cooled_n = pull(&mut *memory, &after, &base())[0];
        assert!((cooled_n - column_n * (-1.0_f64).exp()).abs() < 1e-9);
        assert!(cooled_n > 0.0, "a softer bladder leaves more force");
    }
}
