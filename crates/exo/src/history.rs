//! A muscle's force along a motion: what effects beyond eq. 11 remember, step by step.
//!
//! Plant and controller use it alike, the one with what is, the other with what it has measured. The direction is the
//! state of the friction, -1 to 1, which spares effects with a direction the chatter of a sign at standstill.

use pam_muscle::effects::{AugmentedMemory, AugmentedModel, Moment};

/// Force of an augmented model along a motion.
#[derive(Debug)]
pub struct History {
    model: AugmentedModel,
    memory: AugmentedMemory,
    /// The step before; none before the first.
    last: Option<Moment>,
}

impl History {
    /// A muscle that has not moved yet.
    pub fn new(model: AugmentedModel) -> Self {
        let memory = model.start();
        Self { model, memory, last: None }
    }

    /// Force, in N, after a step to a gauge pressure, a length and a state of the friction. The first step, and one of
    /// 0 s, finds the muscle at rest.
    pub fn advance(&mut self, step_s: f64, pressure_pa: f64, length_m: f64, friction_state: f64) -> f64 {
        let settled = Moment::settled(self.model.base().muscle(), pressure_pa, length_m, friction_state);
        let now = match &self.last {
            Some(last) if step_s > 0.0 => {
                let speed_m_per_s = (last.length_m - length_m) / step_s;
                Moment {
                    time_s: last.time_s + step_s,
                    step_s,
                    pressure_rate_pa_per_s: (pressure_pa - last.pressure_pa) / step_s,
                    speed_m_per_s,
                    slide_speed_m_per_s: speed_m_per_s,
                    acceleration_m_per_s2: (speed_m_per_s - last.speed_m_per_s) / step_s,
                    force_n: last.force_n,
                    ..settled
                }
            }
            last => Moment {
                time_s: last.map_or(0.0, |last| last.time_s),
                force_n: self.model.settled_force_n(pressure_pa, length_m, friction_state),
                ..settled
            },
        };
        let force_n = self.memory.force_n(&self.model, now);
        self.last = Some(Moment { force_n, ..now });
        force_n
    }

    /// Force at the last step less that which the muscle would settle at there, in N.
    pub fn remembered_n(&self) -> f64 {
        self.last.map_or(0.0, |last| {
            last.force_n - self.model.settled_force_n(last.pressure_pa, last.length_m, last.direction)
        })
    }

    /// Whether the muscle or its cable was slack after the last step.
    pub fn is_slack(&self) -> bool {
        self.memory.is_cut()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{nominal_model, with_effect};

    #[test]
    fn a_muscle_at_rest_has_its_settled_force_and_forgets_on_the_way_there() {
        let relaxing = with_effect("viscoelastic-relaxation", &[0.3], &[0.5, 0.0, 0.0]);
        let mut history = History::new(relaxing.clone());
        let settled_n = relaxing.settled_force_n(1e5, 0.25, 1.0);
        assert!((history.advance(0.0, 1e5, 0.25, 1.0) - settled_n).abs() < 1e-9);
        history.advance(1e-3, 1e5, 0.24, 1.0);
        // Half of what the rubber resists more at 0.24 m than at 0.25 m.
        let bladder_n = |length_m| nominal_model().terms(1e5, length_m, 0.0).bladder_n;
        let expected_n = 0.5 * (bladder_n(0.24) - bladder_n(0.25));
        assert!((history.remembered_n() / expected_n - 1.0).abs() < 0.05, "{} {expected_n}", history.remembered_n());
        for _ in 0..3000 {
            history.advance(1e-3, 1e5, 0.24, 1.0);
        }
        assert!(history.remembered_n().abs() < 1e-3);
    }
}
