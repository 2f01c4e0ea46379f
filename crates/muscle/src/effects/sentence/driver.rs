//! What drives a sentence.
//!
//! | driver                      | value                                                              | unit |
//! |-----------------------------|--------------------------------------------------------------------|------|
//! | `pressure`                  | gauge pressure                                                     | Pa   |
//! | `contraction`               | contraction ratio                                                  | 1    |
//! | `speed`                     | speed of contraction, positive when shortening                     | m/s  |
//! | `force`                     | force of eq. 11 without friction                                   | N    |
//! | `time`                      | time since the recording began                                     | s    |
//! | `travel-since-reversal`     | travel of the braid since it last turned                           | m    |
//! | `time-since-last-move`      | time since length or pressure changed faster than the two limits   | s    |
//! | `time-since-pressure-moved` | time since the pressure changed faster than its limit              | s    |
//! | `cycle`                     | cycles of motion, from 1                                           | 1    |
//!
//! The force is that of the model: the measured one holds what is to be explained.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Sentence;
use super::recall::Recalled;
use crate::coordinate::Coordinate;
use crate::effects::{Base, Moment};

/// What drives a sentence; see the [module](self) for values and units.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Driver {
    /// Gauge pressure, in Pa.
    Pressure,
    /// Contraction ratio.
    Contraction,
    /// Speed of contraction, in m/s.
    Speed,
    /// Force of eq. 11 without friction, in N.
    Force,
    /// Time since the recording began, in s.
    Time,
    /// Travel of the braid since it last turned, in m.
    TravelSinceReversal,
    /// Time since length or pressure moved, in s.
    TimeSinceLastMove {
        /// Speed above which the length moves, in m/s.
        above_m_per_s: f64,
        /// Rate above which the pressure moves, in Pa/s.
        above_pa_per_s: f64,
    },
    /// Time since the pressure moved, in s.
    TimeSincePressureMoved {
        /// Rate above which the pressure moves, in Pa/s.
        above_pa_per_s: f64,
    },
    /// Cycle of motion, counted from 1.
    Cycle,
}

impl Driver {
    /// Unit of its value.
    pub fn unit(&self) -> &'static str {
        match self {
            Self::Pressure => "Pa",
            Self::Contraction | Self::Cycle => "1",
            Self::Speed => "m/s",
            Self::Force => "N",
            Self::TravelSinceReversal => "m",
            Self::Time | Self::TimeSinceLastMove { .. } | Self::TimeSincePressureMoved { .. } => "s",
        }
    }

    /// Name as in files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Pressure => "pressure",
            Self::Contraction => "contraction",
            Self::Speed => "speed",
            Self::Force => "force",
            Self::Time => "time",
            Self::TravelSinceReversal => "travel-since-reversal",
            Self::TimeSinceLastMove { .. } => "time-since-last-move",
            Self::TimeSincePressureMoved { .. } => "time-since-pressure-moved",
            Self::Cycle => "cycle",
        }
    }

    /// Coordinate over which a residual shows what it drives.
    pub fn coordinate(&self) -> Coordinate {
        match self {
            Self::Pressure => Coordinate::Pressure,
            Self::Contraction => Coordinate::Contraction,
            Self::Speed => Coordinate::Speed,
            Self::Force => Coordinate::Force,
            Self::Time => Coordinate::Time,
            Self::TravelSinceReversal => Coordinate::TravelSinceReversal,
            Self::TimeSinceLastMove { .. } | Self::TimeSincePressureMoved { .. } => Coordinate::TimeSinceLastMove,
            Self::Cycle => Coordinate::Cycle,
        }
    }

    pub(super) fn check(&self) -> Result<(), String> {
        let limits = match *self {
            Self::TimeSinceLastMove { above_m_per_s, above_pa_per_s } => [above_m_per_s, above_pa_per_s],
            Self::TimeSincePressureMoved { above_pa_per_s } => [above_pa_per_s; 2],
            _ => return Ok(()),
        };
        match limits.iter().find(|limit| !(limit.is_finite() && **limit > 0.0)) {
            Some(limit) => {
                Err(format!("the limit above which the {} begins is {limit}; it has to be positive", self.name()))
            }
            None => Ok(()),
        }
    }
}

/// What the curve of a sentence is evaluated at, moment by moment: the driver as the memory leaves it.
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
