//! A legend in one row, above the panel, where it covers no data.

use crate::plot::{Anchor, Canvas, Color, palette, text_width};

/// Size of the letters, in pixels.
const SIZE: f64 = 11.5;
/// Room for a mark and the gap to its text.
const MARK: f64 = 22.0;
/// Gap between entries.
const GAP: f64 = 16.0;

/// How an entry of a legend is marked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mark {
    /// A line of this width.
    Line(f64),
    /// A dashed line of this width.
    Dashes(f64),
    /// A filled dot.
    Dot,
    /// An open dot.
    Ring,
    /// A filled rectangle.
    Patch,
}

/// An entry of a legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// Text.
    pub text: String,
    /// Mark before it.
    pub mark: Mark,
    /// Color of the mark.
    pub color: Color,
}

impl Key {
    /// An entry.
    pub fn new(text: impl Into<String>, mark: Mark, color: Color) -> Self {
        Self { text: text.into(), mark, color }
    }
}

/// Draws `keys` in one row that ends at `right`, its middle at height `y`; gives the left end of the row.
pub fn legend(canvas: &mut Canvas<'_>, keys: &[Key], right: f64, y: f64) -> f64 {
    let left = right - legend_width(keys);
    legend_from(canvas, keys, left, y);
    left
}

/// Width of a row of `keys`, in pixels.
pub fn legend_width(keys: &[Key]) -> f64 {
    keys.iter().map(width).sum::<f64>() + GAP * keys.len().saturating_sub(1) as f64
}

fn width(key: &Key) -> f64 {
    MARK + text_width(&key.text, SIZE)
}

/// Draws `keys` in one row that begins at `left`, its middle at height `y`.
pub fn legend_from(canvas: &mut Canvas<'_>, keys: &[Key], left: f64, y: f64) {
    let mut x = left;
    for key in keys {
        let (from, to) = ((x, y), (x + MARK - 6.0, y));
        let middle = (0.5 * (from.0 + to.0), y);
        match key.mark {
            Mark::Line(width) => canvas.line([from, to], key.color, width),
            Mark::Dashes(width) => canvas.dashes(from, to, key.color, width, 3.2),
            Mark::Dot => canvas.dot(middle, 3.5, key.color),
            Mark::Ring => canvas.ring(middle, 4.5, key.color, 1.5),
            Mark::Patch => {
                let patch = crate::plot::Rect { left: from.0 + 2.0, top: y - 5.0, right: to.0, bottom: y + 5.0 };
                canvas.rect(patch, key.color);
            }
        }
        canvas.text(&key.text, (x + MARK, y), Anchor::Start, SIZE, palette::GRAY);
        x += width(key) + GAP;
    }
}
