//! State of friction along rows without a gap: what the play on the length, the pressure at a standstill and the travel since
//! a turn say of it.

use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

use super::rest::{held, never_rests, pushed, standstills};
use super::slow_turn::SlowTurn;
use super::thresholds::{Driver, Standstill, Thresholds};
use super::travel::{Path, turn_over, turns_of};
use super::turn::{NOISE, Turn};

/// Length of the moving average, in s; at least five samples and at most 101 are averaged.
pub const WINDOW_S: f64 = 0.05;

/// Most that friction which sticks is of what a motion would give it at the same pressure. Of eight looked-at muscles in which it sticks eq. 11
/// leaves up to 6 % more with three times in the place of five, and as much, to 1 %, with ten.
pub const STICKS_UP_TO: f64 = 5.0;
/// Gauge pressure below which friction that sticks changes no more, in Pa: hardly anything presses the strands together.
pub const STICKS_FROM_PA: f64 = 1e3;

/// Between what the state of friction must lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bounds {
    low: f64,
    high: f64,
}

impl Bounds {
    #[cfg(test)]
    pub(super) const UNKNOWN: Self = Self { low: -1.0, high: 1.0 };
    /// Bounds that are closer than this are a state.
    const CLOSE: f64 = 0.2;

    pub(super) fn at(state: f64) -> Self {
        Self { low: state, high: state }
    }

    pub(super) fn between(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    pub(super) fn ends(self) -> (f64, f64) {
        (self.low, self.high)
    }

    pub(super) fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }

    pub(super) fn is_known(self) -> bool {
        self.high - self.low < Self::CLOSE
    }

    /// The sign where it is certain, 0 elsewhere.
    pub(super) fn sign(self) -> i8 {
        if self.is_known() { self.middle().signum() as i8 } else { 0 }
    }

    /// After the friction has slid by `by`, in units of its range from 0 to 1, up to `share` of it.
    fn slid(self, by: f64, share: f64) -> Self {
        let slid = |state: f64| {
            if by > 0.0 { (state + by).min(share).max(state) } else { (state + by).max(-share).min(state) }
        };
        Self { low: slid(self.low), high: slid(self.high) }
    }

    /// A share of it.
    fn relaxed(self, share: f64) -> Self {
        Self { low: share * self.low, high: share * self.high }
    }

    /// After the pressure has gone from one value to another, in Pa, beside a friction that stays the force it was. That is so of the
    /// bladder's friction on the strands, which goes with the pressure at one length; of that between strands, with its 5/3rd power, the force
    /// still changes with the 2/3rd.
    fn stuck(self, from_pa: f64, to_pa: f64) -> Self {
        let times = from_pa.max(STICKS_FROM_PA) / to_pa.max(STICKS_FROM_PA);
        let stuck = |state: f64| (times * state).clamp(-STICKS_UP_TO, STICKS_UP_TO);
        Self { low: stuck(self.low), high: stuck(self.high) }
    }
}

/// State of friction at one row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct State {
    pub(super) bounds: Bounds,
    pub(super) is_settled: bool,
}

/// Consecutive rows without a gap, and what they say whatever friction does at a standstill.
pub(super) struct Stretch<'a> {
    time_s: &'a [f64],
    pressure_pa: &'a [f64],
    period_s: f64,
    thresholds: Thresholds,
    driver: Driver,
    shortening: Vec<f64>,
    /// Moving averages, and half of their window in rows.
    contraction: Vec<f64>,
    pressure: Vec<f64>,
    half: usize,
    resting: Vec<Range<usize>>,
    /// Where in them the length rests, without the motions on either side.
    held: Vec<Range<usize>>,
    /// Where in them the pressure moves while it does.
    pushed: Vec<Range<usize>>,
    /// Half of the window that a slow-down is measured against, in rows: within as many a turn lies.
    long: usize,
    /// Paths by their turns, which most laws have in common.
    paths: Mutex<Vec<(Vec<usize>, Arc<Path>)>>,
}

impl<'a> Stretch<'a> {
    /// Of at least two rows. Of `thresholds`, the plays count.
    pub(super) fn of(
        time_s: &'a [f64],
        pressure_pa: &'a [f64],
        length_m: &'a [f64],
        thresholds: Thresholds,
        driver: Driver,
    ) -> Self {
        let n = time_s.len();
        let period_s = (time_s[n - 1] - time_s[0]) / (n - 1) as f64;
        let half = ((0.5 * WINDOW_S / period_s).round() as usize).clamp(2, 50);
        let long = long_window(period_s, half);
        let pressure = moving_average(pressure_pa, half);
        let nothing = || (Vec::new(), Vec::new());
        let ((shortening, contraction), [resting, held, pushed]) = match driver {
            Driver::Pressure => (nothing(), [const { Vec::new() }; 3]),
            Driver::Motion => {
                let shortening: Vec<f64> = length_m.iter().map(|length| -length).collect();
                let contraction = moving_average(&shortening, half);
                let (play_m, noise_m) = (thresholds.length_m, NOISE * thresholds.length_m);
                let mut resting = standstills(time_s, &contraction, play_m);
                let most = SlowTurn::longest(period_s);
                resting.retain(|still| {
                    !never_rests(&shortening[still.clone()], play_m, noise_m)
                        && !SlowTurn::is_at(&shortening, still, most, noise_m)
                });
                // Deviation of an average of the length at rest.
                let noise_m = noise_m / ((2 * half + 1) as f64).sqrt();
                let push = |index| pushed(&resting, index, &contraction, noise_m, &pressure, thresholds.pressure_pa);
                let pushed = (0..resting.len()).filter_map(push).collect();
                let held = resting.iter().map(|still| held(still, &contraction, noise_m));
                let held = held.filter(|held| !held.is_empty()).collect();
                ((shortening, contraction), [resting, held, pushed])
            }
        };
        Self {
            time_s,
            pressure_pa,
            period_s,
            thresholds,
            driver,
            shortening,
            contraction,
            pressure,
            half,
            resting,
            held,
            pushed,
            long,
            paths: Mutex::default(),
        }
    }

    /// States under a law of `standstill`, after the state `carried`, before friction takes its travels to turn over.
    pub(super) fn states(&self, standstill: Standstill, carried: Bounds) -> Vec<State> {
        let Self { half, thresholds, pressure, .. } = self;
        let mut marks = vec![0; self.time_s.len()];
        if self.driver == Driver::Pressure {
            play(pressure, self.pressure_pa, thresholds.pressure_pa, *half, carried.sign(), &mut marks);
            return from_marks(&marks, carried);
        }
        play(&self.contraction, &self.shortening, thresholds.length_m, *half, carried.sign(), &mut marks);
        let follows = matches!(standstill, Standstill::Slides { over_pa, share }
            if over_pa <= 2.0 * thresholds.pressure_pa && share >= 1.0);
        if follows {
            for still in &self.pushed {
                let rest = self.resting.iter().find(|rest| rest.contains(&still.start)).unwrap_or(still);
                let before = if still.start > 0 { marks[still.start - 1].signum() } else { carried.sign() };
                let (smooth, raw) = (&pressure[still.clone()], &self.pressure_pa[still.clone()]);
                marks[still.clone()].fill(0);
                play(smooth, raw, thresholds.pressure_pa, *half, before, &mut marks[still.clone()]);
                keep(still.end, rest.end + 2 * half, before, &mut marks);
            }
        }
        let slow = Slow { contraction: &self.contraction, pressure, half: *half, long: self.long };
        slow.doubt(&self.resting, *thresholds, &mut marks);
        let mut states = from_marks(&marks, carried);
        if !follows && standstill.is_moved() {
            for still in self.moved(standstill) {
                let before = if still.start > 0 { states[still.start - 1].bounds } else { carried };
                let along = (&self.time_s[still.clone()], &pressure[still.clone()]);
                rest(along, standstill, before, &mut states[still.clone()]);
                let after = states[still.end - 1];
                let unmoved = marks[still.end..].iter().take_while(|mark| **mark == 0).count();
                states[still.end..still.end + unmoved].fill(after);
            }
        }
        states
    }

    /// Where friction moves at a standstill under a law of `standstill`.
    fn moved(&self, standstill: Standstill) -> &[Range<usize>] {
        match standstill {
            Standstill::Held => &[],
            Standstill::Relaxes { .. } => &self.held,
            Standstill::Sticks | Standstill::Slides { .. } => &self.pushed,
        }
    }

    /// The path along which friction turns over after the turns of `states`; none where no length says how it does.
    pub(super) fn path(&self, states: &[State]) -> Option<Arc<Path>> {
        if self.driver == Driver::Pressure {
            return None;
        }
        let turns = turns_of(states, &self.pushed);
        let paths = || self.paths.lock().unwrap_or_else(PoisonError::into_inner);
        let known = paths().iter().find(|(of, _)| *of == turns).map(|(_, path)| Arc::clone(path));
        Some(known.unwrap_or_else(|| {
            let path = Path::of(self.time_s, self.period_s, &self.shortening, self.thresholds, &turns, &self.resting);
            let path = Arc::new(path);
            paths().push((turns, Arc::clone(&path)));
            path
        }))
    }

    /// `states`, which came after `carried`, where friction turns over along `path` within the travels of `thresholds`.
    pub(super) fn turned(
        &self,
        states: &[State],
        path: Option<&Path>,
        thresholds: Thresholds,
        carried: Bounds,
    ) -> Vec<State> {
        let mut states = states.to_vec();
        if let Some(path) = path {
            turn_over(path, thresholds, self.long, carried, self.moved(thresholds.standstill), &mut states);
        }
        states
    }
}

/// Lets what the pressure has made of friction before row `from` last until the length turns, or moves at all; `before` is the
/// sign before the push, which the length says up to a turn. A turn beyond `until` has nothing to do with it.
fn keep(from: usize, until: usize, before: i8, marks: &mut [i8]) {
    let last = marks[from - 1].signum();
    let after = &mut marks[from..];
    let turn = after.iter().position(|mark| mark.signum() != before).unwrap_or(after.len());
    let turn = if from + turn < until { turn } else { 0 };
    after[..turn].fill(last);
    after[turn..].iter_mut().take_while(|mark| **mark == 0).for_each(|mark| *mark = last);
}

/// What marks say, with `carried` before the first motion.
fn from_marks(marks: &[i8], carried: Bounds) -> Vec<State> {
    let state = |&mark: &i8| match mark {
        0 => State { bounds: carried, is_settled: true },
        _ => State { bounds: Bounds::at(f64::from(mark.signum())), is_settled: mark.abs() < 2 },
    };
    marks.iter().map(state).collect()
}

/// Friction at a standstill along `time_s` and the smooth `pressure`. Where it slides it is a stop that gives way from one sign to the
/// other, and what it was before the standstill need not be known: once the pressure has moved far enough, it is. Where it sticks, the less
/// the pressure is the more of what that would give it is left; where it relaxes, less and less is left of what it was `before`.
pub(super) fn rest((time_s, pressure): (&[f64], &[f64]), standstill: Standstill, before: Bounds, states: &mut [State]) {
    let mut bounds = before;
    let mut last_pa = pressure[0];
    for (state, (&now_s, &pressure_pa)) in states.iter_mut().zip(time_s.iter().zip(pressure)) {
        bounds = match standstill {
            Standstill::Held => bounds,
            Standstill::Sticks => bounds.stuck(last_pa, pressure_pa),
            Standstill::Relaxes { time_constant_s, to } => {
                before.relaxed(to + (1.0 - to) * (-(now_s - time_s[0]) / time_constant_s).exp())
            }
            Standstill::Slides { over_pa, share } => bounds.slid(2.0 * (pressure_pa - last_pa) / over_pa, share),
        };
        last_pa = pressure_pa;
        *state = State { bounds, is_settled: true };
    }
}

/// Half of the window that a slow-down is measured against, in s.
const LONG_S: f64 = 0.25;

/// The same in rows; never shorter than twice the moving average.
fn long_window(period_s: f64, half: usize) -> usize {
    ((LONG_S / period_s).round() as usize).clamp(2 * half, 500)
}

/// Where a motion slows down so far that it may have turned for a moment without passing the threshold, or rests for
/// less than a standstill while the pressure works against its direction: no channel tells the direction there.
struct Slow<'a> {
    contraction: &'a [f64],
    pressure: &'a [f64],
    half: usize,
    long: usize,
}

impl Slow<'_> {
    /// Unsettles such rows.
    fn doubt(&self, resting: &[Range<usize>], thresholds: Thresholds, marks: &mut [i8]) {
        let n = self.contraction.len();
        if n <= 2 * self.long {
            return;
        }
        // A difference of two averages has this deviation.
        let noise = NOISE * thresholds.length_m * (2.0 / (2 * self.half + 1) as f64).sqrt();
        let mut stills = resting.iter().peekable();
        for (row, mark) in marks.iter_mut().enumerate().take(n - self.long).skip(self.long) {
            while stills.next_if(|still| still.end <= row).is_some() {}
            if mark.abs() != 1 || stills.peek().is_some_and(|still| still.contains(&row)) {
                continue;
            }
            let sign = f64::from(*mark);
            let moved = |reach: usize| sign * (self.contraction[row + reach] - self.contraction[row - reach]);
            let (near, far) = (moved(self.half), moved(self.long));
            let doubtful = if far > 3.0 * noise {
                near < 3.0 * noise && near / (self.half as f64) < 0.25 * far / self.long as f64
            } else {
                sign * (self.pressure[row + self.long] - self.pressure[row - self.long]) < -thresholds.pressure_pa
            };
            if doubtful {
                *mark *= 2;
            }
        }
    }
}

/// Centered average over `2 half + 1` values, over fewer and still centered at the ends.
pub(super) fn moving_average(values: &[f64], half: usize) -> Vec<f64> {
    // Sums relative to the first value, so that a long recording loses no digits.
    let origin = values[0];
    let mut sums = Vec::with_capacity(values.len() + 1);
    let mut sum = 0.0;
    sums.push(0.0);
    for &value in values {
        sum += value - origin;
        sums.push(sum);
    }
    (0..values.len())
        .map(|index| {
            let reach = half.min(index).min(values.len() - 1 - index);
            origin + (sums[index + reach + 1] - sums[index - reach]) / (2 * reach + 1) as f64
        })
        .collect()
}

/// The play operator on `smooth` with flips dated back to where the motion turned. `marks` becomes ±1, ±2 around
/// a flip, and 0 before the first motion if `carried` is 0.
///
/// A flip is noticed at `f`, one threshold away from the extreme. The last value half a threshold away, at `d`,
/// tells the speed of the return, and going on backwards at that speed reaches the turn at
/// `d - (f - d)`. After a hold that is the end of the hold, where the extreme itself is any peak of the noise.
/// A turn that accelerates, as a sine does, lies up to `1.6 (f - d)` earlier, and noise makes `f - d` too short;
/// twice that before is unsettled, and half a moving average more on either side.
fn play(smooth: &[f64], raw: &[f64], threshold: f64, half: usize, carried: i8, marks: &mut [i8]) {
    let Some(&first) = smooth.first() else { return };
    let mut sign = carried;
    // Both extremes while the direction is unknown; only the leading one counts afterwards.
    let (mut high, mut high_at) = (first, 0);
    let (mut low, mut low_at) = (first, 0);
    let mut last_turn = 0;
    let mut unsettled_until = 0;
    for (index, &value) in smooth.iter().enumerate() {
        if value > high {
            (high, high_at) = (value, index);
        }
        if value < low {
            (low, low_at) = (value, index);
        }
        let turned = match sign {
            0 if high - low > threshold => Some(if high_at > low_at { 1 } else { -1 }),
            1 if high - value > threshold => Some(-1),
            -1 if value - low > threshold => Some(1),
            _ => None,
        };
        marks[index] = if index < unsettled_until { 2 * sign } else { sign };
        let Some(new_sign) = turned else {
            if sign > 0 && value >= high {
                (low, low_at) = (value, index);
            } else if sign < 0 && value <= low {
                (high, high_at) = (value, index);
            }
            continue;
        };
        let (extreme, extreme_at) = if new_sign > 0 { (low, low_at) } else { (high, high_at) };
        let near = |value: f64| (value - extreme).abs() <= 0.5 * threshold;
        let departed = (extreme_at..index).rev().find(|&at| near(smooth[at])).unwrap_or(extreme_at);
        let took = index - departed;
        let mut turn = departed.saturating_sub(took).max(extreme_at);
        let mut noticed = index;
        let mut doubtful = turn.saturating_sub(3 * took + half).max(last_turn);
        if took <= half {
            // Faster than the average follows: the average smears the start, the raw values show it.
            let start = (extreme_at..raw.len().min(index + half)).rev().find(|&at| near(raw[at])).unwrap_or(turn);
            turn = start.max(turn);
            noticed = noticed.max(turn);
        }
        let mut settled_from = noticed + half;
        if sign != 0
            && let reach = (index.saturating_sub(turn).max(half) + half).min(turn - last_turn)
            && let Some(found) = Turn::of(raw, turn.min(index), reach, new_sign, threshold)
        {
            turn = found.row.clamp(last_turn, index);
            // Within two deviations of the noise of the length from where it turned nobody knows which way it went.
            let within = |row: &usize| (smooth[*row] - smooth[turn]).abs() < 2.0 * NOISE * threshold;
            let most = 3 * took + half;
            let before = (last_turn..turn).rev().take_while(within).take(most).count();
            let after = (turn..index).take_while(within).take(most).count();
            doubtful = turn.saturating_sub(found.doubt.max(before)).max(last_turn);
            settled_from = turn + found.doubt.max(after);
        }
        last_turn = turn.min(index);
        if sign == 0 {
            // The first motion: there is no other direction that it could be taken for. One that is dated within the
            // average of the beginning began there.
            let from = if last_turn <= 2 * half { 0 } else { last_turn };
            marks[from..=index].fill(new_sign);
        } else {
            for mark in &mut marks[doubtful.min(last_turn)..last_turn] {
                *mark = 2 * mark.signum();
            }
            for (row, mark) in marks.iter_mut().enumerate().take(index + 1).skip(last_turn) {
                *mark = if row < settled_from { 2 * new_sign } else { new_sign };
            }
            unsettled_until = settled_from;
        }
        sign = new_sign;
        (high, high_at, low, low_at) = (value, index, value, index);
    }
}

#[cfg(test)]
mod tests;
