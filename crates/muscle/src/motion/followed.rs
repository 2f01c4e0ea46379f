//! What a segment remembers of its way, from row to row.

use super::local::{Local, View};
use super::{Instant, NOISE_PER_THRESHOLD};
use crate::effects::Moment;
use crate::force::ForceModel;
use crate::smoothing::Onward;

/// What a segment remembers of its way so far.
pub(super) struct Followed {
    rest_length_m: f64,
    contraction: Onward,
    slide: Onward,
    rest_slide: Onward,
    by_pressure_m: f64,
    /// Time and pressure of the row before.
    last: Option<(f64, f64)>,
}

impl Followed {
    pub(super) fn from_rest(view: &View<'_>, base: &ForceModel) -> Self {
        let rest_length_m = base.muscle().rest_length_m;
        let slid_m = base.slide_m_per_pa(rest_length_m) * view.thresholds.pressure_pa;
        let noise = view.average.share_of_noise() * NOISE_PER_THRESHOLD;
        let onward = |threshold_m: f64| Onward::new(noise * threshold_m, view.window.width_s());
        Self {
            rest_length_m,
            contraction: onward(view.thresholds.length_m),
            slide: onward(view.thresholds.length_m + slid_m),
            rest_slide: onward(slid_m),
            by_pressure_m: 0.0,
            last: None,
        }
    }

    /// The instant of the next row of recording `index`, which began at `origin_s`.
    pub(super) fn on_to(&mut self, local: &Local, index: usize, origin_s: f64) -> Instant {
        let Local { instant, average_pa, average_m, slide_m_per_pa, sharp_pa_per_s, sharp_m_per_s, resting } = *local;
        let time_s = instant.moment.time_s;
        let (step_s, pressure_step_pa) =
            self.last.map_or((0.0, 0.0), |(last_s, last_pa)| (time_s - last_s, average_pa - last_pa));
        self.last = Some((time_s, average_pa));
        let by_pressure_m_per_s = if resting { slide_m_per_pa * sharp_pa_per_s } else { 0.0 };
        if resting {
            self.by_pressure_m += slide_m_per_pa * pressure_step_pa;
        }
        let shortened_m = self.rest_length_m - average_m;
        let slide_speed_m_per_s = if resting { by_pressure_m_per_s } else { -sharp_m_per_s };
        let contraction_m = self.contraction.follow(shortened_m, -sharp_m_per_s);
        let slide_m = self.slide.follow(shortened_m + self.by_pressure_m, slide_speed_m_per_s);
        let rest_slide_m = self.rest_slide.follow(self.by_pressure_m, by_pressure_m_per_s);
        Instant {
            moment: Moment {
                recording: index,
                time_s: time_s - origin_s,
                step_s,
                contraction_ratio: contraction_m / self.rest_length_m,
                slide_speed_m_per_s,
                slide_m,
                rest_slide_m,
                ..instant.moment
            },
            ..instant
        }
    }
}
