//! The reference: a quintic from rest to rest (Fig. 9).
//!
//! ```text
//! q(s) = q₀ + (q₁ - q₀) (10 s³ - 15 s⁴ + 6 s⁵),   s = t / T
//! ```
//!
//! The only quintic with angle given and velocity and acceleration zero at both ends. Before the lift it stands
//! at `q₀`, after it at `q₁`. The largest velocity, `15/8 (q₁ - q₀)/T`, is at half time.
//!
//! Source: section 3.3 of Appl. Sci. 2023, 13(21), 12038; Craig (2005), "Introduction to Robotics", 7.3.

/// A lift from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quintic {
    /// Angle before, in rad.
    pub from_rad: f64,
    /// Angle after, in rad.
    pub to_rad: f64,
    /// Time from rest to rest, in s.
    pub duration_s: f64,
}

/// The reference at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ReferenceAt {
    /// Angle, in rad.
    pub q_rad: f64,
    /// Angular velocity, in rad/s.
    pub dq_rad_per_s: f64,
    /// Angular acceleration, in rad/s².
    pub ddq_rad_per_s2: f64,
}

impl Quintic {
    /// The reference at a time, in s.
    pub fn at(&self, time_s: f64) -> ReferenceAt {
        let s = (time_s / self.duration_s).clamp(0.0, 1.0);
        let rise_rad = self.to_rad - self.from_rad;
        let rest = 1.0 - s;
        ReferenceAt {
            q_rad: self.from_rad + rise_rad * s * s * s * (10.0 + s * (-15.0 + 6.0 * s)),
            dq_rad_per_s: rise_rad / self.duration_s * 30.0 * s * s * rest * rest,
            ddq_rad_per_s2: rise_rad / (self.duration_s * self.duration_s) * 60.0 * s * rest * (1.0 - 2.0 * s),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: Quintic = Quintic { from_rad: 0.0, to_rad: 0.3, duration_s: 5.0 };

    #[test]
    fn it_begins_and_ends_at_rest() {
        for (time_s, q_rad) in [(-1.0, 0.0), (0.0, 0.0), (5.0, 0.3), (7.0, 0.3)] {
            let at = PAPER.at(time_s);
            assert!((at.q_rad - q_rad).abs() < 1e-15 && at.dq_rad_per_s.abs() < 1e-15, "{at:?}");
            assert!(at.ddq_rad_per_s2.abs() < 1e-15);
        }
    }

    #[test]
    fn validates_against_published_extremes() {
        // 0.1125 rad/s at half time; 0.0693 rad/s² at T (3 - √3) / 6.
        assert!((PAPER.at(2.5).dq_rad_per_s - 0.1125).abs() < 1e-12);
        let at = PAPER.at(5.0 * (3.0 - 3.0_f64.sqrt()) / 6.0);
        assert!((at.ddq_rad_per_s2 - 0.0693).abs() < 5e-5, "{at:?}");
    }

    #[test]
    fn velocity_and_acceleration_are_slopes() {
        for time_s in [0.3, 1.7, 2.5, 4.4] {
            let step_s = 1e-5;
            let (before, at, after) = (PAPER.at(time_s - step_s), PAPER.at(time_s), PAPER.at(time_s + step_s));
            assert!(((after.q_rad - before.q_rad) / (2.0 * step_s) - at.dq_rad_per_s).abs() < 1e-9);
            assert!(((after.dq_rad_per_s - before.dq_rad_per_s) / (2.0 * step_s) - at.ddq_rad_per_s2).abs() < 1e-9);
        }
    }
}
