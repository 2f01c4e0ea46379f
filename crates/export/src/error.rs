//! Why a model cannot be exported.

/// Why a model cannot be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The model has no force at a point of its own operating range.
    #[error(
        "the model has no force at {:.1} kPa and {:.2} mm, inside its operating range; identify it anew",
        pressure_pa * 1e-3,
        length_m * 1e3
    )]
    WithoutForce {
        /// Gauge pressure, in Pa.
        pressure_pa: f64,
        /// Length, in m.
        length_m: f64,
    },
    /// An effect that cannot be written in C.
    #[error(
        "the model has the effect {id}, which this version does not write in C; export --vectors, or leave it out of the model"
    )]
    UnknownEffect {
        /// Id of the effect.
        id: String,
    },
    /// The operating range has no extent.
    #[error("the model was identified at one {what}; an export needs a range of it")]
    NoRange {
        /// `pressure` or `length`.
        what: &'static str,
    },
    /// The muscle pulls at too few points of its operating range.
    #[error(
        "the modelled muscle hardly pulls anywhere in its operating range; there is nothing to make an actuator of"
    )]
    NoPull,
    /// The name of the file gives no names for C.
    #[error("\"{name}\" gives no name for what is in it; begin the file's name with a letter, as in muscle.h")]
    NoName {
        /// Name of the file without its suffix.
        name: String,
    },
}
