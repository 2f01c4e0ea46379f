//! Elbow exoskeleton: arm, valve, sensors, controller, closed-loop lifts.
//!
//! Conventions: SI; the elbow's angle is 0 where the forearm is level, positive upward; torque is positive
//! upward; pressure is gauge. Nothing here prints or reads a clock; random numbers come from streams handed in.
//!
//! In reading order: [`arm`] (eqs 20–51), [`mod@reference`], [`inverse`], [`history`] (effects beyond eq. 11), [`control`] (eqs 52–55), [`plant`],
//! [`lift`] (one lift), [`trouble`] (what makes it no success), [`metrics`] (eqs 56–58), [`config`], [`simulation`] (a configuration and a muscle),
//! [`reach`] (what can be said beforehand), [`study`] (many lifts), [`options`] (what each option is worth),
//! [`artifact`] (`exo-metrics/1`).

pub mod arm;
pub mod artifact;
pub mod config;
pub mod control;
pub mod error;
pub mod history;
pub mod inverse;
pub mod lift;
pub mod metrics;
pub mod options;
pub mod plant;
pub mod reach;
pub mod reference;
pub mod simulation;
pub mod study;
#[cfg(test)]
mod testing;
pub mod trouble;
pub mod uncertainty;
