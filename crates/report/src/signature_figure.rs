//! The figure of an effect: what it does to a force, and where its residual sits.

use crate::FigureError;
use crate::plot::{Anchor, Axis, Canvas, Color, Key, Mark, Panel, Rect, legend, palette, thin};
use crate::residual_cells::quantile;

/// Everything that the figure shows.
#[derive(Debug, Clone, PartialEq)]
pub struct SignatureFigure {
    /// Headline.
    pub title: String,
    /// One to three panels, side by side.
    pub panels: Vec<SignaturePanel>,
}

/// One panel.
#[derive(Debug, Clone, PartialEq)]
pub struct SignaturePanel {
    /// Title of the panel.
    pub title: String,
    /// Title of the horizontal axis, with unit.
    pub x_label: String,
    /// Title of the vertical axis, with unit.
    pub y_label: String,
    /// The lines.
    pub series: Vec<SignatureSeries>,
}

/// One line of a panel, in the order of its points; where it leaps along the horizontal, it is interrupted.
#[derive(Debug, Clone, PartialEq)]
pub struct SignatureSeries {
    /// Name in the legend.
    pub name: String,
    /// Horizontal values.
    pub xs: Vec<f64>,
    /// Vertical values, as many.
    pub ys: Vec<f64>,
    /// Whether they are dots: a path that returns often would be a tangle of lines.
    pub dots: bool,
}

/// Colors of the lines, in turn: what is expected in ink, what the effect does in color.
const COLORS: [Color; 5] = [palette::INK, palette::VERMILION, palette::BLUE, palette::GREEN, palette::PURPLE];
/// Points of a line.
const POINTS: usize = 1500;
/// Dots in place of a line.
const DOTS: usize = 1000;

/// Draws the figure, as an SVG document 380 pixels high and 450 wide per panel.
///
/// # Errors
/// [`FigureError`] if no line has two finite points, or if a line has not as many of both values.
pub fn signature_figure(figure: &SignatureFigure) -> Result<String, FigureError> {
    let series = || figure.panels.iter().flat_map(|panel| &panel.series);
    for line in series() {
        if line.ys.len() != line.xs.len() {
            let (expected, found) = (line.xs.len(), line.ys.len());
            return Err(FigureError::UnequalColumns { recording: line.name.clone(), column: "ys", expected, found });
        }
    }
    if !series().any(|line| points(line).count() > 1) {
        return Err(FigureError::NothingToDraw);
    }
    let n_panels = figure.panels.len().max(1);
    Canvas::document(450 * n_panels as u32, 380, &figure.title, |canvas, sheet| {
        canvas.bold(&figure.title, (18.0, 24.0), Anchor::Start, 17.0, palette::INK);
        let width = sheet.width() / n_panels as f64;
        for (index, panel) in figure.panels.iter().enumerate() {
            let left = width * index as f64;
            draw(canvas, Rect { left, right: left + width, top: 46.0, bottom: sheet.bottom - 4.0 }, panel);
        }
    })
}

fn draw(canvas: &mut Canvas<'_>, cell: Rect, panel: &SignaturePanel) {
    let extent = |of: fn((f64, f64)) -> f64| {
        let values = panel.series.iter().flat_map(points).map(of);
        values.fold((f64::NAN, f64::NAN), |(low, high): (f64, f64), value| (low.min(value), high.max(value)))
    };
    let (x, y) = (extent(|(x, _)| x), extent(|(_, y)| y));
    let values: Vec<f64> = panel.series.iter().flat_map(points).map(|(x, _)| x).collect();
    // Below the title a row for the legend.
    let axes = Panel::new(
        cell.inset(0.0, 18.0, 0.0, 0.0),
        x_axis(panel, &values, x),
        // A peak that touches the frame would look cut off.
        Axis::linear(&*panel.y_label, y.0 - 0.04 * (y.1 - y.0), y.1 + 0.04 * (y.1 - y.0), 5),
        18.0,
    );
    axes.draw_frame(canvas);
    if y.0 < 0.0 && y.1 > 0.0 {
        axes.line(canvas, [(axes.x.from, 0.0), (axes.x.to, 0.0)], palette::SILVER, 1.0);
    }
    let mut keys = Vec::new();
    // A line by itself is what the effect does.
    let alone = panel.series.len() == 1;
    let colors = COLORS.iter().cycle().skip(usize::from(alone));
    for (index, (line, color)) in panel.series.iter().zip(colors).enumerate() {
        // The expected line is broad and pale below that of the effect, so that both are seen where they coincide.
        let (color, width) = match index {
            0 if alone => (color.faded(0.75), 1.1),
            0 => (color.faded(0.3), 5.0),
            _ => (*color, 1.4),
        };
        // From reversal to reversal a coordinate may start anew: no line leads back.
        let far = 0.2 * (axes.x.to - axes.x.from);
        let values: Vec<(f64, f64)> = points(line).collect();
        if line.dots {
            // Values below a logarithmic axis have no place on it.
            let shown = || values.iter().filter(|(x, _)| *x >= axes.x.from);
            for (x, y) in shown().step_by(shown().count().div_ceil(DOTS).max(1)) {
                canvas.dot(axes.at(*x, *y), 1.4, color);
            }
            keys.push(Key::new(line.name.clone(), Mark::Dot, color));
            continue;
        }
        if is_count(&values) {
            ranges(canvas, &axes, &values, color);
            continue;
        }
        for run in values.chunk_by(|a, b| (a.0 - b.0).abs() < far) {
            let ys: Vec<f64> = run.iter().map(|(_, y)| *y).collect();
            let within = |row: usize| (run[row].0.max(axes.x.from), run[row].1);
            axes.line(canvas, thin(&ys, POINTS).into_iter().map(within), color, width);
        }
        keys.push(Key::new(line.name.clone(), Mark::Line(width), color));
    }
    canvas.bold(&panel.title, (axes.frame.left, cell.top + 14.0), Anchor::Start, 13.5, palette::INK);
    if panel.series.len() > 1 {
        legend(canvas, &keys, axes.frame.right, cell.top + 40.0);
    }
}

/// Whether the horizontal counts, as cycles do: few whole numbers, each with many points.
fn is_count(values: &[(f64, f64)]) -> bool {
    let mut counts: Vec<f64> = values.iter().map(|(x, _)| *x).collect();
    counts.dedup();
    values.iter().all(|(x, _)| x.fract() == 0.0) && counts.len() <= 40 && values.len() >= 10 * counts.len()
}

/// Over each whole number a bar from the lowest to the highest value, and a dot at the mean.
fn ranges(canvas: &mut Canvas<'_>, axes: &Panel, values: &[(f64, f64)], color: Color) {
    for run in values.chunk_by(|a, b| a.0 == b.0) {
        let ys = || run.iter().map(|(_, y)| *y);
        let (low, high) = (ys().fold(f64::INFINITY, f64::min), ys().fold(f64::NEG_INFINITY, f64::max));
        axes.line(canvas, [(run[0].0, low), (run[0].0, high)], color.faded(0.35), 9.0);
        canvas.dot(axes.at(run[0].0, ys().sum::<f64>() / run.len() as f64), 4.0, color);
    }
    let keys = [Key::new("range", Mark::Patch, color.faded(0.35)), Key::new("mean", Mark::Dot, color)];
    legend(canvas, &keys, axes.frame.right, axes.frame.top - 18.0);
}

/// A logarithmic axis where most of what is to be seen lies close to zero, as it does right after a reversal.
fn x_axis(panel: &SignaturePanel, values: &[f64], (lowest, highest): (f64, f64)) -> Axis {
    let positive: Vec<f64> = values.iter().copied().filter(|value| *value > 0.0).collect();
    let (low, middle) = (quantile(&positive, 0.02), quantile(&positive, 0.5));
    if lowest >= 0.0 && panel.series.len() == 1 && middle < 0.15 * highest && highest > 20.0 * low {
        Axis::logarithmic(&*panel.x_label, low.max(1e-4 * highest), highest)
    } else {
        let counts = panel.series.iter().all(|line| is_count(&points(line).collect::<Vec<_>>()));
        let margin = if counts { 0.5 } else { 0.0 };
        Axis::linear(&*panel.x_label, lowest - margin, highest + margin, 5)
    }
}

/// Finite points of a line.
fn points(line: &SignatureSeries) -> impl Iterator<Item = (f64, f64)> + '_ {
    line.xs.iter().copied().zip(line.ys.iter().copied()).filter(|(x, y)| (x + y).is_finite())
}
