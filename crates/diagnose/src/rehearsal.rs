//! A protocol run in thought: the instants that its recording would have, without noise.
//!
//! Instants lie close where the path moves and far apart where it rests, so each carries the time that it stands for.
//! Corners of the path are rounded over [`HALF_CORNER_S`] to either side, as a drive does.

use pam_muscle::effects::Moment;
use pam_muscle::force::ForceModel;
use pam_muscle::motion::Instant;
use pam_muscle::smoothing::HALF_WINDOW_S;

use crate::protocols::{Reach, Take};
use crate::track::Track;

/// Half of the time over which rates are taken, in s.
const HALF_CORNER_S: f64 = 0.01;
/// Share of the range of a channel that it moves from one instant to the next, at most.
const LARGEST_MOVE: f64 = 0.04;
/// Time from one instant to the next, at most, in s.
const LONGEST_STEP_S: f64 = 1.0;

/// Instants of a protocol.
#[derive(Debug)]
pub(crate) struct Rehearsal {
    /// One recording for each take; it has no blocks.
    pub track: Track,
    /// Time that each instant stands for, in s.
    pub stands_for_s: Vec<f64>,
}

impl Rehearsal {
    /// Of `takes` within `reach`; `force_n` of the moments is that of its model.
    pub(crate) fn of(takes: &[Take], reach: &Reach<'_>) -> Self {
        Self::with_steps(takes, reach, LONGEST_STEP_S)
    }

    /// The same with another longest step.
    fn with_steps(takes: &[Take], reach: &Reach<'_>, longest_step_s: f64) -> Self {
        let mut rehearsal = Self { track: Track::default(), stands_for_s: Vec::new() };
        for (index, take) in takes.iter().enumerate() {
            rehearsal.add(take, reach, index, longest_step_s);
        }
        rehearsal.track.counted = vec![true; rehearsal.track.n()];
        rehearsal.leave_out_reversals();
        rehearsal
    }

    /// What is near a reversal hangs on how the direction is told from noisy channels: it decides nothing.
    fn leave_out_reversals(&mut self) {
        for range in &self.track.recordings {
            let moment = |at: usize| &self.track.instants[at].moment;
            let turns: Vec<usize> =
                range.clone().skip(1).filter(|&at| moment(at).direction != moment(at - 1).direction).collect();
            for (position, &turn) in turns.iter().enumerate() {
                // The last instant before it is where the path turns.
                let turn_s = moment(turn - 1).time_s;
                let reach_s = |other: Option<&usize>| {
                    let apart_s = other.map_or(f64::INFINITY, |&other| (moment(other - 1).time_s - turn_s).abs());
                    HALF_WINDOW_S.min(0.25 * apart_s)
                };
                let (before_s, after_s) = (
                    reach_s(position.checked_sub(1).and_then(|before| turns.get(before))),
                    reach_s(turns.get(position + 1)),
                );
                let near = |at: &usize| {
                    let by_s = moment(*at).time_s - turn_s;
                    -before_s <= by_s && by_s <= after_s
                };
                let back = (range.start..turn).rev().take_while(near);
                let (first, last) = (back.last().unwrap_or(turn), (turn..range.end).take_while(near).last());
                for at in first..=last.unwrap_or(turn - 1) {
                    self.track.counted[at] = false;
                    self.stands_for_s[at] = 0.0;
                }
            }
        }
    }

    fn add(&mut self, take: &Take, reach: &Reach<'_>, index: usize, longest_step_s: f64) {
        let first = self.track.instants.len();
        let points = points(take, reach, longest_step_s);
        let muscle = reach.model.muscle();
        let mut slide_by_pressure_m = 0.0;
        for (at, point) in points.iter().enumerate() {
            let [before, here, after] =
                [point.time_s - HALF_CORNER_S, point.time_s, point.time_s + HALF_CORNER_S].map(|t| state(take, t));
            let span_s = after.0 - before.0;
            let rate = |left: f64, right: f64| if span_s > 0.0 { (right - left) / span_s } else { 0.0 };
            let step_s = if at == 0 { 0.0 } else { point.time_s - points[at - 1].time_s };
            let slide_m_per_pa = reach.model.slide_m_per_pa(here.2);
            if at > 0 && point.rests {
                let last_pa = self.track.instants[first + at - 1].moment.pressure_pa;
                slide_by_pressure_m += slide_m_per_pa * (here.1 - last_pa);
            }
            let moment = Moment {
                recording: index,
                time_s: point.time_s,
                step_s,
                pressure_pa: here.1,
                pressure_rate_pa_per_s: rate(before.1, after.1),
                length_m: here.2,
                contraction_ratio: muscle.contraction_ratio(here.2),
                speed_m_per_s: -rate(before.2, after.2),
                slide_speed_m_per_s: if point.rests {
                    slide_m_per_pa * rate(before.1, after.1)
                } else {
                    -rate(before.2, after.2)
                },
                acceleration_m_per_s2: -(after.2 - 2.0 * here.2 + before.2) / HALF_CORNER_S.powi(2),
                direction: point.direction,
                came: true,
                slide_m: muscle.rest_length_m - here.2 + slide_by_pressure_m,
                rest_slide_m: slide_by_pressure_m,
                force_n: force_n(reach.model, here.1, here.2, point.direction),
                warmth_k: 0.0,
            };
            self.track.instants.push(Instant { row: at, moment, force_n: moment.force_n, knee: false, settled: true });
            let left_s = if at == 0 { point.time_s } else { points[at - 1].time_s };
            let right_s = points.get(at + 1).map_or(point.time_s, |next| next.time_s);
            self.stands_for_s.push(0.5 * (right_s - left_s));
        }
        self.track.recordings.push(first..self.track.instants.len());
    }
}

fn force_n(model: &ForceModel, pressure_pa: f64, length_m: f64, direction: f64) -> f64 {
    model.force_n(pressure_pa, length_m, direction)
}

struct Point {
    time_s: f64,
    direction: f64,
    /// Whether the length stands still there.
    rests: bool,
}

/// Times of the instants of a take, with the direction of motion.
fn points(take: &Take, reach: &Reach<'_>, longest_step_s: f64) -> Vec<Point> {
    let range = |(low, high): (f64, f64)| (LARGEST_MOVE * (high - low)).max(f64::MIN_POSITIVE);
    let (move_pa, move_m) = (range(reach.pressure_pa), range(reach.length_m));
    let mut points = Vec::new();
    let mut direction = 0.0;
    for pair in take.knots.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let (by_pa, by_m) = (to.pressure_pa - from.pressure_pa, to.length_m - from.length_m);
        let rests = by_m == 0.0;
        // Contraction where the length falls; of a muscle that is held, where the pressure rises.
        let now = if rests { by_pa } else { -by_m };
        if now != 0.0 {
            direction = now.signum();
        }
        if points.is_empty() {
            points.push(Point { time_s: from.time_s, direction, rests });
        }
        let duration_s = to.time_s - from.time_s;
        let corner_s = if duration_s >= 20.0 * HALF_CORNER_S { HALF_CORNER_S } else { 0.0 };
        let between = (by_pa.abs() / move_pa).max(by_m.abs() / move_m).max(duration_s / longest_step_s);
        let steps = (between.ceil() as usize).max(1);
        let mut times: Vec<f64> =
            (1..=steps).map(|step| from.time_s + duration_s * step as f64 / steps as f64).collect();
        if corner_s > 0.0 {
            let (first_s, last_s) = (from.time_s + corner_s, to.time_s - corner_s);
            times.retain(|time_s| *time_s > first_s && *time_s < last_s);
            times.insert(0, first_s);
            times.extend([last_s, to.time_s]);
        }
        points.extend(times.into_iter().map(|time_s| Point { time_s, direction, rests }));
    }
    // Where the first moves are waited for, the muscle came as it goes on.
    let coming = points.iter().map(|point| point.direction).find(|direction| *direction != 0.0).unwrap_or(0.0);
    for point in points.iter_mut().take_while(|point| point.direction == 0.0) {
        point.direction = coming;
    }
    points
}

/// Time (within the take), pressure and length.
fn state(take: &Take, time_s: f64) -> (f64, f64, f64) {
    let knots = &take.knots;
    let time_s = time_s.clamp(0.0, take.duration_s());
    let after = knots.partition_point(|knot| knot.time_s < time_s).clamp(1, knots.len() - 1);
    let (from, to) = (&knots[after - 1], &knots[after]);
    let share = ((time_s - from.time_s) / (to.time_s - from.time_s)).clamp(0.0, 1.0);
    let between = |from: f64, to: f64| if from == to { from } else { from + share * (to - from) };
    (time_s, between(from.pressure_pa, to.pressure_pa), between(from.length_m, to.length_m))
}

#[cfg(test)]
pub(crate) mod tests;
