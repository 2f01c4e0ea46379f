//! How friction turns over along the travel after a turn, and the path that this travel is taken from.

use std::ops::Range;

use super::rest::rests_within;
use super::slow_turn::SlowTurn;
use super::states::{Bounds, State};
use super::thresholds::Thresholds;
use super::turn::{NOISE, is_across};
use crate::smoothing::{Sliding, Window};

/// Deviation that is left in the path that friction turns over on, in m, where the window allows: less than strands give.
const PATH_M: f64 = 4e-6;
/// Longest half of that window, in s: half a period of what a muscle does.
const PATH_S: f64 = 0.15;

/// Rows at which the length turns as the signs of `states` say; none where the pressure turns friction over.
pub(super) fn turns_of(states: &[State], pushed: &[Range<usize>]) -> Vec<usize> {
    let is_pushed = |row: usize| pushed.iter().any(|still| still.start <= row && row <= still.end);
    let is_turn = |row: &usize| {
        let [before, after] = [*row - 1, *row].map(|row| states[row].bounds.sign());
        before != after && !is_pushed(*row)
    };
    (1..states.len()).filter(is_turn).collect()
}

/// How a path is smooth around a turn.
struct Bend {
    row: usize,
    /// Rows to either side that a parabola goes over.
    half: usize,
    /// Whether none goes across the turn.
    is_split: bool,
}

impl Bend {
    /// Rows to either side of the shortest parabola.
    const LEAST_HALF: usize = 4;

    /// Around `row` of `shortening`, where a parabola over `half` rows to either side is as long as the noise needs: the longest that
    /// describes the turn, across it or, where it is a corner, up to it from both sides.
    fn of(shortening: &[f64], row: usize, half: usize, noise_m: f64) -> Self {
        let is_described = |from: usize, at: usize, to: usize| {
            let to = to.min(shortening.len());
            to - from < 2 * Self::LEAST_HALF || !is_across(&shortening[from..to], at - from, noise_m)
        };
        let mut half = half;
        loop {
            let (before, after) = (row.saturating_sub(half), row + half + 1);
            let is_smooth = is_described(before, row, after);
            let is_split = !is_smooth
                && is_described(row.saturating_sub(2 * half + 1), before, row)
                && is_described(row, after.min(shortening.len()), row + 2 * half + 1);
            if is_smooth || is_split || half <= Self::LEAST_HALF {
                return Self { row, half, is_split };
            }
            half = (half / 2).max(Self::LEAST_HALF);
        }
    }
}

/// Travels along which friction turns over.
pub(super) struct Path {
    /// In m.
    travels_m: Vec<f64>,
    /// Deviation that is left in them, in m.
    noise_m: f64,
    /// Slow turns, in order.
    slow_turns: Vec<SlowTurn>,
}

impl Path {
    /// Deviations of the noise of a path that rests within. With half of it eq. 11 leaves as much of 320 cases of other worlds, to a percent in
    /// the mean, and with twice of it 1 % less of healthy muscles and 1 to 2 % more where something is concealed that is no single effect.
    const RESTS: f64 = 2.0;
    /// Deviations by which it came from elsewhere, twice as long before its farthest point as it takes to leave it. With half or twice of
    /// it eq. 11 leaves as much of them, to half a percent.
    const CAME: f64 = 4.0;

    /// `shortening` as parabolas describe it, over windows as long as its noise needs and as short as its `turns` do: one that goes
    /// across a turn that it does not describe, such as a corner, has its vertex elsewhere.
    pub(super) fn of(
        time_s: &[f64],
        period_s: f64,
        shortening: &[f64],
        thresholds: Thresholds,
        turns: &[usize],
        resting: &[Range<usize>],
    ) -> Self {
        let n_rows = shortening.len();
        let noise_m = NOISE * thresholds.length_m;
        // A parabola over n values leaves 2.25 / n of the variance in the middle one.
        let n = 2.25 * (noise_m / PATH_M).powi(2);
        let longest = Window::over(time_s, (0.5 * n * period_s).min(PATH_S)).half;
        let bends: Vec<Bend> = turns.iter().map(|&turn| Bend::of(shortening, turn, longest, noise_m)).collect();
        // The next split at or after every turn, and after the last.
        let mut ends = vec![n_rows; bends.len() + 1];
        for (index, bend) in bends.iter().enumerate().rev() {
            ends[index] = if bend.is_split { bend.row } else { ends[index + 1] };
        }
        let mut travels_m = Vec::with_capacity(n_rows);
        // Rows between two splits, one window after the other.
        let mut from = 0;
        for (index, to) in ends.into_iter().enumerate() {
            let (before, after) = (index.checked_sub(1).map(|index| &bends[index]), bends.get(index));
            if let Some(bend) = before.filter(|bend| bend.is_split) {
                from = bend.row;
            }
            let half = before.into_iter().chain(after).fold(longest, |half, bend| half.min(bend.half));
            let piece = &shortening[from..to];
            let half = half.min((piece.len().max(1) - 1) / 2);
            let window = Window::over(&time_s[from..to], half as f64 * period_s);
            let mut sliding = Sliding::along(&window, piece);
            let rows = before.map_or(0, |bend| bend.row)..after.map_or(n_rows, |bend| bend.row);
            travels_m.extend(rows.map(|row| sliding.value(row - from)));
        }
        let slow_turns = slow_turns(shortening, turns, &bends, (longest, SlowTurn::longest(period_s)), noise_m);
        for turn in &slow_turns {
            turn.rows.clone().for_each(|row| travels_m[row] = turn.at(row));
        }
        let white_m = 1.5 * noise_m / ((2 * longest + 1) as f64).sqrt();
        let noise_m = white_m.max(wanders_m(&travels_m, resting));
        Self { travels_m, noise_m, slow_turns }
    }

    /// Vertex of the slow turn around `row` that goes the way of `way`, not before row `from`, and the travel there; none where no slow one is.
    fn leaves_slowly(&self, row: usize, from: usize, way: f64) -> Option<(usize, f64)> {
        let is_here = |turn: &&SlowTurn| turn.way == way && from <= turn.vertex && turn.rows.contains(&row);
        self.slow_turns.iter().find(is_here).map(|turn| (turn.vertex, self.travels_m[turn.vertex]))
    }

    /// Where within `rows` it leaves its farthest point to go the way of `way`, and the travel there.
    fn leaves(&self, rows: Range<usize>, way: f64) -> Option<(usize, f64)> {
        let ahead_m = |row: usize| way * self.travels_m[row];
        let farthest = rows.clone().min_by(|&one, &other| ahead_m(one).total_cmp(&ahead_m(other)))?;
        let within = |&row: &usize| ahead_m(row) <= ahead_m(farthest) + Self::RESTS * self.noise_m;
        let last = rows.clone().rev().find(within)?;
        // A path that came from there as it goes has its vertex at the farthest point; one that rested leaves at the end of the rest,
        // where the farthest point is any peak of the noise.
        let took = last - farthest;
        let before = farthest.checked_sub(2 * took).filter(|before| took > 0 && rows.contains(before));
        if before.is_some_and(|before| ahead_m(before) - ahead_m(farthest) > Self::CAME * self.noise_m) {
            return Some((farthest, self.travels_m[farthest]));
        }
        let rested = &self.travels_m[farthest..=last];
        Some((last, rested.iter().sum::<f64>() / rested.len() as f64))
    }
}

/// Those of `turns` that are slow and no corners, described no farther than halfway to the turns on either side, over halves between the
/// two of `halves`, in rows.
fn slow_turns(
    shortening: &[f64],
    turns: &[usize],
    bends: &[Bend],
    halves: (usize, usize),
    noise_m: f64,
) -> Vec<SlowTurn> {
    let around = |(index, bend): (usize, &Bend)| {
        if bend.is_split {
            return None;
        }
        let before = index.checked_sub(1).map_or(0, |before| turns[before].midpoint(bend.row));
        let after = turns.get(index + 1).map_or(shortening.len(), |&after| after.midpoint(bend.row));
        SlowTurn::around(shortening, bend.row, &(before..after), halves, noise_m)
    };
    bends.iter().enumerate().filter_map(around).collect()
}

/// Deviation of `travels_m` in the middle half of every standstill, the middle one of all; zero without any. White noise is averaged away
/// along a path, other noise is not.
fn wanders_m(travels_m: &[f64], resting: &[Range<usize>]) -> f64 {
    let mut deviations_m: Vec<f64> = resting.iter().map(|still| rests_within(travels_m, still).1).collect();
    deviations_m.sort_by(f64::total_cmp);
    deviations_m.get(deviations_m.len() / 2).copied().unwrap_or(0.0)
}

/// Lets the states follow the travel along `path` after every turn, as `thresholds` say; over the stretches `pushed` the
/// pressure moves them. A turn is where the path leaves its farthest point, within `reach` rows of where the sign changes.
pub(super) fn turn_over(
    path: &Path,
    thresholds: Thresholds,
    reach: usize,
    carried: Bounds,
    pushed: &[Range<usize>],
    states: &mut [State],
) {
    let mut ways: Vec<i8> = states.iter().map(|state| state.bounds.sign()).collect();
    let mut is_pushed = vec![false; states.len()];
    pushed.iter().for_each(|still| is_pushed[still.clone()].fill(true));
    let mut state = carried.is_known().then(|| carried.middle());
    let mut sign = carried.sign();
    // The last turn, where on the path, the state there, and the farthest travel from it.
    let (mut turn, mut from_m, mut at_turn, mut farthest_m) = (0, path.travels_m[0], state, 0.0);
    // Where the sign changed at one row and the path says another, nobody knows the direction between the two.
    let doubt = |rows: Range<usize>, states: &mut [State]| {
        states[rows].iter_mut().for_each(|state| state.is_settled = false);
    };
    let mut row = 0;
    while row < states.len() {
        if !states[row].bounds.is_known() {
            row += 1;
            continue;
        }
        if is_pushed[row] {
            state = Some(states[row].bounds.middle());
            sign = 0;
            row += 1;
            continue;
        }
        let way = f64::from(ways[row]);
        if ways[row] != sign {
            // No farther than the turns on either side.
            let next = row + ways[row..].iter().take(reach).take_while(|other| **other == ways[row]).count();
            let (around, left_m) = path
                .leaves_slowly(row, turn, way)
                .or_else(|| path.leaves(row.saturating_sub(reach).max(turn)..next, way))
                .unwrap_or_else(|| (row, path.travels_m[row]));
            // What came before the turn still goes the other way, what lies between it and here came this way already.
            let free = |rows: Range<usize>| rows.into_iter().all(|row| !is_pushed[row] && ways[row] != 0);
            if sign != 0 && around > row && free(row..around) {
                ways[row..around].fill(sign);
                doubt(row..around, states);
                continue;
            }
            let back = around.max(turn);
            let from = if sign != 0 && back < row && free(back..row) { back } else { row };
            sign = ways[row];
            ways[from..row].fill(sign);
            doubt(from..row, states);
            (turn, farthest_m) = (around.min(row), 0.0);
            from_m = if around > row { path.travels_m[row] } else { left_m };
            at_turn = if 0 < from && from < row { Some(states[from].bounds.middle()) } else { state };
            row = from;
        }
        farthest_m = f64::max(farthest_m, way * (path.travels_m[row] - from_m));
        let turned_m = (farthest_m - thresholds.held_m).max(0.0);
        // Nothing is known of what came before the first motion.
        let turned = match at_turn {
            Some(state) if turned_m == 0.0 => state,
            Some(state) if thresholds.turn_m > 0.0 => {
                (state + 2.0 * way * turned_m / thresholds.turn_m).clamp(-1.0, 1.0)
            }
            _ => way,
        };
        state = Some(turned);
        states[row].bounds = Bounds::at(turned);
        row += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::thresholds::Standstill;

    const PERIOD_S: f64 = 0.005;

    /// Of a length with so much noise, in m.
    fn thresholds(noise_m: f64) -> Thresholds {
        let length_m = noise_m / NOISE;
        Thresholds { length_m, pressure_pa: 1e3, held_m: 0.0, turn_m: 0.0, standstill: Standstill::Held }
    }

    /// The path of `truth` over 200 rows, recorded with 20 µm of noise, which turns at each of `turns`; the largest distance from it.
    fn off_m(truth: &dyn Fn(f64) -> f64, turns: &[usize]) -> f64 {
        let time_s: Vec<f64> = (0..200).map(|row| PERIOD_S * f64::from(row)).collect();
        let noise_m = |row: usize| 40e-6 * ((row * 7919 % 1013) as f64 / 1013.0 - 0.5);
        let recorded: Vec<f64> = time_s.iter().enumerate().map(|(row, &t)| truth(t) + noise_m(row)).collect();
        let path = Path::of(&time_s, PERIOD_S, &recorded, thresholds(20e-6), turns, &[]);
        path.travels_m.iter().zip(&time_s).map(|(path, &t)| (path - truth(t)).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_path_keeps_a_corner_and_is_smooth_across_a_vertex() {
        // Slowly there and fast back: a parabola across it would lie off by a tenth of a millimetre, and turn where it does.
        let corner = |t: f64| if t < 0.5 { -2e-3 * (t - 0.5) } else { 20e-3 * (t - 0.5) };
        let vertex = |t: f64| 4e-3 * (t - 0.5).powi(2);
        assert!(off_m(&corner, &[]) > 1e-4, "{}", off_m(&corner, &[]));
        assert!(off_m(&corner, &[100]) < 2e-5, "{}", off_m(&corner, &[100]));
        assert!(off_m(&vertex, &[100]) < 1e-5, "{}", off_m(&vertex, &[100]));
    }

    #[test]
    fn a_path_follows_swings_that_are_shorter_than_its_windows() {
        // Half a swing is 20 rows, as long as what the noise asks for on one side.
        let swings = |t: f64| 1e-3 * (10.0 * std::f64::consts::PI * t).cos();
        let turns: Vec<usize> = (1..10).map(|turn| 20 * turn).collect();
        assert!(off_m(&swings, &[]) > 5e-4, "{}", off_m(&swings, &[]));
        assert!(off_m(&swings, &turns) < 8e-5, "{}", off_m(&swings, &turns));
    }

    #[test]
    fn friction_turns_over_after_its_own_turn_where_others_are_near() {
        // Swings that grow: the farthest point within reach is that of a later one.
        let path: Vec<f64> = (0..120).map(|row| 1e-5 * f64::from(row) * (0.3 * f64::from(row)).sin()).collect();
        let way = |row: usize| if path[row] > path[row - 1] { 1.0 } else { -1.0 };
        let ways: Vec<f64> = (1..120).map(way).collect();
        let ways: Vec<f64> = [ways[0]].into_iter().chain(ways).collect();
        let mut states: Vec<State> =
            ways.iter().map(|&way| State { bounds: Bounds::at(way), is_settled: true }).collect();
        let slow = Thresholds { turn_m: 1e-6, ..thresholds(1e-6) };
        turn_over(
            &Path { travels_m: path, noise_m: 1e-9, slow_turns: Vec::new() },
            slow,
            40,
            Bounds::at(ways[0]),
            &[],
            &mut states,
        );
        let off = states.iter().zip(&ways).filter(|(state, way)| state.bounds.middle() * **way < 0.0).count();
        assert!(off <= ways.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count(), "{off}");
    }

    /// Where the path of `truth`, recorded with 20 µm of noise, leaves to rise around row `turn`, and what it has travelled there.
    fn leaves(truth: &dyn Fn(f64) -> f64, turn: usize, resting: &[Range<usize>]) -> (usize, f64) {
        let time_s: Vec<f64> = (0..200).map(|row| PERIOD_S * f64::from(row)).collect();
        let noise_m = |row: usize| 40e-6 * ((row * 7919 % 1013) as f64 / 1013.0 - 0.5);
        let recorded: Vec<f64> = time_s.iter().enumerate().map(|(row, &t)| truth(t) + noise_m(row)).collect();
        Path::of(&time_s, PERIOD_S, &recorded, thresholds(12e-6), &[turn], resting).leaves(50..150, 1.0).unwrap()
    }

    #[test]
    fn a_turn_is_at_its_vertex_and_a_motion_begins_where_a_rest_ends() {
        // Both leave 8 µm within the same time of the turn; only one has come from elsewhere.
        let (row, travel_m) = leaves(&|t| 4e-3 * (t - 0.5).powi(2), 100, &[]);
        assert!(row.abs_diff(100) <= 4 && travel_m.abs() < 6e-6, "{row}, {travel_m}");
        let (row, travel_m) = leaves(&|t| 4e-3 * (t - 0.5).max(0.0).powi(2), 100, &[]);
        assert!((100..125).contains(&row) && travel_m.abs() < 6e-6, "{row}, {travel_m}");
    }

    #[test]
    fn a_path_that_wanders_while_it_rests_leaves_where_it_goes() {
        // Slow noise that no average takes away.
        let wandering = |t: f64| 30e-6 * (20.0 * t - 5.7).sin() + 20e-3 * (t - 0.6).max(0.0);
        let (white, known) = (leaves(&wandering, 120, &[]), leaves(&wandering, 120, std::slice::from_ref(&(0..120))));
        assert!(white.0 < 115 && known.0.abs_diff(120) <= 2, "{white:?}, {known:?}");
    }

    #[test]
    fn what_lies_between_two_dates_of_a_turn_is_unsettled() {
        // The sign changes at row 50; the length rests until row 60 and goes then.
        let path = |leaves: usize| Path {
            travels_m: (0..120).map(|row: usize| -1e-5 * row.saturating_sub(leaves) as f64).collect(),
            noise_m: 1e-9,
            slow_turns: Vec::new(),
        };
        let turned = |leaves: usize| {
            let before = State { bounds: Bounds::at(1.0), is_settled: true };
            let mut states = vec![before; 120];
            states[50..].fill(State { bounds: Bounds::at(-1.0), ..before });
            turn_over(&path(leaves), thresholds(1e-6), 20, Bounds::at(1.0), &[], &mut states);
            let goes = states.iter().position(|state| state.bounds.middle() < 0.0);
            let unsettled: Vec<usize> = (0..120).filter(|&row| !states[row].is_settled).collect();
            (goes, unsettled)
        };
        assert_eq!(turned(60), (Some(61), (50..60).collect()));
        assert_eq!(turned(40), (Some(41), (40..50).collect()));
    }
}
