//! Terms for the part of a mismatch that has no name: each with its equation, its curve, and how sure it is.

use super::html::{equation, figure, heading, newtons, paragraph, percent, remark, table};
use crate::number::engineering;
use crate::plot::{Axis, Canvas, Panel, palette};
use crate::{FigureError, Table};

/// Terms without a name, and what they gain.
#[derive(Debug, Clone, PartialEq)]
pub struct PageEmpirical {
    /// The terms.
    pub terms: Vec<PageTerm>,
    /// Residual without and with them, root mean square, in N.
    pub left_n: [f64; 2],
    /// Whether that is of held-out recordings; of held-out blocks otherwise.
    pub of_holdout: bool,
}

/// A term without a name.
#[derive(Debug, Clone, PartialEq)]
pub struct PageTerm {
    /// Its action in a sentence without its full stop.
    pub words: String,
    /// Its equation.
    pub equation: String,
    /// Numbers that belong to the equation, each with its name, value and SI unit.
    pub numbers: Vec<(String, f64, String)>,
    /// Argument of the curve, with the unit that people use.
    pub argument_label: String,
    /// Values of that, in this unit.
    pub argument: Vec<f64>,
    /// Force at a typical scale, in N, as many.
    pub force_n: Vec<f64>,
    /// Lower end of its band of 95 %.
    pub low_n: Vec<f64>,
    /// Upper end.
    pub high_n: Vec<f64>,
    /// Share of the draws of blocks that choose it.
    pub chosen: f64,
    /// Others that draws choose, in words, with their share.
    pub others: Vec<(String, f64)>,
    /// Effects of the catalogue that come nearest, by id, with what speaks against each.
    pub nearest: Vec<(String, String)>,
}

/// Sentences about the terms; nothing where there are none.
///
/// # Errors
/// [`FigureError`] if a curve has not as many values of each column.
pub(super) fn empirical(page: Option<&PageEmpirical>) -> Result<String, FigureError> {
    let Some(page) = page else { return Ok(String::new()) };
    let [without_n, with_n] = page.left_n.map(newtons);
    let on =
        if page.of_holdout { "over counted samples of held-out recordings" } else { "of blocks left out of the fit" };
    let mut html = heading("Unmodelled structure, as empirical terms");
    html.push_str(&paragraph(&format!(
        "No effect of the catalogue in its published form explains the rest. An empirical equation, found in these recordings, \
         lowers the RMSE {on} from {without_n} to {with_n}, everything else fitted beside it. It describes and does not explain; outside the \
         range of the recordings it fades to zero."
    )));
    for term in &page.terms {
        html.push_str("<article class=\"effect\">\n");
        html.push_str(&paragraph(&format!("{}.", capitalized(&term.words))));
        html.push_str(&equation(&term.equation));
        if !term.numbers.is_empty() {
            html.push_str(&table(&numbers(&term.numbers)));
        }
        let caption = "Force of the term at the RMS value of its scale, with the 95 % confidence band of a jackknife over \
                       stretches of recording.";
        html.push_str(&figure(&curve(term)?, caption));
        html.push_str(&paragraph(&stability(term)));
        if !term.nearest.is_empty() {
            html.push_str("<h4>Nearest effects of the catalogue</h4>\n");
            html.push_str(&table(&nearest(&term.nearest)));
        }
        html.push_str("</article>\n");
    }
    html.push_str(&remark(
        "Bootstrap over blocks of recording: each candidate is fitted to the blocks of a sample and judged on those outside it.",
    ));
    Ok(html)
}

fn capitalized(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_uppercase().chain(characters).collect())
}

fn numbers(numbers: &[(String, f64, String)]) -> Table {
    let mut table = Table::new(["number", "value"]);
    for (name, value, unit) in numbers {
        table.row([name.clone(), engineering(*value, unit, 3)]);
    }
    table
}

fn stability(term: &PageTerm) -> String {
    let chosen = percent(term.chosen);
    if term.others.is_empty() {
        return format!("{chosen} of the bootstrap samples select the same term.");
    }
    let others: Vec<String> =
        term.others.iter().map(|(words, share)| format!("{words} ({})", percent(*share))).collect();
    format!("{chosen} of the bootstrap samples select the same term; others select {}.", others.join(", "))
}

fn nearest(nearest: &[(String, String)]) -> Table {
    let mut table = Table::new(["effect", "evidence against it"]);
    for (id, against) in nearest {
        table.row([id.clone(), against.clone()]);
    }
    table
}

/// The curve of a term with its band.
fn curve(term: &PageTerm) -> Result<String, FigureError> {
    for (column, values) in [("force_n", &term.force_n), ("low_n", &term.low_n), ("high_n", &term.high_n)] {
        let (expected, found) = (term.argument.len(), values.len());
        if expected != found {
            return Err(FigureError::UnequalColumns {
                recording: term.argument_label.clone(),
                column,
                expected,
                found,
            });
        }
    }
    let extent = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::NAN, f64::NAN), |(low, high): (f64, f64), value| (low.min(value), high.max(value)))
    };
    let (from, to) = extent(&mut term.argument.iter().copied());
    let (low, high) = extent(&mut term.low_n.iter().chain(&term.high_n).copied().chain(std::iter::once(0.0)));
    let title = format!("Force of the term over {}", term.argument_label);
    Canvas::document(640, 300, &title, |canvas, sheet| {
        let panel = Panel::new(
            sheet.inset(0.0, -18.0, 0.0, 4.0),
            Axis::linear(&*term.argument_label, from, to, 6),
            Axis::linear("force / N", low, high, 5),
            20.0,
        );
        panel.draw_frame(canvas);
        let upper = term.argument.iter().zip(&term.high_n);
        let lower = term.argument.iter().zip(&term.low_n).rev();
        canvas.area(upper.chain(lower).map(|(x, y)| panel.at(*x, *y)), palette::SKY.faded(0.35));
        panel.level(canvas, 0.0, palette::SILVER, 1.0);
        panel.line(canvas, term.argument.iter().copied().zip(term.force_n.iter().copied()), palette::BLUE, 2.2);
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page() -> PageEmpirical {
        PageEmpirical {
            terms: vec![PageTerm {
                words: "a force of up to 7 N that acts only between 11 and 13 %".to_owned(),
                equation: "F = F_base + a exp(-((ε - c) / w)²)".to_owned(),
                numbers: vec![("a".to_owned(), -7.0, "N".to_owned())],
                argument_label: "contraction / %".to_owned(),
                argument: vec![10.0, 12.0, 14.0],
                force_n: vec![0.0, -7.0, 0.0],
                low_n: vec![-1.0, -8.0, -1.0],
                high_n: vec![1.0, -6.0, 1.0],
                chosen: 0.75,
                others: vec![("the pressure".to_owned(), 0.25)],
                nearest: vec![("stribeck".to_owned(), "it leaves 3 N".to_owned())],
            }],
            left_n: [4.0, 1.0],
            of_holdout: true,
        }
    }

    #[test]
    fn a_term_is_shown_with_its_curve_its_rivals_and_what_speaks_against_names() {
        let html = empirical(Some(&page())).expect("a page");
        for text in [
            "A force of up to 7 N",
            "75 % of the bootstrap samples",
            "the pressure (25 %)",
            "stribeck",
            "<svg",
            "over counted samples of held-out recordings",
        ] {
            assert!(html.contains(text), "{text}");
        }
        assert!(empirical(None).expect("nothing").is_empty());
    }

    #[test]
    fn a_curve_without_as_many_values_is_refused() {
        let mut page = page();
        page.terms[0].low_n.pop();
        assert!(empirical(Some(&page)).is_err());
    }
}
