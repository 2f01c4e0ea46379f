//! Why a network cannot be trained.

use std::io;

/// Why a network cannot be trained.
#[derive(Debug, thiserror::Error)]
pub enum InverseError {
    /// The model was identified on too small a range to be inverted.
    #[error(
        "the model's domain covers {name} {from} to {to} {unit} only; identify it from recordings in which the {name} varies"
    )]
    Degenerate {
        /// Coordinate.
        name: &'static str,
        /// Lower end, in `unit`.
        from: f64,
        /// Upper end, in `unit`.
        to: f64,
        /// Unit of the ends.
        unit: &'static str,
    },
    /// Friction that drives: it would add force instead of taking it.
    #[error("{name} is {value:e}, a friction that drives; identify the model anew")]
    Drives {
        /// Parameter.
        name: String,
        /// Its value.
        value: f64,
    },
    /// Hardly any point of the domain has an inverse.
    #[error(
        "the model can be inverted in {percent:.1} % of its domain only ({slack:.1} % slack, {flat:.1} % where force does not grow with pressure); check the model"
    )]
    HardlyInvertible {
        /// Share that can be inverted, in percent.
        percent: f64,
        /// Share below the lowest force, in percent.
        slack: f64,
        /// Share without slope, in percent.
        flat: f64,
    },
    /// Recordings that have nothing to do with the model.
    #[error(
        "none of the {n_rows} rows that were taken from the recordings lies where the model can be inverted; name recordings \
         of its muscle, or none"
    )]
    NothingRecorded {
        /// Rows that were taken.
        n_rows: usize,
    },
    /// Fewer points than weights.
    #[error(
        "{n_training} points to train on for {n_parameters} weights and biases; take more points or fewer hidden neurons"
    )]
    TooFewPoints {
        /// Points to train on.
        n_training: usize,
        /// Weights and biases.
        n_parameters: usize,
    },
    /// The hidden layers cannot be built.
    #[error("a hidden layer of {width} neurons, expected 1 to {max}")]
    Width {
        /// Neurons asked for.
        width: usize,
        /// Most that are possible.
        max: usize,
    },
    /// Every start ran away.
    #[error("the weights grew without bound in every start; take a smaller learning rate")]
    Diverged,
    /// Samples of a recording cannot be read back.
    #[error("cannot read samples back: {reason}")]
    Samples {
        /// Message of the system.
        reason: io::Error,
    },
}
