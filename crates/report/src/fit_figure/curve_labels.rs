//! Labels of the curves in panels a and b: the value of the other channel.

use super::characteristic::Abscissa;
use super::clean::{mean, quantile};
use super::curves::{Mean, curves};
use super::sweeps::Sweep;
use crate::plot::{Anchor, Canvas, Color, Panel, palette, text_width};

/// Size of a label within the panel, in pixels.
const SIZE: f64 = 11.0;

/// Labels at the right ends of curves: the other channel's value.
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
    let ends = sweeps.iter().filter_map(|Sweep { recording, rows, level, .. }| {
        let along = &abscissa.along(recording)[rows.clone()];
        let (low, high) = (quantile(along, 0.03), quantile(along, 0.97));
        let ends_within = high - low >= 0.4 * (highest - lowest) && high < highest - 0.2 * (highest - lowest);
        let end = (0..along.len()).max_by(|a, b| along[*a].total_cmp(&along[*b]))?;
        ends_within.then(|| (panel.at(along[end], recording.force_n[rows.start + end]), abscissa.level_text(*level)))
    });
    // Some hundred points of each curve, in pixels: a label must not lie on one.
    let mut taken: Vec<(f64, f64)> = sweeps
        .iter()
        .flat_map(|Sweep { recording, rows, .. }| {
            let along = abscissa.along(recording);
            let every = (rows.len() / 300).max(1);
            rows.clone().step_by(every).map(|row| panel.at(along[row], recording.force_n[row]))
        })
        .collect();
    for ((x, y), text) in ends {
        let width = text_width(&text, SIZE);
        let places = [(x + 6.0, y), (x - 4.0 - width, y - 9.0), (x + 6.0, y + 9.0), (x - 0.5 * width, y - 11.0)];
        let is_free = |(left, middle): &(f64, f64)| {
            let inside = *left > panel.frame.left && left + width < panel.frame.right && middle - 6.0 > panel.frame.top;
            inside
                && !taken.iter().any(|(x, y)| (left - 2.0..left + width + 2.0).contains(x) && (y - middle).abs() < 8.0)
        };
        if let Some((left, middle)) = places.into_iter().find(is_free) {
            canvas.text(&text, (left, middle), Anchor::Start, SIZE, palette::GRAY);
            taken.extend([0.0, 0.5, 1.0].map(|share| (left + share * width, middle)));
        }
    }
}
