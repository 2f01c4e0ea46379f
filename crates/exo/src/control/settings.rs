//! Gains and options of the controller.

/// Where the inverse's length comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthSource {
    /// The measured angle, as in the paper. The muscle's own stiffness is thereby canceled.
    Measured,
    /// The reference. The muscle's own stiffness then pulls back towards it.
    Reference,
}

/// Gains and options; what a field switches on beyond the paper is off in [`ControlSettings::paper`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlSettings {
    /// Period, in s.
    pub period_s: f64,
    /// `K_p`, in 1/s².
    pub kp_per_s2: f64,
    /// `K_d`, in 1/s.
    pub kd_per_s: f64,
    /// Bandwidth of the observer, in rad/s.
    pub observer_rad_per_s: f64,
    /// Where the inverse's length comes from.
    pub length: LengthSource,
    /// Gain of the integral action, in 1/s³; 0 for none.
    pub integral_per_s3: f64,
    /// Whether the observer estimates a disturbance that the torque then opposes.
    pub disturbance_observer: bool,
    /// Whether the valve's lag is compensated: a loop on the measured pressure, and a look ahead.
    pub lag_compensation: bool,
    /// Whether the valve is told a ramp to the pressure at the end of the period, instead of a step to the pressure at its
    /// beginning.
    pub ramp: bool,
    /// Lag of the valve as the controller knows it, in s.
    pub valve_lag_s: f64,
    /// Transport delay as the controller knows it, in s.
    pub transport_delay_s: f64,
    /// Lag that the loop on the pressure leaves, in s.
    pub pressure_loop_s: f64,
    /// Whether the inverse follows the state of the friction instead of the sign of the reference's motion.
    pub hysteresis_aware: bool,
    /// Travel of pre-sliding as the controller knows it, in m.
    pub presliding_m: f64,
    /// Whether the force follows what effects beyond eq. 11 remember; nothing where the model has none.
    pub effect_memory: bool,
    /// Whether the load is weighed before the lift: mean force by pressure and length, over the time given.
    pub payload_estimation: bool,
    /// Limits of the commanded pressure, in Pa.
    pub pressure_limits_pa: [f64; 2],
}

impl ControlSettings {
    /// The same gains without any option beyond the paper.
    pub fn paper(&self) -> Self {
        Self {
            length: LengthSource::Measured,
            integral_per_s3: 0.0,
            disturbance_observer: false,
            lag_compensation: false,
            ramp: false,
            hysteresis_aware: false,
            effect_memory: false,
            payload_estimation: false,
            ..*self
        }
    }
}
