//! What the curve of a sentence is evaluated at, moment by moment.

use super::Sentence;
use super::driver::Driver;
use super::recall::Recalled;
use crate::effects::{Base, Moment};

/// The driver as the memory leaves it.
#[derive(Debug, Clone)]
pub struct Argument {
    driver: Driver,
    recalled: Recalled,
    recording: Option<usize>,
    direction: f64,
    turn_m: f64,
    flips: usize,
    moved_s: f64,
}

impl Argument {
    /// At the beginning of a recording or a simulation.
    pub fn of(sentence: &Sentence) -> Self {
        let Sentence { driver, memory, .. } = *sentence;
        let recalled = Recalled::new(memory);
        Self { driver, recalled, recording: None, direction: 0.0, turn_m: 0.0, flips: 0, moved_s: 0.0 }
    }

    /// Goes on to `now`.
    pub fn follow(&mut self, now: &Moment, base: &Base) -> f64 {
        let begins = self.recording != Some(now.recording);
        let value = self.driven(now, base, begins);
        self.recording = Some(now.recording);
        self.recalled.follow(now, base, value, begins)
    }

    fn driven(&mut self, now: &Moment, base: &Base, begins: bool) -> f64 {
        match self.driver {
            Driver::Pressure => now.pressure_pa,
            Driver::Contraction => now.contraction_ratio,
            Driver::Speed => now.speed_m_per_s,
            Driver::Force => base.static_force_n,
            Driver::Time => now.time_s,
            Driver::TravelSinceReversal | Driver::Cycle => {
                self.turn(now, begins);
                match self.driver {
                    Driver::Cycle => 1.0 + (self.flips / 2) as f64,
                    _ => (now.slide_m - self.turn_m).abs(),
                }
            }
            Driver::TimeSinceLastMove { above_m_per_s, above_pa_per_s } => {
                let moves =
                    now.speed_m_per_s.abs() > above_m_per_s || now.pressure_rate_pa_per_s.abs() > above_pa_per_s;
                self.since(now, begins || moves)
            }
            Driver::TimeSincePressureMoved { above_pa_per_s } => {
                self.since(now, begins || now.pressure_rate_pa_per_s.abs() > above_pa_per_s)
            }
        }
    }

    /// Time since something last moved, which it does now or does not.
    fn since(&mut self, now: &Moment, moves: bool) -> f64 {
        if moves {
            self.moved_s = now.time_s;
        }
        now.time_s - self.moved_s
    }

    fn turn(&mut self, now: &Moment, begins: bool) {
        if begins {
            (self.direction, self.flips) = (0.0, 0);
        }
        if begins || now.direction != self.direction {
            self.flips += usize::from(self.direction != 0.0);
            (self.direction, self.turn_m) = (now.direction, now.slide_m);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Curve, Recall, Scale};
    use super::*;
    use crate::effects::moment::tests::{base, still};

    fn argument(driver: Driver) -> Argument {
        let (memory, scale, shape) = (Recall::None, Scale::One, Curve::Line);
        Argument::of(&Sentence { driver, memory, scale, shape, seen: [0.0, 1.0] })
    }

    #[test]
    fn travel_begins_anew_where_the_braid_turns_and_two_turns_are_a_cycle() {
        let (mut travel, mut cycle) = (argument(Driver::TravelSinceReversal), argument(Driver::Cycle));
        let mut at = |slide_m: f64, direction: f64| {
            let now = Moment { slide_m, direction, ..still() };
            (travel.follow(&now, &base()), cycle.follow(&now, &base()))
        };
        assert_eq!(at(0.0, 1.0), (0.0, 1.0));
        assert_eq!(at(0.02, 1.0), (0.02, 1.0));
        assert_eq!(at(0.02, -1.0), (0.0, 1.0));
        assert_eq!(at(0.015, -1.0).1, 1.0);
        assert_eq!(at(0.015, 1.0), (0.0, 2.0));
    }

    #[test]
    fn a_pressure_that_stands_still_is_held_however_the_length_moves() {
        let mut held = argument(Driver::TimeSincePressureMoved { above_pa_per_s: 1e3 });
        let mut at = |time_s: f64, pressure_rate_pa_per_s: f64| {
            held.follow(&Moment { time_s, pressure_rate_pa_per_s, speed_m_per_s: 0.1, ..still() }, &base())
        };
        assert_eq!([at(3.0, 0.0), at(5.0, 10.0), at(6.0, 2e3), at(6.5, 0.0)], [0.0, 2.0, 0.0, 0.5]);
    }
}
