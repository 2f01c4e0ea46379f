//! The inverse of a force model: which pressure gives a force at a length, while the muscle moves one way or
//! the other.
//!
//! In reading order: [`domain`] (where the model may be asked), [`branch`] (which pressures have a force of
//! their own), [`root`] and [`exact`] (the inverse by root finding); [`network`] (the layers of eqs 13 and 14),
//! [`design`] and [`recorded`] (points to train at), [`samples`] (scaled), [`backpropagation`],
//! [`levenberg_marquardt`] and [`train`] (how the weights come about); [`inverse_network`] (the finished network),
//! [`coverage`] and [`judge`] (what it is worth), [`report`] (all of it as an artifact).
//!
//! Conventions: SI; direction +1 while contracting, -1 while extending, anything between where the friction has
//! not yet turned. Nothing here prints or reads a clock; every random draw comes from a named [`stream`].

pub mod activation;
pub mod backpropagation;
pub mod branch;
mod cholesky;
pub mod coverage;
pub mod design;
pub mod domain;
mod error;
pub mod exact;
pub mod inverse_network;
pub mod judge;
pub mod levenberg_marquardt;
pub mod network;
mod normal_equations;
pub mod recorded;
pub mod report;
pub mod root;
pub mod samples;
pub mod stream;
pub mod train;

pub use error::InverseError;
pub use exact::{ExactInverse, NoInverse};
pub use inverse_network::{Evaluation, InverseNetwork};
