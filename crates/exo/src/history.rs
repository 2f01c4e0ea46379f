//! A muscle's force along a motion: what effects beyond eq. 11 remember, step by step.
//!
//! Plant and controller use it alike, the one with what is, the other with what it has measured. The direction is the
//! state of the friction, -1 to 1, which spares effects with a direction the chatter of a sign at standstill.

use pam_core::effects::{AugmentedMemory, AugmentedModel, Moment};

/// Force of an augmented model along a motion.
#[derive(Debug)]
pub struct History<'a> {
    model: &'a AugmentedModel,
    memory: AugmentedMemory,
    /// The step before; none before the first.
    last: Option<Moment>,
}

impl<'a> History<'a> {
    /// A muscle that has not moved yet.
    pub fn new(model: &'a AugmentedModel) -> Self {
        Self { model, memory: model.start(), last: None }
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
        let force_n = self.memory.force_n(self.model, now);
        self.last = Some(Moment { force_n, ..now });
        force_n
    }

    /// Whether the muscle or its cable was slack after the last step.
    pub fn is_slack(&self) -> bool {
        self.memory.is_cut()
    }
}
