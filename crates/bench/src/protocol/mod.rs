//! The protocols of the bench by name.
//!
//! Each is one function that makes takes for a muscle; the table [`ALL`] is the list that a user sees.

mod isobaric;
mod isometric;
mod loaded;
mod multisine;
mod sweeps;
mod wear;

use crate::path::{Command, Take};
use crate::reach::{REFERENCE_PRESSURE_PA, Reach};
use crate::true_muscle::TrueMuscle;

/// A protocol by name.
#[derive(Debug, Clone, Copy)]
pub struct Protocol {
    /// Name on the command line.
    pub name: &'static str,
    /// Number in the catalogue of bench protocols; `-` where it is a use and not a test.
    pub id: &'static str,
    /// What it does and what it shows, in one line.
    pub summary: &'static str,
    build: fn(&Setting<'_>) -> Vec<Take>,
}

/// Every protocol, in the order of the catalogue.
pub const ALL: [Protocol; 15] = [
    Protocol {
        name: "null",
        id: "P0",
        summary: "vented at rest, then stretched by 2 %: zero of the load cell, bladder alone",
        build: isobaric::null,
    },
    Protocol {
        name: "run-in",
        id: "P1",
        summary: "triangles of growing stroke, twice, a rest, once more: softening in the first cycles",
        build: wear::run_in,
    },
    Protocol {
        name: "isobaric-triangles",
        id: "P2",
        summary: "length triangles at seven pressures: statics and friction",
        build: isobaric::triangles,
    },
    Protocol {
        name: "rate-ladder",
        id: "P3",
        summary: "length triangles at five speeds and three pressures: how friction depends on speed",
        build: isobaric::rate_ladder,
    },
    Protocol {
        name: "minor-loops",
        id: "P4",
        summary: "nested small triangles and reversals at one pressure: memory of the friction",
        build: isobaric::minor_loops,
    },
    Protocol {
        name: "isometric-ramps",
        id: "P5",
        summary: "slow pressure ramps at five lengths: threshold pressure, slack, offsets",
        build: isometric::ramps,
    },
    Protocol {
        name: "length-steps",
        id: "P6",
        summary: "length steps and holds at three pressures: relaxation of the bladder",
        build: isobaric::length_steps,
    },
    Protocol {
        name: "pressure-steps",
        id: "P7",
        summary: "pressure steps and holds at three lengths: creep, leaks, lag",
        build: isometric::steps,
    },
    Protocol {
        name: "pressure-chirp",
        id: "P8",
        summary: "pressure sweep from 0.05 to 10 Hz at three lengths: lag and delay of the pressure",
        build: sweeps::pressure_chirp,
    },
    Protocol {
        name: "length-chirp",
        id: "P9",
        summary: "length sweep from 0.05 to 8 Hz at three pressures: damping, inertia, delay",
        build: sweeps::length_chirp,
    },
    Protocol {
        name: "multisine",
        id: "P10",
        summary: "pressure and length wander together, phases from the seed: validation",
        build: multisine::multisine,
    },
    Protocol {
        name: "isotonic",
        id: "P11",
        summary: "pressure triangles under four constant loads: friction that depends on load",
        build: loaded::isotonic,
    },
    Protocol {
        name: "endurance",
        id: "P12",
        summary: "two hundred cycles with probe cycles before, between and after a rest: drift",
        build: wear::endurance,
    },
    Protocol {
        name: "dwell",
        id: "P14",
        summary: "waits of 0.1 to 100 s before reversal and before going on: stiction or relaxation",
        build: wear::dwell,
    },
    Protocol {
        name: "lift",
        id: "-",
        summary: "the elbow lifts three payloads by 0.3 rad and lowers them: the use of the muscle",
        build: loaded::lift,
    },
];

/// What a protocol may be told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Seed of random phases; other protocols do not use it.
    pub seed: u64,
    /// Duration relative to that in the catalogue, in (0, 100]: shortens holds, sweeps and the number of
    /// cycles; where one cycle is left, it runs faster.
    pub duration_scale: f64,
    /// Highest pressure; the pressures of the catalogue, up to 500 kPa, are scaled to it.
    pub highest_pressure_pa: f64,
    /// Lowest tension that a contracting muscle may be taken to; `-∞` lets it hang slack.
    pub lowest_tension_n: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { seed: 0, duration_scale: 1.0, highest_pressure_pa: REFERENCE_PRESSURE_PA, lowest_tension_n: 5.0 }
    }
}

/// Why a protocol cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProtocolError {
    /// No protocol has this name.
    #[error("there is no protocol \"{name}\"")]
    Unknown {
        /// Name asked for.
        name: String,
    },
    /// A duration that cannot be run.
    #[error("duration scale {value} is outside 0.001 to 100; 1 is the duration in the catalogue")]
    DurationScale {
        /// Value asked for.
        value: f64,
    },
    /// A pressure that is none, or would burst the muscle.
    #[error("highest pressure {value_pa} Pa is outside 1000 to 2000000 Pa")]
    HighestPressure {
        /// Value asked for.
        value_pa: f64,
    },
    /// A braid that gives way under the pressure.
    #[error(
        "the strands of this braid would stretch by {percent:.0} % at {highest_pressure_pa} Pa, more than \
         {MOST_PERCENT} %; check number, diameter and modulus of the strands, or lower the pressure"
    )]
    SoftBraid {
        /// Stretch of the strands at rest length, in percent.
        percent: f64,
        /// Highest pressure allowed.
        highest_pressure_pa: f64,
    },
    /// The muscle is slack wherever the protocol would take it.
    #[error(
        "protocol \"{protocol}\" finds this muscle slack: it never pulls {lowest_tension_n} N at up to \
         {highest_pressure_pa} Pa; raise the pressure or lower the tension asked for"
    )]
    Slack {
        /// Name of the protocol.
        protocol: &'static str,
        /// Lowest tension asked for.
        lowest_tension_n: f64,
        /// Highest pressure allowed.
        highest_pressure_pa: f64,
    },
}

/// Stretch of the strands, in percent, beyond which nothing here is true any more; nylon breaks at about 20.
const MOST_PERCENT: f64 = 15.0;

/// What a protocol is made from.
pub(crate) struct Setting<'a> {
    reach: Reach<'a>,
    pace: Pace,
    seed: u64,
}

/// How a duration scale is spent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pace {
    scale: f64,
}

impl Pace {
    /// Of `nominal` cycles, how many remain, and by what factor each is then stretched in time.
    fn cycles(self, nominal: u32) -> (u32, f64) {
        let wanted = f64::from(nominal) * self.scale;
        let count = wanted.round().max(1.0);
        (count as u32, wanted / count)
    }

    /// A hold or a sweep of `nominal_s`.
    fn duration_s(self, nominal_s: f64) -> f64 {
        nominal_s * self.scale
    }
}

impl Protocol {
    /// The protocol called `name`.
    ///
    /// # Errors
    /// [`ProtocolError::Unknown`].
    pub fn named(name: &str) -> Result<Self, ProtocolError> {
        let unknown = || ProtocolError::Unknown { name: name.to_owned() };
        ALL.into_iter().find(|protocol| protocol.name == name).ok_or_else(unknown)
    }

    /// The protocol made for a muscle.
    ///
    /// # Errors
    /// [`ProtocolError`] if an option is out of range, or if the muscle is slack throughout.
    pub fn command(&self, muscle: &TrueMuscle, options: &Options) -> Result<Command, ProtocolError> {
        let Options { seed, duration_scale, highest_pressure_pa, lowest_tension_n } = *options;
        if !(1e-3..=100.0).contains(&duration_scale) {
            return Err(ProtocolError::DurationScale { value: duration_scale });
        }
        if !(1e3..=2e6).contains(&highest_pressure_pa) {
            return Err(ProtocolError::HighestPressure { value_pa: highest_pressure_pa });
        }
        let strain = muscle.strand_strain(highest_pressure_pa, muscle.muscle().rest_length_m);
        let percent = if strain < 0.0 { f64::INFINITY } else { 100.0 * strain };
        if percent > MOST_PERCENT {
            return Err(ProtocolError::SoftBraid { percent, highest_pressure_pa });
        }
        let setting = Setting {
            reach: Reach::new(muscle, highest_pressure_pa, lowest_tension_n),
            pace: Pace { scale: duration_scale },
            seed,
        };
        let mut takes = (self.build)(&setting);
        takes.retain(|take| take.knots.len() > 1);
        if let Some(first) = takes.first_mut() {
            first.pause_before_s = 0.0;
        } else {
            return Err(ProtocolError::Slack { protocol: self.name, lowest_tension_n, highest_pressure_pa });
        }
        Ok(Command { protocol: self.name, takes })
    }
}

/// The protocol called `name`, made for a muscle.
///
/// # Errors
/// See [`Protocol::named`] and [`Protocol::command`].
pub fn command(name: &str, muscle: &TrueMuscle, options: &Options) -> Result<Command, ProtocolError> {
    Protocol::named(name)?.command(muscle, options)
}
