//! Parts of a canvas.

/// A rectangle in pixels; y grows downward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Left edge.
    pub left: f64,
    /// Top edge.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Bottom edge.
    pub bottom: f64,
}

impl Rect {
    /// Width, in pixels.
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Height, in pixels.
    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// The rectangle without a margin on each side.
    pub fn inset(&self, left: f64, top: f64, right: f64, bottom: f64) -> Self {
        Self { left: self.left + left, top: self.top + top, right: self.right - right, bottom: self.bottom - bottom }
    }

    /// Side by side, with widths in proportion to `shares` and `gap` pixels between.
    pub fn columns<const N: usize>(&self, shares: [f64; N], gap: f64) -> [Self; N] {
        let unit = (self.width() - gap * (N as f64 - 1.0)) / shares.iter().sum::<f64>();
        let mut left = self.left;
        shares.map(|share| {
            let column = Self { left, right: left + unit * share, ..*self };
            left = column.right + gap;
            column
        })
    }

    /// One below the other, with heights in proportion to `shares` and `gap` pixels between.
    pub fn rows<const N: usize>(&self, shares: [f64; N], gap: f64) -> [Self; N] {
        let unit = (self.height() - gap * (N as f64 - 1.0)) / shares.iter().sum::<f64>();
        let mut top = self.top;
        shares.map(|share| {
            let row = Self { top, bottom: top + unit * share, ..*self };
            top = row.bottom + gap;
            row
        })
    }
}
