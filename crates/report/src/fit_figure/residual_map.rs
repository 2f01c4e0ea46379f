//! Panel d: mean residual over pressure and length.

use super::clean::{Clean, extent, mean, quantile};
use crate::plot::{Axis, Bins, Canvas, ColorBar, Map, Rect, diverging, title};

/// Cells along the pressure.
const COLUMNS: usize = 26;
/// Cells along the length, where it moves.
const ROWS: usize = 18;
/// With more clamped lengths than this, equal bins serve better than one row each.
const MOST_LENGTHS: usize = 14;

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, recordings: &[Clean], noise_n: Option<f64>) {
    let pressure = extent(recordings.iter().flat_map(|recording| recording.pressure_kpa.iter().copied()));
    let length = extent(recordings.iter().flat_map(|recording| recording.length_mm.iter().copied()));
    let columns = Bins::Equal(Axis::linear("pressure (kPa)", pressure.0, pressure.1, 5), COLUMNS);
    let clamped = clamped_lengths(recordings);
    let rows = match &clamped {
        Some(lengths) => {
            let names = lengths.iter().map(|length| format!("{:.1}", length)).collect();
            Bins::Named("length (mm)".to_owned(), names)
        }
        None => Bins::Equal(Axis::linear("length (mm)", length.0, length.1, 5), ROWS),
    };
    let mut sums = vec![(0.0, 0.0); columns.count() * rows.count()];
    for recording in recordings {
        let fixed_row = clamped.as_ref().map(|lengths| nearest(lengths, mean(&recording.length_mm)));
        for (row, residual_n) in recording.residual_n.iter().enumerate() {
            let cell = columns
                .bin_of(recording.pressure_kpa[row])
                .zip(fixed_row.or_else(|| rows.bin_of(recording.length_mm[row])));
            if let Some((column, row)) = cell {
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

/// The lengths at which the muscle was clamped, rising, if it was clamped in every recording.
fn clamped_lengths(recordings: &[Clean]) -> Option<Vec<f64>> {
    let longest = extent(recordings.iter().flat_map(|recording| recording.length_mm.iter().copied())).1;
    let same = 0.005 * longest.abs();
    let mut lengths = Vec::new();
    for recording in recordings {
        let (shortest, longest) = (quantile(&recording.length_mm, 0.02), quantile(&recording.length_mm, 0.98));
        if longest - shortest > same {
            return None;
        }
        lengths.push(mean(&recording.length_mm));
    }
    lengths.sort_by(f64::total_cmp);
    let lengths: Vec<f64> = lengths.chunk_by(|a, b| b - a <= same).map(mean).collect();
    (lengths.len() <= MOST_LENGTHS).then_some(lengths)
}

fn nearest(lengths: &[f64], length: f64) -> usize {
    let distance = |index: &usize| (lengths[*index] - length).abs();
    (0..lengths.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}
