//! Forms of the fixture: a late channel, a spring in series, a mass that moves.

use std::f64::consts::TAU;

use super::{Built, Channel, Compliance, Delay, Lateness, Setting, Spring, size};
use crate::draw::Dice;
use crate::mechanism::{Mechanism, Moment};

fn delay(dice: &mut Dice, u: f64, jitter: f64) -> Built {
    let channel = *dice.pick(&[Channel::Pressure, Channel::Length, Channel::Force]);
    let delay_s = size(u, 1e-3, 5e-2);
    let number = match channel {
        Channel::Pressure => 0.0,
        Channel::Length => 1.0,
        Channel::Force => 2.0,
    };
    Built { delay: Some(Delay { channel, delay_s, lateness: Lateness::Wandering(jitter) }), ..Built::default() }
        .with("delay_s", delay_s)
        .with("channel_of_pressure_length_force", number)
}

/// One channel late by a constant time.
pub fn delay_pure(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    delay(dice, u, 0.0)
}

/// One channel late by a time that wanders.
pub fn delay_wandering(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let jitter = dice.uniform(0.15, 0.4);
    delay(dice, u, jitter)
}

fn compliance(stiffness_n_per_m: f64, spring: Spring) -> Built {
    Built { compliance: Some(Compliance { stiffness_n_per_m, spring }), ..Built::default() }
        .with("stiffness_n_per_mm", 1e-3 * stiffness_n_per_m)
}

/// A linear spring in series: 20 to 500 N/mm.
pub fn compliance_linear(_: &mut Dice, u: f64, _: &Setting) -> Built {
    compliance(size(1.0 - u, 2e4, 5e5), Spring::Linear)
}

/// A cable in series that hardens as it straightens.
pub fn compliance_hardening(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let hardening_n = dice.uniform(0.1, 0.5) * setting.forces_n.1.max(50.0);
    compliance(size(1.0 - u, 2e4, 5e5), Spring::Hardening { hardening_n })
}

/// A mass between muscle and load cell.
#[derive(Debug)]
struct Mass {
    mass_kg: f64,
    /// Natural frequency in rad/s and damping ratio of the spring it hangs on; none for a rigid one.
    spring: Option<(f64, f64)>,
    value: f64,
    rate: f64,
}

impl Mechanism for Mass {
    fn begin(&mut self, _recording: usize, _rested: bool) {
        (self.value, self.rate) = (0.0, 0.0);
    }

    fn cell_n(&mut self, now: &Moment, force_n: f64) -> f64 {
        let followed = match self.spring {
            None => now.acceleration_m_per_s2,
            Some((natural, ratio)) => {
                let parts = (natural * now.dt_s / 0.05).ceil().max(1.0);
                let step_s = now.dt_s / parts;
                for _ in 0..parts as usize {
                    let push = natural * natural * (now.acceleration_m_per_s2 - self.value);
                    self.rate += step_s * (push - 2.0 * ratio * natural * self.rate);
                    self.value += step_s * self.rate;
                }
                self.value
            }
        };
        force_n - self.mass_kg * followed
    }
}

fn mass(u: f64, spring: Option<(f64, f64)>) -> Built {
    let mass_kg = size(u, 0.1, 1.5);
    Built::one(Mass { mass_kg, spring, value: 0.0, rate: 0.0 }).with("mass_kg", mass_kg)
}

/// A rigid mass.
pub fn inertia_mass(_: &mut Dice, u: f64, _: &Setting) -> Built {
    mass(u, None)
}

/// A mass on a spring, which rings.
pub fn inertia_spring(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    mass(u, Some((TAU * dice.uniform(12.0, 35.0), dice.uniform(0.05, 0.2))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mass_that_is_pulled_towards_the_muscle_takes_force_away() {
        let now = Moment { acceleration_m_per_s2: 2.0, dt_s: 1e-3, ..Moment::default() };
        let mut rigid = Mass { mass_kg: 1.5, spring: None, value: 0.0, rate: 0.0 };
        assert_eq!(rigid.cell_n(&now, 10.0), 7.0);
        let mut hung = Mass { mass_kg: 1.5, spring: Some((100.0, 0.2)), value: 0.0, rate: 0.0 };
        let mut last_n = 0.0;
        for _ in 0..2000 {
            last_n = hung.cell_n(&now, 10.0);
        }
        assert!((last_n - 7.0).abs() < 1e-3, "{last_n}");
    }

    #[test]
    fn a_hardening_spring_extends_less() {
        let linear = Compliance { stiffness_n_per_m: 5e4, spring: Spring::Linear };
        let spring = Spring::Hardening { hardening_n: 100.0 };
        let hardening = Compliance { stiffness_n_per_m: 5e4, spring };
        assert!((linear.extension_m(100.0) - 2e-3).abs() < 1e-12);
        assert!(hardening.extension_m(100.0) < linear.extension_m(100.0));
    }
}
