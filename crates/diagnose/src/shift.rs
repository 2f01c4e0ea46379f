//! Channels moved in time against the force.

pub(crate) use pam_core::shift::shifted;
