//! Friction with memory: Dahl's model on the length of the muscle.
//!
//! ```text
//! dz/dx = (1 - z sgn dx) / δ   =>   z ← s + (z - s) exp(-|Δx| / δ),   s = sgn Δx
//! ```
//!
//! | symbol | code           | unit | meaning                                                    |
//! |--------|----------------|------|------------------------------------------------------------|
//! | `z`    | `state`        | 1    | share of the sliding friction, -1 to 1; + while contracting |
//! | `x`    | contraction    | m    | `L₀ - L`                                                   |
//! | `δ`    | `presliding_m` | m    | travel in which all but 1/e of a reversal is over          |
//!
//! The step is exact for motion in one direction and depends on no clock. Minor loops drift, as Dahl's model
//! has no return-point memory; a lift has none to speak of.
//!
//! Source: Dahl (1968), "A solid friction model", Aerospace Corp. TOR-0158.

/// State of the friction; see the [module](self).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dahl {
    /// `z`.
    pub state: f64,
    inverse_m: f64,
}

impl Dahl {
    /// Friction that starts at `state`.
    pub fn new(presliding_m: f64, state: f64) -> Self {
        Self { state, inverse_m: 1.0 / presliding_m }
    }

    /// State after a contraction by `travel_m`.
    pub fn after(&self, travel_m: f64) -> f64 {
        let end = if travel_m > 0.0 { 1.0 } else { -1.0 };
        let share = travel_m.abs() * self.inverse_m;
        // A step of the plant is a hundredth of δ, where five terms are exact to 1e-13.
        let kept = if share < 0.02 {
            1.0 - share * (1.0 - share * (0.5 - share * (1.0 / 6.0 - share * (1.0 / 24.0 - share / 120.0))))
        } else {
            (-share).exp()
        };
        end + (self.state - end) * kept
    }

    /// Moves by a contraction of `travel_m`; gives the new state.
    pub fn advance(&mut self, travel_m: f64) -> f64 {
        self.state = self.after(travel_m);
        self.state
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_small_steps_are_one_large_step() {
        let mut small = Dahl::new(1e-3, -0.4);
        for _ in 0..10_000 {
            small.advance(2e-7);
        }
        assert!((small.state - Dahl::new(1e-3, -0.4).after(2e-3)).abs() < 1e-12, "{}", small.state);
    }

    #[test]
    fn a_reversal_is_over_after_some_lengths_of_presliding() {
        let mut friction = Dahl::new(1e-3, 1.0);
        assert!((friction.advance(-1e-3) - (2.0 * (-1.0_f64).exp() - 1.0)).abs() < 1e-12);
        assert!((friction.advance(-10e-3) + 1.0).abs() < 1e-4);
    }

    #[test]
    fn nothing_changes_at_standstill() {
        assert!((Dahl::new(1e-3, 0.3).after(0.0) - 0.3).abs() < f64::EPSILON);
    }
}
