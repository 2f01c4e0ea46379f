//! The virtual bench: a muscle whose truth is known, protocols that drive it, sensors that log it.
//!
//! A fit that is tried on data from its own formulas always succeeds. So the bench shares with the rest
//! of the toolchain nothing but the dimensions of the muscle (`pam_muscle::Muscle`): its tension is the
//! derivative of stored energies, its friction acts step by step on the true motion, and what a
//! recording holds has gone through noise, quantization and a clock.
//!
//! Conventions: SI inside; pressure is gauge; tension is positive when the muscle pulls; the contraction
//! ratio is positive when the muscle is shortened; direction is +1 contracting, -1 extending.
//!
//! In reading order:
//! - [`true_muscle`]: the muscle, from stored energies; [`parameters`]: its parameters;
//! - [`mechanism`]: what acts step by step between the drive and the load cell;
//! - [`friction`]: friction of the braid, the first such mechanism;
//! - [`catalogue`]: effects that can be concealed; [`concealed`]: those that are; [`draw`]: their inner parameters;
//! - [`path`]: where the rig takes pressure and length; [`reach`]: where the muscle lets it;
//! - [`protocol`]: the protocols by name;
//! - [`sensors`]: noise, quantization, clock;
//! - [`mod@bench`]: muscle, protocol and sensors together make a [`recording`].

pub mod bench;
pub mod catalogue;
mod chain;
pub mod concealed;
pub mod draw;
mod dual;
mod energy;
pub mod friction;
pub mod mechanism;
pub mod parameters;
pub mod path;
pub mod protocol;
mod random_muscle;
pub mod reach;
pub mod recording;
pub mod sensors;
pub mod true_muscle;

pub use bench::Bench;
pub use concealed::{Concealed, ConcealedEffect};
pub use parameters::Parameters;
pub use protocol::{Options, Protocol, command};
pub use recording::BenchRecording;
pub use sensors::Sensors;
pub use true_muscle::TrueMuscle;
