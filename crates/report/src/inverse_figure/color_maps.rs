//! Panels a to c: pressure, slope and error in color.
//!
//! # Design
//! A map of a rectangle for each cell is half a megabyte. So colors come in steps, and neighbors of one color are one
//! rectangle: a tenth of them, which also reads as the contour map that it is.

use std::ops::Range;

use super::{InverseCell, InverseMap, SlopeCell, SlopeMap};
use crate::plot::{
    Anchor, Axis, Bins, Canvas, Color, ColorBar, Key, Map, Mark, Panel, Rect, diverging, legend, palette, round_levels,
    sequential, title,
};

/// Where there is nothing to show.
const BLANK: Color = Color::new(0xF1, 0xF1, 0xF1);
/// Where the inverse is missing.
const MISSING: Color = Color::new(0xC9, 0xC9, 0xC9);
/// Stripes on it.
const STRIPE: Color = Color::new(0x77, 0x77, 0x77);

/// Panel a.
pub(super) fn pressure(canvas: &mut Canvas<'_>, cell: Rect, map: &InverseMap) {
    let values = map.values(|network_kpa, _| network_kpa);
    let (lowest, highest) = extent(values.iter().copied().flatten());
    let axis = Axis::linear("", lowest, highest, 5);
    let bar = ColorBar {
        title: "pressure (kPa)".to_owned(),
        from: axis.from,
        to: axis.to,
        logarithm: false,
        color: stepped_sequential,
    };
    let panel = map.draw(canvas, cell, &values, &bar);
    let levels = round_levels(lowest, highest, 9);
    for level in levels.iter().filter(|level| **level > lowest) {
        let color = bar.color_of(*level).readable_on();
        let line = map.level_line(*level);
        if line.len() * 3 < map.n_columns {
            continue;
        }
        // The label interrupts the line where it is longest away from the others.
        let label_at = line.len() * 3 / 4;
        let gap = label_at.saturating_sub(1)..(label_at + 2).min(line.len());
        panel.line(canvas, line[..gap.start.min(line.len())].iter().copied(), color.faded(0.8), 1.2);
        panel.line(canvas, line[gap.end.min(line.len())..].iter().copied(), color.faded(0.8), 1.2);
        if let Some(&(length_mm, force_n)) = line.get(label_at) {
            canvas.text(&format!("{level}"), panel.at(length_mm, force_n), Anchor::Middle, 11.0, color);
        }
    }
    let (y, _) = title(canvas, cell, "a", "Learned pressure, contracting");
    keys(canvas, cell, y, map.has_missing());
}

/// Panel b.
pub(super) fn slope(canvas: &mut Canvas<'_>, cell: Rect, map: &SlopeMap) {
    let rising = |cell: &SlopeCell| if let SlopeCell::Rising(slope) = cell { Some(*slope) } else { None };
    let values: Vec<Option<f64>> = map.cells.iter().map(rising).collect();
    let (_, highest) = extent(values.iter().copied().flatten());
    let axis = Axis::linear("", 0.0, highest, 5);
    let bar = ColorBar {
        title: "dF/dp (N/kPa)".to_owned(),
        from: 0.0,
        to: axis.to,
        logarithm: false,
        color: stepped_sequential,
    };
    let n_rows = map.cells.len() / map.n_columns.max(1);
    let (columns, rows) = (length_axis(map.length_mm), exact_axis("pressure (kPa)", map.pressure_kpa));
    let (columns, rows) = (Bins::Equal(columns, map.n_columns), Bins::Equal(rows, n_rows));
    let panel = draw_runs(canvas, cell, [columns, rows], &values, &bar);
    let missing: Vec<bool> = map.cells.iter().map(|cell| *cell == SlopeCell::Missing).collect();
    let blank: Vec<bool> = map.cells.iter().map(|cell| *cell == SlopeCell::OutOfReach).collect();
    cover(canvas, &panel, map.n_columns, &missing, &blank);
    let (y, _) = title(canvas, cell, "b", "Slope of the force, contracting");
    keys(canvas, cell, y, missing.contains(&true));
}

/// Panel c: at each cell the error of the direction in which it is larger.
pub(super) fn error(canvas: &mut Canvas<'_>, cell: Rect, maps: &[InverseMap; 2]) {
    let [contracting, extending] = maps;
    let larger = |one: &InverseCell, other: &InverseCell| match (error_kpa(one), error_kpa(other)) {
        (Some(one_kpa), Some(other_kpa)) => {
            if one_kpa.abs() >= other_kpa.abs() {
                *one
            } else {
                *other
            }
        }
        (Some(_), None) => *one,
        (None, Some(_)) => *other,
        (None, None) => {
            if *one == InverseCell::Missing {
                *one
            } else {
                *other
            }
        }
    };
    // The two end at the same lengths; where forces end, that of the higher one is shown.
    let (higher, lower) =
        if contracting.force_n[1] > extending.force_n[1] { (contracting, extending) } else { (extending, contracting) };
    let cells = higher
        .cells
        .iter()
        .enumerate()
        .map(|(index, one)| lower.at(higher, index).map_or(*one, |other| larger(one, other)));
    let map = InverseMap { cells: cells.collect(), ..higher.clone() };
    let values: Vec<Option<f64>> = map.cells.iter().map(error_kpa).collect();
    let limit_kpa = limit_kpa(maps);
    let bar = ColorBar {
        logarithm: false,
        title: "error (kPa)".to_owned(),
        from: -limit_kpa,
        to: limit_kpa,
        color: |share| diverging(2.0 * middle_of_step(share) - 1.0),
    };
    map.draw(canvas, cell, &values, &bar);
    let (y, _) = title(canvas, cell, "c", "Network less exact inverse, worse direction");
    // Panel a shows the points outside the domain.
    if map.has_missing() {
        keys(canvas, cell, y + 2.0, true);
    }
}

fn error_kpa(cell: &InverseCell) -> Option<f64> {
    if let InverseCell::Found { network_kpa, exact_kpa } = cell { Some(network_kpa - exact_kpa) } else { None }
}

/// Steps that a range of values is colored in; odd, so that zero in the middle of a range has a color of its own.
const STEPS: f64 = 15.0;

fn middle_of_step(share: f64) -> f64 {
    ((share.clamp(0.0, 1.0) * STEPS).floor().min(STEPS - 1.0) + 0.5) / STEPS
}

fn stepped_sequential(share: f64) -> Color {
    sequential(middle_of_step(share))
}

/// Cells of one color that make a rectangle.
#[derive(Debug, Clone, PartialEq)]
struct Run {
    columns: Range<usize>,
    rows: Range<usize>,
    color: Color,
}

/// The rectangles of a map, from its upper end: cells of a row that have one color, and rows that are alike there.
fn runs(values: &[Option<f64>], n_columns: usize, color: impl Fn(&Option<f64>) -> Option<Color>) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    // The first run that reaches the row above.
    let mut above = 0;
    for (row, values) in values.chunks_exact(n_columns).enumerate().rev() {
        let (mut start, first) = (0, runs.len());
        for cells in values.chunk_by(|one, next| color(one) == color(next)) {
            let columns = start..start + cells.len();
            start = columns.end;
            let Some(color) = color(&cells[0]) else { continue };
            let alike = |run: &Run| run.columns == columns && run.color == color && run.rows.start == row + 1;
            if let Some(run) = runs[above..first].iter_mut().find(|run| alike(run)) {
                run.rows.start = row;
            } else {
                runs.push(Run { columns, rows: row..row + 1, color });
            }
        }
        // A run that goes on may lie further up.
        above = runs.iter().position(|run| run.rows.start == row).unwrap_or(runs.len());
    }
    runs
}

/// A map whose neighbors of one color are one rectangle.
fn draw_runs(
    canvas: &mut Canvas<'_>,
    cell: Rect,
    [columns, rows]: [Bins; 2],
    values: &[Option<f64>],
    bar: &ColorBar,
) -> Panel {
    let (n_columns, n_rows) = (columns.count().max(1), rows.count().max(1));
    let panel = Map { columns, rows, values: Vec::new(), texts: Vec::new(), bar: bar.clone() }.draw(canvas, cell);
    let Rect { left, right, bottom, .. } = panel.frame;
    let (width, height) = (panel.frame.width() / n_columns as f64, panel.frame.height() / n_rows as f64);
    let color = |value: &Option<f64>| value.filter(|value| value.is_finite()).map(|value| bar.color_of(value));
    // From the top and from the left, each overlapping the next by a fraction of a pixel, so that no seam shows.
    for Run { columns, rows, color } in runs(values, n_columns, color) {
        let tile = Rect {
            left: left + columns.start as f64 * width,
            right: (left + columns.end as f64 * width + 0.5).min(right),
            top: bottom - rows.end as f64 * height,
            bottom: (bottom - rows.start as f64 * height + 0.5).min(bottom),
        };
        canvas.rect(tile, color);
    }
    panel
}

/// End of the colors of errors: nearly all of them lie below.
fn limit_kpa(maps: &[InverseMap; 2]) -> f64 {
    let mut sizes: Vec<f64> =
        maps.iter().flat_map(|map| map.values(|network, exact| (network - exact).abs())).flatten().collect();
    sizes.sort_by(f64::total_cmp);
    let limit = sizes.get((sizes.len() * 99 / 100).min(sizes.len().saturating_sub(1))).copied().unwrap_or(1.0);
    if limit > 0.0 && limit.is_finite() { limit } else { 1.0 }
}

impl InverseMap {
    fn values(&self, of: impl Fn(f64, f64) -> f64) -> Vec<Option<f64>> {
        let value = |cell: &InverseCell| match *cell {
            InverseCell::Found { network_kpa, exact_kpa } => Some(of(network_kpa, exact_kpa)),
            InverseCell::Missing | InverseCell::OutOfReach => None,
        };
        self.cells.iter().map(value).collect()
    }

    fn has_missing(&self) -> bool {
        self.cells.contains(&InverseCell::Missing)
    }

    fn n_rows(&self) -> usize {
        self.cells.len() / self.n_columns.max(1)
    }

    /// The cell at the middle of cell `index` of `other`; none where this map ends before.
    fn at(&self, other: &Self, index: usize) -> Option<&InverseCell> {
        let [from_n, to_n] = self.force_n;
        let middle = ((index / other.n_columns) as f64 + 0.5) / other.n_rows() as f64;
        let force_n = other.force_n[0] + middle * (other.force_n[1] - other.force_n[0]);
        let row = (force_n - from_n) / (to_n - from_n) * self.n_rows() as f64;
        let inside = row >= 0.0 && row < self.n_rows() as f64;
        inside.then(|| self.cells.get(row as usize * self.n_columns + index % other.n_columns)).flatten()
    }

    fn draw(&self, canvas: &mut Canvas<'_>, cell: Rect, values: &[Option<f64>], bar: &ColorBar) -> Panel {
        let columns = Bins::Equal(length_axis(self.length_mm), self.n_columns);
        let rows = Bins::Equal(exact_axis("force (N)", self.force_n), self.n_rows());
        let panel = draw_runs(canvas, cell, [columns, rows], values, bar);
        let is = |kind: InverseCell| -> Vec<bool> { self.cells.iter().map(|cell| *cell == kind).collect() };
        cover(canvas, &panel, self.n_columns, &is(InverseCell::Missing), &is(InverseCell::OutOfReach));
        panel
    }

    /// Lengths and forces at which the network's pressure is `level_kpa`; along a column the pressure rises.
    fn level_line(&self, level_kpa: f64) -> Vec<(f64, f64)> {
        let pressure = |row: usize, column: usize| match self.cells.get(row * self.n_columns + column) {
            Some(InverseCell::Found { network_kpa, .. }) => Some(*network_kpa),
            _ => None,
        };
        let middle = |[from, to]: [f64; 2], at: f64, n: usize| from + (to - from) * (at + 0.5) / n as f64;
        let crossing = |column: usize| {
            (1..self.n_rows()).find_map(|row| {
                let (below, above) = pressure(row - 1, column).zip(pressure(row, column))?;
                let crosses = below < level_kpa && above >= level_kpa;
                crosses.then(|| row as f64 - 1.0 + (level_kpa - below) / (above - below))
            })
        };
        (0..self.n_columns)
            .filter_map(|column| {
                let row = crossing(column)?;
                Some((middle(self.length_mm, column as f64, self.n_columns), middle(self.force_n, row, self.n_rows())))
            })
            .collect()
    }
}

fn length_axis(length_mm: [f64; 2]) -> Axis {
    exact_axis("length (mm)", length_mm)
}

fn exact_axis(title: &str, [from, to]: [f64; 2]) -> Axis {
    Axis::exact(title, from, to, 6)
}

/// Covers cells: stripes where the inverse is missing, a plain gray where there is nothing to ask.
fn cover(canvas: &mut Canvas<'_>, panel: &Panel, n_columns: usize, missing: &[bool], blank: &[bool]) {
    let n_columns = n_columns.max(1);
    let n_rows = missing.len() / n_columns;
    let Rect { left, bottom, .. } = panel.frame;
    let (width, height) = (panel.frame.width() / n_columns as f64, panel.frame.height() / n_rows.max(1) as f64);
    let right = |column: usize| (left + column as f64 * width).round();
    let top = |row: usize| (bottom - row as f64 * height).round();
    let kinds: Vec<Option<f64>> = missing
        .iter()
        .zip(blank)
        .map(|(&missing, &blank)| if missing { Some(1.0) } else { blank.then_some(0.0) })
        .collect();
    let color = |kind: &Option<f64>| kind.map(|kind| if kind > 0.5 { MISSING } else { BLANK });
    for Run { columns, rows, color } in runs(&kinds, n_columns, color) {
        let run =
            Rect { left: right(columns.start), right: right(columns.end), top: top(rows.end), bottom: top(rows.start) };
        canvas.rect(run, color);
        if color != MISSING {
            continue;
        }
        for (row, column) in rows.flat_map(|row| columns.clone().map(move |column| (row, column))) {
            canvas.line([(right(column), top(row)), (right(column + 1), top(row + 1))], STRIPE, 0.8);
        }
    }
}

fn keys(canvas: &mut Canvas<'_>, cell: Rect, y: f64, missing: bool) {
    let mut keys = vec![Key::new("outside the domain", Mark::Patch, BLANK.toward(palette::SILVER, 0.2))];
    if missing {
        keys.push(Key::new("no inverse", Mark::Patch, STRIPE.toward(MISSING, 0.5)));
    }
    // Left of the title of the color bar.
    legend(canvas, &keys, cell.right - 110.0, y + 14.0);
}

fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    values.into_iter().fold((f64::NAN, f64::NAN), |(lowest, highest), value| (lowest.min(value), highest.max(value)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbors_of_one_color_become_one_rectangle_and_cover_what_they_did() {
        let values =
            [1.0, 1.0, 2.0, 1.0, 1.0, 2.0, 3.0, 1.0, 2.0].map(|value| Some(value).filter(|value| *value < 3.0));
        let color = |value: &Option<f64>| value.map(|value| sequential(0.1 * value));
        let runs = runs(&values, 3, color);
        assert_eq!(runs.len(), 3);
        for (index, value) in values.iter().enumerate() {
            let (row, column) = (index / 3, index % 3);
            let over: Vec<&Run> =
                runs.iter().filter(|run| run.rows.contains(&row) && run.columns.contains(&column)).collect();
            assert_eq!(over.iter().map(|run| run.color).collect::<Vec<_>>(), Vec::from_iter(color(value)));
        }
    }
}
