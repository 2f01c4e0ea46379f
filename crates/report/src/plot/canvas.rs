//! A sheet to draw on, in pixels, which writes an SVG document.
//!
//! # Design
//! Numbers in the document are whole: the sheet is [`FINE`] times as large as it is shown, and the root element says so.
//! A point of a line is a step from the one before it, and consecutive lines, or rectangles, of one style are one path. So a
//! figure of some ten thousand points stays below 200 kB, and a color map is a path for each color. A drawing library stood
//! here before; its absolute coordinates were twice as long, and it had neither groups nor clipping, which figures that
//! zoom need.
//!
//! This is the pen of every figure; other pages that draw take it from here, as `pam_report::plot::Canvas`.

use std::fmt::Write as _;

use crate::FigureError;
use crate::escape::escaped;
use crate::plot::{Color, Rect};

/// Units of the document in a pixel.
const FINE: f64 = 4.0;

/// Where a text is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// At its beginning.
    Start,
    /// In its middle.
    Middle,
    /// At its end.
    End,
}

/// A white sheet, measured in pixels from its upper left corner.
#[derive(Debug)]
pub struct Canvas<'a> {
    text: &'a mut String,
    /// Attributes and data of the path that goes on while the style stays.
    path: Option<(String, String)>,
}

impl Canvas<'_> {
    /// Units of the document in a pixel, for scripts that draw on it.
    pub(crate) const UNITS: f64 = FINE;

    /// A whole SVG document of `width` × `height` pixels; `title` is what a screen reader says.
    ///
    /// # Errors
    /// [`FigureError::TooLarge`] where the document would not be readable by a viewer.
    pub fn document(
        width: u32,
        height: u32,
        title: &str,
        draw: impl FnOnce(&mut Canvas<'_>, Rect),
    ) -> Result<String, FigureError> {
        if width.max(height) > MOST_PIXELS {
            return Err(FigureError::TooLarge { width, height });
        }
        let mut text = String::with_capacity(1 << 16);
        // Writing to a string cannot fail, here and below.
        let _ = write!(
            text,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {} {}\" \
             style=\"max-width:100%;height:auto\" font-family=\"sans-serif\" stroke-linejoin=\"round\" \
             stroke-linecap=\"round\" role=\"img\">\n<title>{}</title>\n",
            width * FINE as u32,
            height * FINE as u32,
            escaped(title)
        );
        let sheet = Rect { left: 0.0, top: 0.0, right: f64::from(width), bottom: f64::from(height) };
        let mut canvas = Canvas { text: &mut text, path: None };
        canvas.rect(sheet, crate::plot::palette::WHITE);
        draw(&mut canvas, sheet);
        canvas.end_path();
        text.push_str("</svg>\n");
        Ok(text)
    }

    /// A line through `points`; points that are not finite are left out.
    pub fn line(&mut self, points: impl IntoIterator<Item = (f64, f64)>, color: Color, width: f64) {
        let data = line_data(points);
        self.path(stroke(color, width), &data);
    }

    /// The same in dashes and gaps `dash` pixels long.
    pub fn dashed_line(&mut self, points: impl IntoIterator<Item = (f64, f64)>, color: Color, width: f64, dash: f64) {
        let style = format!("{} stroke-dasharray=\"{}\" stroke-linecap=\"butt\"", stroke(color, width), FINE * dash);
        self.path(style, &line_data(points));
    }

    /// A line of dashes `dash` pixels long that begins and ends with ink.
    pub fn dashes(&mut self, from: (f64, f64), to: (f64, f64), color: Color, width: f64, dash: f64) {
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        if !(length.is_finite() && length > 0.0) {
            return;
        }
        // An odd number of equal pieces.
        let pieces = (length / dash).round() as usize | 1;
        let piece = (FINE * length / pieces as f64 * 10.0).round() / 10.0;
        let style = format!("{} stroke-dasharray=\"{piece}\" stroke-linecap=\"butt\"", stroke(color, width));
        self.path(style, &line_data([from, to]));
    }

    /// A filled rectangle.
    pub fn rect(&mut self, rect: Rect, color: Color) {
        let corners = (fine_point((rect.left, rect.top)), fine_point((rect.right, rect.bottom)));
        if let (Some((left, top)), Some((right, bottom))) = corners
            && left < right
            && top < bottom
        {
            let data = format!("M{left} {top}h{}v{}h{}z", right - left, bottom - top, left - right);
            self.path(fill(color), &data);
        }
    }

    /// A filled area bounded by `points`.
    pub fn area(&mut self, points: impl IntoIterator<Item = (f64, f64)>, color: Color) {
        let mut data = line_data(points);
        if !data.is_empty() {
            data.push('z');
            // An area of its own: what two of one style share would be a hole or ink by how they wind.
            self.end_path();
            self.path(fill(color), &data);
            self.end_path();
        }
    }

    /// A filled disk.
    pub fn dot(&mut self, center: (f64, f64), radius: f64, color: Color) {
        self.circle(center, radius, &fill(color));
    }

    /// A circle.
    pub fn ring(&mut self, center: (f64, f64), radius: f64, color: Color, width: f64) {
        self.circle(center, radius, &stroke(color, width));
    }

    /// Text whose middle line runs through `at`.
    pub fn text(&mut self, text: &str, at: (f64, f64), anchor: Anchor, size: f64, color: Color) {
        self.lettering(text, at, anchor, size, color, "");
    }

    /// Bold text whose middle line runs through `at`.
    pub fn bold(&mut self, text: &str, at: (f64, f64), anchor: Anchor, size: f64, color: Color) {
        self.lettering(text, at, anchor, size, color, " font-weight=\"bold\"");
    }

    /// Text that reads upward, its middle line running through `at`.
    pub fn upward(&mut self, text: &str, at: (f64, f64), anchor: Anchor, size: f64, color: Color) {
        let Some((x, y)) = fine_point(at) else { return };
        self.lettering(text, at, anchor, size, color, &format!(" transform=\"rotate(270 {x} {y})\""));
    }

    /// The drawing of `draw` as a group with these attributes, which a page's style sheet or script can address.
    pub fn group(&mut self, attributes: &[(&str, &str)], draw: impl FnOnce(&mut Canvas<'_>)) {
        self.end_path();
        self.text.push_str("<g");
        self.attributes(attributes);
        self.text.push_str(">\n");
        self.nested(draw);
        self.text.push_str("</g>\n");
    }

    /// What `draw` draws inside `frame`, cut at its edges, with these attributes. It is a document within the document, for
    /// a clip path needs an identifier that no other figure of a page has.
    pub fn clipped(&mut self, frame: Rect, attributes: &[(&str, &str)], draw: impl FnOnce(&mut Canvas<'_>)) {
        let corners = (fine_point((frame.left, frame.top)), fine_point((frame.right, frame.bottom)));
        let (Some((left, top)), Some((right, bottom))) = corners else { return };
        let (width, height) = ((right - left).max(1), (bottom - top).max(1));
        self.end_path();
        let _ = write!(
            self.text,
            "<svg x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" viewBox=\"{left} {top} {width} {height}\""
        );
        self.attributes(attributes);
        self.text.push_str(">\n");
        self.nested(draw);
        self.text.push_str("</svg>\n");
    }

    fn nested(&mut self, draw: impl FnOnce(&mut Canvas<'_>)) {
        let mut inner = Canvas { text: self.text, path: None };
        draw(&mut inner);
        inner.end_path();
    }

    fn attributes(&mut self, attributes: &[(&str, &str)]) {
        for (name, value) in attributes {
            let _ = write!(self.text, " {name}=\"{}\"", escaped(value).replace('"', "&quot;"));
        }
    }

    fn circle(&mut self, center: (f64, f64), radius: f64, style: &str) {
        if let Some((x, y)) = fine_point(center) {
            self.end_path();
            let _ = writeln!(self.text, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\" {style}/>", (radius * FINE).round());
        }
    }

    fn lettering(&mut self, text: &str, at: (f64, f64), anchor: Anchor, size: f64, color: Color, more: &str) {
        // Half the height of a digit is 0.36 em.
        let Some((x, y)) = fine_point((at.0, at.1 + 0.36 * size)) else { return };
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let text: String = text.chars().filter(|character| !character.is_control()).collect();
        if text.is_empty() {
            return;
        }
        self.end_path();
        let _ = writeln!(
            self.text,
            "<text x=\"{x}\" y=\"{y}\"{anchor} font-size=\"{}\"{more} {}>{}</text>",
            FINE * size,
            fill(color),
            escaped(&text)
        );
    }

    /// Draws `data` in `style`, as a part of the path before where that has the same.
    fn path(&mut self, style: String, data: &str) {
        if data.is_empty() {
            return;
        }
        match &mut self.path {
            Some((last, path)) if *last == style => path.push_str(data),
            _ => {
                self.end_path();
                self.path = Some((style, data.to_owned()));
            }
        }
    }

    fn end_path(&mut self) {
        if let Some((style, data)) = self.path.take() {
            let _ = writeln!(self.text, "<path d=\"{data}\" {style}/>");
        }
    }
}

/// A sheet wider or higher than this is shown by no viewer.
const MOST_PIXELS: u32 = 60_000;

/// Path data of a line through `points`; none where fewer than two are finite, or all are in one place.
fn line_data(points: impl IntoIterator<Item = (f64, f64)>) -> String {
    let mut data = String::new();
    let mut last: Option<(i32, i32)> = None;
    let mut n = 0;
    for point in points.into_iter().filter_map(fine_point) {
        n += 1;
        match last {
            None => {
                let _ = write!(data, "M{} {}", point.0, point.1);
            }
            Some(before) if before == point => {}
            Some(before) => {
                let (dx, dy) = (point.0 - before.0, point.1 - before.1);
                let _ = match (dx, dy) {
                    (dx, 0) => write!(data, "h{dx}"),
                    (0, dy) => write!(data, "v{dy}"),
                    // A minus parts two numbers as well as a blank does.
                    (dx, dy) if dy < 0 => write!(data, "l{dx}{dy}"),
                    (dx, dy) => write!(data, "l{dx} {dy}"),
                };
            }
        }
        last = Some(point);
    }
    if n < 2 || !data.contains(['h', 'v', 'l']) { String::new() } else { data }
}

/// Width of `text` at `size`, in pixels, on the wide side: fonts differ, and a label must not touch another.
pub fn text_width(text: &str, size: f64) -> f64 {
    let em = |character: char| match character {
        'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '\'' | '|' | ' ' | '(' | ')' | '/' => 0.36,
        'm' | 'w' | 'M' | 'W' | '±' | '−' => 0.88,
        'A'..='Z' => 0.7,
        _ => 0.6,
    };
    text.chars().map(em).sum::<f64>() * size
}

fn fine_point((x, y): (f64, f64)) -> Option<(i32, i32)> {
    // Far outside is cut, so that no number overflows in a renderer.
    let fine = |pixels: f64| (pixels * FINE).round().clamp(-1e6, 1e6) as i32;
    (x.is_finite() && y.is_finite()).then(|| (fine(x), fine(y)))
}

fn hex(color: Color) -> String {
    let [red, green, blue] = color.rgb;
    format!("#{red:02X}{green:02X}{blue:02X}")
}

/// Opacity as an attribute; an opaque color needs none.
fn opacity(name: &str, color: Color) -> String {
    if color.opacity < 1.0 {
        format!(" {name}=\"{}\"", (1000.0 * color.opacity).round() / 1000.0)
    } else {
        String::new()
    }
}

fn fill(color: Color) -> String {
    format!("fill=\"{}\"{}", hex(color), opacity("fill-opacity", color))
}

fn stroke(color: Color, width: f64) -> String {
    let width = (width * FINE * 10.0).round() / 10.0;
    format!("fill=\"none\" stroke=\"{}\"{} stroke-width=\"{width}\"", hex(color), opacity("stroke-opacity", color))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::palette;

    fn drawn(draw: impl FnOnce(&mut Canvas<'_>)) -> String {
        Canvas::document(10, 10, "t", |canvas, _| draw(canvas)).expect("a small sheet")
    }

    #[test]
    fn lines_of_one_style_are_one_path_of_steps() {
        let svg = drawn(|canvas| {
            canvas.line([(0.0, 0.0), (1.0, 0.0), (f64::NAN, 1.0), (1.0, 2.0), (0.5, 1.75)], palette::INK, 1.0);
            canvas.line([(3.0, 3.0), (4.0, 4.0)], palette::INK, 1.0);
            canvas.line([(5.0, 5.0)], palette::INK, 1.0);
        });
        assert!(svg.contains("<path d=\"M0 0h4v8l-2-1M12 12l4 4\" fill=\"none\" stroke=\"#222222\""), "{svg}");
    }

    #[test]
    fn what_is_clipped_or_grouped_is_closed_before_the_next() {
        let svg = drawn(|canvas| {
            let frame = Rect { left: 1.0, top: 1.0, right: 3.0, bottom: 2.0 };
            canvas.clipped(frame, &[("class", "a\"b")], |canvas| canvas.rect(frame, palette::BLUE));
            canvas.group(&[], |canvas| canvas.rect(frame, palette::BLUE));
        });
        let clip = "<svg x=\"4\" y=\"4\" width=\"8\" height=\"4\" viewBox=\"4 4 8 4\" class=\"a&quot;b\">\n\
                    <path d=\"M4 4h8v4h-8z\" fill=\"#0072B2\"/>\n</svg>\n<g>\n<path d=\"M4 4h8v4h-8z\" fill=\"#0072B2\"/>\n</g>";
        assert!(svg.contains(clip), "{svg}");
    }

    #[test]
    fn a_sheet_that_no_viewer_shows_is_refused() {
        let refused = Canvas::document(100, 70_000, "t", |_, _| {});
        assert_eq!(refused, Err(FigureError::TooLarge { width: 100, height: 70_000 }));
    }
}
