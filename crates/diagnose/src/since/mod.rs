//! Recordings of the same muscle made later: what has changed since its diagnosis.
//!
//! The model of then, its effects included, is the base. Against later recordings it is moved in one thing at a time: a channel's
//! zero or gain, a base parameter, the size or shape of an effect that was there, one that was not. What explains the most
//! on blocks left out of the fit is taken, the others are looked at again beside it, until nothing more is gained.
//!
//! ```text
//! force recorded = F(model of then, moved by what changed) + Σ nuisances + noise
//! ```
//!
//! What was not known then is no change now, so everything that the model of then was unsure of is beside every hypothesis,
//! with the prior that its standard errors are: a difference counts both errors. So are the tare of each recording, friction
//! around reversals, what a lasting memory brings with it, and a smooth static force as large as the model of then missed its own
//! recordings by.
//!
//! In reading order: [`point`] is the model and the channels as numbers that move, [`quantity`] those numbers, [`rows`] the
//! regression that every hypothesis is judged by, [`hypothesis`] what is said to have changed and its fit, [`candidate`] what may have,
//! [`search`] the search, [`mod@changes`] all
//! of it in order, [`traces`] forces over time for a page.

mod baseline;
mod candidate;
pub mod changes;
mod domain;
mod hypothesis;
mod nuisances;
mod point;
mod quantity;
mod rows;
mod search;
mod traces;
pub mod words;
mod written;

pub use changes::{Changes, Request, changes, check};
pub use traces::LaterTrace;
