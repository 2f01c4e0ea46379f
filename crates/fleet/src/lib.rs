//! Many muscles beside one another: which of them, which rig and which date differs.
//!
//! In reading order: [`table`] (one row per recording), [`plan`] (what is to be done), [`step`] (what a program said of a
//! campaign), [`record`] (what is kept of its artifacts), [`robust`] (centers, spreads and limits), [`control`] (control
//! charts), [`groups`] (rigs and days), [`change`] (the same muscle later), [`survey`] (all of that together, and who stands
//! out), [`sheet`] (one row per campaign, as CSV).
//!
//! Results lie in one folder per campaign, named as the plan says. A step leaves what it said in `STEP.jsonl` and its exit
//! code in `STEP.exit`; its artifact lies beside them under the name that [`step::Step`] gives.

pub mod change;
pub mod control;
pub mod error;
pub mod groups;
pub mod plan;
pub mod record;
pub mod robust;
pub mod sheet;
pub mod step;
pub mod survey;
pub mod table;
