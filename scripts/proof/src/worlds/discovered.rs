//! What a diagnosis discovers where no name fits: whether its driver and its memory are those of what was concealed.

use serde::Serialize;
use serde_json::Value;

use super::score::{Score, Share, error_left};

/// Driver and memory of a term without a name.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Discovered {
    /// As in its sentence.
    pub driver: String,
    /// As in its sentence, without its numbers.
    pub memory: String,
}

/// What was discovered over a number of cases.
#[derive(Debug, Clone, Serialize)]
pub struct Discoveries {
    /// Nothing concealed, and nothing discovered.
    pub nothing_where_nothing: Share,
    /// Nameless cases in which something was discovered.
    pub discovered: Share,
    /// Of these, those with the driver of what was concealed.
    pub driver: Share,
    /// And with its memory.
    pub memory: Share,
    /// Nameless cases whose held-out error is not above that of the base.
    pub no_harm: Share,
    /// Error left over nameless cases, over all samples: median and 90th percentile.
    pub error_left: Option<(f64, f64)>,
    /// The same over samples whose direction is settled, as the diagnosis has it.
    pub settled_left: Option<(f64, f64)>,
}

/// Drivers and memories that say what each nameless form does.
const EXPECTED: &[(&str, &[&str], &[&str])] = &[
    ("touching-object", &["contraction"], &["none"]),
    ("kinked-hose", &["pressure"], &["lag", "two-lags"]),
    ("bad-spot", &["force"], &["none"]),
    ("creeping-clamp", &["time"], &["none"]),
    ("eccentric-pulley", &["contraction"], &["none"]),
    ("stick-at-one-length", &["contraction"], &["none"]),
    ("encoder-slip", &["time"], &["none"]),
    ("room-swing", &["time"], &["none"]),
    ("loose-fitting", &["contraction"], &["play", "dahl"]),
    ("leak-while-holding", &["time-since-pressure-moved", "time-since-last-move"], &["none"]),
    ("second-muscle", &["contraction"], &["none"]),
    ("supply-sagging", &["pressure"], &["lag", "two-lags"]),
    ("dead-zone", &["pressure"], &["none"]),
    ("one-way-catch", &["contraction"], &["none"]),
    ("sleeve-wrinkle", &["contraction", "pressure"], &["none"]),
    ("bundle-jump", &["contraction"], &["play", "dahl"]),
    ("moist-air", &["time"], &["none"]),
    ("pump-strokes", &["time"], &["none"]),
    ("sticking-swivel", &["pressure"], &["play", "dahl"]),
    ("missed-pulses", &["contraction", "speed"], &["travelled", "largest"]),
];

impl Discovered {
    /// The first term of a diagnosis, if it has one.
    pub fn of(diagnosis: &Value) -> Option<Self> {
        let sentence = diagnosis["empirical"]["terms"].as_array()?.first()?;
        Some(Self { driver: word(&sentence["sentence"]["driver"])?, memory: word(&sentence["sentence"]["memory"])? })
    }

    /// Whether driver and memory are those of the nameless form `id`; none where that is not known.
    fn is_right(&self, id: &str) -> Option<[bool; 2]> {
        let form = id.strip_prefix("nameless:")?;
        let (_, drivers, memories) = EXPECTED.iter().find(|(known, ..)| *known == form)?;
        Some([drivers.contains(&self.driver.as_str()), memories.contains(&self.memory.as_str())])
    }
}

/// Name of a part of a sentence: a string, or the only key of what has numbers.
fn word(part: &Value) -> Option<String> {
    match part {
        Value::String(word) => Some(word.clone()),
        Value::Object(numbers) => numbers.keys().next().cloned(),
        _ => None,
    }
}

impl Discoveries {
    /// Over `scores`.
    pub fn of(scores: &[Score]) -> Self {
        let kind = |kind: &'static str| scores.iter().filter(move |score| score.truth.kind == kind);
        let right = |score: &Score, part: usize| {
            let id = score.truth.ids.first().map_or("", String::as_str);
            score.answer.discovered.as_ref().and_then(|found| found.is_right(id)).is_some_and(|right| right[part])
        };
        let found = || kind("nameless").filter(|score| score.answer.discovered.is_some());
        Self {
            nothing_where_nothing: Share::count(kind("nothing"), |score| score.answer.discovered.is_none()),
            discovered: Share::count(kind("nameless"), |score| score.answer.discovered.is_some()),
            driver: Share::count(found(), |score| right(score, 0)),
            memory: Share::count(found(), |score| right(score, 1)),
            no_harm: Share::count(kind("nameless"), |score| error_left(score) <= 1.0),
            error_left: spread(kind("nameless").map(error_left)),
            settled_left: spread(kind("nameless").filter_map(|score| score.answer.settled_left)),
        }
    }
}

/// Median and 90th percentile.
fn spread(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let at = |share: f64| sorted[((sorted.len() - 1) as f64 * share).round() as usize];
    (!sorted.is_empty()).then(|| (at(0.5), at(0.9)))
}

#[cfg(test)]
mod tests {
    use pam_worlds::catalogue::{Half, nameless};
    use serde_json::json;

    use super::*;

    #[test]
    fn every_nameless_form_has_a_driver_and_a_memory() {
        let forms: Vec<_> = [Half::Choose, Half::Report, Half::Sealed].into_iter().flat_map(nameless).collect();
        for form in &forms {
            assert!(EXPECTED.iter().any(|(known, ..)| *known == form.form), "{}", form.form);
        }
        assert_eq!(EXPECTED.len(), forms.len());
    }

    #[test]
    fn parts_of_a_sentence_are_compared_without_their_numbers() {
        let sentence = json!({"driver": "pressure", "memory": {"lag": {"time_constant_s": 0.2}}});
        let found = Discovered::of(&json!({"empirical": {"terms": [{"sentence": sentence}]}})).expect("a term");
        assert_eq!(found.is_right("nameless:kinked-hose"), Some([true, true]));
        assert_eq!(found.is_right("nameless:dead-zone"), Some([true, false]));
        assert_eq!(found.is_right("inertia"), None);
        assert_eq!(Discovered::of(&json!({"effects": []})), None);
    }
}
