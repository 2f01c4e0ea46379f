//! Errors of a lift (eqs 56–58).
//!
//! ```text
//! MAX = max |e|,   MAE = Σ |e| / H,   RMSE = √(Σ e² / H),   ITAE = ∫ t |e| dt,   plain sum = Σ t |e|
//! ```
//!
//! The paper prints MAE without the bars, and for ITAE a sum without the step: with `Σ t = 1252.5 s` over 5 s at
//! 100 Hz its figures are 0.0464 rad s² and so on. Both are given here.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::reference::ReferenceAt;

/// Errors of one signal; units are those of the signal, for ITAE times s² and s.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct SignalErrors {
    /// Largest absolute error.
    pub max: f64,
    /// Mean absolute error.
    pub mae: f64,
    /// Root mean square error.
    pub rmse: f64,
    /// Integral of time times absolute error.
    pub itae: f64,
    /// Sum of time times absolute error over the samples, as the paper prints it.
    pub itae_sum: f64,
}

/// Errors of one arm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct TrackingErrors {
    /// Angle, in rad.
    pub angle_rad: SignalErrors,
    /// Angular velocity, in rad/s.
    pub velocity_rad_per_s: SignalErrors,
    /// Angular acceleration, in rad/s².
    pub acceleration_rad_per_s2: SignalErrors,
}

/// Sums of all three signals of an arm, sample by sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ErrorSums {
    angle: SignalSums,
    velocity: SignalSums,
    acceleration: SignalSums,
}

impl ErrorSums {
    /// Takes in what should be and what is at a time, in s, from the start of the lift.
    pub fn add(&mut self, time_s: f64, reference: &ReferenceAt, state: &ReferenceAt) {
        self.angle.add(time_s, reference.q_rad - state.q_rad);
        self.velocity.add(time_s, reference.dq_rad_per_s - state.dq_rad_per_s);
        self.acceleration.add(time_s, reference.ddq_rad_per_s2 - state.ddq_rad_per_s2);
    }

    /// Errors of samples taken every `period_s`.
    pub fn finish(&self, period_s: f64) -> TrackingErrors {
        TrackingErrors {
            angle_rad: self.angle.finish(period_s),
            velocity_rad_per_s: self.velocity.finish(period_s),
            acceleration_rad_per_s2: self.acceleration.finish(period_s),
        }
    }
}

/// Sums of one signal.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct SignalSums {
    count: f64,
    max: f64,
    absolute: f64,
    squares: f64,
    timed: f64,
}

impl SignalSums {
    /// Takes in an error at a time, in s, from the start of the lift.
    fn add(&mut self, time_s: f64, error: f64) {
        let absolute = error.abs();
        self.count += 1.0;
        // An error that is no number must not vanish in a maximum.
        self.max = if absolute > self.max || absolute.is_nan() { absolute } else { self.max };
        self.absolute += absolute;
        self.squares += error * error;
        self.timed += time_s * absolute;
    }

    /// Errors of samples taken every `period_s`.
    fn finish(&self, period_s: f64) -> SignalErrors {
        let count = self.count.max(1.0);
        SignalErrors {
            max: self.max,
            mae: self.absolute / count,
            rmse: (self.squares / count).sqrt(),
            itae: self.timed * period_s,
            itae_sum: self.timed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_a_ramp_are_their_closed_forms() {
        // e = -t over 5 s at 100 Hz: MAX 5, MAE 2.5, RMSE 5/√3, ITAE 125/3; sums differ from integrals by
        // half a sample.
        let mut sums = SignalSums::default();
        for tick in 0..=500 {
            let time_s = 0.01 * f64::from(tick);
            sums.add(time_s, -time_s);
        }
        let errors = sums.finish(0.01);
        assert!((errors.max - 5.0).abs() < 1e-12 && (errors.mae - 2.5).abs() < 1e-12);
        assert!((errors.rmse - 5.0 / 3.0_f64.sqrt()).abs() < 2e-3 && (errors.itae - 125.0 / 3.0).abs() < 0.15);
        assert!((errors.itae_sum - 100.0 * errors.itae).abs() < 1e-9);
    }

    #[test]
    fn validates_against_the_sum_that_the_paper_printed() {
        // Σ t = 1252.5 s: an error of 0.0038 rad at all times is 4.76 rad s, and 0.0476 rad s² as an integral.
        let mut sums = SignalSums::default();
        (0..=500).for_each(|tick| sums.add(0.01 * f64::from(tick), 0.0038));
        assert!((sums.finish(0.01).itae_sum - 4.76).abs() < 1e-2);
    }

    #[test]
    fn an_error_that_is_no_number_stays_visible() {
        let mut sums = SignalSums::default();
        sums.add(0.0, f64::NAN);
        sums.add(0.1, 1.0);
        assert!(sums.finish(0.1).mae.is_nan());
    }
}
