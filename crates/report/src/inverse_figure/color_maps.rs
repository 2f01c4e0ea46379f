//! Panels a to d: pressure, slope and error in color.

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
    let bar = ColorBar { title: "pressure (kPa)".to_owned(), from: axis.from, to: axis.to, color: sequential };
    let panel = map.draw(canvas, cell, values, bar.clone());
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
    let (y, _) = title(canvas, cell, "a", "Learned pressure while contracting");
    keys(canvas, cell, y, map.has_missing());
}

/// Panel b.
pub(super) fn slope(canvas: &mut Canvas<'_>, cell: Rect, map: &SlopeMap) {
    let rising = |cell: &SlopeCell| if let SlopeCell::Rising(slope) = cell { Some(*slope) } else { None };
    let values: Vec<Option<f64>> = map.cells.iter().map(rising).collect();
    let (_, highest) = extent(values.iter().copied().flatten());
    let axis = Axis::linear("", 0.0, highest, 5);
    let bar = ColorBar { title: "dF/dp (N/kPa)".to_owned(), from: 0.0, to: axis.to, color: sequential };
    let n_rows = map.cells.len() / map.n_columns.max(1);
    let (columns, rows) = (length_axis(map.length_mm), exact_axis("pressure (kPa)", map.pressure_kpa));
    let (columns, rows) = (Bins::Equal(columns, map.n_columns), Bins::Equal(rows, n_rows));
    let panel = Map { columns, rows, values, texts: Vec::new(), bar }.draw(canvas, cell);
    let missing: Vec<bool> = map.cells.iter().map(|cell| *cell == SlopeCell::Missing).collect();
    let blank: Vec<bool> = map.cells.iter().map(|cell| *cell == SlopeCell::OutOfReach).collect();
    cover(canvas, &panel, map.n_columns, &missing, &blank);
    let (y, _) = title(canvas, cell, "b", "Where the inverse exists (contracting)");
    keys(canvas, cell, y, missing.contains(&true));
}

/// Panels c and d.
pub(super) fn error(
    canvas: &mut Canvas<'_>,
    cell: Rect,
    (letter, name): (&str, &str),
    map: &InverseMap,
    limit_kpa: f64,
) {
    let values = map.values(|network_kpa, exact_kpa| network_kpa - exact_kpa);
    let bar = ColorBar {
        title: "error (kPa)".to_owned(),
        from: -limit_kpa,
        to: limit_kpa,
        color: |share| diverging(2.0 * share - 1.0),
    };
    map.draw(canvas, cell, values, bar);
    let (y, _) = title(canvas, cell, letter, &format!("Network less exact inverse, {name}"));
    keys(canvas, cell, y, map.has_missing());
}

/// What the colors of errors end at: nearly all of them lie below.
pub(super) fn limit_kpa(maps: &[InverseMap; 2]) -> f64 {
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

    fn draw(&self, canvas: &mut Canvas<'_>, cell: Rect, values: Vec<Option<f64>>, bar: ColorBar) -> Panel {
        let columns = Bins::Equal(length_axis(self.length_mm), self.n_columns);
        let rows = Bins::Equal(exact_axis("force (N)", self.force_n), self.n_rows());
        let panel = Map { columns, rows, values, texts: Vec::new(), bar }.draw(canvas, cell);
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
    let n_rows = missing.len() / n_columns.max(1);
    let Rect { left, bottom, .. } = panel.frame;
    let (width, height) = (panel.frame.width() / n_columns as f64, panel.frame.height() / n_rows.max(1) as f64);
    for row in 0..n_rows {
        let (top, low) = ((bottom - (row + 1) as f64 * height).round(), (bottom - row as f64 * height).round());
        let mut column = 0;
        while column < n_columns {
            let kind = |column: usize| (missing[row * n_columns + column], blank[row * n_columns + column]);
            let start = column;
            while column < n_columns && kind(column) == kind(start) {
                column += 1;
            }
            let right = |column: usize| (left + column as f64 * width).round();
            let run = Rect { left: right(start), right: right(column), top, bottom: low };
            match kind(start) {
                (true, _) => {
                    canvas.rect(run, MISSING);
                    for cell in start..column {
                        canvas.line([(right(cell), low), (right(cell + 1), top)], STRIPE, 0.8);
                    }
                }
                (_, true) => canvas.rect(run, BLANK),
                _ => {}
            }
        }
    }
}

fn keys(canvas: &mut Canvas<'_>, cell: Rect, y: f64, missing: bool) {
    let mut keys = vec![Key::new("outside the domain", Mark::Patch, BLANK.toward(palette::SILVER, 0.2))];
    if missing {
        keys.push(Key::new("no inverse", Mark::Patch, STRIPE.toward(MISSING, 0.5)));
    }
    // Left of the title of the color bar.
    legend(canvas, &keys, cell.right - 110.0, y + 12.0);
}

fn extent(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    values.into_iter().fold((f64::NAN, f64::NAN), |(lowest, highest), value| (lowest.min(value), highest.max(value)))
}
