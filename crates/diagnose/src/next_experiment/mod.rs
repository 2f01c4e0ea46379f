//! What to record next: of the bench protocols, the one that drives the surviving explanations furthest apart.
//!
//! Each protocol is run in thought within the pressures and lengths that the model covers, through every explanation as it
//! was fitted. The base parameters of one may then be refitted to the force of the other; the root mean square of what
//! remains is how far apart the protocol drives the two. Mean squares over time are information per time, so the
//! largest separation is also the most information per minute of recording; time in which nothing is recorded counts as lost.

mod choice;
mod closer;
mod plan;
mod separation;
mod setpoints;

pub(crate) use choice::{confirm_mass, next_experiment};
pub use setpoints::{SetPoint, Setpoints};
