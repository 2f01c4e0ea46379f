//! The muscle itself and the sensors themselves, as links of the chain.

use crate::mechanism::{Mechanism, Moment, Reading};
use crate::true_muscle::TrueMuscle;

/// The muscle itself, without friction: pressure and length make tension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PassiveTension;

impl Mechanism for PassiveTension {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        now.tension = muscle.passive_tension(now.muscle_pressure_pa, now.muscle_length_m);
    }
}

/// Perfect sensors: the gauge, the drive's length and the tension as they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Readout;

impl Mechanism for Readout {
    fn act(&mut self, _muscle: &TrueMuscle, now: &mut Moment) {
        now.reading = Reading {
            pressure_pa: now.gauge_pressure_pa,
            length_m: now.drive_length_m,
            force_n: now.tension.total_n(),
        };
    }
}
