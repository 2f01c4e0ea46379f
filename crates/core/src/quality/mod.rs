//! Quality gate: what a recording is good for, before anything is fitted to it.
//!
//! [`channel`] looks at one column: range, noise, quantization, clipping. [`recording`] puts them together
//! with the clock and the rates that were excited. [`out_of_range`] finds the rows that a sensor did not reach. Which parameters an excitation can identify needs the
//! model and is judged where it is fitted.

pub mod channel;
pub mod out_of_range;
mod printed_step;
pub mod recording;

pub use channel::ChannelQuality;
pub use out_of_range::SensorEnds;
pub use recording::RecordingQuality;
