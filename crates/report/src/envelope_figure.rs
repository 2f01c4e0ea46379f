//! The figure of a robustness study: errors over time, and how the errors of whole lifts are distributed.
//!
//! | panel | shows                                                                                |
//! |-------|--------------------------------------------------------------------------------------|
//! | a     | angle error over time: median, and the bands that hold 50, 90 and 99 % of the trials |
//! | b     | share of the trials whose MAX, MAE and RMSE stay below a value, against the paper's  |

use crate::FigureError;
use crate::plot::{Anchor, Axis, Canvas, Color, Key, Mark, Panel, Rect, legend, palette, title};

/// Everything that the figure shows.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvelopeFigure {
    /// Headline.
    pub title: String,
    /// Line below it.
    pub subtitle: String,
    /// Time (s), and the angle error (rad) at the shares 0.5, 5, 25, 50, 75, 95 and 99.5 % of the trials.
    pub envelope: Vec<(f64, [f64; 7])>,
    /// MAX, MAE and RMSE of every trial, in rad.
    pub errors_rad: [Vec<f64>; 3],
    /// The paper's values for them, in rad; where the lift is the paper's.
    pub paper_rad: Option<[f64; 3]>,
}

/// Names and colors of the three errors.
const ERRORS: [(&str, Color); 3] = [("MAX", palette::VERMILION), ("MAE", palette::GREEN), ("RMSE", palette::PURPLE)];

/// Draws the figure, as an SVG document of 1000 × 860 pixels.
///
/// # Errors
/// [`FigureError::NothingToDraw`] without a trial.
pub fn envelope_figure(figure: &EnvelopeFigure) -> Result<String, FigureError> {
    if figure.envelope.is_empty() || figure.errors_rad.iter().any(Vec::is_empty) {
        return Err(FigureError::NothingToDraw);
    }
    Canvas::document(1000, 860, &figure.title, |canvas, sheet| {
        let page = sheet.inset(14.0, 0.0, 14.0, 8.0);
        canvas.bold(&figure.title, (page.left + 14.0, 26.0), Anchor::Start, 19.0, palette::INK);
        canvas.text(&figure.subtitle, (page.left + 14.0, 50.0), Anchor::Start, 13.5, palette::GRAY);
        let [upper, lower] = page.inset(0.0, 68.0, 0.0, 0.0).rows([1.0; 2], 12.0);
        draw_envelope(canvas, upper, &figure.envelope);
        draw_distribution(canvas, lower, figure);
    })
}

fn draw_envelope(canvas: &mut Canvas<'_>, cell: Rect, envelope: &[(f64, [f64; 7])]) {
    let finite = || envelope.iter().flat_map(|(_, shares)| shares).filter(|value| value.is_finite());
    let (lowest, highest) = finite().fold((0.0_f64, 0.0_f64), |(low, high), value| (low.min(*value), high.max(*value)));
    let end_s = envelope.last().map_or(1.0, |(time_s, _)| *time_s);
    let x = Axis::exact("time (s)", 0.0, end_s, 6);
    let y = Axis::linear("tracking error (mrad)", 1.1e3 * lowest, 1.1e3 * highest, 6);
    let panel = Panel::new(cell, x, y, 16.0);
    panel.draw_frame(canvas);
    let column = |share: usize| envelope.iter().map(move |(time_s, shares)| (*time_s, 1e3 * shares[share]));
    for (low, high, opacity) in [(0, 6, 0.16), (1, 5, 0.26), (2, 4, 0.4)] {
        let mut outline: Vec<(f64, f64)> = column(high).collect();
        outline.extend(column(low).collect::<Vec<_>>().into_iter().rev());
        outline.retain(|(_, error)| error.is_finite());
        canvas.area(outline.into_iter().map(|(time_s, error)| panel.at(time_s, error)), palette::BLUE.faded(opacity));
    }
    panel.line(canvas, [(0.0, 0.0), (end_s, 0.0)], palette::SILVER, 1.0);
    panel.line(canvas, column(3), palette::BLUE.toward(palette::INK, 0.4), 1.8);
    let (y, _) = title(canvas, cell, "a", "Tracking error of the angle over time");
    let keys = [
        Key::new("median", Mark::Line(1.8), palette::BLUE.toward(palette::INK, 0.4)),
        Key::new("50 %", Mark::Patch, palette::BLUE.faded(0.65)),
        Key::new("90 %", Mark::Patch, palette::BLUE.faded(0.4)),
        Key::new("99 % of the trials", Mark::Patch, palette::BLUE.faded(0.16)),
    ];
    legend(canvas, &keys, panel.frame.right, y);
}

fn draw_distribution(canvas: &mut Canvas<'_>, cell: Rect, figure: &EnvelopeFigure) {
    let sorted = figure.errors_rad.clone().map(|mut errors| {
        errors.retain(|error| error.is_finite());
        errors.sort_by(f64::total_cmp);
        errors
    });
    let ends = || sorted.iter().flat_map(|errors| errors.first().into_iter().chain(errors.last()));
    let lowest = ends().chain(figure.paper_rad.iter().flatten()).copied().fold(f64::MAX, f64::min);
    let highest = ends().chain(figure.paper_rad.iter().flatten()).copied().fold(f64::MIN, f64::max);
    let x = Axis::logarithmic("tracking error (mrad)", 0.9e3 * lowest, 1.1e3 * highest);
    let panel = Panel::new(cell, x, Axis::exact("share of the trials (%)", 0.0, 100.0, 5), 20.0);
    panel.draw_frame(canvas);
    panel.level(canvas, 95.0, palette::SILVER, 1.2);
    let (left, height) = panel.at(panel.x.from, 95.0);
    canvas.text("95 %", (left + 6.0, height + 9.0), Anchor::Start, 12.5, palette::GRAY);
    for (index, (errors, (name, color))) in sorted.iter().zip(ERRORS).enumerate() {
        let total = figure.errors_rad[index].len();
        // As many points as there are pixels, however many trials.
        let points = (0..=600).filter_map(|point| {
            let row = (point * errors.len().checked_sub(1)?) / 600;
            Some((1e3 * errors[row], 100.0 * (row + 1) as f64 / total as f64))
        });
        panel.line(canvas, points, color, 2.0);
        let Some(paper_rad) = figure.paper_rad else { continue };
        let (x, _) = panel.at(1e3 * paper_rad[index], 0.0);
        canvas.dashes((x, panel.frame.top), (x, panel.frame.bottom), color.faded(0.8), 1.2, 4.0);
        let at = (x - 8.0, panel.frame.bottom - 14.0);
        canvas.upward(&format!("paper's {name}"), at, Anchor::Start, 12.5, color.toward(palette::INK, 0.3));
    }
    let (y, _) = title(canvas, cell, "b", "Tracking error of whole lifts");
    let keys = ERRORS.map(|(name, color)| Key::new(name, Mark::Line(2.0), color));
    legend(canvas, &keys, panel.frame.right, y);
}
