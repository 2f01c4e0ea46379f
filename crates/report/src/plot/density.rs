//! How many samples lie where, as a map; thousands of dots would hide one another.

use crate::plot::{Axis, Bins, Canvas, ColorBar, Map, Panel, Rect, sequential};

/// Cells along each axis.
const CELLS: usize = 60;

/// Draws `points` over two axes; gives the panel for lines to be drawn on it.
pub(crate) fn density(
    canvas: &mut Canvas<'_>,
    cell: Rect,
    points: impl Iterator<Item = (f64, f64)>,
    [x, y]: [Axis; 2],
) -> Panel {
    let (columns, rows) = (Bins::Equal(x, CELLS), Bins::Equal(y, CELLS));
    let mut counts = vec![0_u32; CELLS * CELLS];
    for (x, y) in points {
        if let Some((column, row)) = columns.bin_of(x).zip(rows.bin_of(y)) {
            counts[row * CELLS + column] += 1;
        }
    }
    let most = f64::from(counts.iter().copied().max().unwrap_or(1).max(2));
    // Few samples far off are what matters, so that colors go by the logarithm.
    let value = |count: &u32| (*count > 0).then(|| f64::from(*count).log10());
    let bar = ColorBar {
        title: "samples".to_owned(),
        from: 0.0,
        to: most.log10(),
        logarithm: true,
        color: |share| sequential(0.25 + 0.75 * (12.0 * share).round() / 12.0),
    };
    let values = counts.iter().map(value).collect();
    Map { columns, rows, values, texts: Vec::new(), bar }.draw(canvas, cell)
}
