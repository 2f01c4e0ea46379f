//! The figure of a proof: which effects were concealed and which were named.

use crate::FigureError;
use crate::plot::{Anchor, Bins, Canvas, ColorBar, Map, Rect, palette, sequential, text_width};

/// Everything that the figure shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConfusionFigure {
    /// Headline.
    pub title: String,
    /// Concealed effects: names of the rows, from the top.
    pub concealed: Vec<String>,
    /// Named effects: names of the columns, from the left.
    pub named: Vec<String>,
    /// Cases, row by row.
    pub counts: Vec<Vec<usize>>,
}

/// Side of a cell, in pixels.
const CELL: f64 = 30.0;

/// Draws the figure, as an SVG document that grows with the number of names.
///
/// # Errors
/// [`FigureError::TooLarge`] where there are more names than a sheet has room for.
pub fn confusion_figure(figure: &ConfusionFigure) -> Result<String, FigureError> {
    let (rows, columns) = (&figure.concealed, &figure.named);
    let count = |row: usize, column: usize| figure.counts.get(row).and_then(|row| row.get(column)).copied();
    let totals: Vec<usize> =
        (0..rows.len()).map(|row| figure.counts.get(row).map_or(0, |row| row.iter().sum())).collect();
    let widest = |names: &[String]| names.iter().map(|name| text_width(name, 11.5)).fold(0.0, f64::max);
    // Rows of a map count from the bottom.
    let names = rows.iter().zip(&totals).map(|(name, total)| format!("{name} ({total})")).rev().collect::<Vec<_>>();
    let cells = || (0..rows.len()).rev().flat_map(|row| (0..columns.len()).map(move |column| (row, column)));
    let map = Map {
        values: cells()
            .map(|(row, column)| {
                let cases = count(row, column).filter(|cases| *cases > 0)?;
                Some(cases as f64 / totals[row] as f64)
            })
            .collect(),
        texts: cells()
            .map(|(row, column)| count(row, column).filter(|cases| *cases > 0).map_or(String::new(), |n| n.to_string()))
            .collect(),
        columns: Bins::Named("named".to_owned(), columns.clone()),
        rows: Bins::Named("concealed (cases)".to_owned(), names.clone()),
        bar: ColorBar { title: "share of row".to_owned(), from: 0.0, to: 1.0, logarithm: false, color: sequential },
    };
    let width = CELL * columns.len() as f64 + widest(&names) + 36.0 + 84.0 + 20.0;
    let height = 50.0 + 40.0 + CELL * rows.len() as f64 + widest(columns) + 46.0;
    let (width, height) = (width.max(460.0), height.max(300.0));
    Canvas::document(width as u32, height as u32, &figure.title, |canvas, sheet| {
        canvas.bold(&figure.title, (18.0, 26.0), Anchor::Start, 17.0, palette::INK);
        let right = map.draw(canvas, sheet.inset(0.0, 42.0, 16.0, 0.0));
        // The cells where a right name would stand.
        for (row, name) in rows.iter().enumerate() {
            if let Some(column) = columns.iter().position(|other| other == name) {
                let Rect { left, bottom, .. } = right.frame;
                let (wide, tall) =
                    (right.frame.width() / columns.len() as f64, right.frame.height() / rows.len() as f64);
                let (x, y) = (left + wide * column as f64, bottom - tall * (rows.len() - row) as f64);
                let corners = [(x, y), (x + wide, y), (x + wide, y + tall), (x, y + tall), (x, y)];
                canvas.line(corners.map(|(x, y)| (x.round() - 0.5, y.round() - 0.5)), palette::GRAY, 1.0);
            }
        }
    })
}
