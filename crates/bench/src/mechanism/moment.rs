//! The present moment of the simulation, and what may act on it.

use crate::true_muscle::{Tension, TrueMuscle};

/// What perfect sensors would read.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reading {
    /// Gauge pressure.
    pub pressure_pa: f64,
    /// Length, clamp to clamp.
    pub length_m: f64,
    /// Tension.
    pub force_n: f64,
}

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
    /// Pressure in the muscle, where it reaches the braid.
    pub muscle_pressure_pa: f64,
    /// Length of the muscle.
    pub muscle_length_m: f64,
    /// By how much the muscle has shortened since the moment before.
    pub shortening_m: f64,
    /// By how much the braid has closed since the moment before, as a shortening: that of the muscle, or where its
    /// length is held, the one that would open the braid as the stretch of its strands does.
    pub braid_travel_m: f64,
    /// Direction of the braid's motion: +1 contracting, -1 extending.
    pub direction: f64,
    /// Parts of the muscle's tension.
    pub tension: Tension,
    /// What perfect sensors would read.
    pub reading: Reading,
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
            shortening_m: 0.0,
            braid_travel_m: 0.0,
            direction: 0.0,
            tension: Tension::default(),
            reading: Reading::default(),
        }
    }

    /// Speed at which the muscle shortens, in m/s.
    pub fn shortening_speed_m_per_s(&self) -> f64 {
        if self.step_s > 0.0 { self.shortening_m / self.step_s } else { 0.0 }
    }

    /// Speed of the braid without sign, in m/s.
    pub fn braid_speed_m_per_s(&self) -> f64 {
        if self.step_s > 0.0 { self.braid_travel_m.abs() / self.step_s } else { 0.0 }
    }
}

/// Something that acts at every step of the simulation.
pub trait Mechanism: Duplicate {
    /// Acts on the present moment, given what it remembers of those before.
    fn act(&mut self, muscle: &TrueMuscle, now: &mut Moment);

    /// Called once before the first moment of a recording, with the recording's own seed.
    fn begin(&mut self, _seed: u64) {}
}

/// A copy with all it remembers, so that a step can be tried before it is taken.
pub trait Duplicate {
    /// The copy.
    fn duplicate(&self) -> Box<dyn Mechanism>;
}

impl<T: Mechanism + Clone + 'static> Duplicate for T {
    fn duplicate(&self) -> Box<dyn Mechanism> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
pub(crate) mod rig {
    //! A bare rig for tests: the nominal muscle, its friction, and one mechanism.

    use super::*;
    use crate::friction::BraidFriction;
    use crate::mechanism::{BraidMotion, PassiveTension, Readout};

    /// Step of the bare rig.
    pub(crate) const STEP_S: f64 = 1e-3;

    /// Takes the nominal muscle through pressures and lengths, a millisecond apart, `mechanism` after its friction and
    /// before the sensors.
    pub(crate) fn drive(mechanism: impl Mechanism + 'static, path: &[(f64, f64)]) -> Vec<Moment> {
        drive_chain(vec![Box::new(mechanism)], path)
    }

    /// The same with several mechanisms.
    pub(crate) fn drive_chain(mechanisms: Vec<Box<dyn Mechanism>>, path: &[(f64, f64)]) -> Vec<Moment> {
        let mut chain: Vec<Box<dyn Mechanism>> =
            vec![Box::new(BraidMotion::new()), Box::new(PassiveTension), Box::new(BraidFriction)];
        chain.extend(mechanisms);
        chain.push(Box::new(Readout));
        run(chain, path)
    }

    /// Takes the nominal muscle through pressures and lengths with a chain of one's own.
    pub(crate) fn run(mut chain: Vec<Box<dyn Mechanism>>, path: &[(f64, f64)]) -> Vec<Moment> {
        let muscle = TrueMuscle::nominal();
        let mut moments = Vec::with_capacity(path.len());
        for (index, (pressure_pa, length_m)) in path.iter().enumerate() {
            let step_s = if index == 0 { 0.0 } else { STEP_S };
            let mut now = Moment::at(index as f64 * STEP_S, step_s, *pressure_pa, *length_m);
            for mechanism in &mut chain {
                mechanism.act(&muscle, &mut now);
            }
            moments.push(now);
        }
        moments
    }

    /// Goes in `steps` equal steps from one state to another, leaving out the first.
    pub(crate) fn go(path: &mut Vec<(f64, f64)>, pressure_pa: f64, length_m: f64, steps: usize) {
        let from = path.last().copied().unwrap_or((pressure_pa, length_m));
        for step in 1..=steps {
            let share = step as f64 / steps as f64;
            // A channel that stays must stay to the last bit.
            let between = |from: f64, to: f64| if from == to { from } else { from + share * (to - from) };
            path.push((between(from.0, pressure_pa), between(from.1, length_m)));
        }
    }

    /// Work that the rig has done on the muscle along a path, in J: positive where the mechanism dissipates.
    pub(crate) fn work_j(moments: &[Moment], force_n: impl Fn(&Moment) -> f64) -> f64 {
        moments
            .windows(2)
            .map(|pair| {
                0.5 * (force_n(&pair[0]) + force_n(&pair[1])) * (pair[1].muscle_length_m - pair[0].muscle_length_m)
            })
            .sum()
    }
}
