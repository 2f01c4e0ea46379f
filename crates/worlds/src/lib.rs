//! Many worlds: a virtual bench that shares nothing with the fitter.
//!
//! A diagnosis that is proved on a bench with its own formulas proves that it can find them again. Every case here is a world
//! of its own: another muscle, other laws for rubber, friction, standstill and noise, other protocols; and in it an effect
//! in one of several published forms, or two, or none, or one that no catalogue has. Forms are split into two halves, so that
//! whoever chooses constants on one half reports on forms that were never seen. A third part, [`sealed`], has forms, rubbers,
//! turns of friction, calipers, sensors and protocols that neither half has.
//!
//! # Two benches
//! [`lumped`]: a cylinder by virtual work. [`slices`]: 15 to 40 slices in equilibrium, without any closed form.
//! Around both: [`friction`], the concealed [`forms`], the rig's [`protocol`]s and the [`sensors`].
//!
//! # Files
//! Per case a folder `caseNNN` with `muscle.toml`, `e1.csv`… to estimate on and `h1.csv`… to judge on. Apart from them
//! `truth.json`, and `truth/caseNNN/h1.csv` with the force along each held-out recording as the load cell would read it
//! without noise, bits and tare (its gain, its filter and what is concealed are in it).
//!
//! # Severity
//! An effect is made as large as drawn beside what the sensors add, within its published range, measured after a linear refit
//! of a generic static map ([`severity`]). A world in which it cannot show is drawn anew and counted by reason;
//! after 40 of them, or as many steps as take about a second, another effect is concealed instead.
//!
//! Modules in reading order: [`draw`], [`curve`], [`rubber`], [`muscle`], [`caliper`], [`lumped`], [`slices`], [`shape`],
//! [`standstill`], [`friction`], [`mechanism`], [`place`], [`forms`], [`sealed`], [`catalogue`], [`region`], [`protocol`],
//! [`plan`], [`simulate`], [`noise`], [`sensors`], [`severity`], [`world`], [`case`], [`mod@write`].

pub mod caliper;
pub mod case;
pub mod catalogue;
pub mod curve;
pub mod draw;
pub mod forms;
pub mod friction;
pub mod lumped;
pub mod mechanism;
pub mod muscle;
pub mod noise;
pub mod place;
pub mod plan;
pub mod protocol;
pub mod region;
pub mod rubber;
pub mod sealed;
pub mod sensors;
pub mod severity;
pub mod shape;
pub mod simulate;
pub mod slices;
mod stage;
pub mod standstill;
pub mod world;
pub mod write;
