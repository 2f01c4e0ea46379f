//! A jump of the force in the rows of a recording, where no drive moves.

use std::io;
use std::ops::Range;

use pam_identification::prepare::Prepared;
use pam_muscle::direction::Thresholds;
use pam_muscle::motion::Instant;

use crate::coverage;
use crate::steps::{PARTS, stands_alone};
use crate::track::Track;

/// Instants of the grid to either side in which drives rest: 0.1 s. Between the pulses of a valve they seldom do for longer.
const REST: usize = 5;
/// How long the force is to stay where it jumped to, and was where it jumped from, in s.
const STAYS_S: f64 = 0.1;
/// Time to either side whose medians are compared, in s: what follows a drive late, or swings on after it, moves little within.
const NEAR_S: f64 = 0.02;
/// Rows that a median is taken of, at least.
const NEAR_ROWS: usize = 5;
/// Rows are as far apart as this, at least, in s: more would tell nothing about what jumps.
const FINE_S: f64 = 0.002;
/// By how much the pressure may swing at rest, in times what is one of its motions: behind a pulse it rings, and what a force follows of
/// that is there behind the other pulses too.
const RINGS: f64 = 2.0;
/// By how much friction turns over where it does not rest.
const TURNS: f64 = 0.5;
/// Share of a jump that lies within a third of [`NEAR_S`]: what takes longer is no jump.
const SHARP: f64 = 0.5;
/// The same where it is abrupt, and within what time then, in s: no muscle follows a drive that fast, and nothing sticks and slides along it.
const ABRUPT: f64 = 0.8;
/// See [`ABRUPT`].
const ABRUPT_S: f64 = 0.01;
/// Probability by chance, corrected for the rows that were looked at, that is still believed.
const CHANCE: f64 = 0.01;

/// The force of a recording as it was recorded, thinned to [`FINE_S`].
#[derive(Debug)]
pub(super) struct Rows {
    time_s: Vec<f64>,
    force_n: Vec<f64>,
    /// Rows of the recording for one of these.
    stride: usize,
    /// Time between two of them, in s.
    period_s: f64,
    /// What the load cell resolves, in N.
    resolution_n: f64,
}

impl Rows {
    /// Of a recording.
    ///
    /// # Errors
    /// Where samples cannot be read back.
    pub(super) fn of(Prepared { recording, quality, .. }: &Prepared) -> io::Result<Self> {
        let stride = ((FINE_S / quality.period_s).round() as usize).max(1);
        let mut rows = Self {
            time_s: Vec::new(),
            force_n: Vec::new(),
            stride,
            period_s: stride as f64 * quality.period_s,
            resolution_n: quality.channel("force").and_then(|force| force.quantization_step).unwrap_or(0.0),
        };
        for chunk in recording.samples.chunks() {
            let chunk = chunk?;
            let first = chunk.first_row().next_multiple_of(stride) - chunk.first_row();
            rows.time_s.extend(chunk.time_s().iter().skip(first).step_by(stride));
            rows.force_n.extend(chunk.force_n().iter().skip(first).step_by(stride));
        }
        Ok(rows)
    }

    /// Median force of `rows`, in N.
    fn median_n(&self, rows: Range<usize>) -> f64 {
        let mut values_n = self.force_n[rows].to_vec();
        let middle = values_n.len() / 2;
        *values_n.select_nth_unstable_by(middle, f64::total_cmp).1
    }

    /// Median force of `near` rows from `at` on less that of as many before, in N.
    fn jump_n(&self, at: usize, near: usize) -> f64 {
        self.median_n(at..at + near) - self.median_n(at - near..at)
    }

    /// By how much the force jumps at `at` within `near` rows and is off by over `stays` rows, in N: what swings back is none.
    fn lasting_n(&self, at: usize, near: usize, stays: usize) -> f64 {
        let [now_n, then_n] = [near, stays].map(|rows| self.jump_n(at, rows));
        if now_n * then_n > 0.0 { now_n.signum() * now_n.abs().min(then_n.abs()) } else { 0.0 }
    }

    /// Whether the rows `around` follow one another without a gap.
    fn follow(&self, around: &Range<usize>) -> bool {
        let lasts_s = self.time_s[around.end - 1] - self.time_s[around.start];
        lasts_s < 1.5 * self.period_s * around.len() as f64
    }
}

/// A jump at rest in one recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jump {
    pub(super) instant_s: f64,
    pub(super) step_n: f64,
    pub(super) stderr_n: f64,
    pub(super) chance: f64,
    /// Whether it came faster than anything does that a muscle does.
    pub(super) is_abrupt: bool,
}

impl Jump {
    /// The largest of `rows`, which the instants `range` of `track` are a grid of, where it stands alone among those at other
    /// rests and passes them by more than chance.
    pub(super) fn of(track: &Track, range: Range<usize>, rows: &Rows, direction: Thresholds) -> Option<Self> {
        let n = rows.force_n.len();
        let near = ((NEAR_S / rows.period_s).round() as usize).max(NEAR_ROWS);
        let stays = ((STAYS_S / rows.period_s).round() as usize).max(near);
        if near as f64 * rows.period_s > STAYS_S {
            return None;
        }
        let resting = resting(track, &range, direction).into_iter().flat_map(|at| {
            let row = |at: usize| track.instants[at].row / rows.stride;
            row(at)..if at + 1 < range.end { row(at + 1) } else { row(at) + 1 }
        });
        let jumps: Vec<(usize, f64)> = resting
            .filter(|&at| at >= stays && at + stays <= n && rows.follow(&(at - stays..at + stays)))
            .map(|at| (at, rows.lasting_n(at, near, stays)))
            .collect();
        let &(at, step_n) = jumps.iter().max_by(|left, right| left.1.abs().total_cmp(&right.1.abs()))?;
        let part = |at: usize| at * PARTS / n;
        let mut largest_n = [None; PARTS];
        for (at, jump_n) in &jumps {
            let largest_n = &mut largest_n[part(*at)];
            *largest_n = Some(jump_n.abs().max(largest_n.unwrap_or(rows.resolution_n)));
        }
        // What overlaps it is part of it.
        let others = jumps.iter().filter(|(other, _)| other.abs_diff(at) > 2 * near);
        let (n_others, squares) = others.fold((0.0, 0.0), |(n, sum), (_, jump_n)| (n + 1.0, sum + jump_n * jump_n));
        let stderr_n = f64::sqrt(squares / f64::max(n_others, 1.0) + rows.resolution_n.powi(2) / 12.0);
        let by_chance = libm::erfc(step_n.abs() / stderr_n / std::f64::consts::SQRT_2);
        let chance = (by_chance * jumps.len() as f64 / near as f64 * track.recordings.len() as f64).min(1.0);
        let sharp = near / 3;
        let sharpest = |at: &usize| rows.jump_n(*at, sharp).abs();
        let at = (at - near / 2..=at + near / 2).max_by(|left, right| sharpest(left).total_cmp(&sharpest(right)))?;
        let share = sharpest(&at) / step_n.abs();
        // Where a recording begins, or ends, the force is on its way from, or to, something that nobody sees.
        let is_within = (1..PARTS - 1).contains(&part(at));
        let alone = stands_alone(&largest_n, part(at), step_n.abs());
        (is_within && share > SHARP && alone && chance < CHANCE).then_some(Self {
            instant_s: rows.time_s[at],
            step_n,
            stderr_n,
            chance,
            is_abrupt: share > ABRUPT && sharp as f64 * rows.period_s < ABRUPT_S,
        })
    }
}

/// Instants in `range` of `track` at which no drive moves to either side.
fn resting(track: &Track, range: &Range<usize>, direction: Thresholds) -> Vec<usize> {
    let rests = |at: &usize| {
        let near = &track.instants[at - REST..at + REST];
        let swing = |of: fn(&Instant) -> f64| {
            let (low, high) = coverage::range(near.iter().map(of));
            high - low
        };
        track.counted[at - REST..at + REST].iter().all(|counted| *counted)
            && swing(|instant| instant.moment.pressure_pa) < RINGS * direction.pressure_pa
            && swing(|instant| instant.moment.length_m) < direction.length_m
            && swing(|instant| instant.moment.direction) <= TURNS
    };
    (range.start + REST..(range.end + 1).saturating_sub(REST)).filter(rests).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    use pam_muscle::Muscle;
    use pam_muscle::direction::Standstill;

    const DIRECTION: Thresholds =
        Thresholds { length_m: 2e-5, pressure_pa: 2e3, held_m: 0.0, turn_m: 0.0, standstill: Standstill::AT_ONCE };
    const PERIOD_S: f64 = 0.002;
    const GRID: usize = 10;
    const N: usize = 1500;

    pub(crate) struct Pulsed {
        pub(crate) track: Track,
        pub(crate) muscle: Muscle,
        rows: Rows,
    }

    impl Pulsed {
        pub(crate) fn jump(&self) -> Option<Jump> {
            Jump::of(&self.track, 0..N, &self.rows, DIRECTION)
        }
    }

    /// Half a minute at one length, the pressure higher by 20 kPa every half second, which rings for a while and is followed late, and
    /// what is `added_n` to that at a time.
    pub(crate) fn pulsed(added_n: impl Fn(f64) -> f64) -> Pulsed {
        let Given { mut track, muscle, .. } = Given::of(&["isobaric-triangles"], &[]);
        let ringing_pa = |time_s: f64| 3e4 * (-(time_s % 0.5) / 0.03).exp() * (60.0 * (time_s % 0.5)).cos();
        let pressure_pa = |time_s: f64| 5e4 + 2e4 * (time_s / 0.5).floor() + ringing_pa(time_s);
        let wobble_n = |row: usize| 0.6 * ((row * 7919 % 1013) as f64 / 506.0 - 1.0);
        let force_n = |row: usize| {
            let time_s = PERIOD_S * row as f64;
            1e-3 * (pressure_pa(time_s) - 1.5 * ringing_pa(time_s)) + added_n(time_s) + wobble_n(row)
        };
        let time_s = (0..GRID * N).map(|row| PERIOD_S * row as f64).collect();
        let force_n: Vec<f64> = (0..GRID * N).map(force_n).collect();
        let first = track.instants[0];
        let instant = |at: usize| {
            let mut instant = first;
            instant.row = GRID * at;
            instant.moment.time_s = PERIOD_S * (GRID * at) as f64;
            instant.moment.pressure_pa = pressure_pa(instant.moment.time_s);
            instant.moment.direction = 1.0;
            instant.force_n = force_n[instant.row];
            instant
        };
        track.instants = (0..N).map(instant).collect();
        track.recordings = vec![0..N; 1];
        track.counted = vec![true; N];
        Pulsed { track, muscle, rows: Rows { time_s, force_n, stride: 1, period_s: PERIOD_S, resolution_n: 0.0 } }
    }

    fn stepped(at_s: f64) -> impl Fn(f64) -> f64 {
        move |time_s| if time_s < at_s { 0.0 } else { 9.0 }
    }

    #[test]
    fn a_force_that_jumps_between_two_pulses_is_found_with_its_size() {
        let jump = pulsed(stepped(12.3)).jump().expect("a jump");
        assert!((jump.instant_s - 12.3).abs() < 0.003 && (jump.step_n - 9.0).abs() < 0.5, "{jump:?}");
        assert!(jump.is_abrupt && jump.chance < 1e-6 && jump.stderr_n < 0.5, "{jump:?}");
    }

    #[test]
    fn what_takes_a_few_rows_is_a_jump_but_not_abrupt() {
        let jump = pulsed(|time_s| 9.0 * ((time_s - 12.3) / 0.01).clamp(0.0, 1.0)).jump().expect("a jump");
        assert!(!jump.is_abrupt && (jump.step_n - 9.0).abs() < 1.0, "{jump:?}");
    }

    #[test]
    fn pulses_alone_and_a_force_that_rises_slowly_are_no_jump() {
        assert_eq!(pulsed(|_| 0.0).jump(), None);
        assert_eq!(pulsed(|time_s| 9.0 * ((time_s - 12.3) / 0.06).clamp(0.0, 1.0)).jump(), None);
    }

    #[test]
    fn a_force_that_jumps_and_comes_back_is_no_jump() {
        assert_eq!(pulsed(|time_s| if (12.3..12.34).contains(&time_s) { 9.0 } else { 0.0 }).jump(), None);
    }

    #[test]
    fn a_jump_as_a_pulse_comes_or_as_the_recording_begins_is_not_judged() {
        assert_eq!(pulsed(stepped(12.02)).jump(), None);
        assert_eq!(pulsed(stepped(0.3)).jump(), None);
    }

    #[test]
    fn a_step_of_the_load_cell_is_no_jump() {
        let mut given = pulsed(|_| 0.0);
        given.rows.force_n = given.rows.time_s.iter().map(|time_s| if *time_s < 12.3 { 0.0 } else { 4.0 }).collect();
        assert!(given.jump().is_some());
        given.rows.resolution_n = 4.0;
        assert_eq!(given.jump(), None);
    }

    #[test]
    fn what_is_slower_than_a_jump_can_be_seen_in_is_not_judged() {
        let mut given = pulsed(stepped(12.3));
        given.rows.period_s = 0.021;
        assert_eq!(given.jump(), None);
    }
}
