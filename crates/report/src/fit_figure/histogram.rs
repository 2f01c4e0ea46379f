//! Panel e: distribution of the residual against that of the noise.

use super::clean::{Clean, extent, quantile};
use super::{ESTIMATION, Role, VALIDATION};
use crate::number::significant;
use crate::plot::{Anchor, Axis, Canvas, Key, Mark, Panel, Rect, legend, palette, title};

/// Bins from end to end.
const BINS: usize = 60;

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, recordings: &[Clean], noise_n: Option<f64>) {
    let limit = limit(recordings, noise_n);
    let x = Axis::linear("residual (N)", -limit, limit, 8);
    let density = |role: Role| density(recordings, role, &x);
    let (estimation, validation) = (density(Role::Estimation), density(Role::Validation));
    let tallest = extent(estimation.iter().chain(&validation).copied()).1;
    let tallest = if tallest > 0.0 { tallest } else { 1.0 };
    let peak = noise_n.map_or(0.0, |noise_n| gauss(0.0, noise_n));
    // Noise far below the residual is a needle; its foot says enough.
    let y = Axis::linear("density (1/N)", 0.0, tallest.max(peak.min(2.0 * tallest)), 5);
    let panel = Panel::new(cell, x, y, 20.0);
    panel.draw_frame(canvas);
    let width = (panel.x.to - panel.x.from) / BINS as f64;
    let edge = |bin: usize| panel.x.from + bin as f64 * width;
    for (bin, height) in estimation.iter().enumerate().filter(|(_, height)| **height > 0.0) {
        let ((left, top), (right, bottom)) = (panel.at(edge(bin), *height), panel.at(edge(bin + 1), 0.0));
        canvas.rect(Rect { left, top, right: right - 0.75, bottom }, ESTIMATION.faded(0.55));
    }
    let has_validation = recordings.iter().any(|recording| recording.role == Role::Validation);
    if has_validation {
        let steps =
            validation.iter().enumerate().flat_map(|(bin, height)| [(edge(bin), *height), (edge(bin + 1), *height)]);
        panel.line(canvas, steps, VALIDATION, 1.8);
    }
    if let Some(noise_n) = noise_n {
        draw_noise(canvas, &panel, noise_n);
    }
    panel.line(canvas, [(panel.x.from, 0.0), (panel.x.to, 0.0)], palette::SILVER, 1.0);
    let all = || recordings.iter().flat_map(|recording| recording.residual_n.iter());
    let beyond = all().filter(|residual_n| !(panel.x.from..=panel.x.to).contains(*residual_n)).count();
    if beyond > 0 {
        let share = 100.0 * beyond as f64 / all().count() as f64;
        let text = format!("{} % beyond the axis", significant(share, 2));
        let at = (panel.frame.right - 4.0, panel.frame.top + 10.0);
        canvas.text(&text, at, Anchor::End, 11.5, palette::GRAY);
    }

    let (y, _) = title(canvas, cell, "e", "Residual against noise");
    let mut keys = vec![Key::new("estimation", Mark::Patch, ESTIMATION.faded(0.55))];
    if has_validation {
        keys.push(Key::new("validation", Mark::Line(1.8), VALIDATION));
    }
    if noise_n.is_some() {
        keys.push(Key::new("noise alone", Mark::Line(2.0), palette::ORANGE.toward(palette::INK, 0.1)));
    }
    legend(canvas, &keys, panel.frame.right, y + 17.0);
}

/// Half the width of the axis: nearly all residuals, and the noise in any case.
fn limit(recordings: &[Clean], noise_n: Option<f64>) -> f64 {
    let sizes: Vec<f64> = recordings
        .iter()
        .flat_map(|recording| recording.residual_n.iter().map(|residual_n| residual_n.abs()))
        .collect();
    let limit = quantile(&sizes, 0.995).max(3.5 * noise_n.unwrap_or(0.0));
    if limit > 0.0 { limit } else { 1.0 }
}

/// Share of samples per newton in each bin.
fn density(recordings: &[Clean], role: Role, x: &Axis) -> Vec<f64> {
    let mut counts = vec![0.0; BINS];
    let mut total = 0.0;
    for recording in recordings.iter().filter(|recording| recording.role == role) {
        for residual_n in &recording.residual_n {
            let share = x.fraction(*residual_n);
            if (0.0..1.0).contains(&share) {
                counts[(share * BINS as f64) as usize] += 1.0;
            }
            total += 1.0;
        }
    }
    let width = (x.to - x.from) / BINS as f64;
    counts.into_iter().map(|count| if total > 0.0 { count / (total * width) } else { 0.0 }).collect()
}

/// The noise's bell; where it is taller than the panel, its two flanks.
fn draw_noise(canvas: &mut Canvas<'_>, panel: &Panel, noise_n: f64) {
    let color = palette::ORANGE.toward(palette::INK, 0.1);
    let peak = gauss(0.0, noise_n);
    let clear = if peak > panel.y.to { noise_n * (2.0 * (peak / panel.y.to).ln()).sqrt() } else { 0.0 };
    let end = (5.0 * noise_n).min(panel.x.to);
    for side in [-1.0, 1.0] {
        let flank = (0..=100).map(|step| clear + (end - clear) * f64::from(step) / 100.0);
        let flank = flank.map(|size_n| (side * size_n, gauss(size_n, noise_n).min(panel.y.to)));
        panel.line(canvas, flank, color, 2.0);
    }
}

fn gauss(value: f64, deviation: f64) -> f64 {
    (-0.5 * (value / deviation).powi(2)).exp() / (deviation * (2.0 * std::f64::consts::PI).sqrt())
}
