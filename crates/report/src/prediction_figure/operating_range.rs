//! Panel c: where the recording lies beside what the model was identified on.

use super::PredictionFigure;
use crate::plot::{Axis, Canvas, Color, Key, Mark, Panel, Rect, legend, palette, title};

/// Cells along each axis; one disk stands for all samples of a cell.
const CELLS: f64 = 70.0;

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, figure: &PredictionFigure, letter: &str) {
    let extent = |values: &[f64], [from, to]: [f64; 2]| {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        (finite().fold(from, f64::min), finite().fold(to, f64::max))
    };
    let (x, y) = (extent(&figure.length_mm, figure.identified_mm), extent(&figure.pressure_kpa, figure.identified_kpa));
    let margin = |(low, high): (f64, f64)| 0.04 * (high - low);
    let panel = Panel::new(
        cell,
        Axis::linear("length (mm)", x.0 - margin(x), x.1 + margin(x), 6),
        Axis::linear("pressure (kPa)", y.0 - margin(y), y.1 + margin(y), 6),
        16.0,
    );
    panel.draw_frame(canvas);
    let ([left, right], [low, high]) = (figure.identified_mm, figure.identified_kpa);
    let ((left, bottom), (right, top)) = (panel.at(left, low), panel.at(right, high));
    canvas.rect(Rect { left, top, right, bottom }, palette::SKY.faded(0.18));
    let (inside, outside) = (palette::BLUE.faded(0.55), palette::VERMILION);
    let at = |row: usize| panel.at(figure.length_mm[row], figure.pressure_kpa[row]);
    dots(canvas, &panel, (0..figure.time_s.len()).filter(|&row| !figure.extrapolated[row]).map(at), inside);
    dots(canvas, &panel, (0..figure.time_s.len()).filter(|&row| figure.extrapolated[row]).map(at), outside);
    let (y, _) = title(canvas, cell, letter, "Operating range");
    let mut keys =
        vec![Key::new("identified on", Mark::Patch, palette::SKY.faded(0.4)), Key::new("recorded", Mark::Dot, inside)];
    if figure.extrapolated.contains(&true) {
        keys.push(Key::new("extrapolated", Mark::Dot, outside));
    }
    legend(canvas, &keys, cell.right - 16.0, y);
}

/// A disk in every cell of a grid that a point falls into.
fn dots(canvas: &mut Canvas<'_>, panel: &Panel, points: impl Iterator<Item = (f64, f64)>, color: Color) {
    let Rect { left, top, .. } = panel.frame;
    let (width, height) = (panel.frame.width() / CELLS, panel.frame.height() / CELLS);
    let place = |(x, y): (f64, f64)| (((x - left) / width).floor() as i32, ((y - top) / height).floor() as i32);
    let mut cells: Vec<(i32, i32)> = points.filter(|(x, y)| (x + y).is_finite()).map(place).collect();
    cells.sort_unstable();
    cells.dedup();
    for (column, row) in cells {
        let (x, y) = (left + (f64::from(column) + 0.5) * width, top + (f64::from(row) + 0.5) * height);
        // A square is a fifth of the text of a disk.
        canvas.rect(Rect { left: x - 1.7, right: x + 1.7, top: y - 1.7, bottom: y + 1.7 }, color);
    }
}
