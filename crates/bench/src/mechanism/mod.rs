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
//! `chain` module; which mechanism an effect's id stands for is in [`catalogue`](crate::catalogue).
//!
//! The forms are chosen to differ from those that a fit would use: a rate equation instead of a sum of elements, a spectrum
//! instead of one time constant, a distribution instead of a smooth corner.

mod bad_spot;
mod bouc_wen;
mod braid_lockup;
mod braid_motion;
mod capstan;
mod channel_delay;
mod end_taper;
mod force_drift;
mod force_step;
mod gauge_play;
mod inertia;
mod lugre;
mod moment;
mod mullins;
mod passive;
mod pressure_creep;
mod pressure_line;
mod rate_dependence;
mod rubbing_tie;
mod series_cable;
mod slack;
mod smooth_misfit;
mod spectrum;
mod stribeck;
mod thermal;
mod threshold;
mod viscoelastic;
mod viscous;
mod wear;

pub use braid_motion::BraidMotion;
pub use moment::{Duplicate, Mechanism, Moment, Reading};
pub use passive::{PassiveTension, Readout};

pub(crate) use bad_spot::BadSpot;
pub(crate) use bouc_wen::BoucWen;
pub(crate) use braid_lockup::BraidLockup;
pub(crate) use capstan::Capstan;
pub(crate) use channel_delay::ChannelDelay;
pub(crate) use end_taper::EndTaper;
pub(crate) use force_drift::ForceDrift;
pub(crate) use force_step::ForceStep;
pub(crate) use gauge_play::GaugePlay;
pub(crate) use inertia::Inertia;
pub(crate) use lugre::LuGre;
pub(crate) use mullins::Mullins;
pub(crate) use pressure_creep::PressureCreep;
pub(crate) use pressure_line::PressureLine;
pub(crate) use rate_dependence::RateDependence;
pub(crate) use rubbing_tie::RubbingTie;
pub(crate) use series_cable::{Cable, SeriesCable};
pub(crate) use slack::Slack;
pub(crate) use smooth_misfit::SmoothMisfit;
pub(crate) use stribeck::Stribeck;
pub(crate) use thermal::Thermal;
pub(crate) use threshold::Threshold;
pub(crate) use viscoelastic::Viscoelastic;
pub(crate) use viscous::Viscous;
pub(crate) use wear::Wear;
