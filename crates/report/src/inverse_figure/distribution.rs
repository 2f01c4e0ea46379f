//! Panel d: share of unseen points whose error is smaller.

use super::{CONTRACTING, EXTENDING};
use crate::number::significant;
use crate::plot::{Anchor, Axis, Canvas, Key, Mark, Panel, Rect, legend, note, palette, title};

/// Quantiles that are marked.
const MARKED: [f64; 3] = [50.0, 95.0, 100.0];
/// Points of one curve.
const POINTS: usize = 400;

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, errors_kpa: &[Vec<f64>; 2]) {
    let (y, _) = title(canvas, cell, "d", "Errors on unseen points");
    let sorted = errors_kpa.each_ref().map(|errors| {
        let mut sizes: Vec<f64> = errors.iter().map(|error| error.abs()).filter(|size| *size > 0.0).collect();
        sizes.retain(|size| size.is_finite());
        sizes.sort_by(f64::total_cmp);
        sizes
    });
    let largest = sorted.iter().filter_map(|sizes| sizes.last()).copied().fold(0.0, f64::max);
    if largest <= 0.0 {
        note(canvas, cell.inset(64.0, 40.0, 20.0, 46.0), "no point was judged");
        return;
    }
    // Below the smallest twentieth there is nothing to see.
    let smallest = sorted.iter().filter(|sizes| !sizes.is_empty()).map(|sizes| quantile(sizes, 5.0));
    let x = Axis::logarithmic("error, absolute (kPa)", smallest.fold(largest, f64::min), largest);
    let panel = Panel::new(cell, x, Axis::exact("points with less (%)", 0.0, 100.0, 5), 20.0);
    panel.draw_frame(canvas);
    let mut keys = Vec::new();
    for (sizes, name, color) in [(&sorted[0], "contracting", CONTRACTING), (&sorted[1], "extending", EXTENDING)] {
        if sizes.is_empty() {
            continue;
        }
        let curve = (0..=POINTS).map(|step| 100.0 * step as f64 / POINTS as f64);
        let curve = curve.map(|percent| (quantile(sizes, percent), percent)).filter(|(size, _)| *size >= panel.x.from);
        panel.line(canvas, curve, color, 2.0);
        for percent in MARKED {
            canvas.dot(panel.at(quantile(sizes, percent), percent), 3.0, color);
        }
        keys.push(Key::new(name, Mark::Line(2.0), color));
    }
    write_quantiles(canvas, &panel, &sorted);
    legend(canvas, &keys, cell.right - 12.0, y + 12.0);
}

/// Quantiles in the corner below the curves, which rise to the right.
fn write_quantiles(canvas: &mut Canvas<'_>, panel: &Panel, sorted: &[Vec<f64>; 2]) {
    let (right, mut y) = (panel.frame.right - 12.0, panel.frame.bottom - 52.0);
    for (percent, name) in MARKED.into_iter().zip(["median", "95 % below", "largest"]) {
        canvas.text(name, (right - 90.0, y), Anchor::End, 11.5, palette::GRAY);
        for ((sizes, color), x) in sorted.iter().zip([CONTRACTING, EXTENDING]).zip([44.0, 0.0]) {
            let text = if sizes.is_empty() { "–".to_owned() } else { significant(quantile(sizes, percent), 2) };
            canvas.text(&text, (right - x, y), Anchor::End, 11.5, color.toward(palette::INK, 0.2));
        }
        y += 17.0;
    }
}

fn quantile(sorted: &[f64], percent: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * percent / 100.0).round() as usize]
}
