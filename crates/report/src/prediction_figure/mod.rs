//! The figure of a prediction.
//!
//! | panel | shows                                                                                     |
//! |-------|-------------------------------------------------------------------------------------------|
//! | a     | measured and modelled force over time, with the band in which the force is to be expected |
//! | b     | residual over time against that band, with the samples that are not counted               |
//! | c     | pressures and lengths of the recording beside those that the model was identified on      |
//! | d     | residual against modelled force, by density                                               |
//!
//! Where no force was recorded, b and d are left out.

mod density;
mod operating_range;
mod over_time;

use crate::FigureError;
use crate::number::significant;
use crate::plot::{Anchor, Canvas, Color, Rect, palette};

/// Everything that the figure shows; columns have one entry per sample, but for `force_n`, which is empty where no force was
/// recorded.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PredictionFigure {
    /// Headline.
    pub title: String,
    /// Its statement in numbers.
    pub facts: Vec<String>,
    /// Time, in s.
    pub time_s: Vec<f64>,
    /// Gauge pressure, in kPa.
    pub pressure_kpa: Vec<f64>,
    /// Length, in mm.
    pub length_mm: Vec<f64>,
    /// Measured force, in N.
    pub force_n: Vec<f64>,
    /// Modelled force, in N.
    pub model_n: Vec<f64>,
    /// Half of the band, in N.
    pub half_width_n: Vec<f64>,
    /// Share of samples that the band is meant to hold.
    pub level: f64,
    /// Whether a sample counts.
    pub counted: Vec<bool>,
    /// Whether the model extrapolates.
    pub extrapolated: Vec<bool>,
    /// Pressures that the model was identified on, in kPa.
    pub identified_kpa: [f64; 2],
    /// Lengths that it was identified on, in mm.
    pub identified_mm: [f64; 2],
}

/// Measured force: broad and pale below the modelled one, so that both are seen where they coincide.
const MEASURED: Color = palette::INK.faded(0.35);
/// Modelled force.
const MODELLED: Color = palette::BLUE;
/// Where the force is to be expected.
const BAND: Color = palette::SKY.faded(0.35);
/// Where the model extrapolates.
const EXTRAPOLATED: Color = palette::ORANGE.faded(0.25);
/// Samples that are not counted.
const UNCOUNTED: Color = palette::SILVER.faded(0.3);

/// Draws the figure, as an SVG document 1000 pixels wide.
///
/// # Errors
/// [`FigureError`] if no sample can be shown or columns differ in length.
pub fn prediction_figure(figure: &PredictionFigure) -> Result<String, FigureError> {
    check(figure)?;
    let has_force = !figure.force_n.is_empty();
    let rows: &[f64] = if has_force { &[330.0, 220.0, 330.0] } else { &[330.0, 330.0] };
    let height = 74.0 + rows.iter().sum::<f64>();
    Canvas::document(1000, height as u32, &figure.title, |canvas, sheet| {
        let page = sheet.inset(12.0, 0.0, 12.0, 8.0);
        canvas.bold(&figure.title, (page.left + 14.0, 24.0), Anchor::Start, 18.0, palette::INK);
        canvas.text(
            &figure.facts.join("\u{2003}·\u{2003}"),
            (page.left + 14.0, 47.0),
            Anchor::Start,
            13.0,
            palette::GRAY,
        );
        let mut top = 62.0;
        let mut next = |height: f64| {
            let row = Rect { top, bottom: top + height, ..page };
            top += height;
            row
        };
        over_time::force(canvas, next(rows[0]), figure);
        if has_force {
            over_time::residual(canvas, next(rows[1]), figure);
        }
        let [left, right] = next(330.0).columns([1.0, 1.0], 20.0);
        operating_range::draw(canvas, left, figure, if has_force { "c" } else { "b" });
        if has_force {
            density::draw(canvas, right, figure);
        }
    })
}

fn check(figure: &PredictionFigure) -> Result<(), FigureError> {
    let expected = figure.time_s.len();
    let force = if figure.force_n.is_empty() { expected } else { figure.force_n.len() };
    let columns = [
        ("pressure_kpa", figure.pressure_kpa.len()),
        ("length_mm", figure.length_mm.len()),
        ("force_n", force),
        ("model_n", figure.model_n.len()),
        ("half_width_n", figure.half_width_n.len()),
        ("counted", figure.counted.len()),
        ("extrapolated", figure.extrapolated.len()),
    ];
    if let Some((column, found)) = columns.into_iter().find(|(_, found)| *found != expected) {
        return Err(FigureError::UnequalColumns { recording: figure.title.clone(), column, expected, found });
    }
    if figure.model_n.iter().all(|force_n| !force_n.is_finite()) {
        return Err(FigureError::NothingToDraw);
    }
    Ok(())
}

/// The band in words.
fn band_words(figure: &PredictionFigure) -> String {
    format!("{} % band", significant(100.0 * figure.level, 2))
}
