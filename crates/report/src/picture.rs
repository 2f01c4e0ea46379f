//! A figure in the format that the ending of its path asks for.
//!
//! Figures are drawn as SVG; PNG and PDF are made from that by `resvg` and `svg2pdf`. SVG names a generic typeface and is
//! the same everywhere; PNG and PDF hold letters of a font of this machine, so their bytes are those of its fonts.

use std::path::Path;
use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use crate::FigureError;

/// Format of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PictureFormat {
    /// Scalable, for screens and for editing.
    Svg,
    /// Points, twice as many as the figure has pixels, for slides.
    Png,
    /// For papers.
    Pdf,
}

/// Points of a PNG in a pixel of the figure.
const SCALE: f32 = 2.0;
/// Typefaces that stand for any without serifs, the first that is there.
const SANS: [&str; 5] = ["Liberation Sans", "DejaVu Sans", "Arial", "Helvetica", "Noto Sans"];

impl PictureFormat {
    /// The format that a path ends in; SVG where it ends otherwise.
    pub fn of_path(path: &Path) -> Self {
        let ends = |ending: &str| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(ending));
        if ends("png") {
            Self::Png
        } else if ends("pdf") {
            Self::Pdf
        } else {
            Self::Svg
        }
    }

    /// `svg` in this format.
    ///
    /// # Errors
    /// [`FigureError::NoFont`] where no font is installed, [`FigureError::Conversion`] where a library gives up.
    pub fn write(self, svg: String) -> Result<Vec<u8>, FigureError> {
        match self {
            Self::Svg => Ok(svg.into_bytes()),
            Self::Png => png(&tree(&svg, "PNG")?),
            Self::Pdf => {
                let options = svg2pdf::ConversionOptions::default();
                let page = svg2pdf::PageOptions::default();
                svg2pdf::to_pdf(&tree(&svg, "PDF")?, options, page).map_err(|reason| failed("PDF", &reason))
            }
        }
    }
}

fn failed(format: &'static str, reason: &dyn std::fmt::Display) -> FigureError {
    FigureError::Conversion { format, reason: reason.to_string() }
}

fn tree(svg: &str, format: &'static str) -> Result<Tree, FigureError> {
    let mut fonts = fontdb::Database::new();
    fonts.load_system_fonts();
    let has = |name: &str| fonts.faces().any(|face| face.families.iter().any(|(family, _)| family == name));
    let any = || fonts.faces().next().and_then(|face| Some(face.families.first()?.0.clone()));
    let known = SANS.into_iter().find(|name| has(name)).map(str::to_owned);
    let family = known.or_else(any).ok_or(FigureError::NoFont)?;
    fonts.set_sans_serif_family(family);
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    Tree::from_str(svg, &options).map_err(|reason| failed(format, &reason))
}

fn png(tree: &Tree) -> Result<Vec<u8>, FigureError> {
    let size = tree.size();
    let (width, height) = ((SCALE * size.width()).ceil() as u32, (SCALE * size.height()).ceil() as u32);
    let mut points = Pixmap::new(width, height).ok_or_else(|| failed("PNG", &"it is too large"))?;
    resvg::render(tree, Transform::from_scale(SCALE, SCALE), &mut points.as_mut());
    points.encode_png().map_err(|reason| failed("PNG", &reason))
}

#[cfg(test)]
#[expect(clippy::print_stdout, reason = "a test that skips says so")]
mod tests {
    use super::*;
    use crate::plot::{Anchor, Canvas, palette};

    fn figure() -> String {
        Canvas::document(40, 20, "t", |canvas, sheet| {
            canvas.rect(sheet.inset(0.0, 0.0, 20.0, 0.0), palette::BLUE);
            canvas.text("a", (30.0, 10.0), Anchor::Middle, 14.0, palette::INK);
        })
        .expect("a small sheet")
    }

    #[test]
    fn the_ending_of_a_path_is_the_format() {
        let formats = ["a.svg", "a.PNG", "b/a.pdf", "a", "a.txt"].map(|path| PictureFormat::of_path(Path::new(path)));
        let [svg, png, pdf] = [PictureFormat::Svg, PictureFormat::Png, PictureFormat::Pdf];
        assert_eq!(formats, [svg, png, pdf, svg, svg]);
    }

    #[test]
    fn points_have_the_colors_of_the_figure() {
        let bytes = match PictureFormat::Png.write(figure()) {
            Err(FigureError::NoFont) => return println!("skipped: no font is installed"),
            bytes => bytes.expect("a picture"),
        };
        let points = Pixmap::decode_png(&bytes).expect("a PNG");
        assert_eq!((points.width(), points.height()), (80, 40));
        let color = |x, y| points.pixel(x, y).map(|point| (point.red(), point.green(), point.blue()));
        assert_eq!(color(10, 20), Some((0x00, 0x72, 0xB2)));
        assert_eq!(color(79, 0), Some((0xFF, 0xFF, 0xFF)));
        let letters = (44..76).any(|x| (4..36).any(|y| color(x, y).is_some_and(|(red, _, _)| red < 0x80)));
        assert!(letters, "no letter is there");
    }

    #[test]
    fn a_page_begins_and_ends_as_one() {
        match PictureFormat::Pdf.write(figure()) {
            Err(FigureError::NoFont) => println!("skipped: no font is installed"),
            bytes => {
                let bytes = bytes.expect("a page");
                assert!(bytes.starts_with(b"%PDF-") && bytes.trim_ascii_end().ends_with(b"%%EOF"));
            }
        }
    }
}
