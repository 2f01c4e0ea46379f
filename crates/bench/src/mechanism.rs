//! What acts between the drive and the load cell, one step at a time.
//!
//! The bench is a chain: the drive sets pressure and length, each mechanism in turn changes what the
//! muscle sees or how it pulls, and what is left at the end goes to the sensors. A mechanism keeps its
//! own memory (a direction, a filter's state) and sees only the present [`Moment`].
//!
//! # Design
//! Position in the chain says where a mechanism acts: one that stands before [`PassiveTension`] changes
//! the pressure or the length that reaches the muscle, one that stands after it changes the tension. So one
//! trait with one function serves all of them.

use crate::friction::BraidFriction;
use crate::true_muscle::{Tension, TrueMuscle};

/// The rig and the muscle at one instant of the simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct Moment {
    /// Time since the start of the protocol.
    pub time_s: f64,
    /// Time since the moment before; zero at the first.
    pub step_s: f64,
    /// Pressure at the gauge.
    pub gauge_pressure_pa: f64,
    /// Length at the drive, clamp to clamp.
    pub drive_length_m: f64,
    /// Pressure in the muscle.
    pub muscle_pressure_pa: f64,
    /// Length of the muscle.
    pub muscle_length_m: f64,
    /// Direction of the braid's motion: +1 contracting, -1 extending.
    pub direction: f64,
    /// Parts of the muscle's tension.
    pub tension: Tension,
}

impl Moment {
    /// The rig at a pressure and a length, before any mechanism has acted.
    pub fn at(time_s: f64, step_s: f64, pressure_pa: f64, length_m: f64) -> Self {
        Self {
            time_s,
            step_s,
            gauge_pressure_pa: pressure_pa,
            drive_length_m: length_m,
            muscle_pressure_pa: pressure_pa,
            muscle_length_m: length_m,
            direction: 0.0,
            tension: Tension::default(),
        }
    }
}

/// Something that acts at every step of the simulation.
pub trait Mechanism {
    /// Acts on the present moment, given what it remembers of those before.
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment);
}

/// The muscle itself, without friction: pressure and length make tension.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PassiveTension;

impl Mechanism for PassiveTension {
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment) {
        now.tension = muscle.passive_tension(now.muscle_pressure_pa, now.muscle_length_m);
    }
}

/// The chain of a muscle with nothing concealed.
pub(crate) fn base_chain() -> Vec<Box<dyn Mechanism>> {
    vec![Box::new(PassiveTension), Box::new(BraidFriction::new())]
}
