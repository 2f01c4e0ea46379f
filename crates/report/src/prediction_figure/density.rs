//! Panel d: residual against modelled force, by density. Measured against modelled force would be a straight line for any
//! model worth looking at.

use super::PredictionFigure;
use super::over_time::residual_limit;
use crate::plot::{Axis, Canvas, Rect, density, palette, title};
use crate::residual_cells::quantile;

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, figure: &PredictionFigure) {
    let limit = residual_limit(figure);
    let axes = [
        Axis::linear("modelled force (N)", quantile(&figure.model_n, 0.0), quantile(&figure.model_n, 1.0), 6),
        Axis::exact("residual (N)", -limit, limit, 5),
    ];
    let points = figure.model_n.iter().zip(&figure.force_n).map(|(model_n, force_n)| (*model_n, force_n - model_n));
    let panel = density(canvas, cell, points, axes);
    panel.line(canvas, [(panel.x.from, 0.0), (panel.x.to, 0.0)], palette::VERMILION, 1.2);
    title(canvas, cell, "d", "Residual against modelled force");
}
