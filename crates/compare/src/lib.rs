//! Which of two models follows the same recordings better, and whether that is more than chance.
//!
//! Residuals of neighboring samples are alike, so that a test that takes samples for independent finds a difference
//! everywhere. [`blocks`] therefore resamples stretches that are longer than the autocorrelation of the difference of squared
//! errors; [`compare`](compare()) walks both models along the recordings and puts the numbers together.

pub mod blocks;
mod compare;

pub use compare::{Compared, compare, parameters};
