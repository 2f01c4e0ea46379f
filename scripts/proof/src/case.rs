//! What a case is: everything that is needed to record it again, and what was concealed in it.

use pam_muscle::effects::effect;
use pam_virtual_bench::catalogue::EFFECTS;
use serde::{Deserialize, Serialize};

/// How many effects are concealed, and of which sort.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// One effect of the catalogue.
    Single,
    /// Nothing.
    Nothing,
    /// Two effects of the catalogue.
    Pair,
    /// Three effects of the catalogue.
    Triple,
    /// One that no catalogue has, in some cases beside one that the catalogue has.
    Nameless,
}

impl Kind {
    /// Every kind with its share of the cases.
    pub const SHARES: [(Self, f64); 5] =
        [(Self::Single, 0.44), (Self::Nothing, 0.20), (Self::Pair, 0.16), (Self::Triple, 0.10), (Self::Nameless, 0.10)];

    /// Name as in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Nothing => "nothing",
            Self::Pair => "pair",
            Self::Triple => "triple",
            Self::Nameless => "nameless",
        }
    }
}

/// One case, with its truth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Random letters; names the folder.
    pub name: String,
    /// What sort of case it is.
    pub kind: Kind,
    /// Decides the muscle.
    pub muscle_seed: u64,
    /// Decides the inner parameters of the effects and the shape of the misfit.
    pub effect_seed: u64,
    /// Standard set of protocols.
    pub set: String,
    /// Lowest tension that the rig takes the contracting muscle to, in N; below zero it may hang slack.
    pub lowest_tension_n: f64,
    /// What is concealed.
    pub concealed: Vec<Concealed>,
    /// Noise, and what it leaves of a perfect model.
    pub noise: Noise,
    /// What refitting eq. 11 leaves of the noise-free force with nothing concealed, in N.
    pub nothing_leaves_n: f64,
    /// What it leaves with everything concealed together, the misfit excluded, in N.
    pub together_leave_n: f64,
    /// Recordings that the diagnosis is given to fit.
    pub estimation: Vec<Log>,
    /// Recordings that it may only check itself on.
    pub holdout: Vec<Log>,
    /// Draws that had to be thrown away because the effect could not be made as strong or as weak as drawn.
    pub redraws: u32,
}

/// A concealed effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Concealed {
    /// Id; for effects of the catalogue the one that a diagnosis names.
    pub id: String,
    /// Severity on the bench.
    pub severity: f64,
    /// What refitting eq. 11 leaves of it, over the noise floor, as drawn.
    pub drawn_over_floor: f64,
    /// The same as reached.
    pub over_floor: f64,
    /// Where it shows, where it lives in a region.
    pub place: Option<Place>,
}

/// Where an effect shows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// Coordinate, by the name of the diagnosis.
    pub coordinate: String,
    /// Lower end, SI.
    pub from: f64,
    /// Upper end, SI.
    pub to: f64,
}

/// Noise of the sensors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// White noise of every channel relative to that of the sensors.
    pub white_factor: f64,
    /// AR(1) noise of the force beside it, and a smooth static misfit.
    pub colored: bool,
    /// Standard deviation of the colored noise of the force, in N; 0 where it is white.
    pub colored_n: f64,
    /// What noise leaves of a perfect model, in N.
    pub floor_n: f64,
    /// Smooth static misfit, root mean square, in N.
    pub misfit_n: f64,
}

/// One recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Log {
    /// File name: random letters.
    pub file: String,
    /// Protocol of the bench.
    pub protocol: String,
    /// Duration relative to the catalogue.
    pub duration_scale: f64,
    /// Seed of noise and phases.
    pub seed: u64,
    /// Whether what happens once happens in this one.
    pub eventful: bool,
}

/// Ids of the two effects that no catalogue has.
pub const NAMELESS: [&str; 2] = ["rubbing-tie", "bad-spot"];

/// The effect that happens once, in one recording.
pub const EVENT: &str = "force-step";

/// Ids of the effects that the bench can conceal and the catalogue has, in the order of the bench.
pub fn catalogue() -> Vec<&'static str> {
    EFFECTS.iter().map(|effect| effect.id).filter(|id| effect(id).is_some()).collect()
}
