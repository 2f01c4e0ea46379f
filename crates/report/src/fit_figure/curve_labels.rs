//! Labels of the curves in panels a and b: the value of the other channel.

use super::characteristic::Abscissa;
use super::clean::{mean, quantile};
use super::curves::{Mean, curves};
use super::sweeps::Sweep;
use crate::plot::{Anchor, Canvas, Color, Panel, palette, text_width};

/// What is written at the right ends of curves: the other channel's value.
pub(super) fn labels(
    abscissa: Abscissa,
    sweeps: &[Sweep<'_>],
    means: &[Mean],
    levels: &[f64],
    (lowest, highest): (f64, f64),
) -> Vec<(f64, String, Color)> {
    // The label of a curve that ends far from the edge would seem to belong to another.
    let reaches_edge = |at: f64| at >= highest - 0.2 * (highest - lowest);
    // Text, sum of heights, how many.
    let mut labels: Vec<(String, f64, f64)> = Vec::new();
    let mut add = |text: String, height: f64| match labels.iter_mut().find(|label| label.0 == text) {
        Some(label) => (label.1, label.2) = (label.1 + height, label.2 + 1.0),
        None => labels.push((text, height, 1.0)),
    };
    for curve in curves(means, 0.0) {
        if reaches_edge(curve.end.0) {
            add(abscissa.level_text(levels[curve.level]), curve.end.1);
        }
    }
    for Sweep { recording, rows, level, .. } in sweeps {
        let along = &abscissa.along(recording)[rows.clone()];
        let end = quantile(along, 0.97);
        if reaches_edge(end) {
            let force_n = &recording.force_n[rows.clone()];
            let at_end: Vec<f64> =
                along.iter().zip(force_n).filter(|(x, _)| **x >= end).map(|(_, force)| *force).collect();
            add(abscissa.level_text(*level), mean(&at_end));
        }
    }
    labels.into_iter().map(|(text, sum, count)| (sum / count, text, palette::GRAY)).collect()
}

/// Writes the other channel's value at the ends of long curves that end within the panel.
pub(super) fn label_within(
    canvas: &mut Canvas<'_>,
    panel: &Panel,
    (abscissa, (lowest, highest)): (Abscissa, (f64, f64)),
    sweeps: &[Sweep<'_>],
) {
    const SIZE: f64 = 11.0;
    let mut written: Vec<(f64, f64)> = Vec::new();
    for Sweep { recording, rows, level, .. } in sweeps {
        let (along, force_n) = (&abscissa.along(recording)[rows.clone()], &recording.force_n[rows.clone()]);
        let (low, high) = (quantile(along, 0.03), quantile(along, 0.97));
        if high - low < 0.4 * (highest - lowest) || high >= highest - 0.2 * (highest - lowest) {
            continue;
        }
        let Some(end) = (0..along.len()).max_by(|a, b| along[*a].total_cmp(&along[*b])) else { continue };
        let (x, y) = panel.at(along[end], force_n[end]);
        let text = abscissa.level_text(*level);
        // Curves rise: to the left above the end there is room.
        let fits = x - 4.0 - text_width(&text, SIZE) > panel.frame.left;
        if fits && written.iter().all(|at| (at.0 - x).abs() > 60.0 || (at.1 - y).abs() > 14.0) {
            canvas.text(&text, (x - 4.0, y - 9.0), Anchor::End, SIZE, palette::GRAY);
            written.push((x, y));
        }
    }
}
