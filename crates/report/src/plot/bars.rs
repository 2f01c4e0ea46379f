//! Horizontal bars over names.

use crate::plot::{Anchor, Axis, Canvas, Color, Panel, Rect, palette, text_width};

/// One bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// Its name, written left of it.
    pub name: String,
    /// Its length.
    pub value: f64,
    /// Text at its end.
    pub text: String,
    /// Its color.
    pub color: Color,
}

/// Horizontal bars from zero, the first on top; names of any length are read without turning the head.
#[derive(Debug, Clone, PartialEq)]
pub struct Bars {
    /// Title of the value, with unit.
    pub title: String,
    /// The bars.
    pub bars: Vec<Bar>,
}

impl Bars {
    /// Draws the bars into `cell`, below room for a title.
    pub fn draw(&self, canvas: &mut Canvas<'_>, cell: Rect) {
        let finite = || self.bars.iter().map(|bar| bar.value).filter(|value| value.is_finite());
        let axis = Axis::linear(&*self.title, finite().fold(0.0, f64::min), finite().fold(0.0, f64::max), 5);
        let widest =
            |text: fn(&Bar) -> &str| self.bars.iter().map(|bar| text_width(text(bar), 12.0)).fold(0.0, f64::max);
        let names = widest(|bar| &bar.name).min(0.4 * cell.width());
        let texts = widest(|bar| &bar.text).min(0.3 * cell.width());
        let panel = Panel {
            frame: cell.inset(names + 26.0, 40.0, texts + 16.0, 46.0),
            x: axis,
            y: Axis::exact("", 0.0, self.bars.len().max(1) as f64, 1),
            upward_labels: false,
        };
        for (value, _) in &panel.x.ticks {
            let x = panel.at(*value, 0.0).0;
            canvas.line([(x, panel.frame.top), (x, panel.frame.bottom)], palette::MIST, 1.0);
        }
        for (index, bar) in self.bars.iter().enumerate() {
            let middle = (self.bars.len() - index) as f64 - 0.5;
            let (zero, y) = panel.at(0.0, middle);
            let end = if bar.value.is_finite() { panel.at(bar.value, middle).0 } else { zero };
            let thick = (0.35 * panel.frame.height() / self.bars.len() as f64).min(11.0);
            let body = Rect { left: zero.min(end), right: zero.max(end), top: y - thick, bottom: y + thick };
            canvas.rect(body, bar.color);
            canvas.text(&bar.name, (panel.frame.left - 10.0, y), Anchor::End, 12.0, palette::INK);
            canvas.text(&bar.text, (body.right + 6.0, y), Anchor::Start, 12.0, palette::GRAY);
        }
        let zero = panel.at(0.0, 0.0).0;
        canvas.line([(zero, panel.frame.top), (zero, panel.frame.bottom)], palette::SILVER, 1.0);
        panel.draw_x_axis(canvas);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_may_be_negative_missing_or_none_at_all() {
        let bar = |name: &str, value: f64| Bar {
            name: name.to_owned(),
            value,
            text: format!("{value}"),
            color: palette::BLUE,
        };
        for bars in [vec![], vec![bar("a", 3.0), bar("b", -1.0), bar("c", f64::NAN)]] {
            let bars = Bars { title: "log predictive ratio (nats)".to_owned(), bars };
            let svg = Canvas::document(400, 300, "bars", |canvas, sheet| bars.draw(canvas, sheet)).unwrap();
            assert!(svg.contains("log predictive ratio (nats)"));
        }
    }
}
