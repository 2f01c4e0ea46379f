//! What acts between the drive and the load cell, one step at a time.
//!
//! The bench is a chain: the drive sets pressure and length, each mechanism in turn changes what the
//! muscle sees, how it pulls or what a sensor reads. A mechanism keeps its own memory (a direction, a filter's state)
//! and sees only the present [`Moment`].
//!
//! # Design
//! Position in the chain says where a mechanism acts: one that stands before [`PassiveTension`] changes
//! the pressure or the length that reaches the muscle, one that stands after it changes the tension, one after
//! [`Readout`] changes what is read. So one trait with one function serves all of them. The order is in the
//! `chain` module; the mechanisms that an effect's id stands for are in [`catalogue`](crate::catalogue).
//!
//! The forms are chosen to differ from those that a fit would use: a rate equation instead of a sum of elements, a
//! spectrum instead of one time constant, a distribution instead of a smooth corner.

mod braid_motion;
pub(crate) mod moment;
mod passive;
mod series_cable;
mod smooth_misfit;
pub(crate) mod spectrum;

pub use braid_motion::BraidMotion;
pub use moment::{Duplicate, Mechanism, Moment, Reading};
pub use passive::{PassiveTension, Readout};

pub(crate) use series_cable::{Cable, SeriesCable};
pub(crate) use smooth_misfit::SmoothMisfit;
