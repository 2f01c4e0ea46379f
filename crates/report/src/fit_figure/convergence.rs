//! Panel f: how the swarm converged.

use super::SwarmStart;
use super::clean::extent;
use crate::number::significant;
use crate::plot::{Axis, Canvas, Key, Mark, Panel, Rect, legend, note, palette, title};

/// Points of one start's curve.
const POINTS: usize = 1000;

pub(super) fn draw(canvas: &mut Canvas<'_>, cell: Rect, starts: &[SwarmStart], noise_n: Option<f64>) {
    let (y, _) = title(canvas, cell, "f", "Convergence of the swarm");
    let polished: Vec<f64> = starts.iter().filter_map(|start| start.polished_rmse_n).filter(is_positive).collect();
    let curves = starts.iter().flat_map(|start| start.best_rmse_n.iter().copied()).filter(is_positive);
    let (lowest, highest) = extent(curves.chain(polished.iter().copied()));
    if !lowest.is_finite() {
        note(canvas, cell.inset(64.0, 40.0, 20.0, 46.0), "no swarm was run");
        return;
    }
    let iterations = starts.iter().map(|start| start.best_rmse_n.len()).max().unwrap_or(0);
    let (lowest, highest) = noise_n.map_or((lowest, highest), |noise_n| (lowest.min(noise_n), highest.max(noise_n)));
    let panel = Panel::new(
        cell,
        Axis::exact("iteration", 0.0, iterations.max(1) as f64, 5),
        Axis::logarithmic("best RMSE (N)", lowest, highest),
        78.0,
    );
    panel.draw_frame(canvas);
    let best = extent(polished.iter().copied()).0;
    let winner = starts.iter().position(|start| start.polished_rmse_n == Some(best));
    let mut labels = Vec::new();
    let mut keys = vec![Key::new(counted(starts.len()), Mark::Line(1.3), palette::SKY)];
    for pass in [false, true] {
        for (index, start) in starts.iter().enumerate().filter(|(index, _)| (Some(*index) == winner) == pass) {
            let (color, width) = if pass { (palette::BLUE, 2.2) } else { (palette::SKY.faded(0.85), 1.2) };
            panel.line(canvas, staircase(&start.best_rmse_n), color, width);
            // The drop from the swarm's last value to the polished one.
            let last = start.best_rmse_n.last().copied().filter(is_positive);
            if let (Some(last), Some(polished)) = (last, start.polished_rmse_n.filter(is_positive)) {
                let at = start.best_rmse_n.len() as f64;
                panel.line(canvas, [(at, last), (at, polished)], color, width);
                canvas.dot(panel.at(at, polished), if index == winner.unwrap_or(index) { 3.5 } else { 2.5 }, color);
            }
        }
    }
    if best.is_finite() {
        keys.push(Key::new("best", Mark::Line(2.2), palette::BLUE));
        panel.level(canvas, best, palette::INK, 1.2);
        labels.push((best, format!("{} N", significant(best, 4)), palette::INK));
        let agree = polished.iter().filter(|rmse_n| **rmse_n <= best * 1.001).count();
        let text =
            if starts.len() > 1 { format!("polished, {agree} of {} agree", starts.len()) } else { "polished".into() };
        keys.push(Key::new(text, Mark::Dashes(1.2), palette::INK));
    }
    if let Some(noise_n) = noise_n {
        panel.level(canvas, noise_n, palette::ORANGE, 1.6);
        labels.push((noise_n, format!("{} N", significant(noise_n, 3)), palette::ORANGE.toward(palette::INK, 0.35)));
        keys.push(Key::new("noise", Mark::Dashes(1.6), palette::ORANGE));
    }
    panel.label_right(canvas, &labels);
    legend(canvas, &keys, cell.right - 12.0, y + 17.0);
}

fn is_positive(value: &f64) -> bool {
    value.is_finite() && *value > 0.0
}

fn counted(starts: usize) -> String {
    if starts == 1 { "1 start".to_owned() } else { format!("{starts} starts") }
}

/// Best RMSE over iterations, thinned; a best value only falls, so every few are enough.
fn staircase(best_rmse_n: &[f64]) -> Vec<(f64, f64)> {
    let every = best_rmse_n.len().div_ceil(POINTS).max(1);
    let last = best_rmse_n.len().saturating_sub(1);
    (0..best_rmse_n.len())
        .filter(|index| index % every == 0 || *index == last)
        .filter(|index| is_positive(&best_rmse_n[*index]))
        .map(|index| ((index + 1) as f64, best_rmse_n[index]))
        .collect()
}
