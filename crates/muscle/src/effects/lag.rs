//! A value that follows another through a first-order lag.
//!
//! ```text
//! τ dy/dt = x - y
//! ```
//!
//! Exact for `x` that moves evenly between the moments. The first moment finds it settled, and so does a gap.

/// The follower, and what it followed last.
#[derive(Debug, Clone, Default)]
pub(super) struct Lag {
    last: f64,
    behind: Option<f64>,
}

impl Lag {
    /// The follower of `value` after `step_s` with time constant `time_constant_s`.
    pub(super) fn follow(&mut self, value: f64, step_s: f64, time_constant_s: f64) -> f64 {
        let behind = match self.behind {
            Some(behind) if step_s > 0.0 => {
                let ratio = step_s / time_constant_s;
                let decay = (-ratio).exp();
                let slope = (value - self.last) / ratio;
                value - slope + (behind - self.last + slope) * decay
            }
            _ => value,
        };
        self.last = value;
        self.behind = Some(behind);
        behind
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_is_followed_one_time_constant_late_whatever_the_steps() {
        for step_s in [1e-3, 0.05, 0.4] {
            let mut lag = Lag::default();
            let steps = (2.0_f64 / step_s).round() as u32;
            let last = (0..=steps).map(|step| lag.follow(f64::from(step) * step_s, step_s, 0.1)).last().unwrap();
            assert!((last - (f64::from(steps) * step_s - 0.1)).abs() < 1e-8, "{step_s}: {last}");
        }
    }

    #[test]
    fn it_is_settled_at_first_and_after_a_gap() {
        let mut lag = Lag::default();
        assert_eq!(lag.follow(3.0, 0.0, 0.1), 3.0);
        assert!(lag.follow(4.0, 0.01, 0.1) < 3.1);
        assert_eq!(lag.follow(5.0, 0.0, 0.1), 5.0);
    }
}
