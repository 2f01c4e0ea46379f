//! Figure: residual over pressure and contraction, before and after, mean and root mean square.

use pam_artifact::diagnosis::Region;
use pam_muscle::Coordinate;

use super::coordinate::OnPage as _;
use super::samples::Samples;
use crate::FigureError;
use crate::page::style::{mean_color, size_color};
use crate::plot::{Anchor, Axis, Canvas, Color, ColorBar, Map, Panel, Rect, palette};
use crate::residual_cells::{Channel, quantile};

/// Height of one map with its title and axes, in pixels.
const ROW: f64 = 330.0;

/// Draws the maps; those after the effects stand on the right.
pub(super) fn residual_maps(recordings: &[Samples], regions: &[Region], noise_n: f64) -> Result<String, FigureError> {
    let after = recordings.iter().any(|samples| samples.after_n.is_some());
    let pick = |coordinate| recordings.iter().map(|samples: &Samples| samples.column(coordinate)).collect();
    let pressure = Channel::new("pressure (kPa)", pick(Coordinate::Pressure), 0.05, 0, 26);
    let contraction = Channel::new("contraction (%)", pick(Coordinate::Contraction), 0.015, 1, 18);
    let grid = Grid { pressure, contraction };
    let before_cells = grid.sums(recordings, |samples| &samples.before_n);
    let after_cells = grid.sums(recordings, Samples::last_n);
    let limit = |of: fn(&Sum) -> Option<f64>, least: f64| {
        let sizes: Vec<f64> = before_cells.iter().chain(&after_cells).filter_map(of).map(f64::abs).collect();
        // The few largest cells may saturate; a map within the noise must not look alarming.
        let limit = quantile(&sizes, 0.985).max(least);
        if limit > 0.0 { limit } else { 1.0 }
    };
    let (mean_limit, rms_limit) = (limit(Sum::mean, noise_n), limit(Sum::rms, 2.5 * noise_n));
    let mean_bar = ColorBar {
        title: "mean (N)".to_owned(),
        from: -mean_limit,
        to: mean_limit,
        logarithm: false,
        color: mean_color,
    };
    let rms_bar =
        ColorBar { title: "rms (N)".to_owned(), from: 0.0, to: rms_limit, logarithm: false, color: size_color };
    let height = if after { 2.0 * ROW } else { ROW };
    Canvas::document(900, height as u32, "Residual over pressure and contraction", |canvas, sheet| {
        let [left, right] = sheet.columns([1.0, 1.0], 20.0);
        let mut draw = |cell: Rect, title: &str, cells: &[Sum], of: fn(&Sum) -> Option<f64>, bar: &ColorBar| {
            canvas.bold(title, (cell.left + 8.0, cell.top + 15.0), Anchor::Start, 14.0, palette::INK);
            let panel = grid.draw(canvas, cell, cells.iter().map(of).collect(), bar);
            for region in regions {
                mark(canvas, &grid, &panel, region);
            }
        };
        if after {
            let [top, bottom] = [0.0, ROW].map(|top| (top, top + ROW));
            let at = |column: Rect, (top, bottom): (f64, f64)| Rect { top, bottom, ..column };
            draw(at(left, top), "Before: mean residual", &before_cells, Sum::mean, &mean_bar);
            draw(at(right, top), "After: mean residual", &after_cells, Sum::mean, &mean_bar);
            draw(at(left, bottom), "Before: size of the residual", &before_cells, Sum::rms, &rms_bar);
            draw(at(right, bottom), "After: size of the residual", &after_cells, Sum::rms, &rms_bar);
        } else {
            draw(left, "Mean residual", &before_cells, Sum::mean, &mean_bar);
            draw(right, "Size of the residual", &before_cells, Sum::rms, &rms_bar);
        }
    })
}

/// A bar along the edge of the map over a region of its coordinates.
fn mark(canvas: &mut Canvas<'_>, grid: &Grid<'_>, panel: &Panel, region: &Region) {
    const COLOR: Color = palette::ORANGE;
    let [from, to] = [region.from, region.to].map(|value| region.coordinate.of_si(value));
    let within = |axis: &Axis, value: f64| axis.fraction(value).clamp(0.0, 1.0);
    let Rect { left, top, right, bottom } = panel.frame;
    match region.coordinate {
        Coordinate::Pressure if grid.pressure.is_scale() => {
            let at = |value| left + within(&panel.x, value) * panel.frame.width();
            canvas.rect(Rect { left: at(from), right: at(to), top: top - 7.0, bottom: top - 3.0 }, COLOR);
        }
        Coordinate::Contraction if grid.contraction.is_scale() => {
            let at = |value| bottom - within(&panel.y, value) * panel.frame.height();
            canvas.rect(Rect { left: right + 3.0, right: right + 7.0, top: at(to), bottom: at(from) }, COLOR);
        }
        _ => {}
    }
}

struct Grid<'a> {
    pressure: Channel<'a>,
    contraction: Channel<'a>,
}

/// Sums over the samples of one cell.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    n: f64,
    sum: f64,
    squares: f64,
}

impl Sum {
    fn mean(&self) -> Option<f64> {
        (self.n > 0.0).then(|| self.sum / self.n)
    }

    fn rms(&self) -> Option<f64> {
        (self.n > 0.0).then(|| f64::sqrt(self.squares / self.n))
    }
}

impl Grid<'_> {
    fn sums(&self, recordings: &[Samples], residual: fn(&Samples) -> &[f64]) -> Vec<Sum> {
        let n_columns = self.pressure.bins().count();
        let mut sums = vec![Sum::default(); n_columns * self.contraction.bins().count()];
        for (index, samples) in recordings.iter().enumerate() {
            for (sample, residual_n) in residual(samples).iter().enumerate() {
                let cell = self.pressure.bin_of(index, sample).zip(self.contraction.bin_of(index, sample));
                if let Some((column, row)) = cell
                    && samples.settled[sample]
                {
                    let sum = &mut sums[row * n_columns + column];
                    sum.n += 1.0;
                    sum.sum += residual_n;
                    sum.squares += residual_n * residual_n;
                }
            }
        }
        sums
    }

    fn draw(&self, canvas: &mut Canvas<'_>, cell: Rect, values: Vec<Option<f64>>, bar: &ColorBar) -> Panel {
        let (columns, rows) = (self.pressure.bins().clone(), self.contraction.bins().clone());
        Map { columns, rows, values, texts: Vec::new(), bar: bar.clone() }.draw(canvas, cell)
    }
}
