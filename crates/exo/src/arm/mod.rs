//! The arms: where the muscle pulls, what the load weighs, how both move.
//!
//! [`Lever`] is the geometry of the muscle on the elbow (eqs 28–29), [`rigid_body`] the general formulas of
//! both arms (eqs 32–51), [`Elbow`] what they reduce to for one joint, [`load`] the load seen from the joint
//! (eqs 20–27).

pub mod elbow;
pub mod lever;
pub mod load;
pub mod rigid_body;

pub use elbow::{Elbow, Forearm};
pub use lever::{Lever, LeverAt, LeverMotion};
pub use load::Load;

/// Acceleration of gravity, in m/s²; standard value of ISO 80000-3.
pub const GRAVITY_M_PER_S2: f64 = 9.80665;
