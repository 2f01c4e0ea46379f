//! Panel d: measured against modelled force, by density.

use super::PredictionFigure;
use crate::plot::{Canvas, Rect, density, title};
use crate::residual_cells::quantile;

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, figure: &PredictionFigure) {
    let (lowest, highest) = (quantile(&figure.force_n, 0.0), quantile(&figure.force_n, 1.0));
    let points = figure.model_n.iter().copied().zip(figure.force_n.iter().copied());
    density(canvas, cell, points, (lowest, highest));
    title(canvas, cell, "d", "Measured against modelled");
}
