//! How much can be explained at all: boosted trees on the signals and their past, which know no physics but eq. 11.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde::Serialize;

use super::score::{Score, Share};

/// Error in N of boosted trees fitted by `script` to the files of `fitted`, over all samples of `holdouts`; none where Python cannot
/// run it. Files of [`Beside::Model`] are those of `pam-predict`: trees then learn what its model leaves.
pub fn trees_n(script: &Path, fitted: &[PathBuf], holdouts: &[PathBuf], beside: Beside<'_>) -> Option<f64> {
    let mut command = Command::new("python3");
    command.arg(script).args(fitted).arg("--holdout").args(holdouts);
    if let Beside::Model { truth } = beside {
        command.arg("--beside-model");
        if !truth.is_empty() {
            command.arg("--truth").args(truth);
        }
    }
    let output = command.output().ok().filter(|output| output.status.success())?;
    String::from_utf8(output.stdout).ok()?.trim().parse().ok()
}

/// What trees are fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beside<'a> {
    /// The force.
    Nothing,
    /// What a model leaves, judged against the forces of `truth`, if there are any, row by row.
    Model {
        /// Files with the force without noise.
        truth: &'a [PathBuf],
    },
}

/// The diagnosed model beside the trees, over cases in which something was concealed.
#[derive(Debug, Clone, Serialize)]
pub struct Ceiling {
    /// Error of the diagnosed model over that of the trees, median.
    pub over_trees: f64,
    /// Cases whose diagnosed model has at most 1.2 times the trees' error.
    pub as_good: Share,
    /// Of what trees explain and eq. 11 does not, what the diagnosed model explains, median over the cases where they explain some.
    pub explained: Option<f64>,
}

impl Ceiling {
    /// Over `scores` of `kind`; none where trees were not asked.
    pub fn of(scores: &[Score], kind: &str) -> Option<Self> {
        let cases: Vec<(&Score, f64)> = scores
            .iter()
            .filter(|score| score.truth.kind == kind && score.answer.refused.is_none())
            .filter_map(|score| Some((score, score.answer.trees_n?)))
            .collect();
        let over_trees = median(cases.iter().map(|(score, trees_n)| score.answer.augmented_n / trees_n))?;
        let as_good = Share {
            met: cases.iter().filter(|(score, trees_n)| score.answer.augmented_n <= 1.2 * trees_n).count(),
            of: cases.len(),
        };
        let explained = median(cases.iter().filter_map(|(score, trees_n)| {
            let (base, left) = (score.answer.base_n.powi(2), score.answer.augmented_n.powi(2));
            let explainable = base - trees_n.powi(2);
            (explainable > 0.0).then(|| (base - left) / explainable)
        }));
        Some(Self { over_trees, as_good, explained })
    }
}

/// Median, none of nothing.
pub(super) fn median(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len().saturating_sub(1) / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::super::score::{Answer, Concealed, score};
    use super::*;

    fn case(base_n: f64, augmented_n: f64, trees_n: Option<f64>) -> Score {
        let truth = Concealed { kind: "nameless".to_owned(), ..Concealed::default() };
        score(truth, Answer { base_n, augmented_n, trees_n, ..Answer::default() })
    }

    #[test]
    fn what_trees_explain_is_what_can_be_explained() {
        let ceiling = Ceiling::of(&[case(5.0, 4.0, Some(3.0))], "nameless").expect("trees were asked");
        assert!((ceiling.explained.expect("they explain some") - 9.0 / 16.0).abs() < 1e-12);
        assert!((ceiling.over_trees - 4.0 / 3.0).abs() < 1e-12);
        assert_eq!(ceiling.as_good.met, 0);
    }

    #[test]
    fn trees_that_explain_nothing_are_no_ceiling() {
        let ceiling = Ceiling::of(&[case(2.0, 1.0, Some(3.0))], "nameless").expect("trees were asked");
        assert!(ceiling.explained.is_none() && ceiling.as_good.met == 1);
        assert!(Ceiling::of(&[case(2.0, 1.0, None)], "nameless").is_none());
    }
}
