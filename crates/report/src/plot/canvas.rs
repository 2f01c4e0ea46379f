//! A sheet to draw on, in pixels, on top of the drawing library's SVG backend.
//!
//! # Design
//! The backend counts in whole pixels, which makes slanted lines ragged and text jump. So the sheet is drawn
//! [`FINE`] times as large as it is shown, and the root element says so: same document, finer grid. The
//! root also rounds the joints of lines, whose default spikes at every noisy sample, and lets the figure
//! shrink with the page it is embedded in.

use plotters::backend::{DrawingBackend as _, SVGBackend};
use plotters::prelude::{FontFamily, FontStyle, FontTransform, RGBAColor, ShapeStyle, TextStyle};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, IntoFont as _};

use crate::FigureError;
use crate::escape::escaped;
use crate::plot::{Color, Rect};

/// Backend units in a pixel.
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
pub struct Canvas<'a> {
    backend: SVGBackend<'a>,
    failed: Option<FigureError>,
}

impl std::fmt::Debug for Canvas<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Canvas").field("failed", &self.failed).finish_non_exhaustive()
    }
}

impl<'a> Canvas<'a> {
    /// A whole SVG document of `width` × `height` pixels; `title` is what a screen reader says.
    ///
    /// # Errors
    /// [`FigureError::Backend`] if the drawing library gives up.
    pub fn document(
        width: u32,
        height: u32,
        title: &str,
        draw: impl FnOnce(&mut Canvas<'_>, Rect),
    ) -> Result<String, FigureError> {
        let fine = |pixels: u32| pixels * FINE as u32;
        let mut text = String::with_capacity(1 << 18);
        let sheet = Rect { left: 0.0, top: 0.0, right: f64::from(width), bottom: f64::from(height) };
        let mut canvas =
            Canvas { backend: SVGBackend::with_string(&mut text, (fine(width), fine(height))), failed: None };
        canvas.rect(sheet, crate::plot::palette::WHITE);
        draw(&mut canvas, sheet);
        canvas.keep(|backend| backend.present());
        let failed = canvas.failed.take();
        drop(canvas);
        match failed {
            Some(error) => Err(error),
            None => {
                let body = text.find('\n').map_or(text.as_str(), |end| &text[end..]);
                Ok(format!(
                    "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
                     viewBox=\"0 0 {} {}\" style=\"max-width:100%;height:auto\" stroke-linejoin=\"round\" \
                     stroke-linecap=\"round\" role=\"img\">\n<title>{}</title>{body}",
                    fine(width),
                    fine(height),
                    escaped(title)
                ))
            }
        }
    }

    /// A line through `points`; points that are not finite are left out.
    pub fn line(&mut self, points: impl IntoIterator<Item = (f64, f64)>, color: Color, width: f64) {
        let points: Vec<(i32, i32)> = points.into_iter().filter_map(fine_point).collect();
        if points.len() > 1 {
            let style = stroke(color, width);
            self.keep(|backend| backend.draw_path(points, &style));
        }
    }

    /// A horizontal or vertical line of dashes `dash` pixels long.
    pub fn dashes(&mut self, from: (f64, f64), to: (f64, f64), color: Color, width: f64, dash: f64) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.hypot(dy);
        if !(length.is_finite() && length > 0.0) {
            return;
        }
        // An odd number of equal pieces, so that the line begins and ends with ink.
        let pieces = (length / dash).round() as usize | 1;
        let at = |piece: usize| {
            let share = piece as f64 / pieces as f64;
            (from.0 + share * dx, from.1 + share * dy)
        };
        for piece in (0..pieces).step_by(2) {
            self.line([at(piece), at(piece + 1)], color, width);
        }
    }

    /// A filled rectangle.
    pub fn rect(&mut self, rect: Rect, color: Color) {
        let corners = (fine_point((rect.left, rect.top)), fine_point((rect.right, rect.bottom)));
        if let (Some(upper_left), Some(bottom_right)) = corners
            && upper_left.0 < bottom_right.0
            && upper_left.1 < bottom_right.1
        {
            let style = stroke(color, 0.0);
            self.keep(|backend| backend.draw_rect(upper_left, bottom_right, &style, true));
        }
    }

    /// A filled area bounded by `points`.
    pub fn area(&mut self, points: impl IntoIterator<Item = (f64, f64)>, color: Color) {
        let points: Vec<(i32, i32)> = points.into_iter().filter_map(fine_point).collect();
        let style = stroke(color, 0.0);
        self.keep(|backend| backend.fill_polygon(points, &style));
    }

    /// A filled disk.
    pub fn dot(&mut self, center: (f64, f64), radius: f64, color: Color) {
        if let Some(center) = fine_point(center) {
            let style = stroke(color, 0.0);
            self.keep(|backend| backend.draw_circle(center, (radius * FINE).round() as u32, &style, true));
        }
    }

    /// A circle.
    pub fn ring(&mut self, center: (f64, f64), radius: f64, color: Color, width: f64) {
        if let Some(center) = fine_point(center) {
            let style = stroke(color, width);
            self.keep(|backend| backend.draw_circle(center, (radius * FINE).round() as u32, &style, false));
        }
    }

    /// Text whose middle line runs through `at`.
    pub fn text(&mut self, text: &str, at: (f64, f64), anchor: Anchor, size: f64, color: Color) {
        self.lettering(text, at, anchor, size, color, FontStyle::Normal, FontTransform::None);
    }

    /// Bold text whose middle line runs through `at`.
    pub fn bold(&mut self, text: &str, at: (f64, f64), anchor: Anchor, size: f64, color: Color) {
        self.lettering(text, at, anchor, size, color, FontStyle::Bold, FontTransform::None);
    }

    /// Text that reads upward, its middle line running through `at`.
    pub fn upward(&mut self, text: &str, at: (f64, f64), anchor: Anchor, size: f64, color: Color) {
        self.lettering(text, at, anchor, size, color, FontStyle::Normal, FontTransform::Rotate270);
    }

    #[expect(clippy::too_many_arguments, reason = "the three public forms name what differs")]
    fn lettering(
        &mut self,
        text: &str,
        at: (f64, f64),
        anchor: Anchor,
        size: f64,
        color: Color,
        weight: FontStyle,
        transform: FontTransform,
    ) {
        // Half the height of a digit is 0.36 em; the backend moves the middle by half an x, 0.26 em.
        let low = 0.1 * size;
        let at = if matches!(transform, FontTransform::None) { (at.0, at.1 + low) } else { (at.0 + low, at.1) };
        let Some(position) = fine_point(at) else { return };
        let horizontal = match anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        // The backend divides by 1.24.
        let font = FontDesc::new(FontFamily::SansSerif, size * FINE * 1.24, weight).transform(transform);
        let color = rgba(color);
        let style = TextStyle::from(font.into_font()).color(&color).pos(Pos::new(horizontal, VPos::Center));
        let text: String = text.chars().filter(|character| !character.is_control()).collect();
        self.keep(|backend| backend.draw_text(&text, &style, position));
    }

    /// Keeps the first failure and draws nothing after it.
    fn keep<E: std::fmt::Display>(&mut self, draw: impl FnOnce(&mut SVGBackend<'a>) -> Result<(), E>) {
        if self.failed.is_none()
            && let Err(reason) = draw(&mut self.backend)
        {
            self.failed = Some(FigureError::Backend { reason: reason.to_string() });
        }
    }
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

fn rgba(color: Color) -> RGBAColor {
    RGBAColor(color.rgb[0], color.rgb[1], color.rgb[2], color.opacity)
}

fn stroke(color: Color, width: f64) -> ShapeStyle {
    ShapeStyle { color: rgba(color), filled: true, stroke_width: (width * FINE).round() as u32 }
}
