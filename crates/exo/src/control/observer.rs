//! Angle, velocity and disturbance from readings of the angle.
//!
//! A filter of fixed gains around the model of the arm: the model predicts with the torque that it believes in,
//! the reading corrects. With a third state the filter also estimates the acceleration `d` that the model does
//! not explain:
//!
//! ```text
//! q⁻ = q + T q̇ + ½ T² (a + d),   q̇⁻ = q̇ + T (a + d)
//! q = q⁻ + g (y - q⁻),   q̇ = q̇⁻ + h (y - q⁻) / T,   d ← d + 2 k (y - q⁻) / T²
//! ```
//!
//! All poles lie at `β = exp(-ω T)` (critically damped): `g = 1 - β³`, `h = 1.5 (1 - β²)(1 - β)`,
//! `k = ½ (1 - β)³`; without `d`, `g = 1 - β²`, `h = (1 - β)²`, `k = 0`.
//!
//! | symbol | code             | unit   | meaning                          |
//! |--------|------------------|--------|----------------------------------|
//! | `a`    | argument         | rad/s² | acceleration that the model says |
//! | `d`    | `disturbance_rad_per_s2` | rad/s² | what it leaves out       |
//! | `ω`    | `bandwidth_rad_per_s` | rad/s | bandwidth                      |
//!
//! Source: Brookner (1998), "Tracking and Kalman Filtering Made Easy", critically damped g–h–k filters.

/// State and gains; see the [module](self).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observer {
    /// Angle, in rad.
    pub q_rad: f64,
    /// Angular velocity, in rad/s.
    pub dq_rad_per_s: f64,
    /// Acceleration that the model leaves out, in rad/s²; stays 0 where it is not estimated.
    pub disturbance_rad_per_s2: f64,
    period_s: f64,
    gains: [f64; 3],
}

impl Observer {
    /// A filter at rest at `q_rad`.
    pub fn new(q_rad: f64, period_s: f64, bandwidth_rad_per_s: f64, with_disturbance: bool) -> Self {
        let pole = (-bandwidth_rad_per_s * period_s).exp();
        let gains = if with_disturbance {
            [1.0 - pole.powi(3), 1.5 * (1.0 - pole * pole) * (1.0 - pole), 0.5 * (1.0 - pole).powi(3)]
        } else {
            [1.0 - pole * pole, (1.0 - pole) * (1.0 - pole), 0.0]
        };
        Self { q_rad, dq_rad_per_s: 0.0, disturbance_rad_per_s2: 0.0, period_s, gains }
    }

    /// One period with the model's acceleration, then a reading.
    pub fn advance(&mut self, model_rad_per_s2: f64, reading_rad: f64) {
        let [g, h, k] = self.gains;
        let period_s = self.period_s;
        let acceleration = model_rad_per_s2 + self.disturbance_rad_per_s2;
        let predicted_rad = self.q_rad + period_s * (self.dq_rad_per_s + 0.5 * period_s * acceleration);
        let surprise_rad = reading_rad - predicted_rad;
        self.q_rad = predicted_rad + g * surprise_rad;
        self.dq_rad_per_s += period_s * acceleration + h * surprise_rad / period_s;
        self.disturbance_rad_per_s2 += 2.0 * k * surprise_rad / (period_s * period_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_disturbance_is_found_and_velocity_stays_unbiased() {
        let mut observer = Observer::new(0.0, 0.01, 30.0, true);
        for tick in 1..=300 {
            let time_s = 0.01 * f64::from(tick);
            // The model says 0.5 rad/s², the arm does 0.8.
            observer.advance(0.5, 0.4 * time_s * time_s);
        }
        assert!((observer.disturbance_rad_per_s2 - 0.3).abs() < 1e-6, "{observer:?}");
        assert!((observer.dq_rad_per_s - 2.4).abs() < 1e-6);
    }

    #[test]
    fn without_a_disturbance_the_filter_trusts_the_model() {
        let mut observer = Observer::new(0.0, 0.01, 30.0, false);
        for tick in 1..=300 {
            let time_s = 0.01 * f64::from(tick);
            observer.advance(0.8, 0.4 * time_s * time_s);
        }
        assert!((observer.q_rad - 3.6).abs() < 1e-9 && (observer.dq_rad_per_s - 2.4).abs() < 1e-9);
    }
}
