//! A panel of curves over time.

use super::PanelData;
use crate::plot::{Axis, Canvas, Color, Key, Mark, Panel, Rect, legend, palette, thin, title};

/// Length of a dash, in pixels.
const DASH: f64 = 6.0;

/// Values over time.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    /// Name in the legend.
    text: &'static str,
    mark: Mark,
    color: Color,
    /// One value for each instant.
    values: Vec<f64>,
}

impl Curve {
    /// `mark` is a line or dashes.
    pub(super) fn new(text: &'static str, mark: Mark, color: Color, values: Vec<f64>) -> Self {
        Self { text, mark, color, values }
    }

    /// The curve of what `of` makes of each value and of what it should be.
    pub(super) fn mapped(mut self, should: &[f64], of: impl Fn(f64, f64) -> f64) -> Self {
        for (value, should) in self.values.iter_mut().zip(should) {
            *value = of(*should, *value);
        }
        self
    }
}

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, letter: &str, data: &PanelData, time_s: &[f64]) {
    let finite = |values: &[f64]| -> (f64, f64) {
        values
            .iter()
            .filter(|value| value.is_finite())
            .fold((f64::MAX, f64::MIN), |(low, high), &value| (low.min(value), high.max(value)))
    };
    let (start_s, end_s) = finite(time_s);
    let (lowest, highest) = data
        .curves
        .iter()
        .map(|curve| finite(&curve.values))
        .fold((f64::MAX, f64::MIN), |(low, high), (lowest, highest)| (low.min(lowest), high.max(highest)));
    let margin = 0.04 * (highest - lowest).max(0.0);
    let x = Axis::exact("time (s)", start_s, end_s, 6);
    let y = Axis::linear(data.axis, lowest - margin, highest + margin, 5);
    let panel = Panel::new(cell, x, y, 16.0);
    panel.draw_frame(canvas);
    if panel.y.from < 0.0 && panel.y.to > 0.0 {
        panel.line(canvas, [(panel.x.from, 0.0), (panel.x.to, 0.0)], palette::SILVER, 1.0);
    }
    let pixels = panel.frame.width();
    for curve in &data.curves {
        let kept = thin(&curve.values, (2.0 * pixels) as usize);
        let points = kept.into_iter().filter_map(|row| Some((*time_s.get(row)?, curve.values[row])));
        match curve.mark {
            Mark::Dashes(width) => {
                let points = points.map(|(time_s, value)| panel.at(time_s, value));
                canvas.dashed_line(points, curve.color, width, DASH);
            }
            Mark::Line(width) => panel.line(canvas, points, curve.color, width),
            Mark::Dot | Mark::Ring | Mark::Patch => {}
        }
    }
    let (y, _) = title(canvas, cell, letter, data.title);
    let keys: Vec<Key> = data.curves.iter().map(|curve| Key::new(curve.text, curve.mark, curve.color)).collect();
    legend(canvas, &keys, panel.frame.right, y);
}
