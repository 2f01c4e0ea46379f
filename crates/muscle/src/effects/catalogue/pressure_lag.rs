//! Pressure lag: the muscle's pressure follows the gauge's through a tube.
//!
//! ```text
//! κ τ² d²p_m/dt² + τ dp_m/dt + p_m = p
//! ```
//!
//! The resistance of the tube and the volume behind it make `τ`; the air in a long or wide tube has a mass besides, with which the
//! pressure follows later at first and may swing: `κ = 1 / (4 ζ²)` by the damping ratio `ζ`. Each step is solved exactly for a gauge
//! pressure that moves evenly between two moments.

use crate::coordinate::Coordinate;
use crate::effects::lag::Lag;
use crate::effects::page::{Confusion, Dependence, Page, Symbol, Typical};
use crate::effects::{Effect, Kind, Memory, Moment, Role, Shape};
use crate::geometry::Muscle;

/// The effect.
#[derive(Debug)]
pub(super) struct PressureLag;

impl Effect for PressureLag {
    fn page(&self) -> &'static Page {
        &PAGE
    }

    fn shape(&self) -> &'static [Shape] {
        &[
            Shape {
                name: "time_constant_s",
                symbol: "τ",
                unit: "s",
                range: (1e-3, 1.0),
                grid: &[0.01, 0.02, 0.04, 0.08, 0.16, 0.32],
            },
            Shape { name: "air_mass", symbol: "κ", unit: "1", range: (0.0, 2.0), grid: &[0.0, 0.5] },
        ]
    }

    /// The mass of the air says how the pressure follows, not what it does.
    fn may_end(&self, index: usize, _end: f64) -> bool {
        index == 1
    }

    fn unless_stated(&self, index: usize) -> Option<f64> {
        (index == 1).then_some(0.0)
    }

    fn start(&self, _muscle: &Muscle, shape: &[f64]) -> Box<dyn Memory> {
        let (time_constant_s, air_mass) = (shape[0], shape[1]);
        if air_mass < LEAST_AIR_MASS {
            return Box::new(FirstOrder { time_constant_s, muscle_pa: Lag::default() });
        }
        Box::new(SecondOrder { time_constant_s, air_mass, last: None })
    }
}

/// Share below which air has no mass: what the pressure does within the first thousandth of the lag shows in no recording.
const LEAST_AIR_MASS: f64 = 1e-3;

struct FirstOrder {
    time_constant_s: f64,
    muscle_pa: Lag,
}

impl Memory for FirstOrder {
    fn sees(&mut self, now: &mut Moment) {
        now.pressure_pa = self.muscle_pa.follow(now.pressure_pa, now.step_s, self.time_constant_s);
    }
}

struct SecondOrder {
    time_constant_s: f64,
    air_mass: f64,
    last: Option<Last>,
}

/// Pressures at the moment before, and how fast that of the muscle changed.
#[derive(Clone, Copy)]
struct Last {
    gauge_pa: f64,
    muscle_pa: f64,
    muscle_pa_per_s: f64,
}

/// Share of `a²` that sets two decays apart which are alike: it changes neither by more than a thousandth.
const APART: f64 = 1e-6;

impl SecondOrder {
    /// The distance `e` from where an evenly moving gauge is followed to, and its rate, after `step_s`.
    fn swung(&self, off_pa: f64, off_pa_per_s: f64, step_s: f64) -> (f64, f64) {
        let inertia_s2 = self.air_mass * self.time_constant_s * self.time_constant_s;
        let a = 0.5 * self.time_constant_s / inertia_s2;
        let square = a * a - 1.0 / inertia_s2;
        let q = square.abs().max(APART * a * a).sqrt();
        if square > 0.0 {
            let (slow, fast) = (-1.0 / (inertia_s2 * (a + q)), -(a + q));
            let of_slow_pa = (off_pa_per_s - fast * off_pa) / (slow - fast);
            let (slow_pa, fast_pa) =
                (of_slow_pa * (slow * step_s).exp(), (off_pa - of_slow_pa) * (fast * step_s).exp());
            return (slow_pa + fast_pa, slow * slow_pa + fast * fast_pa);
        }
        let (sine, cosine) = (q * step_s).sin_cos();
        let decay = (-a * step_s).exp();
        let across_pa = (off_pa_per_s + a * off_pa) / q;
        let off = decay * (off_pa * cosine + across_pa * sine);
        (off, decay * q * (across_pa * cosine - off_pa * sine) - a * off)
    }
}

impl Memory for SecondOrder {
    fn sees(&mut self, now: &mut Moment) {
        let gauge_pa = now.pressure_pa;
        let (muscle_pa, muscle_pa_per_s) = match self.last {
            Some(last) if now.step_s > 0.0 => {
                let gauge_pa_per_s = (gauge_pa - last.gauge_pa) / now.step_s;
                let behind_pa = self.time_constant_s * gauge_pa_per_s;
                let off_pa = last.muscle_pa - (last.gauge_pa - behind_pa);
                let (off_pa, off_pa_per_s) = self.swung(off_pa, last.muscle_pa_per_s - gauge_pa_per_s, now.step_s);
                (gauge_pa - behind_pa + off_pa, gauge_pa_per_s + off_pa_per_s)
            }
            _ => (gauge_pa, 0.0),
        };
        self.last = Some(Last { gauge_pa, muscle_pa, muscle_pa_per_s });
        now.pressure_pa = muscle_pa;
    }
}

static PAGE: Page = Page {
    id: "pressure-lag",
    role: Role::Sees,
    kind: Kind::Muscle,
    dependence: Dependence::Past,
    name: "lag of the pressure in the tube",
    summary: "The gauge sits at the valve and the muscle behind a tube, so the pressure in the muscle follows what is \
              recorded with a lag.",
    equation: "κ τ² d²p_m/dt² + τ dp_m/dt + p_m = p,  F = F_base(p_m, L)",
    symbols: &[
        Symbol { symbol: "τ", unit: "s", meaning: "time constant; 20 to 150 ms for 1 to 3 m of tube of 2.5 mm bore" },
        Symbol {
            symbol: "κ",
            unit: "1",
            meaning: "mass of the air in the tube, 1 / (4 ζ²) by its damping ratio ζ: 0 none, 1/4 two lags alike, more and it swings",
        },
        Symbol { symbol: "p_m", unit: "Pa", meaning: "gauge pressure in the muscle" },
    ],
    validity: "Pressures that change slowly against sound in the tube; filling and venting alike.",
    source: "Whitmore, Lindsey, Curry and Gilyard (1990), NASA TM-4171, for lags of tubes in the laminar limit; Bergh and Tijdeman \
             (1965), NLR-TR F.238, for the mass of the air",
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
    typical: Typical { shapes: &[&[0.06, 0.0]], amplitudes: &[] },
    regions: &[],
    drivers: &["pressure"],
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::still;

    /// Pressure that the muscle sees at the end of `time_s`, where the gauge is `gauge_pa`.
    fn behind_pa(shape: &[f64], step_s: f64, time_s: f64, gauge_pa: &dyn Fn(f64) -> f64) -> f64 {
        let mut memory = PressureLag.start(&Muscle::nominal(), shape);
        let steps = (time_s / step_s).round() as u32;
        let see = |step: u32| {
            let step_s = if step == 0 { 0.0 } else { step_s };
            let mut now = Moment { pressure_pa: gauge_pa(f64::from(step) * step_s), step_s, ..still() };
            memory.sees(&mut now);
            now.pressure_pa
        };
        (0..=steps).map(see).last().expect("a moment")
    }

    #[test]
    fn a_ramp_is_followed_one_time_constant_late_whatever_the_mass_of_the_air() {
        for air_mass in [0.0, 0.1, 0.25, 0.7, 2.0] {
            let pa = behind_pa(&[0.1, air_mass], 0.01, 6.0, &|t| 1e5 * t);
            assert!((pa - 5.9e5).abs() < 1.0, "{air_mass}: {pa}");
        }
    }

    #[test]
    fn a_step_is_followed_as_by_the_textbook_and_whatever_the_steps_of_time() {
        let step = |t: f64| if t > 0.0 { 1e5 } else { 0.0 };
        let (natural, time_s) = (0.1_f64.recip() / 0.7_f64.sqrt(), 0.3);
        let damping = 0.5 / 0.7_f64.sqrt();
        let damped = natural * (1.0 - damping * damping).sqrt();
        let (sine, cosine) = (damped * time_s).sin_cos();
        let decay = (-damping * natural * time_s).exp();
        let expected_pa = 1e5 * (1.0 - decay * (cosine + damping * natural / damped * sine));
        for step_s in [1e-4, 1e-3] {
            let pa = behind_pa(&[0.1, 0.7], step_s, time_s, &step);
            // The gauge has no step shorter than that of time.
            assert!((pa - expected_pa).abs() < 2e6 * step_s, "{step_s}: {pa}, {expected_pa}");
        }
    }

    #[test]
    fn two_decays_that_are_nearly_alike_and_next_to_no_mass_join_their_limits() {
        let sine = |t: f64| 1e5 * (20.0 * t).sin();
        let [below, at, above] = [0.25 - 1e-6, 0.25, 0.25 + 1e-6].map(|mass| behind_pa(&[0.1, mass], 0.01, 1.0, &sine));
        assert!((below - at).abs() < 1.0 && (above - at).abs() < 1.0, "{below} {at} {above}");
        let [none, little] = [0.0, 2.0 * LEAST_AIR_MASS].map(|mass| behind_pa(&[0.1, mass], 0.01, 1.0, &sine));
        assert!((none - little).abs() < 300.0, "{none} {little}");
    }
}
