//! A model and recordings in; what physics was left out of the model, where, and what it buys, out.
//!
//! In reading order: [`track`] is the recordings on a common grid, [`design_matrix`] what a [`hypothesis`] makes of it, [`normal`]
//! and [`joint`] fit base and effects together and judge them on held-out blocks. [`isolability`] says what the recordings
//! could tell apart at all, [`next_experiment`] which one would tell more.

pub mod artifact;
pub mod base;
pub mod besides;
mod best_law;
mod borne_out;
mod carried;
mod check;
pub mod coordinates;
mod coverage;
pub mod design_matrix;
pub mod diagnose;
mod discover;
pub mod elsewhere;
pub mod error;
mod events;
pub mod explain;
mod forms;
pub mod given;
pub mod group;
mod held;
mod held_error;
pub mod hypothesis;
pub mod isolability;
pub mod joint;
mod laws;
mod leader;
pub mod mass;
mod named;
mod nameless;
pub mod next_experiment;
pub mod normal;
pub mod nuisance;
mod own;
mod periodic;
mod places;
mod plausible;
pub mod pooled;
pub mod problem;
mod protocols;
mod regions;
mod rehearsal;
mod resting_step;
mod rig;
pub mod search;
mod short;
pub mod since;
mod stand_ins;
mod standing;
pub mod state;
mod steps;
pub mod structure;
mod tangent;
pub mod traces;
pub mod track;
pub mod trial;
mod turns;
mod typical;
pub mod uncertainty;
pub mod verdict;
mod veto;
mod weigh;
pub mod words;
mod written;
