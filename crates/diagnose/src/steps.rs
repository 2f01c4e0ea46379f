//! Instants at which the residual of a recording may have jumped.

use pam_muscle::motion::Instant;

use crate::coverage;
use crate::state::{Setting, State};

/// Instants per recording that are tried for a difference between all before and all after, and as many for a difference
/// between just before and just after.
const PER_RECORDING: usize = 3;
/// What "just" means, in s.
const NEAR_S: f64 = 1.0;
/// What it means at most for a jump: what takes longer is a change, but none at one instant.
const SHARP_S: f64 = 0.25;

/// Share of the mean square that a step must take away where it is no jump but a slip, which takes up to [`NEAR_S`]: nothing that
/// comes and goes with the motion is made up for by one constant from one instant on. Of the ten slips that this was chosen by eight
/// are named with it, and four without; of 116 healthy and nameless cases none gets a step by it.
const SLIPS: f64 = 0.5;
/// The same of one that takes up to [`LONG_S`].
const SLIPS_SLOWLY: f64 = 0.7;
/// What "just" means for that, in s.
const LONG_S: f64 = 2.5;

/// Whether the residual itself jumps at the instant of a step of `step_n`, and by about as much: whatever drifts instead is no
/// step. One that takes away the share `gained` of the mean square may take longer, as a bond does that slips.
pub(crate) fn is_sudden(setting: &Setting<'_>, residuals_n: &[f64], shape: &[f64], step_n: f64, gained: f64) -> bool {
    let Some(range) = setting.track.recordings.get(shape[0] as usize) else { return false };
    let within = |near_s: f64| {
        let jump_n = jump_n(setting, residuals_n, range.clone(), shape[1], near_s);
        jump_n.is_some_and(|jump_n| jump_n / step_n > 0.6 && jump_n / step_n < 1.7)
    };
    within(NEAR_S) && (gained > SLIPS || within(SHARP_S)) || gained > SLIPS_SLOWLY && within(LONG_S)
}

/// Median residual just after an instant less that just before it, over as many of the nearest instants that count as there are
/// within `near_s`; none where too little of either is within [`NEAR_S`], or within that where it is longer. A median, since friction
/// that turns over beside the instant leaves a spike there which is no jump.
fn jump_n(
    setting: &Setting<'_>,
    residuals_n: &[f64],
    range: std::ops::Range<usize>,
    instant_s: f64,
    near_s: f64,
) -> Option<f64> {
    let instants = &setting.track.instants;
    let apart_s = |at: usize| (instants[at].moment.time_s - instant_s).abs();
    let middle = range.start + instants[range.clone()].partition_point(|instant| instant.moment.time_s < instant_s);
    let median_n = |side: &mut dyn Iterator<Item = usize>| {
        let (mut wanted, mut values_n) = (0_usize, Vec::new());
        for at in side.take_while(|&at| apart_s(at) <= near_s.max(NEAR_S)) {
            wanted += usize::from(apart_s(at) <= near_s);
            if apart_s(at) > near_s && values_n.len() >= wanted {
                break;
            }
            if setting.track.counted[at] {
                values_n.push(residuals_n[at]);
            }
        }
        let middle = values_n.len() / 2;
        (values_n.len() >= 5).then(|| *values_n.select_nth_unstable_by(middle, f64::total_cmp).1)
    };
    let before_n = median_n(&mut (range.start..middle).rev())?;
    Some(median_n(&mut (middle..range.end))? - before_n)
}

/// Time to either side in which a drive that starts, stops or turns may be what made the force jump, in s.
const STIR_S: f64 = 0.3;
/// Shares of the largest speed or rate below which a drive rests, and above which it moves.
const RESTS: f64 = 0.03;
/// See [`RESTS`].
const MOVES: f64 = 0.15;

/// Where within `range` a drive starts or stops, or friction turns over, nearby.
fn stirred(setting: &Setting<'_>, range: std::ops::Range<usize>) -> Vec<bool> {
    let instants = &setting.track.instants[range];
    let channels: [fn(&Instant) -> f64; 2] =
        [|instant| instant.moment.speed_m_per_s.abs(), |instant| instant.moment.pressure_rate_pa_per_s.abs()];
    let largest = channels.map(|channel| instants.iter().map(channel).fold(0.0, f64::max));
    let (mut first, mut end) = (0, 0);
    let mut stirred = Vec::with_capacity(instants.len());
    for instant in instants {
        let time_s = instant.moment.time_s;
        while instants[first].moment.time_s < time_s - STIR_S {
            first += 1;
        }
        while end < instants.len() && instants[end].moment.time_s <= time_s + STIR_S {
            end += 1;
        }
        let near = &instants[first..end];
        let range_of = |value: &dyn Fn(&Instant) -> f64| coverage::range(near.iter().map(value));
        let starts = channels.iter().zip(largest).any(|(channel, largest)| {
            let (low, high) = range_of(channel);
            low < RESTS * largest && high > MOVES * largest
        });
        let (low, high) = range_of(&|instant| instant.moment.direction);
        stirred.push(starts || high - low > 0.5);
    }
    stirred
}

/// How many times larger than near any other start, stop or turn of the same recording a jump has to be to be one of its own:
/// whatever friction or a drive does at one of them, it does at the others too.
const ALONE: f64 = 3.0;
/// Parts that a recording is cut into for that comparison, and of how many of them a start, stop or turn is needed for one.
pub(crate) const PARTS: usize = 20;
/// See [`PARTS`].
const OTHERS: usize = 4;
/// Parts from which on one of them may jump as much: where a recording begins, friction is as something before it left it.
const MANY: usize = 8;

/// Share by which two jumps differ that are the same one, seen from either side.
const SAME: f64 = 0.05;

/// Whether a jump of `own_n` in the given part stands alone among the largest of the parts in which drives stir, or rest, at all; its
/// neighbours do not count, for it may reach into them.
pub(crate) fn stands_alone(largest_n: &[Option<f64>; PARTS], part: usize, own_n: f64) -> bool {
    let elsewhere = |other: usize| if other.abs_diff(part) > 1 { largest_n[other] } else { None };
    let jumps_n: Vec<f64> = (0..PARTS).filter_map(elsewhere).collect();
    // One that comes between two parts is seen in both.
    let is_seen_before = |other: usize| {
        let (Some(jump_n), Some(before_n)) = (elsewhere(other), other.checked_sub(1).and_then(elsewhere)) else {
            return false;
        };
        (jump_n / before_n - 1.0).abs() < SAME
    };
    let is_as_large = |other: usize| elsewhere(other).is_some_and(|jump_n| own_n <= ALONE * jump_n);
    let as_large = (0..PARTS).filter(|&other| is_as_large(other) && !is_seen_before(other)).count();
    jumps_n.len() >= OTHERS && as_large <= usize::from(jumps_n.len() >= MANY)
}

/// Shapes (recording, instant in s) of the most likely steps: where the two sides of a cut differ most in their mean.
pub(crate) fn shapes(setting: &Setting<'_>, state: &State) -> Vec<Vec<f64>> {
    let residuals = setting.residuals_n(state);
    let mut shapes = Vec::new();
    for (index, range) in setting.track.recordings.iter().enumerate() {
        let counted: Vec<usize> = range.clone().filter(|&at| setting.track.counted[at]).collect();
        let n = counted.len();
        if n < 40 {
            continue;
        }
        let stirred = stirred(setting, range.clone());
        let total: f64 = counted.iter().map(|&at| residuals[at]).sum();
        let mut gains = Vec::with_capacity(n);
        let mut sum = 0.0;
        for (position, &at) in counted.iter().enumerate() {
            let (left, right) = (position as f64, (n - position) as f64);
            let gain = if position >= n / 20 && position + n / 20 < n {
                let difference = sum / left - (total - sum) / right;
                difference * difference * left * right / n as f64
            } else {
                0.0
            };
            gains.push((gain, position));
            sum += residuals[at];
        }
        let jump_at = |at: usize, near_s: f64| {
            let instant_s = setting.track.instants[at].moment.time_s;
            jump_n(setting, &residuals, range.clone(), instant_s, near_s).unwrap_or(0.0).abs()
        };
        let jumps: Vec<(f64, usize)> =
            counted.iter().enumerate().step_by(5).map(|(position, &at)| (jump_at(at, NEAR_S), position)).collect();
        let part = |position: usize| position * PARTS / n;
        let mut largest_n = [None; PARTS];
        for position in (0..n).step_by(5).filter(|&position| stirred[counted[position] - range.start]) {
            let largest_n = &mut largest_n[part(position)];
            *largest_n = Some(jump_at(counted[position], SHARP_S).max(largest_n.unwrap_or(0.0)));
        }
        for mut ranked in [gains, jumps] {
            let mut taken: Vec<usize> = Vec::new();
            ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            for (gain, position) in ranked {
                if taken.len() == PER_RECORDING || gain <= 0.0 {
                    break;
                }
                let at = counted[position];
                if stirred[at - range.start] && !stands_alone(&largest_n, part(position), jump_at(at, SHARP_S)) {
                    continue;
                }
                if taken.iter().all(|&other| other.abs_diff(position) > n / 20) {
                    taken.push(position);
                    shapes.push(vec![index as f64, setting.track.instants[at].moment.time_s]);
                }
            }
        }
    }
    shapes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rehearsal::tests::Given;

    /// Recordings whose force is higher by 5 N from the middle of the first on; over so many seconds, or at once.
    fn stepped(over_s: f64) -> (Given, f64) {
        let mut given = Given::of(&["multisine"], &[]);
        let range = given.track.recordings[0].clone();
        let middle_s = given.track.instants[range.start + range.len() / 2].moment.time_s;
        for instant in &mut given.track.instants[range] {
            let share = ((instant.moment.time_s - middle_s) / f64::max(over_s, 1e-9)).clamp(0.0, 1.0);
            instant.force_n += 5.0 * share;
        }
        (given, middle_s)
    }

    #[test]
    fn a_force_that_jumps_is_found_at_its_instant_and_is_sudden() {
        let (given, middle_s) = stepped(0.0);
        let setting = given.setting();
        let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let found = shapes(&setting, &state);
        let nearest = found.iter().filter(|shape| shape[0] == 0.0).map(|shape| (shape[1] - middle_s).abs());
        assert!(nearest.fold(f64::INFINITY, f64::min) < 1.0, "{middle_s} {found:?}");
        assert!(is_sudden(&setting, &setting.residuals_n(&state), &[0.0, middle_s], 5.0, 0.2));
    }

    #[test]
    fn a_force_that_rises_over_ten_seconds_is_no_step() {
        let (given, middle_s) = stepped(10.0);
        let setting = given.setting();
        let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        for gained in [0.2, 0.9] {
            assert!(!is_sudden(&setting, &setting.residuals_n(&state), &[0.0, middle_s], 5.0, gained));
        }
    }

    #[test]
    fn a_force_that_slips_is_one_where_it_is_the_more_of_what_is_left_the_longer_it_takes() {
        for (takes_s, too_little, enough) in [(0.8, 0.4, 0.6), (2.0, 0.6, 0.8)] {
            let (given, middle_s) = stepped(takes_s);
            let setting = given.setting();
            let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
            let residuals_n = setting.residuals_n(&state);
            let is_one = |gained| is_sudden(&setting, &residuals_n, &[0.0, middle_s + 0.5 * takes_s], 5.0, gained);
            assert!(!is_one(too_little) && is_one(enough), "{takes_s}");
        }
    }

    #[test]
    fn a_jump_between_two_parts_is_one_and_not_two() {
        let mut largest_n = [Some(1.0); PARTS];
        (largest_n[3], largest_n[4]) = (Some(3.0), Some(3.02));
        assert!(stands_alone(&largest_n, 10, 3.5));
        largest_n[4] = Some(2.0);
        assert!(!stands_alone(&largest_n, 10, 3.5));
    }

    #[test]
    fn a_jump_that_is_larger_than_at_any_other_turn_stands_alone() {
        let mut largest_n = [None; PARTS];
        for part in [2, 5, 9, 14] {
            largest_n[part] = Some(1.0);
        }
        assert!(stands_alone(&largest_n, 17, 3.5) && !stands_alone(&largest_n, 17, 2.5));
        // Too few others, and what it may reach into.
        assert!(!stands_alone(&largest_n, 5, 3.5));
        largest_n[18] = Some(3.4);
        assert!(stands_alone(&largest_n, 17, 3.5));
    }

    #[test]
    fn of_many_turns_one_may_jump_as_much() {
        // Where a recording begins, say.
        let mut largest_n = [Some(1.0); PARTS];
        largest_n[0] = Some(3.0);
        assert!(stands_alone(&largest_n, 10, 3.5));
        largest_n[4] = Some(3.0);
        assert!(!stands_alone(&largest_n, 10, 3.5));
        let mut few = [None; PARTS];
        (few[0], few[3], few[6], few[9], few[12]) = (Some(3.0), Some(1.0), Some(1.0), Some(1.0), Some(1.0));
        assert!(!stands_alone(&few, 16, 3.5));
    }

    #[test]
    fn a_spike_beside_an_instant_is_no_jump() {
        let (given, middle_s) = stepped(0.0);
        let setting = given.setting();
        let state = setting.fit(Vec::new(), &given.start, &given.model).expect("a fit");
        let mut residuals_n = setting.residuals_n(&state);
        let range = given.track.recordings[0].clone();
        let jump_n =
            |residuals_n: &[f64]| jump_n(&setting, residuals_n, range.clone(), middle_s, NEAR_S).expect("both sides");
        let before_n = jump_n(&residuals_n);
        // A tenth of a second in which friction turned over late.
        let late = |at: &usize| (given.track.instants[*at].moment.time_s - middle_s + 0.3).abs() < 0.05;
        range.clone().filter(late).for_each(|at| residuals_n[at] += 40.0);
        assert!((jump_n(&residuals_n) - before_n).abs() < 0.5, "{before_n} {}", jump_n(&residuals_n));
    }

    #[test]
    fn where_a_drive_starts_no_step_is_looked_for() {
        let (given, _) = stepped(0.0);
        let setting = given.setting();
        let range = given.track.recordings[0].clone();
        let stirred = stirred(&setting, range.clone());
        let turns = range
            .clone()
            .skip(1)
            .filter(|&at| given.track.instants[at].moment.direction != given.track.instants[at - 1].moment.direction);
        let (mut n, mut all) = (0, true);
        for at in turns {
            n += 1;
            all &= stirred[at - range.start];
        }
        assert!(n > 0 && all);
    }
}
