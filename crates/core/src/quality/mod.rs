//! Quality gate: what a recording is good for, before anything is fitted to it.
//!
//! [`channel`] looks at one column: range, noise, quantization, clipping. [`recording`] puts them together
//! with the clock and the rates that were excited. Which parameters an excitation can identify needs the
//! model and is judged where it is fitted.

pub mod channel;
pub mod recording;

pub use channel::ChannelQuality;
pub use recording::RecordingQuality;
