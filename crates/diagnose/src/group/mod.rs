//! Several muscles of one rig together: what the rig does to all of them is shared, what a muscle does is its own.
//!
//! A delay, a compliance or a mass of the rig is in the recordings of every muscle with the same values. Too weak to be named in
//! one of them, or called differently in each, it adds up: log predictive ratios over blocks that no fit has seen are of
//! different recordings, so that those of all muscles are summed at one shape.
//!
//! 1. Every muscle is diagnosed alone ([`mod@crate::diagnose`]).
//! 2. [`look`]: every effect of the rig at the shape that gains most in all muscles together ([`shared`]), in each of them
//!    beyond the best explanation without it ([`member`]). What gains most is taken where the muscles show it together, also
//!    without the one that says most, and where what was held out of them does not deny it ([`mod@crate::veto`]); a muscle with a
//!    value of its own is said to differ, and the others share theirs. Then the next, without what is known. What gains nothing
//!    until another effect has been taken off is the remainder of that one.
//! 3. What a muscle has beside the rig is found by the same diagnosis on its recordings without what the rig does
//!    ([`mod@crate::rig`]). A name that belongs to a rig is kept for one muscle alone where the other muscles speak against it, and
//!    for all where each has another value. Where a muscle is followed worse with what the rig does than without anything, its
//!    diagnosis alone stays.

mod look;
mod member;
mod shared;
mod together;
mod words;
mod written;

pub use together::{Group, Muscle, diagnose_group};
