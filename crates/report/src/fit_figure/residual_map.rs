//! Panel d: mean residual over pressure and length.

use super::clean::{Clean, extent, mean, quantile};
use crate::number::with_minus;
use crate::plot::{Axis, Bins, Canvas, ColorBar, Map, Rect, diverging, title};

/// Cells along a channel that moves.
const CELLS: [usize; 2] = [26, 18];
/// With more standstill values than this, equal bins serve better than one each.
const MOST_LEVELS: usize = 14;

/// One coordinate of the map.
struct Coordinate {
    title: &'static str,
    of: fn(&Clean) -> &[f64],
    /// Share of the largest value within which a channel stands still.
    still: f64,
    decimals: usize,
}

/// A pressure regulator wanders by a few percent, a clamped muscle yields by less than half of one.
const PRESSURE: Coordinate =
    Coordinate { title: "pressure (kPa)", of: |recording| &recording.pressure_kpa, still: 0.05, decimals: 0 };
const LENGTH: Coordinate =
    Coordinate { title: "length (mm)", of: |recording| &recording.length_mm, still: 0.005, decimals: 1 };

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, recordings: &[Clean], noise_n: Option<f64>) {
    let (column_levels, row_levels) = (PRESSURE.levels(recordings), LENGTH.levels(recordings));
    let columns = PRESSURE.bins(recordings, column_levels.as_deref(), CELLS[0]);
    let rows = LENGTH.bins(recordings, row_levels.as_deref(), CELLS[1]);
    let mut sums = vec![(0.0, 0.0); columns.count() * rows.count()];
    for recording in recordings {
        let fixed_column = column_levels.as_ref().map(|levels| nearest(levels, mean(&recording.pressure_kpa)));
        let fixed_row = row_levels.as_ref().map(|levels| nearest(levels, mean(&recording.length_mm)));
        for (sample, residual_n) in recording.residual_n.iter().enumerate() {
            let column = fixed_column.or_else(|| columns.bin_of(recording.pressure_kpa[sample]));
            let row = fixed_row.or_else(|| rows.bin_of(recording.length_mm[sample]));
            if let Some((column, row)) = column.zip(row) {
                let sum = &mut sums[row * columns.count() + column];
                *sum = (sum.0 + 1.0, sum.1 + residual_n);
            }
        }
    }
    let values: Vec<Option<f64>> = sums.into_iter().map(|(n, sum)| (n > 0.0).then_some(sum / n)).collect();
    // The few largest cells may saturate; a map within the noise must not look alarming.
    let sizes: Vec<f64> = values.iter().flatten().map(|value| value.abs()).collect();
    let limit = quantile(&sizes, 0.98).max(noise_n.unwrap_or(0.0));
    let limit = if limit > 0.0 { limit } else { 1.0 };
    let bar =
        ColorBar { title: "mean (N)".to_owned(), from: -limit, to: limit, color: |share| diverging(2.0 * share - 1.0) };
    Map { columns, rows, values, texts: Vec::new(), bar }.draw(canvas, cell);
    title(canvas, cell, "d", "Residual over pressure and length");
}

impl Coordinate {
    /// The values at which the channel stands still, rising, if it does so in every recording.
    fn levels(&self, recordings: &[Clean]) -> Option<Vec<f64>> {
        let largest = extent(recordings.iter().flat_map(|recording| (self.of)(recording).iter().map(|v| v.abs()))).1;
        let same = self.still * largest;
        let mut levels = Vec::new();
        for recording in recordings {
            let values = (self.of)(recording);
            if quantile(values, 0.98) - quantile(values, 0.02) > same {
                return None;
            }
            levels.push(mean(values));
        }
        levels.sort_by(f64::total_cmp);
        let levels: Vec<f64> = levels.chunk_by(|a, b| b - a <= same).map(mean).collect();
        (levels.len() <= MOST_LEVELS).then_some(levels)
    }

    fn bins(&self, recordings: &[Clean], levels: Option<&[f64]>, cells: usize) -> Bins {
        if let Some(levels) = levels {
            let decimals = self.decimals;
            let names = levels.iter().map(|level| with_minus(format!("{level:.decimals$}"))).collect();
            return Bins::Named(self.title.to_owned(), names);
        }
        let (lowest, highest) = extent(recordings.iter().flat_map(|recording| (self.of)(recording).iter().copied()));
        Bins::Equal(Axis::linear(self.title, lowest, highest, 5), cells)
    }
}

fn nearest(levels: &[f64], value: f64) -> usize {
    let distance = |index: &usize| (levels[*index] - value).abs();
    (0..levels.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}
