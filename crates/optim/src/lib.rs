//! Particle swarm and least squares over plain slices; knows no muscle.
//!
//! In reading order: [`summary`] condenses any number of rows into a small triangle, [`gathered`] takes them one at a time,
//! [`swarm`] searches a box for the lowest cost, [`polish`] walks from there to the optimum. Nothing here prints, reads a clock
//! or draws random numbers that were not seeded by the caller.

pub mod gathered;
mod levenberg_marquardt;
pub mod polish;
pub mod summary;
pub mod swarm;
mod trust_region;
