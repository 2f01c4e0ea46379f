//! Mass of the moving end, which the load cell accelerates along with it.
//!
//! ```text
//! F_cell = F + m d²y/dt²,   d²y/dt² = ω² (L - y) - 2 ζ ω dy/dt
//! ```
//!
//! | symbol | code        | unit  | meaning                                                   |
//! |--------|-------------|-------|-----------------------------------------------------------|
//! | `m`    | `mass_kg`   | kg    | cell, clamp and a third of the muscle                     |
//! | `y`    | `places_m`  | m     | place of the end, which follows the drive                 |
//! | `ω`    | `rad_per_s` | rad/s | natural frequency of its mount                            |
//! | `ζ`    | `DAMPING`   | 1     | its damping                                               |
//!
//! A drive that turns at a point would accelerate without bound; the mount gives way, so that the mass feels a
//! short knock there.
//!
//! Source: Newton's second law.

use std::f64::consts::TAU;

use crate::draw::Draw;
use crate::mechanism::{Mechanism, Moment};
use crate::true_muscle::TrueMuscle;

/// Damping of the mount.
const DAMPING: f64 = 0.7;

/// Largest phase that is stepped at once, in rad.
const STEP_RAD: f64 = 0.05;

/// A mass on a mount.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Inertia {
    mass_kg: f64,
    rad_per_s: f64,
    /// Places of the drive and of the end.
    places_m: Option<(f64, f64)>,
    speed_m_per_s: f64,
}

impl Inertia {
    pub(crate) fn new(mass_kg: f64, natural_hz: f64) -> Self {
        Self { mass_kg, rad_per_s: TAU * natural_hz, places_m: None, speed_m_per_s: 0.0 }
    }

    pub(crate) fn draw(draw: &mut Draw<'_>) -> Self {
        let mass_kg = draw.severe("moving_mass", 1.0, 1.8, "kg");
        Self::new(mass_kg, draw.ratio("natural_frequency", 20.0, 40.0, "Hz"))
    }
}

impl Mechanism for Inertia {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        let (drive_before_m, mut place_m) = self.places_m.unwrap_or((now.drive_length_m, now.drive_length_m));
        let steps = (now.step_s * self.rad_per_s / STEP_RAD).ceil();
        let step_s = now.step_s / steps;
        let mut acceleration_m_per_s2 = 0.0;
        for step in 1..=steps as usize {
            let share = (step as f64 - 0.5) / steps;
            let drive_m = drive_before_m + share * (now.drive_length_m - drive_before_m);
            acceleration_m_per_s2 =
                self.rad_per_s * (self.rad_per_s * (drive_m - place_m) - 2.0 * DAMPING * self.speed_m_per_s);
            self.speed_m_per_s += acceleration_m_per_s2 * step_s;
            place_m += self.speed_m_per_s * step_s;
        }
        self.places_m = Some((now.drive_length_m, place_m));
        now.reading.force_n += self.mass_kg * acceleration_m_per_s2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::Readout;
    use crate::mechanism::moment::rig::{STEP_S, go, run};

    fn forces_n(path: &[(f64, f64)]) -> Vec<f64> {
        run(vec![Box::new(Readout), Box::new(Inertia::new(1.5, 30.0))], path)
            .iter()
            .map(|now| now.reading.force_n)
            .collect()
    }

    #[test]
    fn a_slow_swing_is_felt_as_mass_times_acceleration() {
        // 3 mm at 2 Hz: 0.47 m/s², positive where the end accelerates outward.
        let omega = TAU * 2.0;
        let path: Vec<(f64, f64)> =
            (0..2000).map(|step| (3e5, 0.25 + 3e-3 * (omega * f64::from(step) * STEP_S).sin())).collect();
        let forces_n = forces_n(&path);
        let peak_n = 1.5 * 3e-3 * omega * omega;
        let largest_n = forces_n[1000..].iter().copied().fold(0.0, f64::max);
        assert!((largest_n / peak_n - 1.0).abs() < 0.03, "{largest_n} {peak_n}");
        // At the inner end the acceleration points outward: the cell reads more.
        assert!(forces_n[1375] > 0.8 * peak_n);
    }

    #[test]
    fn steady_motion_and_standstill_are_not_felt() {
        let mut path = vec![(3e5, 0.25)];
        go(&mut path, 3e5, 0.24, 1000);
        go(&mut path, 3e5, 0.24, 1000);
        let forces_n = forces_n(&path);
        assert!(forces_n[900].abs() < 1e-3 && forces_n[1900].abs() < 1e-6);
    }
}
