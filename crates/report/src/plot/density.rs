//! Measured against modelled, as a map of how many samples lie where; thousands of dots would hide one another.

use crate::plot::{Axis, Bins, Canvas, ColorBar, Map, Rect, palette, sequential};

/// Cells along each axis.
const CELLS: usize = 60;

/// Draws `points`, modelled and measured force in N, between `lowest` and `highest`, with the line on which the two agree.
pub(crate) fn density(
    canvas: &mut Canvas<'_>,
    cell: Rect,
    points: impl Iterator<Item = (f64, f64)>,
    (lowest, highest): (f64, f64),
) {
    let axis = |name: &str| Axis::linear(name, lowest, highest, 6);
    let (columns, rows) =
        (Bins::Equal(axis("modelled force (N)"), CELLS), Bins::Equal(axis("measured force (N)"), CELLS));
    let mut counts = vec![0_u32; CELLS * CELLS];
    for (modelled, measured) in points {
        if let Some((column, row)) = columns.bin_of(modelled).zip(rows.bin_of(measured)) {
            counts[row * CELLS + column] += 1;
        }
    }
    let most = f64::from(counts.iter().copied().max().unwrap_or(1).max(2));
    // Few samples far off are what matters, so that colors go by the logarithm.
    let value = |count: &u32| (*count > 0).then(|| f64::from(*count).log10());
    let bar = ColorBar {
        title: "samples (log₁₀)".to_owned(),
        from: 0.0,
        to: most.log10(),
        color: |share| sequential(0.25 + 0.75 * (12.0 * share).round() / 12.0),
    };
    let values = counts.iter().map(value).collect();
    let panel = Map { columns, rows, values, texts: Vec::new(), bar }.draw(canvas, cell);
    let (low, high) = (panel.x.from, panel.x.to);
    panel.line(canvas, [(low, low), (high, high)], palette::VERMILION, 1.2);
}
