//! What was concealed against what was named first.

use pam_artifact::diagnosis::Verdict;
use pam_report::FigureError;
use pam_report::plot::{self, Bins, Canvas, ColorBar, Map, Rect};
use serde::Serialize;

use crate::case::{Kind, NAMELESS, catalogue};
use crate::score::{Outcome, Score};

/// Columns beside the names of the catalogue.
const OTHERS: [&str; 3] = ["consistent", "no name", "failed"];

/// Counts of cases: a row for each truth, a column for each first answer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Confusion {
    /// What was concealed.
    pub truths: Vec<String>,
    /// What was named first, or the verdict where nothing was named.
    pub answers: Vec<String>,
    /// Cases, row by row.
    pub counts: Vec<Vec<usize>>,
}

impl Confusion {
    /// Of every case with one effect, none, or a nameless one alone.
    pub fn of(scores: &[Score]) -> Self {
        let truths: Vec<String> =
            catalogue().into_iter().chain(NAMELESS).chain([Kind::Nothing.name()]).map(str::to_owned).collect();
        let answers: Vec<String> = catalogue().into_iter().chain(OTHERS).map(str::to_owned).collect();
        let mut counts = vec![vec![0; answers.len()]; truths.len()];
        for score in scores.iter().filter(|score| score.case.concealed.len() <= 1) {
            let truth = score.truth().first().map_or(Kind::Nothing.name(), |id| *id).to_owned();
            let answer = answer(score);
            let row = truths.iter().position(|id| *id == truth);
            let column = answers.iter().position(|id| *id == answer);
            if let (Some(row), Some(column)) = (row, column) {
                counts[row][column] += 1;
            }
        }
        Self { truths, answers, counts }
    }

    /// Cells off the diagonal as lines `truth → answer: count`, the most frequent first; the right answer of what has
    /// no name is no name, of nothing `consistent`.
    pub fn mistakes(&self) -> Vec<String> {
        let mut mistakes = Vec::new();
        for (truth, counts) in self.truths.iter().zip(&self.counts) {
            let right = match truth.as_str() {
                id if NAMELESS.contains(&id) => OTHERS[1],
                id if id == Kind::Nothing.name() => OTHERS[0],
                id => id,
            };
            let wrong = self.answers.iter().zip(counts).filter(|(answer, count)| *answer != right && **count > 0);
            mistakes.extend(wrong.map(|(answer, count)| (*count, format!("{truth} → {answer}: {count}"))));
        }
        mistakes.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
        mistakes.into_iter().map(|(_, line)| line).collect()
    }

    /// The matrix as a figure.
    ///
    /// # Errors
    /// Where the drawing library gives up.
    pub fn figure(&self) -> Result<String, FigureError> {
        const CELL: f64 = 34.0;
        let (n_columns, n_rows) = (self.answers.len(), self.truths.len());
        let numbers: Vec<String> = (1..=n_columns).map(|number| number.to_string()).collect();
        let mut names: Vec<String> = self.truths.iter().enumerate().map(|(row, id)| numbered(id, row)).collect();
        names.reverse();
        let most = |counts: &[usize]| counts.iter().sum::<usize>().max(1) as f64;
        let cells = || self.counts.iter().rev().flat_map(|counts| counts.iter().map(move |count| (count, counts)));
        let map = Map {
            columns: Bins::Named(
                format!(
                    "named first (numbers as on the left; {} consistent, {} no name, {} failed)",
                    n_columns - 2,
                    n_columns - 1,
                    n_columns
                ),
                numbers,
            ),
            rows: Bins::Named("concealed".to_owned(), names),
            values: cells().map(|(count, counts)| (*count > 0).then(|| *count as f64 / most(counts))).collect(),
            texts: cells().map(|(count, _)| if *count > 0 { count.to_string() } else { String::new() }).collect(),
            bar: ColorBar {
                title: "share of the row".to_owned(),
                from: 0.0,
                to: 1.0,
                logarithm: false,
                color: plot::sequential,
            },
        };
        let (width, height) = (CELL * n_columns as f64 + 330.0, CELL * n_rows as f64 + 110.0);
        Canvas::document(
            width as u32,
            height as u32,
            "what was concealed, and what was named first",
            |canvas, sheet| {
                map.draw(canvas, Rect { left: sheet.left + 130.0, ..sheet });
            },
        )
    }
}

fn numbered(id: &str, row: usize) -> String {
    if row < catalogue().len() { format!("{id} {}", row + 1) } else { id.to_owned() }
}

/// First name, or the verdict where nothing was named.
fn answer(score: &Score) -> String {
    match &score.outcome {
        Outcome::Failed(_) => OTHERS[2].to_owned(),
        Outcome::Diagnosed(diagnosed) => match diagnosed.named.first() {
            Some(named) => named.id.clone(),
            None if diagnosed.verdict == Verdict::Consistent => OTHERS[0].to_owned(),
            None => OTHERS[1].to_owned(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::tests::score;

    #[test]
    fn mistakes_are_what_lies_off_the_diagonal() {
        let scores = [
            score(Kind::Single, &["slack"], Verdict::Explained, &[("slack", &[])]),
            score(Kind::Single, &["slack"], Verdict::Explained, &[("inertia", &[])]),
            score(Kind::Nothing, &[], Verdict::Consistent, &[]),
            score(Kind::Nameless, &["bad-spot"], Verdict::Unexplained, &[]),
        ];
        let confusion = Confusion::of(&scores);
        assert_eq!(confusion.mistakes(), ["slack → inertia: 1"]);
        assert!(confusion.figure().unwrap().contains("bad-spot"));
    }
}
