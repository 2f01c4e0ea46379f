//! Figure: residuals before and after as bars, with the noise floor across them.

use pam_artifact::diagnosis::BeforeAfter;

use crate::FigureError;
use crate::page::html::newtons;
use crate::page::style::{AFTER, BEFORE};
use crate::plot::{Anchor, Axis, Canvas, Key, Mark, Panel, Rect, legend_from, legend_width, palette};

/// Height of a bar, in pixels.
const BAR: f64 = 22.0;
/// Width of the figure, in pixels: narrow enough to be read on a telephone.
const WIDTH: f64 = 540.0;

/// Draws a pair of bars for each entry of `fits`; one bar where nothing was added to the model.
pub(super) fn fit_bars(
    title: &str,
    fits: &[(&str, BeforeAfter)],
    additions: Option<&str>,
) -> Result<String, FigureError> {
    let after = additions.is_some();
    let group = if after { 2.0 * BAR + 34.0 } else { BAR + 34.0 };
    let height = 44.0 + group * fits.len() as f64 + 46.0;
    let largest = fits.iter().flat_map(|(_, fit)| [fit.rmse_before_n, fit.rmse_after_n, fit.noise_floor_n]);
    let largest = largest.filter(|value| value.is_finite()).fold(0.0, f64::max);
    let mut keys = vec![Key::new("base model, refitted", Mark::Patch, BEFORE)];
    let with = additions.map(|additions| format!("with {additions}"));
    keys.extend(with.as_deref().map(|with| Key::new(with, Mark::Patch, AFTER)));
    keys.push(Key::new("noise floor", Mark::Dashes(1.8), palette::INK));
    let width = WIDTH.max(legend_width(&keys) + 16.0);
    Canvas::document(width as u32, height as u32, title, |canvas, sheet| {
        let panel = Panel {
            frame: Rect { left: 166.0, top: 36.0, right: sheet.right - 66.0, bottom: height - 46.0 },
            x: Axis::exact("residual, root mean square (N)", 0.0, 1.04 * largest, 6),
            y: Axis::exact("", 0.0, 1.0, 1),
            upward_labels: false,
        };
        for (value, _) in &panel.x.ticks {
            let x = panel.at(*value, 0.0).0;
            canvas.line([(x, panel.frame.top), (x, panel.frame.bottom)], palette::MIST, 1.0);
        }
        for (index, (name, fit)) in fits.iter().enumerate() {
            let top = panel.frame.top + group * index as f64;
            let middle = top + 0.5 * group;
            canvas.text(name, (panel.frame.left - 12.0, middle), Anchor::End, 13.0, palette::INK);
            let mut bars = vec![(fit.rmse_before_n, BEFORE)];
            if after {
                bars.push((fit.rmse_after_n, AFTER));
            }
            let mut bar_top = middle - 0.5 * (BAR * bars.len() as f64 + 4.0 * (bars.len() as f64 - 1.0));
            for (value, color) in bars {
                let (left, right) = (panel.frame.left, panel.at(value, 0.0).0);
                canvas.rect(Rect { left, top: bar_top, right, bottom: bar_top + BAR }, color);
                // Beyond the noise floor where the bar ends close before it.
                let floor = panel.at(fit.noise_floor_n, 0.0).0;
                let at = if floor > right - 4.0 && floor < right + 60.0 { floor.max(right) } else { right };
                let text = newtons(value);
                canvas.text(&text, (at + 9.0, bar_top + 0.5 * BAR), Anchor::Start, 13.0, palette::INK);
                bar_top += BAR + 4.0;
            }
            if fit.noise_floor_n.is_finite() {
                let x = panel.at(fit.noise_floor_n, 0.0).0;
                canvas.dashes((x, top + 6.0), (x, top + group - 6.0), palette::INK, 1.8, 4.0);
            }
        }
        let (left, bottom) = (panel.frame.left, panel.frame.bottom);
        canvas.line([(left, panel.frame.top), (left, bottom)], palette::SILVER, 1.0);
        panel.draw_x_axis(canvas);
        legend_from(canvas, &keys, 8.0, 16.0);
    })
}
