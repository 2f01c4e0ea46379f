//! What is recorded: a few standard sets of protocols, none of which is made for one effect.
//!
//! Each has motion at constant pressure, pressure at constant length, something fast and something that wears, so
//! that a diagnosis has a chance to tell most effects apart; which one is drawn says nothing of what is concealed.

/// A set of protocols.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Set {
    /// Name.
    pub name: &'static str,
    /// Protocols to fit.
    pub estimation: &'static [&'static str],
    /// Protocols to choose the second held-out recording from; the first is a multisine.
    pub holdout: &'static [&'static str],
}

/// Every set.
pub const SETS: [Set; 5] = [
    Set {
        name: "A",
        estimation: &["isobaric-triangles", "isometric-ramps", "pressure-chirp", "endurance", "multisine"],
        holdout: &["rate-ladder", "length-steps"],
    },
    Set {
        name: "B",
        estimation: &["rate-ladder", "isometric-ramps", "length-steps", "run-in", "multisine"],
        holdout: &["isobaric-triangles", "pressure-steps"],
    },
    Set {
        name: "C",
        estimation: &["isobaric-triangles", "pressure-steps", "rate-ladder", "endurance", "multisine"],
        holdout: &["isometric-ramps", "length-steps"],
    },
    Set {
        name: "D",
        estimation: &["rate-ladder", "isometric-ramps", "pressure-chirp", "endurance"],
        holdout: &["isobaric-triangles", "length-steps"],
    },
    Set {
        name: "E",
        estimation: &["isobaric-triangles", "pressure-steps", "run-in", "multisine"],
        holdout: &["isometric-ramps", "minor-loops"],
    },
];

/// Samples of all estimation recordings together, about.
pub const ESTIMATION_SAMPLES: f64 = 48_000.0;

/// Samples of the endurance protocol, which cannot be much shorter.
pub const ENDURANCE_SAMPLES: f64 = 20_000.0;

/// Samples of one held-out recording, about.
pub const HOLDOUT_SAMPLES: f64 = 10_000.0;

impl Set {
    /// Samples that an estimation recording is to have.
    pub fn samples(&self, protocol: &str) -> f64 {
        let n = self.estimation.len() as f64;
        match (protocol, self.estimation.contains(&ENDURANCE)) {
            (ENDURANCE, _) => ENDURANCE_SAMPLES,
            (_, true) => (ESTIMATION_SAMPLES - ENDURANCE_SAMPLES) / (n - 1.0),
            _ => ESTIMATION_SAMPLES / n,
        }
    }
}

const ENDURANCE: &str = "endurance";
