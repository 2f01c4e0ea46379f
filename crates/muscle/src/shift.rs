//! Channels moved in time against the force.

use crate::effects::Moment;
use crate::motion::Instant;

/// The moments of one recording with the pressure channel read `delays_s[0]` later and the length channel `delays_s[1]`
/// later: what a channel that is late by that much should have said. Between instants a cubic through values and slopes.
pub fn shifted(instants: &[Instant], delays_s: [f64; 2]) -> Vec<Moment> {
    let mut moments: Vec<Moment> = instants.iter().map(|instant| instant.moment).collect();
    shift(&mut moments, instants, delays_s);
    moments
}

/// The same in place: `moments` are those of `instants`.
pub fn shift(moments: &mut [Moment], instants: &[Instant], delays_s: [f64; 2]) {
    let [pressure_s, length_s] = delays_s;
    if pressure_s != 0.0 {
        for (at, moment) in moments.iter_mut().enumerate() {
            let Some((left, right, share)) = around(instants, at, pressure_s) else { continue };
            let step_s = right.time_s - left.time_s;
            moment.pressure_pa = hermite(
                [left.pressure_pa, right.pressure_pa],
                [left.pressure_rate_pa_per_s * step_s, right.pressure_rate_pa_per_s * step_s],
                share,
            );
            moment.pressure_rate_pa_per_s =
                left.pressure_rate_pa_per_s + share * (right.pressure_rate_pa_per_s - left.pressure_rate_pa_per_s);
        }
    }
    if length_s != 0.0 {
        for (at, moment) in moments.iter_mut().enumerate() {
            let Some((left, right, share)) = around(instants, at, length_s) else { continue };
            let step_s = right.time_s - left.time_s;
            let length_m = hermite(
                [left.length_m, right.length_m],
                [-left.speed_m_per_s * step_s, -right.speed_m_per_s * step_s],
                share,
            );
            let moved_m = length_m - moment.length_m;
            moment.length_m = length_m;
            moment.slide_m -= moved_m;
            moment.contraction_ratio =
                left.contraction_ratio + share * (right.contraction_ratio - left.contraction_ratio);
            moment.speed_m_per_s = left.speed_m_per_s + share * (right.speed_m_per_s - left.speed_m_per_s);
            moment.slide_speed_m_per_s =
                left.slide_speed_m_per_s + share * (right.slide_speed_m_per_s - left.slide_speed_m_per_s);
            moment.acceleration_m_per_s2 =
                left.acceleration_m_per_s2 + share * (right.acceleration_m_per_s2 - left.acceleration_m_per_s2);
            moment.direction = if share < 0.5 { left.direction } else { right.direction };
        }
    }
}

/// The moments around the time of instant `at` plus `delay_s`, and how far between them it lies; none where a gap or an
/// end of the recording lies between.
fn around(instants: &[Instant], at: usize, delay_s: f64) -> Option<(&Moment, &Moment, f64)> {
    let time_s = instants[at].moment.time_s + delay_s;
    let mut left = at;
    while left > 0 && instants[left].moment.time_s > time_s {
        if instants[left].moment.step_s == 0.0 {
            return None;
        }
        left -= 1;
    }
    while left + 1 < instants.len() && instants[left + 1].moment.time_s <= time_s {
        left += 1;
        if instants[left].moment.step_s == 0.0 {
            return None;
        }
    }
    let right = instants.get(left + 1)?;
    let from = &instants[left].moment;
    if right.moment.step_s == 0.0 || time_s < from.time_s {
        return None;
    }
    Some((from, &right.moment, (time_s - from.time_s) / right.moment.step_s))
}

/// Cubic with values and slopes (per unit of `share`) at both ends.
fn hermite(values: [f64; 2], slopes: [f64; 2], share: f64) -> f64 {
    let (t, t2, t3) = (share, share * share, share * share * share);
    (2.0 * t3 - 3.0 * t2 + 1.0) * values[0]
        + (t3 - 2.0 * t2 + t) * slopes[0]
        + (3.0 * t2 - 2.0 * t3) * values[1]
        + (t3 - t2) * slopes[1]
}
