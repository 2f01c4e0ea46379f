//! Panels a and b: force and residual over time.

use super::{BAND, EXTRAPOLATED, MEASURED, MODELLED, PredictionFigure, UNCOUNTED, band_words};
use crate::plot::{Axis, Canvas, Key, Mark, Panel, Rect, Timeline, legend, palette, title};
use crate::residual_cells::quantile;

/// Points of a line.
const POINTS: usize = 3000;

pub(super) fn force(canvas: &mut Canvas<'_>, cell: Rect, figure: &PredictionFigure) {
    let line = Timeline { time_s: &figure.time_s };
    let band = |sign: f64| -> Vec<f64> {
        figure.model_n.iter().zip(&figure.half_width_n).map(|(model_n, half_n)| model_n + sign * half_n).collect()
    };
    let (low, high) = (band(-1.0), band(1.0));
    // A model that runs away outside its range must not flatten what was measured.
    let shown = if figure.force_n.is_empty() { &figure.model_n } else { &figure.force_n };
    let (lowest, highest) = (quantile(shown, 0.0005), quantile(shown, 0.9995));
    let margin = 0.12 * (highest - lowest) + 2.0 * quantile(&figure.half_width_n, 0.5);
    let panel = panel(cell, figure, ("force (N)", lowest - margin, highest + margin));
    panel.draw_frame(canvas);
    line.shade(canvas, &panel, |row| figure.extrapolated[row], EXTRAPOLATED);
    line.band(canvas, &panel, [&low, &high], BAND);
    let mut keys = Vec::new();
    if !figure.force_n.is_empty() {
        line.line(canvas, &panel, &figure.force_n, (MEASURED, 4.0), POINTS);
        keys.push(Key::new("measured", Mark::Line(4.0), MEASURED));
    }
    line.line(canvas, &panel, &figure.model_n, (MODELLED, 1.4), POINTS);
    keys.push(Key::new("modelled", Mark::Line(2.0), MODELLED));
    keys.push(Key::new(band_words(figure), Mark::Patch, BAND));
    if figure.extrapolated.contains(&true) {
        keys.push(Key::new("extrapolated", Mark::Patch, palette::ORANGE.faded(0.5)));
    }
    let (y, _) = title(canvas, cell, "a", "Force");
    legend(canvas, &keys, cell.right - 16.0, y);
}

pub(super) fn residual(canvas: &mut Canvas<'_>, cell: Rect, figure: &PredictionFigure) {
    let line = Timeline { time_s: &figure.time_s };
    let residual_n: Vec<f64> =
        figure.force_n.iter().zip(&figure.model_n).map(|(force_n, model_n)| force_n - model_n).collect();
    let limit = residual_limit(figure);
    let panel = panel(cell, figure, ("residual (N)", -limit, limit));
    panel.draw_frame(canvas);
    line.shade(canvas, &panel, |row| figure.extrapolated[row], EXTRAPOLATED);
    line.shade(canvas, &panel, |row| !figure.counted[row], UNCOUNTED);
    let below: Vec<f64> = figure.half_width_n.iter().map(|half_n| -half_n).collect();
    line.band(canvas, &panel, [&below, &figure.half_width_n], BAND);
    line.line(canvas, &panel, &residual_n, (MODELLED, 1.0), POINTS);
    panel.level(canvas, 0.0, palette::GRAY, 1.0);
    let mut keys = vec![
        Key::new("measured less modelled", Mark::Line(1.6), MODELLED),
        Key::new(band_words(figure), Mark::Patch, BAND),
    ];
    if figure.counted.contains(&false) {
        keys.push(Key::new("not counted: around reversals", Mark::Patch, UNCOUNTED.faded(0.6)));
    }
    let (y, _) = title(canvas, cell, "b", "Residual");
    legend(canvas, &keys, cell.right - 16.0, y);
}

/// Largest residual that is shown, in N: single spikes, or a model that runs away, must not flatten all the rest.
pub(super) fn residual_limit(figure: &PredictionFigure) -> f64 {
    let sizes = figure.force_n.iter().zip(&figure.model_n).map(|(force_n, model_n)| (force_n - model_n).abs());
    let sizes: Vec<f64> = sizes.collect();
    1.15 * quantile(&sizes, 0.998).max(1.2 * quantile(&figure.half_width_n, 0.5))
}

fn panel(cell: Rect, figure: &PredictionFigure, (name, low, high): (&str, f64, f64)) -> Panel {
    let finite = || figure.time_s.iter().copied().filter(|time_s| time_s.is_finite());
    let (from, to) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    Panel::new(cell, Axis::exact("time (s)", from, to, 12), Axis::linear(name, low, high, 6), 16.0)
}
