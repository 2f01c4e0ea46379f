//! Prony series: overstress that decays exponentially after a change of what drives it.
//!
//! ```text
//! τ dq/dt = f - q,   u = f - q,   so   u ← u e^{-h} + Δf (1 - e^{-h}) / h,   h = Δt / τ
//! ```
//!
//! exact for a driver `f` that moves evenly between the moments. Three states a decade apart stand for a spectrum
//! of some three decades, as rubber and weave have.

use super::Moment;

/// Ratio of one time constant to the one before.
const SPREAD: f64 = 10.0;

/// Overstress with time constants `τ`, `10 τ` and `100 τ`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Overstress {
    states: [State; 3],
    /// Recording, time and driver of the moment before; none before the first.
    last: Option<(usize, f64, f64)>,
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
    /// Settled, with the shortest time constant.
    pub(super) fn new(time_constant_s: f64) -> Self {
        let state = |time_constant_s| State { time_constant_s, overstress_n: 0.0, step_s: 0.0, decay: 1.0, gain: 1.0 };
        let states = [1.0, SPREAD, SPREAD * SPREAD].map(|factor| state(factor * time_constant_s));
        Self { states, last: None }
    }

    /// Overstress of each state `now`, where the driver has moved to `driver_n` evenly since the moment before. It does not
    /// wait in a gap, and another recording finds it settled.
    pub(super) fn follow(&mut self, now: &Moment, driver_n: f64) -> [f64; 3] {
        match self.last {
            Some((recording, last_s, last_n)) if recording == now.recording && now.time_s >= last_s => {
                let step_s = if now.step_s > 0.0 { now.step_s } else { now.time_s - last_s };
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
        self.last = Some((now.recording, now.time_s, driver_n));
        self.states.map(|state| state.overstress_n)
    }
}

impl State {
    fn follow(&mut self, step_s: f64, change_n: f64) {
        if step_s > 0.0 && step_s != self.step_s {
            let ratio = step_s / self.time_constant_s;
            self.step_s = step_s;
            self.decay = (-ratio).exp();
            self.gain = -(-ratio).exp_m1() / ratio;
        }
        let (decay, gain) = if step_s > 0.0 { (self.decay, self.gain) } else { (1.0, 1.0) };
        self.overstress_n = self.overstress_n * decay + change_n * gain;
    }
}

#[cfg(test)]
mod tests {
    use super::super::moment::tests::still;
    use super::*;

    fn at(time_s: f64) -> Moment {
        Moment { time_s, ..still() }
    }

    #[test]
    fn a_sudden_step_decays_with_every_time_constant() {
        let mut overstress = Overstress::new(2.0);
        overstress.follow(&at(0.0), 10.0);
        overstress.follow(&at(1e-9), 110.0);
        for index in 1..=400 {
            let time_s = 0.05 * f64::from(index);
            let left_n = overstress.follow(&at(1e-9 + time_s), 110.0);
            for (left_n, time_constant_s) in left_n.iter().zip([2.0, 20.0, 200.0]) {
                assert!((left_n - 100.0 * (-time_s / time_constant_s).exp()).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn a_ramp_is_exact_at_any_step() {
        // u = r τ (1 - e^{-t/τ}) after the start of a ramp with rate r.
        for n in [1, 7, 100] {
            let mut overstress = Overstress::new(3.0);
            overstress.follow(&at(0.0), 0.0);
            let mut last = [0.0; 3];
            for index in 1..=n {
                let share = f64::from(index) / f64::from(n);
                last = overstress.follow(&at(5.0 * share), 20.0 * share);
            }
            assert!((last[0] - 4.0 * 3.0 * (1.0 - (-5.0_f64 / 3.0).exp())).abs() < 1e-9, "{n} steps: {last:?}");
        }
    }

    #[test]
    fn it_goes_on_in_a_gap_and_not_in_another_recording() {
        let mut overstress = Overstress::new(0.1);
        assert_eq!(overstress.follow(&at(0.0), -60.0), [0.0; 3]);
        let before = overstress.follow(&at(0.1), -30.0);
        let after = overstress.follow(&Moment { step_s: 0.0, ..at(1.1) }, -30.0);
        assert!((after[1] / before[1] - (-1.0_f64).exp()).abs() < 1e-9);
        assert!(overstress.follow(&at(200.0), -30.0).iter().all(|left_n| left_n.abs() < 1e-6));
        overstress.follow(&at(200.1), -60.0);
        assert_eq!(overstress.follow(&Moment { recording: 1, ..at(300.0) }, 5.0), [0.0; 3]);
        assert_eq!(overstress.follow(&Moment { recording: 1, ..at(0.0) }, 5.0), [0.0; 3]);
    }
}
