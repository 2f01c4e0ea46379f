//! Scores of a diagnosis on cases of the independent bench: what was named, what was concealed, and the error left.

use std::collections::BTreeMap;

use serde::Serialize;

use super::discovered::Discovered;
use super::left_out::LeftOut;

/// What the truth says of a case.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Concealed {
    /// Name of the case.
    pub case: String,
    /// `nothing`, `one`, `two` or `nameless`.
    pub kind: String,
    /// Catalogue ids, or `nameless:<kind>`.
    pub ids: Vec<String>,
    /// Attributes to report by.
    pub world: BTreeMap<String, String>,
    /// Places: coordinate, from, to, recording.
    pub places: Vec<(String, f64, f64, Option<String>)>,
    /// Sizes beside the floor.
    pub severities: Vec<f64>,
}

/// What the programs said.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Answer {
    /// Last line of a program that refused.
    pub refused: Option<String>,
    /// Verdict.
    pub verdict: String,
    /// Names with their declared alternatives.
    pub named: Vec<(String, Vec<String>)>,
    /// Regions: coordinate, from, to in the units of the places, recording.
    pub regions: Vec<(String, f64, f64, Option<String>)>,
    /// Root mean square error of the base and of the augmented model against the truth, N; infinite where not finite.
    pub base_n: f64,
    /// Of the augmented model.
    pub augmented_n: f64,
    /// What was discovered without a name.
    pub discovered: Option<Discovered>,
    /// Error left of held-out samples whose direction is settled, as the diagnosis has it.
    pub settled_left: Option<f64>,
    /// The same case without its effect in the catalogue; none where that was not asked.
    pub left_out: Option<LeftOut>,
    /// Error of boosted trees, N; none where they were not asked.
    pub trees_n: Option<f64>,
}

/// A case, scored strictly.
#[derive(Debug, Clone, Serialize)]
pub struct Score {
    /// Truth.
    pub truth: Concealed,
    /// Answer.
    pub answer: Answer,
    /// The strict criterion of its kind.
    pub strict: bool,
    /// The strict criterion, with `end-taper` forgiven where slices have no cylinder's ends.
    pub strict_but_ends: bool,
    /// The right name is first.
    pub right_first: bool,
    /// The right name or a declared alternative of a named effect.
    pub right_or_alternative: bool,
    /// Both names, with at most one other.
    pub both_and_one_other: bool,
    /// A region overlaps a known place by at least half of both; none where no place is known.
    pub region: Option<bool>,
}

fn overlap(place: (f64, f64), region: (f64, f64)) -> bool {
    let common = place.1.min(region.1) - place.0.max(region.0);
    common >= 0.5 * (place.1 - place.0) && common >= 0.5 * (region.1 - region.0) && common > 0.0
}

/// Scores one answer.
pub fn score(truth: Concealed, answer: Answer) -> Score {
    let strictly = |named: &[&str]| -> bool {
        if answer.refused.is_some() {
            return false;
        }
        match truth.kind.as_str() {
            "nothing" => answer.verdict == "consistent" || named.is_empty() && !answer.named.is_empty(),
            "nameless" => named.is_empty() && answer.verdict != "consistent",
            _ => named.len() == truth.ids.len() && truth.ids.iter().all(|id| named.contains(&id.as_str())),
        }
    };
    let named: Vec<&str> = answer.named.iter().map(|name| name.0.as_str()).collect();
    let slices = truth.world.get("bench").is_some_and(|bench| bench == "slices");
    let without_ends: Vec<&str> = named
        .iter()
        .copied()
        .filter(|id| !(slices && *id == "end-taper") || truth.ids.iter().any(|concealed| concealed == id))
        .collect();
    let first = truth.ids.first().map_or("", String::as_str);
    let of_alternatives =
        answer.named.iter().any(|(id, others)| id == first || others.iter().any(|other| other == first));
    let known: Vec<_> = truth.places.iter().collect();
    let region = (!known.is_empty()).then(|| {
        known.iter().any(|place| {
            answer.regions.iter().any(|region| {
                place.0 == region.0
                    && (place.3.is_none() || region.3.is_none() || place.3 == region.3)
                    && overlap((place.1, place.2), (region.1, region.2))
            })
        })
    });
    Score {
        strict: strictly(&named),
        strict_but_ends: strictly(&without_ends),
        right_first: truth.kind == "one" && named.first().is_some_and(|id| *id == first),
        right_or_alternative: truth.kind == "one" && of_alternatives,
        both_and_one_other: truth.kind == "two"
            && named.len() <= 3
            && truth.ids.iter().all(|id| named.contains(&id.as_str())),
        region,
        truth,
        answer,
    }
}

/// A count out of a number.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub struct Share {
    /// Cases that meet it.
    pub met: usize,
    /// Cases.
    pub of: usize,
}

impl Share {
    /// Counts.
    pub fn count<'a>(scores: impl Iterator<Item = &'a Score>, met: impl Fn(&Score) -> bool) -> Self {
        scores.fold(Self::default(), |share, score| Self { met: share.met + usize::from(met(score)), of: share.of + 1 })
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let percent = if self.of == 0 { 0.0 } else { 100.0 * self.met as f64 / self.of as f64 };
        f.pad(&format!("{}/{} ({percent:.0} %)", self.met, self.of))
    }
}

/// Scores of a group of cases.
#[derive(Debug, Clone, Serialize)]
pub struct Summary {
    /// The strict criterion of each kind.
    pub strict: Share,
    /// The same, with `end-taper` forgiven on slices.
    pub strict_but_ends: Share,
    /// Nothing concealed, and called consistent.
    pub nothing: Share,
    /// One concealed: the right name first.
    pub one_right_first: Share,
    /// One concealed: the right name and no other.
    pub one_right_only: Share,
    /// One concealed: the right name or a declared alternative.
    pub one_or_alternative: Share,
    /// Two concealed: both and no other.
    pub both_only: Share,
    /// Two concealed: both and at most one other.
    pub both_and_one_other: Share,
    /// Nameless: no name, and not called consistent.
    pub nameless: Share,
    /// Regions that meet a known place.
    pub regions: Share,
    /// Refused.
    pub refused: Share,
    /// Error left over cases with a named effect concealed: median and 90th percentile.
    pub error_left: Option<(f64, f64)>,
}

/// Quantile of sorted numbers.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}

/// Error left, as a share of the base's.
pub fn error_left(score: &Score) -> f64 {
    if score.answer.refused.is_some() || !score.answer.augmented_n.is_finite() || !score.answer.base_n.is_finite() {
        f64::INFINITY
    } else {
        score.answer.augmented_n / score.answer.base_n.max(1e-9)
    }
}

/// Summarizes a group.
pub fn summarize(scores: &[&Score]) -> Summary {
    let kind = |kind: &'static str| scores.iter().copied().filter(move |score| score.truth.kind == kind);
    let mut left: Vec<f64> = kind("one").chain(kind("two")).map(error_left).collect();
    left.sort_by(f64::total_cmp);
    Summary {
        strict: Share::count(scores.iter().copied(), |score| score.strict),
        strict_but_ends: Share::count(scores.iter().copied(), |score| score.strict_but_ends),
        nothing: Share::count(kind("nothing"), |score| score.strict),
        one_right_first: Share::count(kind("one"), |score| score.right_first),
        one_right_only: Share::count(kind("one"), |score| score.strict),
        one_or_alternative: Share::count(kind("one"), |score| score.right_or_alternative),
        both_only: Share::count(kind("two"), |score| score.strict),
        both_and_one_other: Share::count(kind("two"), |score| score.both_and_one_other),
        nameless: Share::count(kind("nameless"), |score| score.strict),
        regions: Share::count(scores.iter().copied().filter(|score| score.region.is_some()), |score| {
            score.region == Some(true)
        }),
        refused: Share::count(scores.iter().copied(), |score| score.answer.refused.is_some()),
        error_left: (!left.is_empty()).then(|| (quantile(&left, 0.5), quantile(&left, 0.9))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(kind: &str, ids: &[&str], verdict: &str, named: &[&str]) -> Score {
        let truth = Concealed {
            kind: kind.to_owned(),
            ids: ids.iter().map(ToString::to_string).collect(),
            ..Concealed::default()
        };
        let named = named.iter().map(|id| (id.to_string(), vec!["slack".to_owned()])).collect();
        score(truth, Answer { verdict: verdict.to_owned(), named, ..Answer::default() })
    }

    #[test]
    fn strict_scores_forgive_no_other_name() {
        assert!(case("nothing", &[], "consistent", &[]).strict);
        assert!(!case("nothing", &[], "explained", &["inertia"]).strict);
        assert!(case("one", &["inertia"], "explained", &["inertia"]).strict);
        assert!(!case("one", &["inertia"], "explained", &["inertia", "stribeck"]).strict);
        assert!(case("one", &["slack"], "explained", &["inertia"]).right_or_alternative);
        assert!(case("two", &["a", "b"], "explained", &["b", "a"]).strict);
        assert!(case("two", &["a", "b"], "explained", &["b", "a", "c"]).both_and_one_other);
        assert!(case("nameless", &["nameless:x"], "unexplained", &[]).strict);
        assert!(!case("nameless", &["nameless:x"], "consistent", &[]).strict);
    }

    #[test]
    fn a_region_that_is_far_too_wide_does_not_count() {
        assert!(overlap((0.0, 10.0), (2.0, 12.0)));
        assert!(!overlap((0.0, 10.0), (0.0, 100.0)));
        assert!(!overlap((0.0, 10.0), (9.0, 12.0)));
    }
}
