//! The muscle: its geometry, eq. 11, what eq. 11 leaves out, and the state in which a recording shows it.
//!
//! In reading order: [`geometry`] is what ruler and caliper measure and the kinematics of the braid, `muscle_file` reads it; [`force`]
//! is eq. 11, one term in one file; [`coordinate`] names what a residual may depend on; [`effects`] is the catalogue of what eq. 11
//! leaves out, with models that it augments. [`smoothing`] and `knees` make rates of noisy channels; [`direction`] says which way
//! friction acts; [`motion`] walks over a recording and gives every instant as effects see it; [`shift`] moves channels in time.
//!
//! Conventions: SI inside; pressure is gauge; force is tension, positive when the muscle pulls; the
//! contraction ratio is positive when the muscle is shortened. Nothing here prints, reads a clock or
//! draws random numbers, and nothing knows of artifacts.

pub mod coordinate;
pub mod direction;
pub mod effects;
pub mod force;
pub mod geometry;
mod knees;
pub mod motion;
mod muscle_file;
pub mod shift;
pub mod smoothing;

pub use coordinate::Coordinate;
pub use geometry::{Dimension, Kinematics, Muscle};
pub use muscle_file::{MuscleError, MuscleFile};
