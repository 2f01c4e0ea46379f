//! Figure: one recording over time, force above and residual below, with the samples that are not counted.

use super::samples::{Samples, extent};
use crate::FigureError;
use crate::page::html::newtons;
use crate::page::style::{AFTER, BEFORE, MARKED, NOISE};
use crate::plot::{Anchor, Axis, Canvas, Color, Key, Mark, Panel, Rect, Timeline, legend_from, palette, text_width};
use crate::residual_cells::quantile;

/// Points of a line, which are about as many as pixels.
const POINTS: usize = 1000;
/// Size of the sheet, in pixels.
const SHEET: (u32, u32) = (900, 372);
/// Force as measured: broad and pale, so that it shows below a model that follows it.
const MEASURED: Color = palette::INK.faded(0.4);
/// Samples that are not counted.
const UNCOUNTED: Color = palette::SILVER.faded(0.3);

/// A strip and what a script needs to draw it anew.
#[derive(Debug)]
pub(super) struct Strip {
    /// The figure.
    pub(super) svg: String,
    /// Frames of the panels for force and residual.
    pub(super) frames: [Rect; 2],
    /// Lower and upper end of their vertical axes, in N.
    pub(super) ends_n: [[f64; 2]; 2],
    /// First and last time, in s.
    pub(super) time_s: [f64; 2],
}

/// Draws the strip of `samples`; `names` are those of the two models.
pub(super) fn strip(samples: &Samples, noise_n: f64, names: [&str; 2]) -> Result<Strip, FigureError> {
    let [force, residual] = panels(samples, noise_n);
    let svg = Canvas::document(SHEET.0, SHEET.1, &format!("{} over time", samples.name), |canvas, sheet| {
        header(canvas, sheet, samples, names);
        canvas.group(&[("class", "axes")], |canvas| {
            force.draw_frame(canvas);
            residual.draw_frame(canvas);
        });
        draw_force(canvas, &force, samples);
        draw_residual(canvas, &residual, samples, noise_n);
    })?;
    let ends = |panel: &Panel| [panel.y.from, panel.y.to];
    Ok(Strip {
        svg,
        frames: [force.frame, residual.frame],
        ends_n: [ends(&force), ends(&residual)],
        time_s: [force.x.from, force.x.to],
    })
}

/// Axes that end at what matters: a spike, or a model that runs away where nothing is counted, must not flatten all the rest.
fn panels(samples: &Samples, noise_n: f64) -> [Panel; 2] {
    let (from, to) = extent(samples.time_s().iter().copied());
    let forces = &samples.force_n;
    let (low, high) = (quantile(forces, 0.001), quantile(forces, 0.999));
    let counted = |values: &[f64]| -> Vec<f64> {
        let all = !samples.settled.contains(&true);
        values
            .iter()
            .zip(&samples.settled)
            .filter(|(_, counts)| all || **counts)
            .map(|(value, _)| value.abs())
            .collect()
    };
    let size = |values: &[f64]| quantile(&counted(values), 0.998);
    let after = samples.after_n.as_deref().map_or(0.0, size);
    let limit =
        1.1 * [size(&samples.before_n), after, 2.2 * noise_n].into_iter().filter(|n| n.is_finite()).fold(0.0, f64::max);
    let margin = 0.06 * (high - low);
    let frame = |top: f64, bottom: f64| Rect { left: 74.0, top, right: f64::from(SHEET.0) - 12.0, bottom };
    let panel =
        |frame: Rect, x: &str, y: Axis| Panel { frame, x: Axis::exact(x, from, to, 12), y, upward_labels: false };
    let mut force = panel(frame(48.0, 204.0), "", Axis::linear("force (N)", low - margin, high + margin, 5));
    // The axis below the residual is that of both.
    force.x.ticks.iter_mut().for_each(|(_, label)| label.clear());
    [force, panel(frame(216.0, 326.0), "time (s)", Axis::exact("residual (N)", -limit, limit, 4))]
}

fn header(canvas: &mut Canvas<'_>, sheet: Rect, samples: &Samples, names: [&str; 2]) {
    let left = 74.0;
    canvas.bold(&samples.name, (left, 14.0), Anchor::Start, 13.5, palette::INK);
    if samples.held_out {
        let x = left + 1.1 * text_width(&samples.name, 13.5) + 12.0;
        canvas.text("held out", (x, 14.0), Anchor::Start, 12.0, palette::GREEN);
    }
    let pair = |of: &dyn Fn(&[f64]) -> f64| match &samples.after_n {
        Some(after_n) => format!("{} → {}", newtons(of(&samples.before_n)), newtons(of(after_n))),
        None => newtons(of(&samples.before_n)),
    };
    let counted = pair(&|residual_n| samples.rms(residual_n));
    let all = pair(&|residual_n| samples.rms_all(residual_n));
    let text = format!("RMSE {counted} counted, {all} all samples");
    canvas.text(&text, (sheet.right - 12.0, 14.0), Anchor::End, 12.0, palette::GRAY);
    let mut keys = vec![Key::new("measured", Mark::Line(3.2), MEASURED)];
    if samples.after_n.is_some() {
        keys.push(Key::new(names[0], Mark::Line(2.0), BEFORE));
        keys.push(Key::new(names[1], Mark::Line(2.0), AFTER));
    } else {
        keys.push(Key::new("base model", Mark::Line(2.0), BEFORE));
    }
    keys.push(Key::new("±2 σ of the noise", Mark::Patch, NOISE));
    if samples.settled.contains(&false) {
        keys.push(Key::new("not counted", Mark::Patch, UNCOUNTED));
    }
    if !samples.stretches.is_empty() {
        keys.push(Key::new("stands out", Mark::Patch, MARKED.faded(0.45)));
    }
    // On the left, where a narrow screen shows it without scrolling.
    legend_from(canvas, &keys, left, 33.0);
}

fn draw_force(canvas: &mut Canvas<'_>, panel: &Panel, samples: &Samples) {
    let line = Timeline { time_s: samples.time_s() };
    canvas.clipped(panel.frame, &[("class", "plot force")], |canvas| {
        canvas.group(&[("class", "marks")], |canvas| {
            line.shade(canvas, panel, |row| !samples.settled[row], UNCOUNTED);
        });
        let mut draw = |name: &str, values: &[f64], color, width| {
            canvas.group(&[("class", name)], |canvas| line.line(canvas, panel, values, (color, width), POINTS));
        };
        draw("measured", &samples.force_n, MEASURED, 3.2);
        draw("before", &samples.base_n, BEFORE, 1.2);
        if let Some(model_n) = &samples.model_n {
            draw("after", model_n, AFTER, 1.2);
        }
    });
}

fn draw_residual(canvas: &mut Canvas<'_>, panel: &Panel, samples: &Samples, noise_n: f64) {
    let line = Timeline { time_s: samples.time_s() };
    canvas.clipped(panel.frame, &[("class", "plot residual")], |canvas| {
        canvas.group(&[("class", "marks")], |canvas| {
            line.shade(canvas, panel, |row| !samples.settled[row], UNCOUNTED);
            for (from, to) in &samples.stretches {
                let at =
                    |time_s: f64| panel.frame.left + panel.x.fraction(time_s).clamp(0.0, 1.0) * panel.frame.width();
                // A moment is seen as well as a minute.
                let (left, right) = (at(*from), at(*to).max(at(*from) + 2.0));
                canvas.rect(Rect { left, right, ..panel.frame }, MARKED);
            }
        });
        panel.band(canvas, -2.0 * noise_n, 2.0 * noise_n, NOISE);
        let mut draw = |name: &str, values: &[f64], color| {
            canvas.group(&[("class", name)], |canvas| line.line(canvas, panel, values, (color, 1.0), POINTS));
        };
        draw("before", &samples.before_n, BEFORE);
        if let Some(after_n) = &samples.after_n {
            draw("after", after_n, AFTER);
        }
    });
}
