//! Where an effect lives.

use serde::Serialize;

/// A region of one coordinate in which an effect lives.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Place {
    /// `pressure_kPa`, `contraction`, `speed_mm_per_s`, `travel_mm`, `time_s` or `force_N`.
    pub coordinate: &'static str,
    /// Lower end.
    pub from: f64,
    /// Upper end.
    pub to: f64,
    /// Recording that a time belongs to, such as `e2`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recording: Option<String>,
}

impl Place {
    /// A place of any recording.
    pub fn new(coordinate: &'static str, from: f64, to: f64) -> Self {
        Self { coordinate, from, to, recording: None }
    }
}
