//! Forms of the air: lag between gauge and muscle, hysteresis of the gauge.

use super::{Built, Setting, size};
use crate::draw::Dice;
use crate::friction::Element;
use crate::mechanism::{Mechanism, Moment};

/// Lag between gauge and muscle.
#[derive(Debug)]
struct Lag {
    kind: LagKind,
    constant_s: f64,
    first_pa: Option<f64>,
    second_pa: f64,
    rest_volume: f64,
}

#[derive(Debug, Clone, Copy)]
enum LagKind {
    First,
    Second,
    Choked,
    Volume,
}

/// Ambient pressure, Pa.
pub(crate) const AMBIENT_PA: f64 = 101_325.0;
/// Critical ratio of ISO 6358 for a hose with fittings.
const CRITICAL: f64 = 0.35;

impl Mechanism for Lag {
    fn begin(&mut self, _recording: usize, rested: bool) {
        if rested {
            self.first_pa = None;
        }
    }

    fn pressure(&mut self, now: &Moment, pressure_pa: f64) -> f64 {
        let Some(first_pa) = self.first_pa else {
            self.first_pa = Some(pressure_pa);
            self.second_pa = pressure_pa;
            return pressure_pa;
        };
        let towards = |from_pa: f64, to_pa: f64, constant_s: f64| {
            from_pa + (to_pa - from_pa) * (1.0 - (-now.dt_s / constant_s).exp())
        };
        let next_pa = match self.kind {
            LagKind::First => towards(first_pa, pressure_pa, self.constant_s),
            LagKind::Second => {
                let next_pa = towards(first_pa, pressure_pa, 0.5 * self.constant_s);
                self.second_pa = towards(self.second_pa, next_pa, 0.5 * self.constant_s);
                next_pa
            }
            LagKind::Choked => {
                let (inside_pa, outside_pa) = (first_pa + AMBIENT_PA, pressure_pa + AMBIENT_PA);
                let upstream_pa = inside_pa.max(outside_pa);
                let ratio = (inside_pa.min(outside_pa) / upstream_pa).clamp(CRITICAL, 1.0);
                let flow = (1.0 - ((ratio - CRITICAL) / (1.0 - CRITICAL)).powi(2)).max(0.0).sqrt();
                let change_pa = now.dt_s / self.constant_s * 0.4 * upstream_pa * flow;
                if inside_pa < outside_pa {
                    (first_pa + change_pa).min(pressure_pa)
                } else {
                    (first_pa - change_pa).max(pressure_pa)
                }
            }
            LagKind::Volume => {
                let volume =
                    if now.radius_m > 0.0 { now.radius_m.powi(2) * now.encoder_m / self.rest_volume } else { 1.0 };
                towards(first_pa, pressure_pa, self.constant_s * volume)
            }
        };
        self.first_pa = Some(next_pa);
        if matches!(self.kind, LagKind::Second) { self.second_pa } else { next_pa }
    }
}

fn lag(kind: LagKind, u: f64, setting: &Setting) -> Built {
    let constant_s = size(u, 0.02, 0.40);
    let rest_volume = setting.muscle.rest_radius_m.powi(2) * setting.muscle.rest_length_m;
    Built::one(Lag { kind, constant_s, first_pa: None, second_pa: 0.0, rest_volume }).with("time_s", constant_s)
}

/// Lag of first order.
pub fn lag_first(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    lag(LagKind::First, u, setting)
}

/// Two lags of first order in series.
pub fn lag_second(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    lag(LagKind::Second, u, setting)
}

/// Lag of a nozzle (ISO 6358): filling and venting differ.
pub fn lag_choked(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    lag(LagKind::Choked, u, setting)
}

/// Lag of first order that grows with the volume of the muscle.
pub fn lag_volume(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    lag(LagKind::Volume, u, setting)
}

/// Hysteresis of the gauge.
#[derive(Debug)]
enum GaugeLoop {
    /// Play of this half width, Pa, and its output.
    Play(f64, Option<f64>),
    /// An element on pressure with this size, Pa, and the last pressure.
    Element(Element, f64, Option<f64>),
}

impl Mechanism for GaugeLoop {
    fn shown_pressure(&mut self, now: &Moment, pressure_pa: f64) -> f64 {
        match self {
            Self::Play(half_pa, output) => {
                let last_pa = output.unwrap_or(pressure_pa);
                let next_pa = last_pa.clamp(pressure_pa - *half_pa, pressure_pa + *half_pa);
                *output = Some(next_pa);
                next_pa
            }
            Self::Element(element, size_pa, last) => {
                let rise_pa = last.map_or(0.0, |last_pa| pressure_pa - last_pa);
                *last = Some(pressure_pa);
                element.step(rise_pa, now.dt_s);
                pressure_pa - *size_pa * element.state()
            }
        }
    }
}

/// Half width of the gauge's loop, Pa: 0.1 to 0.5 % of full scale, a loop of 1 to 5 kPa.
fn gauge_pa(u: f64) -> f64 {
    size(u, 500.0, 5000.0)
}

/// Gauge hysteresis, a play.
pub fn gauge_play(_: &mut Dice, u: f64, _: &Setting) -> Built {
    Built::one(GaugeLoop::Play(gauge_pa(u), None)).with("half_width_kpa", 1e-3 * gauge_pa(u))
}

/// Gauge hysteresis of Bouc and Wen.
pub fn gauge_bouc_wen(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let element = Element::BoucWen {
        reach_m: dice.log_uniform(6e3, 4e4),
        exponent: dice.uniform(0.9, 1.8),
        beta: dice.uniform(0.4, 0.7),
        state: 0.0,
    };
    Built::one(GaugeLoop::Element(element, gauge_pa(u), None)).with("half_width_kpa", 1e-3 * gauge_pa(u))
}

/// Gauge hysteresis of several stop operators (Preisach's plane along its diagonal).
pub fn gauge_preisach(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let finest_pa = dice.log_uniform(2e3, 6e3);
    let reaches: Vec<f64> = (0..6).map(|index| finest_pa * 2f64.powi(index)).collect();
    let element = Element::slip(&reaches, &[1.0; 6], 0.0);
    Built::one(GaugeLoop::Element(element, gauge_pa(u), None)).with("half_width_kpa", 1e-3 * gauge_pa(u))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lag_arrives_and_is_late_on_the_way() {
        for kind in [LagKind::First, LagKind::Second, LagKind::Choked, LagKind::Volume] {
            let mut lag = Lag { kind, constant_s: 0.1, first_pa: None, second_pa: 0.0, rest_volume: 1.0 };
            let now = Moment { dt_s: 1e-3, ..Moment::default() };
            lag.pressure(&now, 1e5);
            let early_pa = lag.pressure(&now, 2e5);
            assert!(early_pa < 1.2e5, "{kind:?}");
            let mut last_pa = 0.0;
            for _ in 0..3000 {
                last_pa = lag.pressure(&now, 2e5);
            }
            assert!((last_pa - 2e5).abs() < 500.0, "{kind:?}: {last_pa}");
        }
    }

    #[test]
    fn a_play_shows_less_on_the_way_up_and_more_on_the_way_down() {
        let mut play = GaugeLoop::Play(1000.0, None);
        let now = Moment::default();
        for step in 0..=100 {
            play.shown_pressure(&now, 1000.0 * f64::from(step));
        }
        assert_eq!(play.shown_pressure(&now, 1e5), 9.9e4);
        assert_eq!(play.shown_pressure(&now, 5e4), 5.1e4);
    }
}
