//! The configuration of a lift: [`LiftConfig`] as written, [`LiftPlan`] as checked, in SI.

mod check;
mod plan;
mod written;

pub use plan::{LiftPlan, Spreads};
pub use written::LiftConfig;
