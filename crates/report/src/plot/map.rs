//! Colored cells over two coordinates: residual maps, error maps, confusion matrices.

use crate::plot::{Anchor, Axis, Canvas, Color, Panel, Rect, palette};

/// Color of cells without a value.
pub(crate) const BLANK: Color = Color::new(0xFB, 0xFB, 0xFB);

/// How one coordinate of a map is cut.
#[derive(Debug, Clone, PartialEq)]
pub enum Bins {
    /// Equal bins from end to end of an axis.
    Equal(Axis, usize),
    /// One bin per name, with a title for all.
    Named(String, Vec<String>),
}

impl Bins {
    /// How many there are.
    pub fn count(&self) -> usize {
        match self {
            Self::Equal(_, count) => *count,
            Self::Named(_, names) => names.len(),
        }
    }

    /// Bin that `value` falls into, for equal bins.
    pub fn bin_of(&self, value: f64) -> Option<usize> {
        let Self::Equal(axis, count) = self else { return None };
        let share = axis.fraction(value);
        // The upper end belongs to the last bin.
        (0.0..=1.0).contains(&share).then(|| ((share * *count as f64) as usize).min(count.saturating_sub(1)))
    }

    /// An axis for it; names sit in the middle of their bins.
    fn axis(&self) -> Axis {
        match self {
            Self::Equal(axis, _) => axis.clone(),
            Self::Named(title, names) => {
                let mut axis = Axis::exact(title.clone(), 0.0, names.len().max(1) as f64, 5);
                axis.ticks = names.iter().enumerate().map(|(index, name)| (index as f64 + 0.5, name.clone())).collect();
                axis
            }
        }
    }
}

/// Meaning of a map's colors.
#[derive(Debug, Clone)]
pub struct ColorBar {
    /// Title with unit, written above the bar.
    pub title: String,
    /// Lowest value.
    pub from: f64,
    /// Highest value.
    pub to: f64,
    /// Whether values are decimal logarithms: the bar then shows the numbers themselves.
    pub logarithm: bool,
    /// Color at a share of the way from lowest (0) to highest (1).
    pub color: fn(f64) -> Color,
}

/// A map of colored cells with a color bar.
#[derive(Debug, Clone)]
pub struct Map {
    /// Cut along the horizontal.
    pub columns: Bins,
    /// Cut along the vertical, from the bottom.
    pub rows: Bins,
    /// A value per cell, rows from the bottom, columns from the left; `None` stays blank.
    pub values: Vec<Option<f64>>,
    /// Text of each cell, in the same order; may be empty.
    pub texts: Vec<String>,
    /// Meaning of the colors.
    pub bar: ColorBar,
}

impl Map {
    /// Draws the map into `cell`, below room for a title; gives the panel for more to be drawn on it.
    pub fn draw(&self, canvas: &mut Canvas<'_>, cell: Rect) -> Panel {
        let panel = Panel::new(cell, self.columns.axis(), self.rows.axis(), 84.0);
        canvas.rect(panel.frame, BLANK);
        let (n_columns, n_rows) = (self.columns.count(), self.rows.count());
        let Rect { left, bottom, .. } = panel.frame;
        let (width, height) = (panel.frame.width() / n_columns as f64, panel.frame.height() / n_rows as f64);
        for (index, value) in self.values.iter().enumerate().take(n_columns * n_rows) {
            let Some(value) = value.filter(|value| value.is_finite()) else { continue };
            let (row, column) = (index / n_columns, index % n_columns);
            // On whole pixels with one of paper between them: no seams, no moiré.
            let tile = Rect {
                left: (left + column as f64 * width).round(),
                right: (left + (column + 1) as f64 * width).round() - 1.0,
                top: (bottom - (row + 1) as f64 * height).round(),
                bottom: (bottom - row as f64 * height).round() - 1.0,
            };
            let color = self.bar.color_of(value);
            canvas.rect(tile, color);
            if let Some(text) = self.texts.get(index) {
                let middle = (0.5 * (tile.left + tile.right), 0.5 * (tile.top + tile.bottom));
                canvas.text(text, middle, Anchor::Middle, 11.0, color.readable_on());
            }
        }
        panel.draw_x_axis(canvas);
        panel.draw_y_axis(canvas);
        let Rect { top, right, bottom, .. } = panel.frame;
        self.bar.draw(canvas, Rect { left: right + 18.0, top, right: right + 31.0, bottom });
        panel
    }
}

impl ColorBar {
    /// Color of a value.
    pub fn color_of(&self, value: f64) -> Color {
        (self.color)((value - self.from) / (self.to - self.from))
    }

    fn draw(&self, canvas: &mut Canvas<'_>, frame: Rect) {
        const STEPS: usize = 64;
        for step in 0..STEPS {
            let at = |step: usize| frame.bottom - frame.height() * step as f64 / STEPS as f64;
            // Overlapping by a fraction of a pixel, so that no seam shows.
            let strip = Rect { top: at(step + 1), bottom: (at(step) + 0.5).min(frame.bottom), ..frame };
            canvas.rect(strip, (self.color)((step as f64 + 0.5) / STEPS as f64));
        }
        let (axis, at): (Axis, fn(f64) -> f64) = if self.logarithm {
            (Axis::logarithmic("", 10f64.powf(self.from), 10f64.powf(self.to)), f64::log10)
        } else {
            (Axis::exact("", self.from, self.to, 5), |value| value)
        };
        for (value, label) in &axis.ticks {
            let share = (at(*value) - self.from) / (self.to - self.from);
            if !(-1e-9..=1.0 + 1e-9).contains(&share) {
                continue;
            }
            let y = frame.bottom - share * frame.height();
            canvas.line([(frame.right, y), (frame.right + 4.0, y)], palette::SILVER, 1.0);
            canvas.text(label, (frame.right + 7.0, y), Anchor::Start, 11.5, palette::GRAY);
        }
        canvas.text(&self.title, (frame.right + 44.0, frame.top - 14.0), Anchor::End, 11.5, palette::GRAY);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_fall_into_their_bins_and_the_upper_end_into_the_last() {
        let bins = Bins::Equal(Axis::exact("p", 0.0, 10.0, 5), 5);
        assert_eq!([0.0, 1.9, 2.0, 10.0].map(|value| bins.bin_of(value)), [Some(0), Some(0), Some(1), Some(4)]);
        assert_eq!([-0.1, 10.1, f64::NAN].map(|value| bins.bin_of(value)), [None, None, None]);
    }

    #[test]
    fn a_confusion_matrix_has_names_and_texts() {
        let names = ["stribeck", "creep"].map(str::to_owned).to_vec();
        let map = Map {
            columns: Bins::Named("named".to_owned(), names.clone()),
            rows: Bins::Named("true".to_owned(), names),
            values: vec![Some(0.9), None, Some(0.1), Some(1.0)],
            texts: ["90 %", "", "10 %", "100 %"].map(str::to_owned).to_vec(),
            bar: ColorBar {
                title: "share".to_owned(),
                from: 0.0,
                to: 1.0,
                logarithm: false,
                color: crate::plot::sequential,
            },
        };
        let svg = Canvas::document(400, 300, "confusion", |canvas, sheet| {
            map.draw(canvas, sheet);
        });
        let svg = svg.unwrap();
        for text in ["stribeck", "creep", "90 %", "100 %", "share"] {
            assert!(svg.contains(text), "{text}");
        }
    }
}
