//! A force model and its inverse where they are used: C, Simulink, MuJoCo, and test vectors for any other language.
//!
//! | module       | gives                                                                                             |
//! |--------------|---------------------------------------------------------------------------------------------------|
//! | [`vectors`]  | instants with the model's force: kinematics as `pam-predict` has them, to compare a translation with |
//! | [`c`]        | a C99 header without allocation, and a program that checks it against test vectors                  |
//! | [`simulink`] | settled force and inverse as breakpoints and tables in a MATLAB script                              |
//! | [`mujoco`]   | an affine actuator of MuJoCo's own, fitted to the settled force, and how far it is off              |
//!
//! # Design
//! What a program on a microcontroller can know ends at the present instant, while `pam-predict` knows the whole recording: it
//! centers its windows, dates a turn back to where the length turned and looks ahead whether the length will stand still. The
//! model proper (eq. 11, effects, memories) is causal. So an export is parted there: the step function takes a
//! [`Moment`](pam_muscle::effects::Moment), which `pam-predict` and a causal observer compute each in their own way, and agrees
//! with `pam-predict` to rounding on equal moments. What causality costs is a figure of its own.

pub mod c;
pub mod error;
pub mod grid;
pub mod mujoco;
pub mod simulink;
pub mod vectors;

pub use error::ExportError;
