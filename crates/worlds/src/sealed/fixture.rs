//! Fixture: a late channel, a spring in series, a mass that moves.

use std::f64::consts::TAU;

use crate::draw::Dice;
use crate::forms::{Built, Channel, Compliance, Delay, Lateness, Setting, Spring, size};
use crate::mechanism::{Mechanism, Moment};

fn delay(dice: &mut Dice, u: f64, setting: &Setting, lateness: fn(f64, f64) -> Lateness) -> Built {
    let channel = *dice.pick(&[Channel::Pressure, Channel::Length, Channel::Force]);
    let delay_s = size(u, 1e-3, 5e-2);
    let longest_s = setting.durations_s.iter().copied().fold(10.0, f64::max);
    let number = match channel {
        Channel::Pressure => 0.0,
        Channel::Length => 1.0,
        Channel::Force => 2.0,
    };
    Built { delay: Some(Delay { channel, delay_s, lateness: lateness(delay_s, longest_s) }), ..Built::default() }
        .with("delay_s", delay_s)
        .with("channel_of_pressure_length_force", number)
}

/// A channel whose clock runs slow: its delay grows along each recording, from half of the mean to one and a half.
pub fn delay_growing(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    delay(dice, u, setting, |delay_s, longest_s| Lateness::Growing { per_s: delay_s / longest_s })
}

/// A channel that a slow bus asks now and then: it keeps its value for as long as the mean delay, and is half of that old at
/// the asking.
pub fn delay_polled(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    delay(dice, u, setting, |delay_s, _| Lateness::Polled { period_s: delay_s })
}

fn compliance(stiffness_n_per_m: f64, spring: Spring) -> Built {
    Built { compliance: Some(Compliance { stiffness_n_per_m, spring }), ..Built::default() }
        .with("stiffness_n_per_mm", 1e-3 * stiffness_n_per_m)
}

/// A contact in series, which extends by the power 2/3 of the force (Hertz); 20 to 500 N/mm is its secant at the highest force.
pub fn compliance_contact(_: &mut Dice, u: f64, setting: &Setting) -> Built {
    let reference_n = setting.forces_n.1.max(50.0);
    compliance(size(1.0 - u, 2e4, 5e5), Spring::Power { exponent: 2.0 / 3.0, reference_n })
        .with("reference_n", reference_n)
}

/// A joint in series that is held together by a preload and opens beyond it, to a third or less of its stiffness.
pub fn compliance_joint(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let (preload_n, softer) = (dice.uniform(0.2, 0.5) * setting.forces_n.1.max(50.0), dice.uniform(0.15, 0.35));
    compliance(size(1.0 - u, 6e4, 1.5e6), Spring::Preloaded { preload_n, softer })
        .with("preload_n", preload_n)
        .with("softer", softer)
}

/// Masses that move with the muscle's end.
#[derive(Debug)]
enum Moving {
    /// A rigid mass in kg, and one on a spring with its natural frequency in rad/s and damping ratio; value and rate of the
    /// acceleration that it follows with.
    Two { rigid_kg: f64, hung_kg: f64, natural: f64, ratio: f64, value: f64, rate: f64 },
    /// A mass on a lever: `m(x) = m (1 + κ (x − x₀))` in kg and per m; its force is `m a + ½ m' v²` (Lagrange).
    Lever { mass_kg: f64, per_m: f64, middle_m: f64 },
}

impl Mechanism for Moving {
    fn begin(&mut self, _recording: usize, _rested: bool) {
        if let Self::Two { value, rate, .. } = self {
            (*value, *rate) = (0.0, 0.0);
        }
    }

    fn cell_n(&mut self, now: &Moment, force_n: f64) -> f64 {
        let acceleration = now.acceleration_m_per_s2;
        match self {
            Self::Two { rigid_kg, hung_kg, natural, ratio, value, rate } => {
                let parts = (*natural * now.dt_s / 0.05).ceil().max(1.0);
                let step_s = now.dt_s / parts;
                for _ in 0..parts as usize {
                    *rate += step_s * (*natural * *natural * (acceleration - *value) - 2.0 * *ratio * *natural * *rate);
                    *value += step_s * *rate;
                }
                force_n - *rigid_kg * acceleration - *hung_kg * *value
            }
            Self::Lever { mass_kg, per_m, middle_m } => {
                // Contracting is shortening, so that x − x₀ is the middle less the length.
                let mass = *mass_kg * (1.0 + *per_m * (*middle_m - now.length_m));
                force_n - mass * acceleration - 0.5 * *mass_kg * *per_m * now.speed_m_per_s.powi(2)
            }
        }
    }
}

/// A mass of which a part hangs on a spring.
pub fn inertia_two(dice: &mut Dice, u: f64, _: &Setting) -> Built {
    let (mass_kg, share) = (size(u, 0.1, 1.5), dice.uniform(0.3, 0.7));
    let (natural, ratio) = (TAU * dice.uniform(8.0, 20.0), dice.uniform(0.1, 0.4));
    let (rigid_kg, hung_kg) = (mass_kg * (1.0 - share), mass_kg * share);
    Built::one(Moving::Two { rigid_kg, hung_kg, natural, ratio, value: 0.0, rate: 0.0 })
        .with("mass_kg", mass_kg)
        .with("hung_share", share)
}

/// A mass on a lever, whose arm grows or falls by a third over the stroke.
pub fn inertia_lever(dice: &mut Dice, u: f64, setting: &Setting) -> Built {
    let mass_kg = size(u, 0.1, 1.5);
    let rest_m = setting.muscle.rest_length_m;
    let stroke_m = (setting.contractions.1 - setting.contractions.0).max(0.02) * rest_m;
    let per_m = dice.sign() * dice.uniform(0.4, 0.9) / stroke_m;
    let middle_m = rest_m * (1.0 - setting.contraction_at(0.5));
    Built::one(Moving::Lever { mass_kg, per_m, middle_m }).with("mass_kg", mass_kg).with("per_m", per_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn springs_extend_monotonically_and_meet_their_secants() {
        let contact =
            Compliance { stiffness_n_per_m: 5e4, spring: Spring::Power { exponent: 2.0 / 3.0, reference_n: 200.0 } };
        assert!((contact.extension_m(200.0) - 4e-3).abs() < 1e-12);
        let joint = Compliance { stiffness_n_per_m: 2e5, spring: Spring::Preloaded { preload_n: 100.0, softer: 0.2 } };
        assert!((joint.extension_m(100.0) - 5e-4).abs() < 1e-12);
        assert!((joint.extension_m(140.0) - 1.5e-3).abs() < 1e-12);
        for spring in [contact, joint] {
            for force_n in -20..300 {
                let (here, next) = (f64::from(force_n), f64::from(force_n + 1));
                assert!(spring.extension_m(next) > spring.extension_m(here), "{spring:?} at {force_n} N");
            }
        }
    }

    #[test]
    fn a_steady_acceleration_moves_the_whole_mass() {
        let mut two = Moving::Two { rigid_kg: 0.4, hung_kg: 0.6, natural: 80.0, ratio: 0.3, value: 0.0, rate: 0.0 };
        let now = Moment { acceleration_m_per_s2: 3.0, dt_s: 1e-3, ..Moment::default() };
        let first_n = two.cell_n(&now, 0.0);
        let last_n = (0..3000).map(|_| two.cell_n(&now, 0.0)).last().unwrap_or(0.0);
        assert!(first_n > -1.5 && (last_n + 3.0).abs() < 1e-3, "{first_n} {last_n}");
    }

    #[test]
    fn a_lever_keeps_the_energy_it_is_given() {
        let mut lever = Moving::Lever { mass_kg: 1.0, per_m: 10.0, middle_m: 0.2 };
        let (dt_s, mut work_j, mut last_speed) = (1e-5, 0.0, 0.0);
        let path = |t: f64| (0.2 - 0.02 * t * t, 0.04 * t, 0.04);
        for step in 0..100_000 {
            let (length_m, speed_m_per_s, acceleration_m_per_s2) = path(f64::from(step) * dt_s);
            let now = Moment { length_m, speed_m_per_s, acceleration_m_per_s2, dt_s, ..Moment::default() };
            work_j -= lever.cell_n(&now, 0.0) * speed_m_per_s * dt_s;
            last_speed = speed_m_per_s;
        }
        let kinetic_j = 0.5 * (1.0 + 10.0 * 0.02) * last_speed * last_speed;
        assert!((work_j / kinetic_j - 1.0).abs() < 1e-3, "{work_j} {kinetic_j}");
    }
}
