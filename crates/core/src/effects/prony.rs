//! Prony series: overstress that decays exponentially behind a change of what drives it.
//!
//! ```text
//! τ dq/dt = f - q,   u = f - q,   so   u ← u e^{-h} + Δf (1 - e^{-h}) / h,   h = Δt / τ
//! ```
//!
//! exact for a driver `f` that moves evenly between the moments. Two states a decade apart stand for a spectrum
//! of some two decades.

/// Ratio of the two time constants.
pub(super) const SPREAD: f64 = 10.0;

/// Overstress with time constants `τ` and `10 τ`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Overstress {
    states: [State; 2],
    /// Driver at the moment before; none before the first.
    driver_n: Option<f64>,
}

#[derive(Debug, Clone, Copy)]
struct State {
    time_constant_s: f64,
    overstress_n: f64,
    /// Step that `decay` and `gain` were worked out for.
    step_s: f64,
    /// `e^{-h}`.
    decay: f64,
    /// `(1 - e^{-h}) / h`.
    gain: f64,
}

impl Overstress {
    /// Settled, with the shorter time constant.
    pub(super) fn new(time_constant_s: f64) -> Self {
        let state = |time_constant_s| State { time_constant_s, overstress_n: 0.0, step_s: 0.0, decay: 1.0, gain: 1.0 };
        Self { states: [state(time_constant_s), state(SPREAD * time_constant_s)], driver_n: None }
    }

    /// Overstress of both states after `step_s`, over which the driver moved to `driver_n`; a step of zero settles.
    pub(super) fn follow(&mut self, step_s: f64, driver_n: f64) -> [f64; 2] {
        match self.driver_n {
            Some(last_n) if step_s > 0.0 => {
                for state in &mut self.states {
                    state.follow(step_s, driver_n - last_n);
                }
            }
            _ => {
                for state in &mut self.states {
                    state.overstress_n = 0.0;
                }
            }
        }
        self.driver_n = Some(driver_n);
        self.states.map(|state| state.overstress_n)
    }
}

impl State {
    fn follow(&mut self, step_s: f64, change_n: f64) {
        if step_s != self.step_s {
            let ratio = step_s / self.time_constant_s;
            self.step_s = step_s;
            self.decay = (-ratio).exp();
            self.gain = -(-ratio).exp_m1() / ratio;
        }
        self.overstress_n = self.overstress_n * self.decay + change_n * self.gain;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sudden_step_decays_with_both_time_constants() {
        let mut overstress = Overstress::new(2.0);
        overstress.follow(0.0, 10.0);
        overstress.follow(1e-9, 110.0);
        for index in 1..=400 {
            let time_s = 0.05 * f64::from(index);
            let [fast_n, slow_n] = overstress.follow(0.05, 110.0);
            assert!((fast_n - 100.0 * (-time_s / 2.0).exp()).abs() < 1e-6);
            assert!((slow_n - 100.0 * (-time_s / 20.0).exp()).abs() < 1e-6);
        }
    }

    #[test]
    fn a_ramp_is_exact_at_any_step() {
        // u = r τ (1 - e^{-t/τ}) behind the start of a ramp with rate r.
        for n in [1, 7, 100] {
            let mut overstress = Overstress::new(3.0);
            overstress.follow(0.0, 0.0);
            let mut last = [0.0; 2];
            for index in 1..=n {
                last = overstress.follow(5.0 / f64::from(n), 20.0 * f64::from(index) / f64::from(n));
            }
            assert!((last[0] - 4.0 * 3.0 * (1.0 - (-5.0_f64 / 3.0).exp())).abs() < 1e-9, "{n} steps: {last:?}");
        }
    }

    #[test]
    fn at_rest_nothing_is_left_and_a_gap_settles() {
        let mut overstress = Overstress::new(0.1);
        assert_eq!(overstress.follow(0.0, -60.0), [0.0; 2]);
        overstress.follow(0.1, -30.0);
        assert!(overstress.follow(100.0, -30.0).iter().all(|left_n| left_n.abs() < 1e-9));
        overstress.follow(0.1, -60.0);
        assert_eq!(overstress.follow(0.0, 5.0), [0.0; 2]);
    }
}
