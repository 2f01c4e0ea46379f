//! The proof: physics is concealed in fresh recordings, diagnosed by the programs as a user runs them, and scored.
//!
//! ```text
//! draw → calibrate → seal (truth.json, SHA-256) → record → pam-identify, pam-diagnose → open the seal → score → print
//! ```
//!
//! Nothing about what is concealed reaches the programs but through the four channels: recordings are named by
//! random letters, come in random order, and the truth stays in a folder that no program is told of.
//!
//! In reading order: [`case`] (what a case is), [`sets`] (what is recorded), [`draw`] (what is concealed), [`rig`]
//! (the bench), [`calibrate`] (how strong it is), [`seal`], [`folder`] (files of a case), [`programs`] (the diagnosis as
//! subprocesses), [`heldout`] (error against the noise-free truth), [`score`], [`criteria`] and [`confusion`] (all
//! cases together), [`results`] (what is written), [`run`] (all of it in order); [`real`] is the proof on real muscles;
//! [`worlds`] scores cases of the independent bench.

pub mod calibrate;
pub mod case;
pub mod confusion;
pub mod criteria;
pub mod draw;
pub mod folder;
pub mod heldout;
pub mod misses;
pub mod programs;
pub mod real;
pub mod results;
pub mod rig;
pub mod run;
pub mod score;
pub mod seal;
pub mod sets;
pub mod statistics;
pub mod worlds;
