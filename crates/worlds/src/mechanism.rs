//! What a concealed mechanism may touch on the way from the rig to the recording.
//!
//! In the order of one step: the gauge's pressure becomes the pressure in the muscle; the encoder's length becomes the
//! muscle's; factors act on gas, bladder and friction; forces are added; the cable limits the sum; the load cell reads; and
//! the gauge and the encoder show what the log holds. Every hook leaves things as they are unless a mechanism says otherwise.

use std::fmt::Debug;

/// Everything a mechanism may look at in one step. Fields are filled from top to bottom.
#[derive(Debug, Clone, Copy, Default)]
pub struct Moment {
    /// Time since the first recording began, rests between recordings included, s.
    pub time_s: f64,
    /// Time since this recording began, s.
    pub recording_time_s: f64,
    /// Recording, counted from 0: estimation first, then held out.
    pub recording: usize,
    /// Step, s.
    pub dt_s: f64,
    /// Pressure at the gauge, Pa.
    pub gauge_pa: f64,
    /// Rate of the pressure at the gauge, Pa/s.
    pub gauge_rate_pa_per_s: f64,
    /// Length at the encoder, m.
    pub encoder_m: f64,
    /// Pressure in the muscle, Pa.
    pub pressure_pa: f64,
    /// Length of the muscle, m.
    pub length_m: f64,
    /// Contraction ratio.
    pub contraction: f64,
    /// Speed of contraction, m/s.
    pub speed_m_per_s: f64,
    /// Acceleration of contraction, m/s².
    pub acceleration_m_per_s2: f64,
    /// Radius, m.
    pub radius_m: f64,
    /// Force of gas and braid, N.
    pub gas_n: f64,
    /// Force of the bladder, N.
    pub bladder_n: f64,
    /// Friction when sliding, before factors, N.
    pub sliding_n: f64,
    /// State of friction, −1…1.
    pub state: f64,
    /// Force of the muscle as far as it is known; of the last step in the hooks for pressure and length, N.
    pub force_n: f64,
}

/// A concealed mechanism.
pub trait Mechanism: Debug + Send {
    /// Called before a recording; `rested` where the muscle was vented and at rest before it.
    fn begin(&mut self, _recording: usize, _rested: bool) {}
    /// Pressure in the muscle, Pa.
    fn pressure(&mut self, _now: &Moment, pressure_pa: f64) -> f64 {
        pressure_pa
    }
    /// Length of the muscle, m.
    fn length(&mut self, _now: &Moment, length_m: f64) -> f64 {
        length_m
    }
    /// Factor on the force of gas and braid.
    fn gas_factor(&mut self, _now: &Moment) -> f64 {
        1.0
    }
    /// Factor on the force of the bladder.
    fn bladder_factor(&mut self, _now: &Moment) -> f64 {
        1.0
    }
    /// Factor on the friction.
    fn friction_factor(&mut self, _now: &Moment) -> f64 {
        1.0
    }
    /// Force to add, N.
    fn added_n(&mut self, _now: &Moment) -> f64 {
        0.0
    }
    /// Force after the cable, N.
    fn limited_n(&mut self, _now: &Moment, force_n: f64) -> f64 {
        force_n
    }
    /// Force as the load cell reads it, N.
    fn cell_n(&mut self, _now: &Moment, force_n: f64) -> f64 {
        force_n
    }
    /// Pressure as the gauge shows it, Pa.
    fn shown_pressure(&mut self, _now: &Moment, pressure_pa: f64) -> f64 {
        pressure_pa
    }
    /// Length as the encoder shows it, m.
    fn shown_length(&mut self, _now: &Moment, length_m: f64) -> f64 {
        length_m
    }
    /// Temperature to log, °C.
    fn temperature_c(&self) -> Option<f64> {
        None
    }
}
