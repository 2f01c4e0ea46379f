//! Cases that missed, one line each: the truth, and what was said of it.

use pam_artifact::diagnosis::Verdict;

use crate::case::Kind;
use crate::score::{Outcome, Score, Spot};

/// Whether a case missed anything that is asked of its kind.
pub fn is_miss(score: &Score) -> bool {
    let named = match score.case.kind {
        Kind::Single => score.first_is_right() && score.coordinate_is_right() != Some(false),
        Kind::Nothing => score.verdict() == Some(Verdict::Consistent),
        Kind::Pair => score.n_named() == 2,
        Kind::Triple => score.n_named() >= 2,
        Kind::Nameless => score.is_rightly_unexplained() && score.nameless_place_is_right(),
    };
    !named || matches!(score.outcome, Outcome::Failed(_))
}

/// The header and a row for every miss.
pub fn rows(scores: &[Score]) -> Vec<[String; 8]> {
    scores.iter().filter(|score| is_miss(score)).map(row).collect()
}

/// Titles of [`rows`].
pub const TITLES: [&str; 8] =
    ["case", "set, noise", "concealed (severity, over floor)", "verdict", "named (or)", "left", "where", "held out"];

fn row(score: &Score) -> [String; 8] {
    let case = &score.case;
    let concealed: Vec<String> = case
        .concealed
        .iter()
        .map(|effect| format!("{} ({:.2}, {:.1})", effect.id, effect.severity, effect.over_floor))
        .collect();
    let (verdict, named, left, place) = match &score.outcome {
        Outcome::Failed(said) => (format!("failed: {said}"), String::new(), String::new(), String::new()),
        Outcome::Diagnosed(diagnosed) => {
            let named = diagnosed.named.iter().map(|named| {
                if named.alternatives.is_empty() {
                    named.id.clone()
                } else {
                    format!("{} ({})", named.id, named.alternatives.join(", "))
                }
            });
            let spots =
                [&diagnosed.top, &diagnosed.unexplained_top].map(|spot| spot.as_ref().map_or("–".to_owned(), spell));
            (
                verdict_name(diagnosed.verdict),
                named.collect::<Vec<_>>().join("; "),
                format!("{:.0} %", 100.0 * diagnosed.unexplained_share),
                spots.join("; left: "),
            )
        }
    };
    let place = match case.concealed.iter().find_map(|effect| effect.place.as_ref()) {
        Some(truth) if case.kind == Kind::Nameless => {
            format!("{place}; true: {} {:.3} to {:.3}", truth.coordinate, truth.from, truth.to)
        }
        _ => place,
    };
    [
        case.name.clone(),
        format!("{}, {}", case.set, if case.noise.colored { "colored" } else { "white" }),
        if concealed.is_empty() { case.kind.name().to_owned() } else { concealed.join("; ") },
        verdict,
        named,
        left,
        place,
        score.heldout.map_or(String::new(), |heldout| format!("{:.2} → {:.2} N", heldout.base_n, heldout.diagnosed_n)),
    ]
}

fn spell(spot: &Spot) -> String {
    format!("{} {:.3} to {:.3} ({:.0} %)", spot.coordinate.name(), spot.from, spot.to, 100.0 * spot.share)
}

/// The verdict as artifacts write it.
fn verdict_name(verdict: Verdict) -> String {
    serde_json::to_value(verdict).ok().and_then(|name| Some(name.as_str()?.to_owned())).unwrap_or_default()
}
