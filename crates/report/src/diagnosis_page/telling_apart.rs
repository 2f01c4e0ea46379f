//! Section: which effects the recordings can distinguish.

use pam_artifact::diagnosis::Isolability;

use crate::FigureError;
use crate::number::significant;
use crate::page::html::{figure, list, newtons, paragraph};
use crate::page::style::size_color;
use crate::plot::{Bins, Canvas, ColorBar, Map};

/// Above this the residuals of a pair are alike.
const ALIKE: f64 = 0.95;

pub(super) fn telling_apart(isolability: Option<&Isolability>, noise_n: f64) -> Result<String, FigureError> {
    let Some(isolability) = isolability.filter(|isolability| !isolability.ids.is_empty()) else {
        return Ok(paragraph("This was not examined."));
    };
    let mut html = paragraph(
        "The residual that each effect of the catalogue would leave in these recordings, at a typical size and after a \
         refit of the base model, compared with that of every other effect. Dark cells are pairs that these recordings \
         hardly distinguish, by whatever method; the number after a name is the residual that it would leave.",
    );
    html.push_str(&figure(
        &matrix(isolability)?,
        "Residual similarity of each pair, the size of a cosine in percent: 0 for residuals with nothing in common, 100 for \
         residuals of the same shape.",
    ));
    let pairs = alike(isolability);
    if !pairs.is_empty() {
        html.push_str(&paragraph("These recordings cannot distinguish:"));
        html.push_str(&list(&pairs));
    }
    let hidden: Vec<&str> = isolability
        .ids
        .iter()
        .zip(&isolability.visible_n)
        .filter(|(_, visible_n)| **visible_n < 0.5 * noise_n)
        .map(|(id, _)| id.as_str())
        .collect();
    if !hidden.is_empty() {
        html.push_str(&paragraph(&format!(
            "Hardly visible here at a typical size (below half of the noise floor of {}): {}.",
            newtons(noise_n),
            hidden.join(", ")
        )));
    }
    Ok(html)
}

/// Pairs whose residuals are alike, the closest first.
fn alike(isolability: &Isolability) -> Vec<String> {
    let ids = &isolability.ids;
    let mut pairs = Vec::new();
    for (row, cosines) in isolability.cosine.iter().enumerate().take(ids.len()) {
        for (column, cosine) in cosines.iter().enumerate().take(row) {
            if cosine.abs() >= ALIKE {
                pairs.push((cosine.abs(), column, row));
            }
        }
    }
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    pairs.into_iter().map(|(cosine, a, b)| format!("{} and {} ({cosine:.2})", ids[a], ids[b])).collect()
}

fn matrix(isolability: &Isolability) -> Result<String, FigureError> {
    let n = isolability.ids.len();
    let names: Vec<String> = isolability
        .ids
        .iter()
        .enumerate()
        .map(|(index, id)| match isolability.visible_n.get(index) {
            Some(visible_n) if visible_n.is_finite() => format!("{id} · {} N", significant(*visible_n, 2)),
            _ => id.clone(),
        })
        .rev()
        .collect();
    let cosine = |row: usize, column: usize| {
        let cosine = isolability.cosine.get(row)?.get(column)?.abs();
        // The diagonal says nothing.
        (row != column && cosine.is_finite()).then_some(cosine)
    };
    // Rows of a map count from the bottom.
    let cells = || (0..n).rev().flat_map(|row| (0..n).map(move |column| (row, column)));
    let legible = n <= 26;
    let map = Map {
        columns: Bins::Named(String::new(), isolability.ids.clone()),
        rows: Bins::Named(String::new(), names),
        values: cells().map(|(row, column)| cosine(row, column)).collect(),
        texts: cells()
            .map(|(row, column)| match cosine(row, column) {
                Some(cosine) if legible && cosine >= 0.3 => format!("{:.0}", 100.0 * cosine),
                _ => String::new(),
            })
            .collect(),
        bar: ColorBar { title: "cosine".to_owned(), from: 0.0, to: 1.0, logarithm: false, color: size_color },
    };
    // The axis has no title, whose room the sheet can do without. Cells stay about square between the labels on both sides.
    let height = (26 * n as u32 + 240).clamp(360, 940);
    Canvas::document(900, height, "Which effects these recordings can distinguish", |canvas, sheet| {
        let spare = (sheet.width() - 84.0 - 270.0 - 40.0 * n as f64).max(0.0);
        map.draw(canvas, sheet.inset(0.0, 0.0, spare, -22.0));
    })
}
