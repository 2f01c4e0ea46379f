//! The plant: what the controller moves and cannot see into.
//!
//! [`Dahl`] is friction with memory, [`PlantMuscle`] the muscle that has it, [`BladderGas`] the air in the muscle,
//! [`Valve`] what lets it in and out, [`ArmPlant`] one arm of it all, [`Sensor`] what the controller gets to see.

mod arm;
mod dahl;
mod delay;
mod gas;
mod muscle;
mod sensor;
mod valve;

pub use arm::{ArmPhysics, ArmPlant};
pub use dahl::Dahl;
pub use delay::Delay;
pub use gas::{ATMOSPHERE_PA, BladderGas, POLYTROPIC, flow_kg_per_s};
pub use muscle::{MusclePhysics, PlantMuscle, Pull};
pub use sensor::Sensor;
pub use valve::{Valve, ValveKind, ValvePhysics};
