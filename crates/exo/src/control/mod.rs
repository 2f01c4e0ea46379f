//! The controller: 100 times a second from angle and pressure to a commanded pressure (eqs 52–55).
//!
//! [`Observer`] makes angle, velocity and disturbance from the readings, [`Controller`] turns them into torque,
//! force and pressure; [`ControlSettings`] says with which gains and which options beyond the paper.

mod controller;
mod observer;
mod settings;

pub use controller::{Command, Controller, Knowledge, Limited};
pub use observer::Observer;
pub use settings::{ControlSettings, LengthSource};
