//! A panel: title, axes, grid, and lines on it.

use crate::plot::{Anchor, Axis, Canvas, Color, Rect, palette, text_width};

/// Size of tick labels, in pixels.
const TICK_SIZE: f64 = 11.5;
/// Size of axis titles.
const TITLE_SIZE: f64 = 12.5;

/// Two axes on a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Where data is drawn.
    pub frame: Rect,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Whether the labels of the horizontal axis read upward, being too wide to stand side by side.
    pub upward_labels: bool,
}

impl Panel {
    /// Lays a panel into `cell`, leaving room for a title above, axis labels left and below, and `right`
    /// pixels on the right.
    pub fn new(cell: Rect, x: Axis, y: Axis, right: f64) -> Self {
        // Panels below one another line up unless a label is too wide for that.
        let left = (widest_label(&y) + 36.0).clamp(64.0, 0.4 * cell.width().max(160.0));
        let width = cell.width() - left - right;
        let upward_labels = widest_label(&x) > 0.95 * width / x.ticks.len().max(1) as f64;
        let bottom = if upward_labels { (widest_label(&x) + 38.0).min(0.4 * cell.height()) } else { 46.0 };
        Self { frame: cell.inset(left, 40.0, right, bottom.max(46.0)), x, y, upward_labels }
    }

    /// Draws grid, axes, ticks and axis titles; data goes on top.
    pub fn draw_frame(&self, canvas: &mut Canvas<'_>) {
        for (value, _) in &self.y.ticks {
            let y = self.at(self.x.from, *value).1;
            canvas.line([(self.frame.left, y), (self.frame.right, y)], palette::MIST, 1.0);
        }
        for (value, _) in &self.x.ticks {
            let x = self.at(*value, self.y.from).0;
            canvas.line([(x, self.frame.top), (x, self.frame.bottom)], palette::MIST, 1.0);
        }
        self.draw_x_axis(canvas);
        self.draw_y_axis(canvas);
    }

    /// Draws the horizontal axis alone.
    pub fn draw_x_axis(&self, canvas: &mut Canvas<'_>) {
        let Rect { left, right, bottom, .. } = self.frame;
        canvas.line([(left, bottom), (right, bottom)], palette::SILVER, 1.0);
        let labelled =
            self.x.labelled(|value| self.at(value, self.y.from).0, |label| text_width(label, TICK_SIZE) + 4.0);
        for (index, (value, label)) in self.x.ticks.iter().enumerate() {
            let x = self.at(*value, self.y.from).0;
            canvas.line([(x, bottom), (x, bottom + 4.0)], palette::SILVER, 1.0);
            if self.upward_labels {
                canvas.upward(label, (x, bottom + 8.0), Anchor::End, TICK_SIZE, palette::GRAY);
            } else if labelled.contains(&index) {
                canvas.text(label, (x, bottom + 13.0), Anchor::Middle, TICK_SIZE, palette::GRAY);
            }
        }
        let below = if self.upward_labels { widest_label(&self.x) + 24.0 } else { 33.0 };
        canvas.text(&self.x.title, (0.5 * (left + right), bottom + below), Anchor::Middle, TITLE_SIZE, palette::INK);
    }

    /// Draws the vertical axis alone.
    pub fn draw_y_axis(&self, canvas: &mut Canvas<'_>) {
        let Rect { left, top, bottom, .. } = self.frame;
        canvas.line([(left, top), (left, bottom)], palette::SILVER, 1.0);
        for (value, label) in &self.y.ticks {
            let y = self.at(self.x.from, *value).1;
            canvas.line([(left - 4.0, y), (left, y)], palette::SILVER, 1.0);
            canvas.text(label, (left - 8.0, y), Anchor::End, TICK_SIZE, palette::GRAY);
        }
        canvas.upward(
            &self.y.title,
            (left - (widest_label(&self.y) + 24.0).max(52.0), 0.5 * (top + bottom)),
            Anchor::Middle,
            TITLE_SIZE,
            palette::INK,
        );
    }

    /// Where a value lies on the canvas.
    pub fn at(&self, x: f64, y: f64) -> (f64, f64) {
        (
            self.frame.left + self.x.fraction(x) * self.frame.width(),
            self.frame.bottom - self.y.fraction(y) * self.frame.height(),
        )
    }

    /// A line through values.
    pub fn line(
        &self,
        canvas: &mut Canvas<'_>,
        values: impl IntoIterator<Item = (f64, f64)>,
        color: Color,
        width: f64,
    ) {
        canvas.line(values.into_iter().map(|(x, y)| self.at(x, y)), color, width);
    }

    /// A dashed line across the panel at height `y`, if that lies on it.
    pub fn level(&self, canvas: &mut Canvas<'_>, y: f64, color: Color, width: f64) {
        if (0.0..=1.0).contains(&self.y.fraction(y)) {
            canvas.dashes(self.at(self.x.from, y), self.at(self.x.to, y), color, width, 5.0);
        }
    }

    /// A band across the panel between two heights.
    pub fn band(&self, canvas: &mut Canvas<'_>, from: f64, to: f64, color: Color) {
        let height = |value: f64| self.at(self.x.from, value).1.clamp(self.frame.top, self.frame.bottom);
        canvas.rect(Rect { top: height(to), bottom: height(from), ..self.frame }, color);
    }

    /// Writes labels right of the frame at the given heights, pushed apart until none overlaps; where there
    /// are too many for the frame, those in between are left out.
    pub fn label_right(&self, canvas: &mut Canvas<'_>, labels: &[(f64, String, Color)]) {
        const LINE: f64 = 13.0;
        let room = (self.frame.height() / LINE) as usize;
        let every = labels.len().div_ceil(room.max(1)).max(1);
        let mut placed: Vec<(f64, &str, Color)> = labels
            .iter()
            .filter(|(y, _, _)| y.is_finite())
            .map(|(y, text, color)| (self.at(self.x.to, *y).1, text.as_str(), *color))
            .collect();
        placed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut placed: Vec<_> = placed.into_iter().step_by(every).collect();
        // Down first, then back up from the lower edge.
        let mut next = self.frame.top;
        for (y, _, _) in &mut placed {
            *y = y.max(next);
            next = *y + LINE;
        }
        let mut last = self.frame.bottom;
        for (y, _, _) in placed.iter_mut().rev() {
            *y = y.min(last);
            last = *y - LINE;
        }
        for (y, text, color) in placed {
            canvas.text(text, (self.frame.right + 8.0, y), Anchor::Start, TICK_SIZE, color);
        }
    }
}

fn widest_label(axis: &Axis) -> f64 {
    axis.ticks.iter().map(|(_, label)| text_width(label, TICK_SIZE)).fold(0.0, f64::max)
}

/// Writes a panel's letter and title into the top of its cell; gives the height of its middle line and the
/// right end of the text.
pub fn title(canvas: &mut Canvas<'_>, cell: Rect, letter: &str, text: &str) -> (f64, f64) {
    let (x, y) = (cell.left + 14.0, cell.top + 14.0);
    canvas.bold(letter, (x, y), Anchor::Start, 15.0, palette::INK);
    canvas.bold(text, (x + 20.0, y), Anchor::Start, 14.0, palette::INK);
    // Bold letters are a tenth wider.
    (y, x + 20.0 + 1.1 * text_width(text, 14.0))
}

/// Writes a remark in the middle of `frame`, for a panel that has nothing to show.
pub fn note(canvas: &mut Canvas<'_>, frame: Rect, text: &str) {
    let middle = (0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom));
    canvas.text(text, middle, Anchor::Middle, 13.0, palette::SILVER);
}
