//! All cases together: what had to be reached, and what was.

use pam_artifact::diagnosis::Verdict;
use serde::Serialize;

use crate::case::Kind;
use crate::score::Score;
use crate::statistics::{quantile, quantile_interval, wilson};

/// Largest held-out error relative to the base model's, in the median and in nine cases of ten.
const HELD_OUT: [(f64, f64); 2] = [(0.5, 0.25), (0.9, 0.50)];

/// A criterion with what was reached.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Criterion {
    /// What is asked, in words.
    pub asks: String,
    /// What is to be reached; none where it is only reported.
    pub target: Option<f64>,
    /// Whether it is to be at least the target, or at most.
    pub at_least: bool,
    /// What was reached, over all cases; none where there is no case.
    pub reached: Option<f64>,
    /// Its 95 % interval.
    pub interval: Option<(f64, f64)>,
    /// Cases.
    pub n: usize,
    /// What was reached with white noise.
    pub white: Option<f64>,
    /// What was reached with colored noise and the smooth misfit.
    pub colored: Option<f64>,
}

impl Criterion {
    /// Whether the target is reached; none where there is no target or no case.
    pub fn passes(&self) -> Option<bool> {
        let (target, reached) = (self.target?, self.reached?);
        Some(if self.at_least { reached >= target } else { reached <= target })
    }
}

/// Every criterion.
pub fn criteria(scores: &[Score]) -> Vec<Criterion> {
    let kind = |kind: Kind| scores.iter().filter(move |score| score.case.kind == kind);
    let with = |of: Kind, hit: fn(&Score) -> bool| kind(of).map(|score| (score, hit(score))).collect::<Vec<_>>();
    let mut all = vec![
        share("one effect: right name first", Some(0.95), &with(Kind::Single, Score::first_is_right)),
        share("one effect: right name or its declared class", Some(0.98), &with(Kind::Single, Score::class_is_right)),
        share(
            "one effect: the right name and no other",
            None,
            &with(Kind::Single, |score| score.first_is_right() && score.n_false() == 0),
        ),
    ];
    let ratios: Vec<(&Score, f64)> = kind(Kind::Single)
        .map(|score| (score, score.heldout.map_or(f64::INFINITY, |heldout| heldout.ratio())))
        .collect();
    all.extend(HELD_OUT.map(|(at, target)| held_out(at, target, &ratios)));
    all.extend([
        share(
            "nothing: consistent",
            Some(0.98),
            &with(Kind::Nothing, |score| score.verdict() == Some(Verdict::Consistent)),
        ),
        share("two effects: both named", Some(0.80), &with(Kind::Pair, |score| score.n_named() == 2)),
        share("three effects: at least two named", Some(0.80), &with(Kind::Triple, |score| score.n_named() >= 2)),
        share("nameless: unexplained, no wrong name", Some(0.90), &with(Kind::Nameless, Score::is_rightly_unexplained)),
        share("nameless: place right", Some(0.90), &with(Kind::Nameless, Score::nameless_place_is_right)),
    ]);
    let places: Vec<(&Score, bool)> =
        scores.iter().filter_map(|score| Some((score, score.coordinate_is_right()?))).collect();
    all.push(share("effects that live in a region: top coordinate right", Some(0.90), &places));
    all
}

fn share(asks: &str, target: Option<f64>, hits: &[(&Score, bool)]) -> Criterion {
    let of = |wanted: Option<bool>| {
        let hits = hits.iter().filter(|(score, _)| wanted.is_none_or(|colored| score.case.noise.colored == colored));
        let (n, n_hit) = hits.fold((0, 0), |(n, n_hit), (_, hit)| (n + 1, n_hit + usize::from(*hit)));
        (n_hit, n)
    };
    let part = |(n_hit, n): (usize, usize)| (n > 0).then(|| n_hit as f64 / n as f64);
    let (n_hit, n) = of(None);
    Criterion {
        asks: asks.to_owned(),
        target,
        at_least: true,
        reached: part((n_hit, n)),
        interval: (n > 0).then(|| wilson(n_hit, n)),
        n,
        white: part(of(Some(false))),
        colored: part(of(Some(true))),
    }
}

fn held_out(at: f64, target: f64, ratios: &[(&Score, f64)]) -> Criterion {
    let of = |wanted: Option<bool>| -> Vec<f64> {
        let ratios =
            ratios.iter().filter(|(score, _)| wanted.is_none_or(|colored| score.case.noise.colored == colored));
        ratios.map(|(_, ratio)| *ratio).collect()
    };
    let all = of(None);
    let name = if at == 0.5 { "median".to_owned() } else { format!("{:.0} % of cases", 100.0 * at) };
    Criterion {
        asks: format!("one effect: held-out error over the base model's, {name}"),
        target: Some(target),
        at_least: false,
        reached: quantile(&all, at),
        interval: quantile_interval(&all, at),
        n: all.len(),
        white: quantile(&of(Some(false)), at),
        colored: quantile(&of(Some(true)), at),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::tests::score;

    #[test]
    fn criteria_count_their_own_cases() {
        let scores = [
            score(Kind::Single, &["slack"], Verdict::Explained, &[("slack", &[])]),
            score(Kind::Single, &["inertia"], Verdict::Explained, &[("slack", &["inertia"])]),
            score(Kind::Nothing, &[], Verdict::Consistent, &[]),
            score(Kind::Pair, &["slack", "inertia"], Verdict::Explained, &[("inertia", &[]), ("slack", &[])]),
        ];
        let reached: Vec<_> = criteria(&scores).into_iter().map(|criterion| criterion.reached).collect();
        let (one, no) = (Some(1.0), Some(0.0));
        assert_eq!(
            reached,
            [Some(0.5), one, Some(0.5), Some(0.25), Some(0.25), one, one, None, None, None, no],
            "the top region of slack is in contraction"
        );
    }
}
