//! The figure of an inverse: what a network learned, where it errs, and where there is nothing to learn.
//!
//! | panel | shows                                                                                   |
//! |-------|-----------------------------------------------------------------------------------------|
//! | a     | pressure of the network over length and force, with lines of equal pressure             |
//! | b     | how steeply force grows with pressure, over length and pressure: without it, no inverse |
//! | c     | pressure of the network less the exact one, of the direction in which it errs more       |
//! | d     | share of unseen points whose error is smaller, by direction                             |
//! | e     | error by region                                                                         |
//! | f     | error over the epochs of the training                                                   |

mod color_maps;
mod distribution;
mod training;

use crate::FigureError;
use crate::number::significant;
use crate::plot::{Anchor, Bar, Bars, Canvas, Color, Rect, palette, title};

/// Everything that the figure shows.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseFigure {
    /// Headline.
    pub title: String,
    /// Facts in words, written below the headline.
    pub facts: Vec<String>,
    /// Network and exact inverse over length and force; contracting, then extending.
    pub maps: [InverseMap; 2],
    /// Where the inverse exists, over length and pressure.
    pub slopes: SlopeMap,
    /// Training error after every epoch, the untrained network first; root mean square, in kPa.
    pub training_rmse_kpa: Vec<f64>,
    /// Validation error, likewise.
    pub validation_rmse_kpa: Vec<f64>,
    /// Epoch whose weights were kept.
    pub best_epoch: usize,
    /// Pressure errors on unseen points, in kPa; contracting, then extending.
    pub errors_kpa: [Vec<f64>; 2],
    /// Error by region.
    pub regions: Vec<RegionBar>,
}

/// Cells over length and force.
#[derive(Debug, Clone, PartialEq)]
pub struct InverseMap {
    /// Shortest and longest length, in mm.
    pub length_mm: [f64; 2],
    /// Lowest and highest force, in N.
    pub force_n: [f64; 2],
    /// Columns of length.
    pub n_columns: usize,
    /// Cells at the middles of equal steps, rows of force from the lowest, `n_columns` each.
    pub cells: Vec<InverseCell>,
}

/// A length and a force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InverseCell {
    /// The inverse exists.
    Found {
        /// Pressure of the network, in kPa.
        network_kpa: f64,
        /// Pressure of the model, in kPa.
        exact_kpa: f64,
    },
    /// The force occurs, but only where it does not grow with the pressure, or at another pressure as well.
    Missing,
    /// No pressure gives the force.
    OutOfReach,
}

/// Cells over length and pressure.
#[derive(Debug, Clone, PartialEq)]
pub struct SlopeMap {
    /// Shortest and longest length, in mm.
    pub length_mm: [f64; 2],
    /// Lowest and highest pressure, in kPa.
    pub pressure_kpa: [f64; 2],
    /// Columns of length.
    pub n_columns: usize,
    /// Cells, rows of pressure from the lowest, `n_columns` each.
    pub cells: Vec<SlopeCell>,
}

/// A length and a pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SlopeCell {
    /// The inverse exists; slope of the force over the pressure, in N/kPa.
    Rising(f64),
    /// The force grows too little, or falls.
    Missing,
    /// The force is outside the domain: slack, or beyond.
    OutOfReach,
}

/// Error in one region.
#[derive(Debug, Clone, PartialEq)]
pub struct RegionBar {
    /// The region.
    pub name: String,
    /// Root mean square error there, in kPa.
    pub rmse_kpa: f64,
    /// Error that 95 % of the points stay below, in kPa.
    pub p95_kpa: f64,
}

/// Color of the contracting muscle.
const CONTRACTING: Color = palette::BLUE;
/// Color of the extending muscle.
const EXTENDING: Color = palette::VERMILION;

/// Draws the figure, as an SVG document of 1000 × 1130 pixels.
///
/// # Errors
/// [`FigureError`] if there is no cell with an inverse.
pub fn inverse_figure(figure: &InverseFigure) -> Result<String, FigureError> {
    let found = |cell: &InverseCell| matches!(cell, InverseCell::Found { .. });
    if !figure.maps.iter().any(|map| map.cells.iter().any(found)) {
        return Err(FigureError::NothingToInvert);
    }
    Canvas::document(1000, 1130, &figure.title, |canvas, sheet| {
        let page = sheet.inset(14.0, 0.0, 14.0, 8.0);
        headline(canvas, page, figure);
        let [top, middle, bottom] = page.inset(0.0, 64.0, 0.0, 0.0).rows([1.0; 3], 8.0);
        let [left, right] = top.columns([1.0; 2], 10.0);
        color_maps::pressure(canvas, left, &figure.maps[0]);
        color_maps::slope(canvas, right, &figure.slopes);
        let [left, right] = middle.columns([1.0; 2], 10.0);
        color_maps::error(canvas, left, &figure.maps);
        distribution::draw(canvas, right, &figure.errors_kpa);
        let [left, right] = bottom.columns([1.0; 2], 10.0);
        regions(canvas, left, &figure.regions);
        training::draw(canvas, right, figure);
    })
}

fn headline(canvas: &mut Canvas<'_>, page: Rect, figure: &InverseFigure) {
    canvas.bold(&figure.title, (page.left + 14.0, 26.0), Anchor::Start, 19.0, palette::INK);
    let facts = figure.facts.join("\u{2003}·\u{2003}");
    canvas.text(&facts, (page.left + 14.0, 50.0), Anchor::Start, 13.5, palette::GRAY);
}

fn regions(canvas: &mut Canvas<'_>, cell: Rect, regions: &[RegionBar]) {
    title(canvas, cell, "e", "Error by region");
    let bars = regions.iter().map(|region| Bar {
        name: region.name.clone(),
        value: region.rmse_kpa,
        text: format!("{} (95 % below {})", significant(region.rmse_kpa, 2), significant(region.p95_kpa, 2)),
        color: palette::SKY,
    });
    Bars { title: "RMSE (kPa)".to_owned(), bars: bars.collect() }.draw(canvas, cell);
}
