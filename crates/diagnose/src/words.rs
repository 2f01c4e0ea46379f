//! The diagnosis in words.

use pam_core::artifact::diagnosis::{Coordinate, NamedEffect, Region, Verdict};

use crate::artifact::together;
use crate::given::Given;
use crate::verdict::Sizes;

/// The verdict in one sentence.
pub(crate) fn statement(
    verdict: Verdict,
    effects: &[NamedEffect],
    sizes: &Sizes,
    regions: &[Region],
    unexplained: &[Region],
) -> String {
    let names: Vec<&str> = effects.iter().map(|effect| effect.name.as_str()).collect();
    match verdict {
        Verdict::Consistent => format!(
            "Nothing is missing that matters: beyond what noise leaves ({:.2} N) the model is off by {:.2} N, and {:.2} N would \
             matter.",
            sizes.floor_n, sizes.mismatch_n, sizes.matters_n
        ),
        Verdict::Explained | Verdict::ExplainedInPart => format!(
            "The model lacks {}: that explains {:.0} % of a mismatch of {:.2} N, which lies {}.",
            list(&names),
            100.0 * (1.0 - sizes.share_left()),
            sizes.mismatch_n,
            regions.first().map_or_else(|| "nowhere in particular".to_owned(), place)
        ),
        Verdict::Ambiguous => {
            let others: Vec<String> = effects
                .iter()
                .filter(|effect| !effect.alternatives.is_empty())
                .map(|effect| format!("{} or {}", effect.id, effect.alternatives.join(" or ")))
                .collect();
            format!(
                "The model lacks {}, but these recordings cannot tell {}; a mismatch of {:.2} N is explained either way.",
                list(&names),
                others.join(", nor "),
                sizes.mismatch_n
            )
        }
        Verdict::Unexplained => {
            let place = unexplained.first().map_or_else(|| "nowhere in particular".to_owned(), place);
            if names.is_empty() {
                format!("Something is missing that has no name here: a mismatch of {:.2} N, {place}.", sizes.mismatch_n)
            } else {
                format!(
                    "The model lacks {}, and something more that has no name here: {:.2} N of {:.2} N are left, {place}.",
                    list(&names),
                    sizes.left_n,
                    sizes.mismatch_n
                )
            }
        }
    }
}

/// `statement` after what is to be said first: that the model as given misses the recordings, or the diagnosed one what was held
/// out. Where an instrument would explain what the given model misses as well as what was named does, both are said.
pub(crate) fn with_given(given: &Given, statement: &str) -> String {
    let mut words = String::new();
    let before_n = together(&given.estimation).rmse_n;
    if given.misses {
        let shifted = given.shifted().map_or(String::new(), |shifted| format!(" ({shifted})"));
        let reason = match &given.instrument {
            Some(instrument) => format!("{instrument}, or these recordings are of another muscle"),
            None => "these recordings are of another muscle, or an instrument reads otherwise".to_owned(),
        };
        let refitted_n = given.refitted.rmse_n;
        words.push_str(&format!(
            "The model as given misses the recordings by {before_n:.2} N, refitted by {refitted_n:.2} N{shifted}: {reason}. "
        ));
    } else if let Some(instrument) = &given.instrument {
        words.push_str(&format!(
            "The model as given misses the recordings by {before_n:.2} N, and an instrument alone would explain it: \
             {instrument}. "
        ));
    }
    for missed in &given.holdout_missed {
        words.push_str(&format!("Held out, {missed}. "));
    }
    if words.is_empty() {
        return statement.to_owned();
    }
    format!("{words}Beside that: {statement}")
}

fn list(names: &[&str]) -> String {
    match names {
        [] => "nothing".to_owned(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// A region in words, in the units that people use.
pub fn place(region: &Region) -> String {
    let (scale, unit, words) = match region.coordinate {
        Coordinate::Time => (1.0, "s", "in time, from"),
        Coordinate::Pressure => (1e-3, "kPa", "in pressure, from"),
        Coordinate::Contraction => (1e2, "%", "in contraction, from"),
        Coordinate::Speed => (1e3, "mm/s", "in speed, from"),
        Coordinate::TravelSinceReversal => (1e3, "mm", "in travel since the last reversal, from"),
        Coordinate::TimeSinceLastMove => (1.0, "s", "in time since the last move, from"),
        Coordinate::Cycle => (1.0, "", "in cycles, from"),
        Coordinate::Force => (1.0, "N", "in force, from"),
    };
    let (from, to) = (region.from * scale, region.to * scale);
    format!("{words} {} to {} {unit}", rounded(from, to - from), rounded(to, to - from)).trim_end().to_owned()
}

/// An end of an interval that is `span` wide: two digits of the span, and of a small end that is not nothing beside it.
fn rounded(value: f64, span: f64) -> String {
    let smaller = if value.abs() > 1e-2 * span { value.abs().min(span) } else { span };
    let decimals = (1.0 - smaller.max(1e-9).log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
