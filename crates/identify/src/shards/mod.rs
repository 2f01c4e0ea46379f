//! Identification of recordings whose rows are in several places: shards answer, and what they answer is merged.
//!
//! In reading order: [`cut`] puts shards together into recordings, [`parts`] says which rows are whose, [`tile`] are rows that one
//! place works on, [`mod@answer`] is what it finds there, [`mod@summarize`] its file, [`merge`] puts answers together and asks the next question, [`conclude`]
//! fits.
//!
//! # Design
//! What a fit needs of a recording are sums over rows, which merge; but which rows count and which way friction acts in them is
//! found by averages, plays and rests that look far around. They look no further than the border of a stretch of
//! [`STRETCH_ROWS`](pam_muscle::direction::STRETCH_ROWS) rows, counted from the last gap, and what is carried across it is one state.
//! So a shard works on the stretches that it has all rows of, and hands over the others as they are: the place that merges has
//! both sides of a cut, puts the stretch together and works on it as a shard would. Every row then goes through the same
//! operations, on the same numbers and in the same order, as in one process: directions, excluded samples, noise and thresholds
//! are equal to the bit, and sums differ by how they are grouped, which is rounding.
//!
//! What a shard begins with is what came before it. It is guessed from the answer to an earlier question, and every answer
//! says where it ended: where a guess was wrong, the same question is asked once more.
//!
//! A question settles what all rows must agree on before the next can be asked: samples for noise and ranges; excluded samples;
//! laws at standstill; travels of turning; the triangles that are fitted; the agreement of the model. That is seven passes with
//! the first one, which counts rows.
//!
//! A chunk-wise exact running sum, started at every cut, would need no stretch to be handed over; it would give averages that
//! differ in the last digit from those of one process, and where two averages are equal such a digit decides which is an extreme.

pub mod answer;
pub mod conclude;
pub mod cut;
pub mod error;
mod gather;
pub mod merge;
pub mod parts;
pub mod summarize;
pub mod tile;
mod triangle;

pub use error::ShardError;
pub use merge::{Step, advance};
pub use summarize::{Head, summarize};
