//! The figure of a fit: what was measured, what the model says, and where the two differ.
//!
//! | panel | shows                                                                              |
//! |-------|------------------------------------------------------------------------------------|
//! | a     | force against length in slow sweeps, measured and modelled, the directions apart   |
//! | b     | force against pressure, likewise                                                   |
//! | c     | residual over time, one recording after the other, against the noise of the gauge  |
//! | d     | mean residual over pressure and length                                             |
//! | e     | distribution of the residual against that of the noise                             |
//! | f     | how the swarm converged, start by start                                            |
//!
//! A recording at constant length is a vertical line in panel a, and one at constant pressure in panel b. There
//! the panel shows averages at round levels of the other channel instead, joined across recordings. Where there is neither a
//! sweep nor a level, the panel shows measured against modelled force, by density.

mod characteristic;
mod clean;
mod convergence;
mod curve_labels;
mod curves;
mod histogram;
mod residual_map;
mod residual_time;
mod sweeps;

use crate::FigureError;
use crate::number::significant;
use crate::plot::{Anchor, Canvas, Color, Rect, palette};
use clean::Clean;

/// Use of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// The parameters were fitted to it.
    Estimation,
    /// It was held back to test them.
    Validation,
}

/// One recording and what the model makes of it; all columns have one entry per sample. Samples with a value
/// that is not finite are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct FitRecording {
    /// Name to show, such as the file's.
    pub name: String,
    /// Its use.
    pub role: Role,
    /// Time, in s.
    pub time_s: Vec<f64>,
    /// Gauge pressure, in kPa.
    pub pressure_kpa: Vec<f64>,
    /// Length, in mm.
    pub length_mm: Vec<f64>,
    /// Measured tension, in N.
    pub force_n: Vec<f64>,
    /// Modelled tension, in N.
    pub model_n: Vec<f64>,
    /// Direction of motion: +1 contracting, −1 extending.
    pub direction: Vec<f64>,
}

/// One start of the swarm.
#[derive(Debug, Clone, PartialEq)]
pub struct SwarmStart {
    /// Best RMSE after each iteration, in N.
    pub best_rmse_n: Vec<f64>,
    /// RMSE after the polish, in N, if there was one.
    pub polished_rmse_n: Option<f64>,
}

/// Everything that the figure shows.
#[derive(Debug, Clone, PartialEq)]
pub struct FitFigure {
    /// Headline.
    pub title: String,
    /// The recordings, in the order in which they are shown.
    pub recordings: Vec<FitRecording>,
    /// Standard deviation of the force's noise, in N, where known.
    pub noise_floor_n: Option<f64>,
    /// RMSE on estimation recordings, in N.
    pub rmse_estimation_n: Option<f64>,
    /// RMSE on validation recordings, in N.
    pub rmse_validation_n: Option<f64>,
    /// The swarm's starts; may be empty.
    pub starts: Vec<SwarmStart>,
}

/// Color of samples while the muscle contracts.
const CONTRACTING: Color = palette::BLUE;
/// Color of samples while the muscle extends.
const EXTENDING: Color = palette::VERMILION;
/// Color of estimation recordings where they must be told from validation recordings.
const ESTIMATION: Color = Color::new(0x6B, 0x7A, 0x8C);
/// Color of validation recordings.
const VALIDATION: Color = palette::GREEN;

/// Draws the figure, as an SVG document of 1000 × 1240 pixels: two columns, so that its letters are legible at 800.
///
/// # Errors
/// [`FigureError`] if no sample can be shown or columns differ in length.
pub fn fit_figure(figure: &FitFigure) -> Result<String, FigureError> {
    let recordings: Vec<Clean> = figure.recordings.iter().map(Clean::new).collect::<Result<_, _>>()?;
    let recordings: Vec<Clean> = recordings.into_iter().filter(|recording| !recording.force_n.is_empty()).collect();
    if recordings.is_empty() {
        return Err(FigureError::NothingToDraw);
    }
    let noise_n = figure.noise_floor_n.filter(|noise_n| noise_n.is_finite() && *noise_n > 0.0);
    Canvas::document(1000, 1240, &figure.title, |canvas, sheet| {
        let page = sheet.inset(14.0, 0.0, 14.0, 8.0);
        headline(canvas, page, figure);
        let rows = page.inset(0.0, 64.0, 0.0, 0.0).rows([340.0, 240.0, 340.0, 220.0], 10.0);
        let [top, middle, third, bottom] = rows;
        let [left, right] = top.columns([1.0, 1.0], 10.0);
        characteristic::draw(canvas, left, ("a", characteristic::Abscissa::Length), &recordings);
        characteristic::draw(canvas, right, ("b", characteristic::Abscissa::Pressure), &recordings);
        residual_time::draw(canvas, middle, &recordings, noise_n);
        let [left, right] = third.columns([1.0, 1.0], 10.0);
        residual_map::draw(canvas, left, &recordings, noise_n);
        histogram::draw(canvas, right, &recordings, noise_n);
        convergence::draw(canvas, bottom, &figure.starts, noise_n);
    })
}

fn headline(canvas: &mut Canvas<'_>, page: Rect, figure: &FitFigure) {
    canvas.bold(&figure.title, (page.left + 14.0, 26.0), Anchor::Start, 19.0, palette::INK);
    let numbers = [
        ("RMSE on estimation recordings", figure.rmse_estimation_n),
        ("on validation recordings", figure.rmse_validation_n),
        ("sensor noise", figure.noise_floor_n),
    ];
    let parts: Vec<String> = numbers
        .into_iter()
        .filter_map(|(name, value)| Some(format!("{name} {} N", significant(value.filter(|v| v.is_finite())?, 3))))
        .collect();
    canvas.text(&parts.join("\u{2003}·\u{2003}"), (page.left + 14.0, 50.0), Anchor::Start, 13.5, palette::GRAY);
}
