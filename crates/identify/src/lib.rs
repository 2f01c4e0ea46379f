//! Recordings and a force model in, parameters with uncertainty out.
//!
//! In reading order: [`prepare`] puts a quality gate and a direction of motion beside each recording,
//! [`faults`] looks for broken instruments, [`condense`] turns rows into small triangles in one pass,
//! [`search_space`] says what is fitted within which range, [`problem`] is the cost over that space,
//! [`fit`] searches it, [`uncertainty`] says how well the result is known, [`evaluate`] compares it with
//! recordings, [`along`] leaves samples for figures beside that, [`prediction`] row by row with the interval of [`band`]; [`geometry`] and [`robust`] are the slower ways with freed dimensions and robust weights;
//! [`identify`] is all of it in order, and [`shards`] the same over rows in several places.

pub mod along;
pub mod band;
mod check;
pub mod condense;
pub mod error;
pub mod evaluate;
pub mod excitation;
pub mod faults;
pub mod fit;
pub mod geometry;
pub mod identified;
pub mod identify;
pub mod predict;
pub mod prediction;
pub mod prepare;
pub mod problem;
pub mod report;
pub mod request;
pub mod robust;
pub mod search_space;
pub mod shards;
pub mod standstill;
mod tally;
#[cfg(test)]
mod testing;
pub mod trace;
pub mod unbounded;
pub mod uncertainty;
