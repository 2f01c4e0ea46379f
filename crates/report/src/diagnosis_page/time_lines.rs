//! Figure: residual over time, one strip per recording, with the stretches that stand out marked.

use super::samples::{Samples, extent};
use crate::FigureError;
use crate::page::html::newtons;
use crate::page::style::{AFTER, BEFORE, MARKED, NOISE};
use crate::plot::{Anchor, Axis, Canvas, Key, Mark, Panel, Rect, legend, palette, text_width, thin};
use crate::residual_cells::quantile;

/// Height of one strip with its axis and name, in pixels.
const STRIP: f64 = 128.0;
/// Points of all lines together.
const POINTS: usize = 36_000;

/// Draws a strip for each of `recordings`.
pub(super) fn time_lines(recordings: &[&Samples], noise_n: impl Fn(&Samples) -> f64) -> Result<String, FigureError> {
    let height = 34.0 + STRIP * recordings.len() as f64 + 18.0;
    let limit = recordings.iter().flat_map(|samples| {
        // A spike must not flatten all the rest.
        let residual = &samples.before_n;
        [-quantile(residual, 0.001), quantile(residual, 0.999), 2.2 * noise_n(samples)]
    });
    let limit = 1.1 * limit.filter(|limit| limit.is_finite()).fold(0.0, f64::max);
    let after = recordings.iter().any(|samples| samples.after_n.is_some());
    Canvas::document(1040, height as u32, "Residual over time", |canvas, sheet| {
        for (index, samples) in recordings.iter().enumerate() {
            let top = 34.0 + STRIP * index as f64;
            let last = index + 1 == recordings.len();
            let (from, to) = extent(samples.column(super::PageCoordinate::Time).iter().copied());
            let panel = Panel {
                frame: Rect { left: 74.0, top: top + 22.0, right: sheet.right - 12.0, bottom: top + STRIP - 26.0 },
                x: Axis::exact(if last { "time (s)" } else { "" }, from, to, 12),
                y: Axis::exact("residual (N)", -limit, limit, 4),
                upward_labels: false,
            };
            strip(canvas, &panel, samples, noise_n(samples), POINTS / (2 * recordings.len()));
        }
        let mut keys = vec![Key::new(if after { "before" } else { "base model" }, Mark::Line(2.0), BEFORE)];
        if after {
            keys.push(Key::new("after", Mark::Line(2.0), AFTER));
        }
        keys.push(Key::new("±2 standard deviations of the noise", Mark::Patch, NOISE));
        if recordings.iter().any(|samples| !samples.stretches.is_empty()) {
            keys.push(Key::new("stretch that stands out", Mark::Patch, MARKED.faded(0.45)));
        }
        legend(canvas, &keys, sheet.right - 12.0, 16.0);
    })
}

fn strip(canvas: &mut Canvas<'_>, panel: &Panel, samples: &Samples, noise_n: f64, points: usize) {
    panel.draw_frame(canvas);
    panel.band(canvas, -2.0 * noise_n, 2.0 * noise_n, NOISE);
    for (from, to) in &samples.stretches {
        let at = |time_s: f64| panel.frame.left + panel.x.fraction(time_s).clamp(0.0, 1.0) * panel.frame.width();
        let (left, right) = (at(*from), at(*to));
        // A moment is seen as well as a minute.
        let right = right.max(left + 2.0);
        canvas.rect(Rect { left, right, ..panel.frame }, MARKED);
        canvas.rect(Rect { left, right, top: panel.frame.top - 4.0, bottom: panel.frame.top }, palette::ORANGE);
    }
    let time_s = samples.column(super::PageCoordinate::Time);
    let mut draw = |residual_n: &[f64], color| {
        let kept = thin(residual_n, points.clamp(16, 1900));
        let values = kept.into_iter().map(|row| (time_s[row], residual_n[row].clamp(panel.y.from, panel.y.to)));
        panel.line(canvas, values, color, 1.0);
    };
    draw(&samples.before_n, BEFORE);
    if let Some(after_n) = &samples.after_n {
        draw(after_n, AFTER);
    }
    let y = panel.frame.top - 13.0;
    canvas.bold(&samples.name, (panel.frame.left, y), Anchor::Start, 12.5, palette::INK);
    if samples.held_out {
        let x = panel.frame.left + 1.1 * text_width(&samples.name, 12.5) + 12.0;
        canvas.text("held out", (x, y), Anchor::Start, 12.0, palette::GREEN);
    }
    let before = newtons(samples.rms(&samples.before_n));
    let text = match &samples.after_n {
        Some(after_n) => format!("root mean square {before} → {}", newtons(samples.rms(after_n))),
        None => format!("root mean square {before}"),
    };
    canvas.text(&text, (panel.frame.right, y), Anchor::End, 12.0, palette::GRAY);
}
