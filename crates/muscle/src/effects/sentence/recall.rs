//! What a sentence remembers of its driver `x`.
//!
//! | memory      | value                                                                                    | unit |
//! |-------------|------------------------------------------------------------------------------------------|------|
//! | `none`      | `x`                                                                                      | of `x` |
//! | `lag`       | `x - q`, `τ dq/dt = x - q`: what has not followed yet                                     | of `x` |
//! | `two-lags`  | `x - q₂`, `τ₁ dq₁/dt = x - q₁`, `τ₂ dq₂/dt = q₁ - q₂`                                     | of `x` |
//! | `play`      | `x - q`, `q ← clamp(q, x - h, x + h)`                                                     | of `x` |
//! | `dahl`      | `z ← s + (z - s) e^{-\|Δx\| / d}`, `s = sgn Δx`: from -1 to 1                             | 1    |
//! | `largest`   | `max(x) - x` since the recording began                                                   | of `x` |
//! | `travelled` | `Σ \|Δx\|` since the recording began                                                     | of `x` |
//! | `work`      | `Σ F \|ΔL\|` since the recording began, with the force of eq. 11 without friction          | J    |
//!
//! At the first moment of a recording a memory is settled. A gap is crossed: what fades with time has gone on, what slides has
//! come straight.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::driver::Driver;
use crate::effects::{Base, Moment};

/// What a sentence remembers of its driver; see the [module](self) for the equations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Recall {
    /// Nothing.
    None,
    /// A first-order lag.
    Lag {
        /// Time constant, in s.
        time_constant_s: f64,
    },
    /// Two first-order lags, one after the other.
    TwoLags {
        /// Time constants, in s.
        time_constants_s: [f64; 2],
    },
    /// Play.
    Play {
        /// Half of the play, in the unit of the driver.
        half_width: f64,
    },
    /// Dahl's friction.
    Dahl {
        /// Change of the driver over which 63 % of it turn over, in its unit.
        distance: f64,
    },
    /// How far the driver is below its largest so far.
    Largest,
    /// Distance that the driver has travelled.
    Travelled,
    /// Work that the muscle has turned over; of the driver `contraction`.
    Work,
}

impl Recall {
    /// Name as in files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Lag { .. } => "lag",
            Self::TwoLags { .. } => "two-lags",
            Self::Play { .. } => "play",
            Self::Dahl { .. } => "dahl",
            Self::Largest => "largest",
            Self::Travelled => "travelled",
            Self::Work => "work",
        }
    }

    /// Numbers that belong to it.
    pub fn n_parameters(&self) -> usize {
        match self {
            Self::None | Self::Largest | Self::Travelled | Self::Work => 0,
            Self::Lag { .. } | Self::Play { .. } | Self::Dahl { .. } => 1,
            Self::TwoLags { .. } => 2,
        }
    }

    /// Unit of what it makes of `driver`.
    pub fn unit(&self, driver: &Driver) -> &'static str {
        match self {
            Self::Dahl { .. } => "1",
            Self::Work => "J",
            _ => driver.unit(),
        }
    }

    pub(super) fn check(&self, driver: &Driver) -> Result<(), String> {
        let positive = |name: &str, value: f64| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(format!("{name} is {value}; it has to be positive"))
            }
        };
        match *self {
            Self::None | Self::Largest | Self::Travelled => Ok(()),
            Self::Lag { time_constant_s } => positive("time_constant_s", time_constant_s),
            Self::TwoLags { time_constants_s } => {
                time_constants_s.iter().try_for_each(|&value| positive("a value of time_constants_s", value))
            }
            Self::Play { half_width } => positive("half_width", half_width),
            Self::Dahl { distance } => positive("distance", distance),
            Self::Work if *driver == Driver::Contraction => Ok(()),
            Self::Work => Err("the memory work is one of the driver contraction".to_owned()),
        }
    }
}

/// A memory on its way.
#[derive(Debug, Clone)]
pub(super) struct Recalled {
    recall: Recall,
    last: f64,
    last_s: f64,
    last_m: f64,
    states: [f64; 2],
}

impl Recalled {
    pub(super) fn new(recall: Recall) -> Self {
        Self { recall, last: 0.0, last_s: 0.0, last_m: 0.0, states: [0.0; 2] }
    }

    /// What is remembered where the driver has come to `value` now.
    pub(super) fn follow(&mut self, now: &Moment, base: &Base, value: f64, begins: bool) -> f64 {
        if begins {
            self.settle(now, value);
        }
        let change = value - self.last;
        let elapsed_s = if now.step_s > 0.0 { now.step_s } else { (now.time_s - self.last_s).max(0.0) };
        let elapsed_s = if begins { 0.0 } else { elapsed_s };
        let travelled_m = (now.length_m - self.last_m).abs();
        (self.last, self.last_s, self.last_m) = (value, now.time_s, now.length_m);
        let [first, second] = &mut self.states;
        match self.recall {
            Recall::None => value,
            Recall::Lag { time_constant_s } => {
                fall(first, change, elapsed_s / time_constant_s);
                *first
            }
            Recall::TwoLags { time_constants_s } => {
                let before = value - change - *first;
                fall(first, change, elapsed_s / time_constants_s[0]);
                // The second one follows what the first one shows, and lacks what that lacks besides.
                let shown = value - *first;
                fall(second, shown - before, elapsed_s / time_constants_s[1]);
                *first + *second
            }
            Recall::Play { half_width } => {
                *first = first.clamp(value - half_width, value + half_width);
                value - *first
            }
            Recall::Dahl { distance } => {
                if change != 0.0 {
                    *first = change.signum() + (*first - change.signum()) * (-change.abs() / distance).exp();
                }
                *first
            }
            Recall::Largest => {
                *first = first.max(value);
                *first - value
            }
            Recall::Travelled => {
                *first += change.abs();
                *first
            }
            Recall::Work => {
                *first += base.static_force_n.abs() * travelled_m;
                *first
            }
        }
    }

    fn settle(&mut self, now: &Moment, value: f64) {
        (self.last, self.last_s, self.last_m) = (value, now.time_s, now.length_m);
        let came = if now.came { now.direction } else { 0.0 };
        self.states = match self.recall {
            Recall::Play { half_width } => [value - came * half_width, 0.0],
            Recall::Largest => [value, 0.0],
            Recall::Dahl { .. } => [came, 0.0],
            _ => [0.0; 2],
        };
    }
}

/// What is left after `ratio` time constants of a `missing` share that has grown evenly by `change` in the meantime.
fn fall(missing: &mut f64, change: f64, ratio: f64) {
    let gain = if ratio > 1e-9 { -(-ratio).exp_m1() / ratio } else { 1.0 };
    *missing = *missing * (-ratio).exp() + change * gain;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::moment::tests::{base, still};

    /// What `recall` leaves of `values`, a tenth of a second apart.
    fn along(recall: Recall, values: &[f64]) -> Vec<f64> {
        let mut recalled = Recalled::new(recall);
        let at = |(index, &value): (usize, &f64)| {
            let step_s = if index == 0 { 0.0 } else { 0.1 };
            recalled.follow(&Moment { step_s, time_s: 0.1 * index as f64, ..still() }, &base(), value, index == 0)
        };
        values.iter().enumerate().map(at).collect()
    }

    #[test]
    fn a_lag_is_exact_for_a_driver_that_moves_evenly() {
        let ramp: Vec<f64> = (0..100).map(f64::from).collect();
        let left = along(Recall::Lag { time_constant_s: 0.5 }, &ramp);
        for (index, value) in left.iter().enumerate() {
            let expected = 5.0 * (1.0 - (-0.2 * index as f64).exp());
            assert!((value - expected).abs() < 1e-9, "{index}: {value} {expected}");
        }
    }

    #[test]
    fn two_lags_are_late_on_a_ramp_by_both_time_constants() {
        let ramp: Vec<f64> = (0..400).map(f64::from).collect();
        let left = along(Recall::TwoLags { time_constants_s: [0.5, 0.8] }, &ramp);
        assert!((left[399] - 13.0).abs() < 1e-6, "{}", left[399]);
        assert!(left.windows(2).all(|pair| pair[1] > pair[0] - 1e-12));
    }

    #[test]
    fn play_turns_over_within_its_width() {
        let left = along(Recall::Play { half_width: 1.0 }, &[0.0, 5.0, 4.5, 3.0, 2.0, 2.5]);
        for (value, expected) in left.iter().zip([1.0, 1.0, 0.5, -1.0, -1.0, -0.5]) {
            assert!((value - expected).abs() < 1e-12, "{left:?}");
        }
    }

    #[test]
    fn friction_of_dahl_goes_towards_the_way_it_moves() {
        let left = along(Recall::Dahl { distance: 1.0 }, &[0.0, 20.0, 19.5, 0.0]);
        assert!(left[1] > 0.999 && left[3] < -0.999);
        assert!((left[2] - (-1.0 + 2.0 * (-0.5_f64).exp())).abs() < 1e-6);
    }

    #[test]
    fn what_was_largest_and_what_was_travelled_never_come_back() {
        let values = [1.0, 3.0, 2.0, 2.5, 4.0];
        assert_eq!(along(Recall::Largest, &values), [0.0, 0.0, 1.0, 0.5, 0.0]);
        assert_eq!(along(Recall::Travelled, &values), [0.0, 2.0, 3.0, 3.5, 5.0]);
    }
}
