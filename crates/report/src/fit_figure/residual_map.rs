//! Panel d: mean residual over pressure and length.

use super::clean::Clean;
use crate::plot::{Canvas, ColorBar, Map, Rect, diverging, title};
use crate::residual_cells::{Channel, quantile};

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, recordings: &[Clean], noise_n: Option<f64>) {
    let pick = |of: fn(&Clean) -> &[f64]| -> Vec<&[f64]> { recordings.iter().map(of).collect() };
    // A pressure regulator wanders by a few percent, a clamped muscle yields by less than half of one.
    let pressure = Channel::new("pressure (kPa)", pick(|recording| &recording.pressure_kpa), 0.05, 0, 26);
    let length = Channel::new("length (mm)", pick(|recording| &recording.length_mm), 0.005, 1, 18);
    let (columns, rows) = (pressure.bins().clone(), length.bins().clone());
    let mut sums = vec![(0.0, 0.0); columns.count() * rows.count()];
    for (recording, samples) in recordings.iter().enumerate() {
        for (sample, residual_n) in samples.residual_n.iter().enumerate() {
            let cell = pressure.bin_of(recording, sample).zip(length.bin_of(recording, sample));
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
    let bar = ColorBar {
        title: "mean (N)".to_owned(),
        from: -limit,
        to: limit,
        logarithm: false,
        color: |share| diverging(2.0 * share - 1.0),
    };
    Map { columns, rows, values, texts: Vec::new(), bar }.draw(canvas, cell);
    title(canvas, cell, "d", "Residual over pressure and length");
}
