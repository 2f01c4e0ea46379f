//! What the files of the toolchain mean: recordings, muscle, force model, artifacts.
//!
//! Conventions: SI inside; pressure is gauge; force is tension, positive when the muscle pulls; the
//! contraction ratio is positive when the muscle is shortened. Nothing here prints, reads a clock or
//! draws random numbers.

pub mod artifact;
pub mod direction;
pub mod effects;
pub mod force;
pub mod group;
mod knees;
pub mod motion;
pub mod muscle;
pub mod quality;
pub mod recording;
pub mod shift;
pub mod smoothing;
pub mod spelling;
