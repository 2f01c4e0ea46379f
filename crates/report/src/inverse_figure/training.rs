//! Panel f: error over the epochs.

use super::InverseFigure;
use crate::number::significant;
use crate::plot::{Axis, Canvas, Key, Mark, Panel, Rect, legend, note, palette, title};

/// Points of one curve.
const POINTS: usize = 1000;

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, figure: &InverseFigure) {
    let (y, _) = title(canvas, cell, "f", "Training");
    let curves = [
        ("training", &figure.training_rmse_kpa, palette::SKY, 2.4),
        ("validation", &figure.validation_rmse_kpa, palette::INK, 1.2),
    ];
    let shown = || curves.iter().flat_map(|curve| curve.1.iter().copied()).filter(is_positive);
    let (lowest, highest) = (shown().fold(f64::INFINITY, f64::min), shown().fold(0.0, f64::max));
    if !lowest.is_finite() {
        note(canvas, cell.inset(64.0, 40.0, 20.0, 46.0), "no epoch was run");
        return;
    }
    let n_epochs = figure.training_rmse_kpa.len().max(figure.validation_rmse_kpa.len()).max(2) - 1;
    let panel = Panel::new(
        cell,
        Axis::exact("epoch", 0.0, n_epochs as f64, 5),
        Axis::logarithmic("RMSE (kPa)", lowest, highest),
        68.0,
    );
    panel.draw_frame(canvas);
    for (_, curve, color, width) in curves {
        let every = curve.len().div_ceil(POINTS).max(1);
        let points = curve.iter().enumerate().filter(|(epoch, _)| epoch % every == 0 || epoch + 1 == curve.len());
        let points = points.filter(|point| is_positive(point.1)).map(|(epoch, rmse)| (epoch as f64, *rmse));
        panel.line(canvas, points, color, width);
    }
    let mut keys: Vec<Key> =
        curves.iter().map(|(name, _, color, width)| Key::new(*name, Mark::Line(*width), *color)).collect();
    if let Some(&best) = figure.validation_rmse_kpa.get(figure.best_epoch).filter(|rmse| is_positive(rmse)) {
        canvas.dot(panel.at(figure.best_epoch as f64, best), 4.0, palette::VERMILION);
        keys.push(Key::new("kept", Mark::Dot, palette::VERMILION));
        panel.label_right(canvas, &[(best, format!("{} kPa", significant(best, 2)), palette::INK)]);
    }
    legend(canvas, &keys, cell.right - 12.0, y + 12.0);
}

fn is_positive(value: &f64) -> bool {
    value.is_finite() && *value > 0.0
}
