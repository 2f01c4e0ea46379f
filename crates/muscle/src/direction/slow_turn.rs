//! Slow turns: where the length goes over its farthest point in more time than the window of a path.

use std::ops::Range;

use nalgebra::Vector4;

use super::turn::fit;

/// The cubic that describes the length around a slow turn, over as long a time as it does.
#[derive(Debug, Clone)]
pub(super) struct SlowTurn {
    /// Rows that it describes.
    pub(super) rows: Range<usize>,
    /// Row of its vertex.
    pub(super) vertex: usize,
    /// Which way the length goes after it.
    pub(super) way: f64,
    weights: Vector4<f64>,
    origin_m: f64,
    /// Half of the rows that the cubic goes over.
    half: f64,
}

impl SlowTurn {
    /// Longest half, in s: that of a swing of some eight seconds.
    pub(super) const LONGEST_S: f64 = 2.0;
    /// Deviations by which one cubic must fall short of two, before and after its middle, to be none.
    const SURELY: f64 = 4.0;
    /// Deviations of the mean of its rows by which the length is away from the vertex at both ends, at least.
    const CLEARLY: f64 = 8.0;
    /// Deviations of that mean by which it is away where no rest looks like it: of a rest between two motions a cubic leaves a tenth of the
    /// way to the ends.
    const NO_REST: f64 = 100.0;
    /// Times that it is centered on its vertex.
    const ROUNDS: usize = 3;

    /// The longest around row `turn` of `shortening` within `room`, with halves from `least` rows to `most`. None where none is
    /// longer than the former. `noise_m` is the deviation of a row.
    pub(super) fn around(
        shortening: &[f64],
        turn: usize,
        room: &Range<usize>,
        (least, most): (usize, usize),
        noise_m: f64,
    ) -> Option<Self> {
        let mut found: Option<Self> = None;
        let mut half = least;
        loop {
            half = (2 * half).min(most);
            let mut row = found.as_ref().map_or(turn, |arc| arc.vertex);
            let mut arc = None;
            for _ in 0..Self::ROUNDS {
                let within = half.min(row - room.start).min(room.end - 1 - row);
                if within <= found.as_ref().map_or(least, |found| found.rows.len() / 2) {
                    return found;
                }
                let Some(centered) = Self::of(shortening, row - within..row + within + 1, noise_m) else {
                    return found;
                };
                row = centered.vertex;
                arc = Some(centered);
            }
            found = arc;
            if half == most {
                return found;
            }
        }
    }

    /// Whether the length, which seems to rest over the rows `still`, turns slowly there.
    pub(super) fn goes_over(shortening: &[f64], still: &Range<usize>, most: usize, noise_m: f64) -> bool {
        let (middle, least) = (still.start.midpoint(still.end), still.len() / 2);
        Self::around(shortening, middle, &(0..shortening.len()), (least, most), noise_m).is_some_and(|arc| {
            let mean_m = noise_m / (arc.rows.len() as f64).sqrt();
            still.contains(&arc.vertex) && arc.weights[2].abs() > Self::NO_REST * mean_m
        })
    }

    /// The cubic over `rows`; none without a vertex among them, or one that is no more than noise.
    fn of(shortening: &[f64], rows: Range<usize>, noise_m: f64) -> Option<Self> {
        let bins = Bins::of(&shortening[rows.clone()]);
        let half = bins.half(bins.means.len());
        let (one, weights) = bins.cubic(0..bins.means.len())?;
        let [_, slope, square, third] = weights.into();
        // Of the two roots of the slope the one near the vertex of the parabola.
        let root = (square * square - 3.0 * slope * third).sqrt();
        let along = -slope / (square + root.copysign(square));
        let mean_m = noise_m / (rows.len() as f64).sqrt();
        let is_clear = along.abs() < 1.0 && square.abs() - third.abs() > Self::CLEARLY * mean_m;
        let vertex = rows.start + (half * (along + 1.0)).round() as usize;
        let middle = bins.means.len() / 2;
        let two = bins.cubic(0..middle).zip(bins.cubic(middle..bins.means.len()));
        let falls_short = two.is_none_or(|(before, after)| {
            one - before.0 - after.0 > (Self::SURELY * noise_m).powi(2) / bins.rows as f64
        });
        (is_clear && !falls_short).then_some(Self {
            vertex,
            way: square.signum(),
            weights,
            origin_m: shortening[rows.start],
            half,
            rows,
        })
    }

    /// The shortening at a row, in m.
    pub(super) fn at(&self, row: usize) -> f64 {
        self.origin_m + self.weights.dot(&cubic((row - self.rows.start) as f64 / self.half - 1.0))
    }
}

/// Means of as many rows each, so that no fit is larger than needed.
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
