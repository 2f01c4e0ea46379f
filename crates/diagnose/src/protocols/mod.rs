//! Commanded paths of the bench protocols, for a muscle of which only a fitted model is known.
//!
//! # Design
//! The virtual bench has the same protocols, made for a muscle whose truth it knows: where that goes slack bounds its
//! paths. Here the truth is not known, so the paths are worked out again from what is: the pressures and lengths that the
//! recordings of the model covered, and where eq. 11 says that the muscle is taut. Nothing of the bench is used, so neither
//! can leak into the other.
//!
//! Protocols are written in the numbers of a 267 mm muscle at 0 to 500 kPa and contractions of -0.5 to 21 %; another
//! muscle gets them scaled to what was covered.

mod isobaric;
mod isometric;
mod loaded;
mod multisine;
mod path;
mod reach;
mod sweeps;
mod wear;

pub(crate) use path::Take;
pub(crate) use reach::Reach;

/// A protocol.
pub(crate) struct Protocol {
    /// Name, that of the virtual bench.
    pub name: &'static str,
    /// What is done, in words.
    pub summary: &'static str,
    path: fn(&Reach<'_>) -> Vec<Take>,
}

impl Protocol {
    /// Takes within `reach`; empty where it leaves no room for them.
    pub(crate) fn takes(&self, reach: &Reach<'_>) -> Vec<Take> {
        let mut takes = (self.path)(reach);
        takes.retain(|take| take.knots.len() > 1);
        if let Some(first) = takes.first_mut() {
            first.pause_before_s = 0.0;
        }
        takes
    }
}

/// Every protocol.
pub(crate) static PROTOCOLS: [Protocol; 14] = [
    Protocol {
        name: "null",
        summary: "lowest pressure at rest for half a minute, then three slow stretches",
        path: isobaric::null,
    },
    Protocol {
        name: "run-in",
        summary: "length triangles of growing stroke at one pressure, twice, an hour of rest, once more; with rubber that \
                  has rested",
        path: wear::run_in,
    },
    Protocol {
        name: "isobaric-triangles",
        summary: "three length triangles over the whole stroke at each of seven pressures",
        path: isobaric::triangles,
    },
    Protocol {
        name: "rate-ladder",
        summary: "length triangles at five speeds from 0.5 to 50 mm/s, at three pressures",
        path: isobaric::rate_ladder,
    },
    Protocol {
        name: "minor-loops",
        summary: "nested small length triangles and reversals at one pressure",
        path: isobaric::minor_loops,
    },
    Protocol {
        name: "isometric-ramps",
        summary: "slow pressure ramps from the lowest pressure up and back at five lengths",
        path: isometric::ramps,
    },
    Protocol {
        name: "length-steps",
        summary: "fast length steps with holds of a minute at three pressures",
        path: isobaric::length_steps,
    },
    Protocol {
        name: "pressure-steps",
        summary: "fast pressure steps with holds of a minute at three lengths",
        path: isometric::steps,
    },
    Protocol {
        name: "pressure-chirp",
        summary: "a pressure sweep from 0.05 to 10 Hz at three lengths, the length locked",
        path: sweeps::pressure_chirp,
    },
    Protocol {
        name: "length-chirp",
        summary: "a length sweep from 0.05 to 8 Hz at three pressures",
        path: sweeps::length_chirp,
    },
    Protocol {
        name: "multisine",
        summary: "pressure and length wander together without repeating, four minutes",
        path: multisine::multisine,
    },
    Protocol { name: "isotonic", summary: "slow pressure triangles under four constant loads", path: loaded::isotonic },
    Protocol {
        name: "endurance",
        summary: "two hundred cycles at two pressures in turn, with probe cycles before, between and after half an hour of \
                  rest",
        path: wear::endurance,
    },
    Protocol {
        name: "dwell",
        summary: "slow moves with waits of 0.1 to 100 s before going on and before turning back",
        path: wear::dwell,
    },
];

/// The protocol called `name`.
pub(crate) fn named(name: &str) -> Option<&'static Protocol> {
    PROTOCOLS.iter().find(|protocol| protocol.name == name)
}
