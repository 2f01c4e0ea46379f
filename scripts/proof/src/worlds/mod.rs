//! Cases of the independent bench: their truth, what the programs say of them, and scores.
//!
//! In reading order: [`truth`] (what was concealed), [`ask`] (the programs as subprocesses), [`score`] (strictly),
//! [`discovered`] (terms without a name), [`left_out`] (a name taken out of the catalogue), [`ceiling`] (boosted trees), [`table`].

pub mod ask;
pub mod ceiling;
pub mod discovered;
pub mod left_out;
pub mod score;
pub mod table;
pub mod truth;
