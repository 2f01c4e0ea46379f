//! Quality gate: what a recording is good for, before anything is fitted to it.
//!
//! [`channel`] looks at one column: range, noise, quantization, clipping. [`recording`] puts them together
//! with the clock and the rates that were excited. [`parts`] are what it is made
//! of, and [`stuck`] counts samples at the ends of a channel, in several places or one. [`out_of_range`] finds the rows that a sensor did not reach. Which parameters an excitation can identify needs the
//! model and is judged where it is fitted.

pub mod channel;
pub mod out_of_range;
pub mod parts;
mod printed_step;
pub mod recording;
pub mod stuck;

pub use channel::ChannelQuality;
pub use out_of_range::SensorEnds;
pub use recording::RecordingQuality;
