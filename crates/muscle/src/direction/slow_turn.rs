//! Slow turns: where the length takes longer to go over its farthest point than the window of a path.

use std::ops::Range;

use nalgebra::Vector4;

use super::turn::fit;

/// The cubic that describes the length around a slow turn, over as long a time as it does.
#[derive(Debug, Clone)]
pub(super) struct SlowTurn {
    /// Rows that it describes.
    pub(super) rows: Range<usize>,
    /// Row at which the length turns.
    pub(super) vertex: usize,
    /// Which way it goes after that.
    pub(super) way: f64,
    /// Weights of the powers of the place between the ends, from -1 to 1.
    weights: Vector4<f64>,
    origin_m: f64,
    /// Half of the rows that were fitted to.
    half: f64,
}

impl SlowTurn {
    /// Longest half, in s: that of a swing of some eight seconds. With half or twice of it eq. 11 leaves as much of 160 cases of other worlds,
    /// to 0.2 % in the mean.
    const LONGEST_S: f64 = 2.0;
    /// Deviations by which one cubic must fall short of two, before and after its middle, to be none. With half of it eq. 11 leaves 3 % more
    /// of the 40 healthy ones of these cases and as much of the others, with twice of it as much of all, to half a percent.
    const SURELY: f64 = 4.0;
    /// Deviations of the mean of its rows by which the length is away from the vertex at both ends, at least. With half of it, and with
    /// twice, eq. 11 leaves as much, to 0.1 %.
    const CLEARLY: f64 = 8.0;
    /// The same where no rest may look like it: of a rest between two motions a cubic leaves a tenth of the way to the ends.
    /// With half of it eq. 11 leaves the same; with twice 0.7 % more of the healthy ones, one of which is followed worse by a third.
    const NO_REST: f64 = 100.0;
    /// Times that it is centered on its vertex.
    const ROUNDS: usize = 3;

    /// Longest half in rows of a recording with this period.
    pub(super) fn longest(period_s: f64) -> usize {
        (Self::LONGEST_S / period_s) as usize
    }

    /// The longest around row `turn` of `shortening` within the rows of `room`, with halves from `least` rows to `most`; none where
    /// none is longer than the former. `noise_m` is the deviation of a row.
    pub(super) fn around(
        shortening: &[f64],
        turn: usize,
        room: &Range<usize>,
        (least, most): (usize, usize),
        noise_m: f64,
    ) -> Option<Self> {
        let mut found: Option<Self> = None;
        let mut half = least;
        while half < most {
            half = (2 * half).min(most);
            let (mut row, shorter) = found.as_ref().map_or((turn, least), |found| (found.vertex, found.rows.len() / 2));
            let mut longer = None;
            for _ in 0..Self::ROUNDS {
                let reach = half.min(row - room.start).min(room.end.saturating_sub(row + 1));
                if reach <= shorter {
                    return found;
                }
                match Described::over(shortening, row - reach..row + reach + 1, noise_m) {
                    Described::Turn(turn) => row = longer.insert(turn).vertex,
                    Described::Unclear => break,
                    Described::Otherwise => return found,
                }
            }
            found = longer.or(found);
        }
        found
    }

    /// Whether the length, which seems to rest over the rows `still`, turns slowly there.
    pub(super) fn is_at(shortening: &[f64], still: &Range<usize>, most: usize, noise_m: f64) -> bool {
        let (middle, least) = (still.start.midpoint(still.end), still.len() / 2);
        let turn = Self::around(shortening, middle, &(0..shortening.len()), (least, most), noise_m);
        turn.is_some_and(|turn| {
            still.contains(&turn.vertex) && turn.weights[2].abs() > Self::NO_REST * of_the_mean(noise_m, &turn.rows)
        })
    }

    /// The shortening at one of its rows, in m.
    pub(super) fn at(&self, row: usize) -> f64 {
        self.origin_m + self.weights.dot(&cubic((row - self.rows.start) as f64 / self.half - 1.0))
    }
}

/// What the cubic over some rows says.
enum Described {
    Turn(SlowTurn),
    /// That the length does not turn there, or by no more than noise.
    Unclear,
    /// Nothing: two surely leave less.
    Otherwise,
}

impl Described {
    fn over(shortening: &[f64], rows: Range<usize>, noise_m: f64) -> Self {
        let bins = Bins::of(&shortening[rows.clone()]);
        let (n_bins, half) = (bins.means.len(), bins.half(bins.means.len()));
        let (one, before, after) = (bins.cubic(0..n_bins), bins.cubic(0..n_bins / 2), bins.cubic(n_bins / 2..n_bins));
        let Some(((one, weights), (before, after))) = one.zip(before.zip(after)) else { return Self::Unclear };
        if one - before.0 - after.0 > (SlowTurn::SURELY * noise_m).powi(2) / bins.rows as f64 {
            return Self::Otherwise;
        }
        let [_, slope, square, third] = weights.into();
        // Of the two roots of the slope the one near the vertex of the parabola.
        let root = (square * square - 3.0 * slope * third).sqrt();
        let along = -slope / (square + root.copysign(square));
        let away_m = [-1.0, 1.0].map(|end| square.signum() * weights.dot(&(cubic(end) - cubic(along))));
        if along.abs() < 1.0 && away_m[0].min(away_m[1]) > SlowTurn::CLEARLY * of_the_mean(noise_m, &rows) {
            let vertex = rows.start + (half * (along + 1.0)).round() as usize;
            let origin_m = shortening[rows.start];
            return Self::Turn(SlowTurn { rows, vertex, way: square.signum(), weights, origin_m, half });
        }
        Self::Unclear
    }
}

/// Deviation of the mean of `rows`, of which each has that of `noise_m`.
fn of_the_mean(noise_m: f64, rows: &Range<usize>) -> f64 {
    noise_m / (rows.len() as f64).sqrt()
}

/// Means of as many rows each, less the first value, so that no fit is larger than needed.
struct Bins {
    means: Vec<f64>,
    /// Rows of each.
    rows: usize,
}

impl Bins {
    const MOST: usize = 64;

    fn of(values: &[f64]) -> Self {
        let rows = values.len().div_ceil(Self::MOST);
        let mean = |bin: &[f64]| bin.iter().map(|value| value - values[0]).sum::<f64>() / rows as f64;
        Self { means: values.chunks_exact(rows).map(mean).collect(), rows }
    }

    /// Half of the way from the first row to the last of so many.
    fn half(&self, n_bins: usize) -> f64 {
        0.5 * ((n_bins * self.rows) as f64 - 1.0)
    }

    /// The cubic through some of them: squares that it leaves, and weights over their rows from -1 to 1.
    fn cubic(&self, bins: Range<usize>) -> Option<(f64, Vector4<f64>)> {
        let half = self.half(bins.len());
        let center = |bin: f64| (bin + 0.5) * self.rows as f64 - 0.5;
        fit(&self.means[bins], 1, 0.0, |bin| cubic(center(bin) / half - 1.0))
    }
}

fn cubic(along: f64) -> Vector4<f64> {
    Vector4::new(1.0, along, along * along, along.powi(3))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_S: f64 = 0.005;
    const NOISE_M: f64 = 20e-6;

    /// Eight seconds of `truth`, recorded with noise.
    fn recorded(truth: &dyn Fn(f64) -> f64) -> Vec<f64> {
        let noise_m = |row: u32| NOISE_M * 12f64.sqrt() * (f64::from(row * 7919 % 1013) / 1013.0 - 0.5);
        (0..1600).map(|row| truth(PERIOD_S * f64::from(row)) + noise_m(row)).collect()
    }

    fn found(truth: &dyn Fn(f64) -> f64, row: usize) -> Option<SlowTurn> {
        SlowTurn::around(&recorded(truth), row, &(0..1600), (30, SlowTurn::longest(PERIOD_S)), NOISE_M)
    }

    #[test]
    fn a_slow_turn_is_dated_to_some_hundredths_of_a_second_from_far_beside_it() {
        // A swing of eight seconds, which takes 0.2 s to leave by its noise, and one that goes faster after its turn than before.
        let swing = |t: f64| -1.5e-3 * (std::f64::consts::FRAC_PI_4 * t).cos();
        let uneven = |t: f64| 1e-3 * ((t - 4.0).powi(2) + 0.15 * (t - 4.0).powi(3));
        for (truth, vertex, way, from) in
            [(&swing as &dyn Fn(f64) -> f64, 800, -1.0, 760), (&swing, 800, -1.0, 850), (&uneven, 800, 1.0, 760)]
        {
            let turn = found(truth, from).unwrap();
            assert!(turn.vertex.abs_diff(vertex) <= 4 && turn.way == way, "{turn:?}");
            let off = turn.rows.clone().map(|row| (turn.at(row) - truth(PERIOD_S * row as f64)).abs());
            assert!(off.fold(0.0, f64::max) < 10e-6, "{turn:?}");
        }
    }

    #[test]
    fn it_ends_where_the_length_does_something_else() {
        // A parabola for half a second to either side, then straight on.
        let turn = |t: f64| {
            let away = (t - 4.0).abs();
            if away < 0.5 { 2e-3 * away * away } else { 2e-3 * (away - 0.25) }
        };
        let turn = found(&turn, 790).unwrap();
        assert!(turn.vertex.abs_diff(800) <= 4 && (100..=280).contains(&turn.rows.len()), "{turn:?}");
    }

    #[test]
    fn corners_ramps_and_rests_are_none() {
        assert!(found(&|t| 1e-3 * (t - 4.0).abs(), 800).is_none(), "corner");
        assert!(found(&|t| 1e-3 * t, 800).is_none(), "ramp");
        assert!(found(&|_| 0.0, 800).is_none(), "rest");
        assert!(found(&|t| 4e-3 * (t - 4.0).max(0.0).powi(2), 800).is_none(), "end of a rest");
    }

    #[test]
    fn what_seems_to_rest_may_turn() {
        let most = SlowTurn::longest(PERIOD_S);
        let is_at = |truth: &dyn Fn(f64) -> f64| SlowTurn::is_at(&recorded(truth), &(740..860), most, NOISE_M);
        // Within 0.1 mm for 0.6 s, both of them.
        assert!(is_at(&|t| 1e-3 * (t - 4.0).powi(2)), "turn");
        assert!(!is_at(&|t| 2e-3 * ((t - 4.0).abs() - 0.3).max(0.0)), "rest between two motions");
    }
}
