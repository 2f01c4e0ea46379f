//! Air: lag between gauge and muscle, hysteresis of the gauge.

use std::f64::consts::TAU;

use crate::draw::Dice;
use crate::forms::pneumatics::AMBIENT_PA;
use crate::forms::{Built, Setting, size};
use crate::mechanism::{Mechanism, Moment};
use crate::shape::Shape;

/// A line between gauge and muscle.
#[derive(Debug)]
enum Line {
    /// Laminar flow, isothermal: `ṗ = (P_g² − P²)/(2 P_r τ)` of absolute pressures; `τ` in s, `P_r` in Pa.
    Laminar(f64, f64),
    /// A mass of air on the muscle's compliance: `p̈ = ω² (p_g − p) − 2 ζ ω ṗ`; `ω` in rad/s and `ζ`.
    Mass(f64, f64),
}

#[derive(Debug)]
struct Lag {
    line: Line,
    inside_pa: Option<f64>,
    rate_pa_per_s: f64,
}

impl Mechanism for Lag {
    fn begin(&mut self, _recording: usize, rested: bool) {
        if rested {
            (self.inside_pa, self.rate_pa_per_s) = (None, 0.0);
        }
    }

    fn pressure(&mut self, now: &Moment, pressure_pa: f64) -> f64 {
        let Some(mut inside_pa) = self.inside_pa else {
            self.inside_pa = Some(pressure_pa);
            return pressure_pa;
        };
        match self.line {
            Line::Laminar(constant_s, reference_pa) => {
                // The difference of squares is the difference times twice the mean.
                let mean_pa = 0.5 * (pressure_pa + inside_pa) + AMBIENT_PA;
                let towards = -(-now.dt_s / constant_s * mean_pa / reference_pa).exp_m1();
                inside_pa += (pressure_pa - inside_pa) * towards;
            }
            Line::Mass(natural, ratio) => {
                let parts = (natural * now.dt_s / 0.05).ceil().max(1.0);
                let step_s = now.dt_s / parts;
                for _ in 0..parts as usize {
                    let push = natural * natural * (pressure_pa - inside_pa);
                    self.rate_pa_per_s += step_s * (push - 2.0 * ratio * natural * self.rate_pa_per_s);
                    inside_pa += step_s * self.rate_pa_per_s;
                }
            }
        }
        // Air does not pull below vacuum, and a muscle that is vented does not lie below the room.
        inside_pa = inside_pa.max(-0.02 * AMBIENT_PA);
        self.inside_pa = Some(inside_pa);
        inside_pa
    }
}

/// Lag of a line in which the flow is laminar: faster at high pressure; 20 to 400 ms at the middle of the range.
pub fn lag_laminar(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    let constant_s = size(u, 0.02, 0.40);
    let reference_pa = AMBIENT_PA + 0.5 * setting.muscle.highest_pressure_pa;
    Built::one(Lag { line: Line::Laminar(constant_s, reference_pa), inside_pa: None, rate_pa_per_s: 0.0 })
        .with("time_s", constant_s)
}

/// Lag of a long hose whose air has mass: a resonance at 2 to 20 Hz, damped by half.
pub fn lag_mass(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let (hz, ratio) = (size(1.0 - u, 2.0, 20.0), dice.uniform(0.4, 0.8));
    Built::one(Lag { line: Line::Mass(TAU * hz, ratio), inside_pa: None, rate_pa_per_s: 0.0 })
        .with("natural_hz", hz)
        .with("damping_ratio", ratio)
        .with("time_s", 2.0 * ratio / (TAU * hz))
}

/// Hysteresis of the gauge.
#[derive(Debug)]
enum Gauge {
    /// Shape over this rise in Pa, with its state.
    Shaped(Shape, f64, f64),
    /// A play whose half width grows in proportion to pressure up to this one, Pa, and what it shows.
    Growing(f64, Option<f64>),
}

#[derive(Debug)]
struct GaugeLoop {
    gauge: Gauge,
    half_pa: f64,
    last_pa: Option<f64>,
}

impl Mechanism for GaugeLoop {
    fn shown_pressure(&mut self, _now: &Moment, pressure_pa: f64) -> f64 {
        let rise_pa = self.last_pa.map_or(0.0, |last_pa| pressure_pa - last_pa);
        self.last_pa = Some(pressure_pa);
        match &mut self.gauge {
            Gauge::Shaped(shape, reach_pa, state) => {
                *state = shape.step(*state, rise_pa / *reach_pa);
                pressure_pa - self.half_pa * *state
            }
            Gauge::Growing(whole_pa, shown) => {
                let half_pa = self.half_pa * (pressure_pa / *whole_pa).clamp(0.05, 1.0);
                let next_pa = shown.unwrap_or(pressure_pa).clamp(pressure_pa - half_pa, pressure_pa + half_pa);
                *shown = Some(next_pa);
                next_pa
            }
        }
    }
}

fn gauge(gauge: Gauge, u: f64) -> Built {
    let half_pa = size(u, 500.0, 5000.0);
    Built::one(GaugeLoop { gauge, half_pa, last_pa: None }).with("half_width_kpa", 1e-3 * half_pa)
}

/// Gauge hysteresis by Valanis' endochronic law.
pub fn gauge_endochronic(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let (kappa, reach_pa) = (dice.uniform(0.4, 0.85), dice.log_uniform(6e3, 4e4));
    gauge(Gauge::Shaped(Shape::Endochronic(kappa), reach_pa, 0.0), u).with("reach_kpa", 1e-3 * reach_pa)
}

/// Gauge hysteresis as a play that is wider at higher pressure, as of a worn lever.
pub fn gauge_growing(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    gauge(Gauge::Growing(setting.muscle.highest_pressure_pa, None), u)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(line: Line, from_pa: f64, to_pa: f64, seconds: f64) -> f64 {
        let mut lag = Lag { line, inside_pa: Some(from_pa), rate_pa_per_s: 0.0 };
        let now = Moment { dt_s: 1e-3, ..Moment::default() };
        (0..(seconds * 1e3) as usize).map(|_| lag.pressure(&now, to_pa)).last().unwrap_or(from_pa)
    }

    #[test]
    fn every_line_arrives_and_is_late_on_the_way() {
        for line in [|| Line::Laminar(0.1, 3e5), || Line::Mass(TAU * 5.0, 0.6)] {
            assert!(after(line(), 1e5, 2e5, 0.005) < 1.2e5);
            assert!((after(line(), 1e5, 2e5, 3.0) - 2e5).abs() < 10.0);
        }
    }

    #[test]
    fn a_laminar_line_vents_the_slower_the_emptier_the_muscle() {
        let fall_pa = |from_pa: f64| from_pa - after(Line::Laminar(0.1, 3e5), from_pa, from_pa - 2e4, 0.05);
        assert!(fall_pa(4e5) > 1.5 * fall_pa(5e4));
    }

    #[test]
    fn a_hose_with_mass_overshoots_and_one_without_does_not() {
        let most =
            |line: fn() -> Line| (1..60).map(|k| after(line(), 0.0, 1e5, 0.01 * f64::from(k))).fold(0.0, f64::max);
        assert!(most(|| Line::Mass(TAU * 5.0, 0.4)) > 1.1e5);
        assert!(most(|| Line::Laminar(0.05, 2e5)) <= 1e5);
    }

    #[test]
    fn every_gauge_shows_less_on_the_way_up_and_more_on_the_way_down() {
        for kind in 0..2 {
            let gauge =
                if kind == 0 { Gauge::Shaped(Shape::Endochronic(0.6), 1e4, 0.0) } else { Gauge::Growing(3e5, None) };
            let mut gauge = GaugeLoop { gauge, half_pa: 2000.0, last_pa: None };
            let mut shown_pa = |true_pa: f64| gauge.shown_pressure(&Moment::default(), true_pa) - true_pa;
            (0..300).for_each(|kpa| {
                shown_pa(1e3 * f64::from(kpa));
            });
            let up_pa = shown_pa(3e5);
            (0..100).for_each(|kpa| {
                shown_pa(3e5 - 1e3 * f64::from(kpa));
            });
            let down_pa = shown_pa(2e5);
            assert!(up_pa < -1900.0 && down_pa > 1200.0, "{up_pa} {down_pa}");
        }
    }
}
