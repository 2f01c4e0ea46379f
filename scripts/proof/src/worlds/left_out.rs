//! Leave one out: an effect is concealed and taken out of the catalogue, so that only a term without a name can model it.

use pam_muscle::effects::effect;
use serde::Serialize;

use super::ceiling::median;
use super::discovered::Discovered;
use super::score::{Score, Share};

/// What is said of a case without its effect in the catalogue.
#[derive(Debug, Clone, Serialize)]
pub struct LeftOut {
    /// Verdict.
    pub verdict: String,
    /// Names; each is wrong.
    pub named: Vec<String>,
    /// The term without a name.
    pub discovered: Option<Discovered>,
    /// Error of the augmented model over all samples of the hold-outs, N.
    pub error_n: f64,
}

/// What was said over a number of cases, each without its effect.
#[derive(Debug, Clone, Serialize)]
pub struct Without {
    /// No wrong name, and not `consistent`.
    pub no_name: Share,
    /// Cases whose error is at most 1.5 times that with the name.
    pub as_good: Share,
    /// Error over that with the name, median.
    pub over_named: Option<f64>,
    /// A term was discovered.
    pub discovered: Share,
    /// Of these, those with a driver of the effect.
    pub driver: Share,
}

impl Without {
    /// Over `scores` whose effect has its name when it is in the catalogue; none where nothing was left out.
    pub fn of(scores: &[Score]) -> Option<Self> {
        let cases: Vec<(&Score, &LeftOut)> = scores
            .iter()
            .filter(|score| score.strict)
            .filter_map(|score| Some((score, score.answer.left_out.as_ref()?)))
            .collect();
        let over_named = |(score, without): &(&Score, &LeftOut)| without.error_n / score.answer.augmented_n;
        let share = |met: &dyn Fn(&(&Score, &LeftOut)) -> bool, of: &dyn Fn(&(&Score, &LeftOut)) -> bool| Share {
            met: cases.iter().filter(|case| of(case) && met(case)).count(),
            of: cases.iter().filter(|case| of(case)).count(),
        };
        let is_found = |(_, without): &(&Score, &LeftOut)| without.discovered.is_some();
        let has_driver = |(score, without): &(&Score, &LeftOut)| {
            let id = score.truth.ids.first().map_or("", String::as_str);
            let drivers = effect(id).map_or(&[][..], |effect| effect.page().drivers);
            without.discovered.as_ref().is_some_and(|found| drivers.contains(&found.driver.as_str()))
        };
        (!cases.is_empty()).then(|| Self {
            no_name: share(&|(_, without)| without.named.is_empty() && without.verdict != "consistent", &|_| true),
            as_good: share(&|case| over_named(case) <= 1.5, &|_| true),
            over_named: median(cases.iter().map(over_named)),
            discovered: share(&is_found, &|_| true),
            driver: share(&has_driver, &is_found),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::score::{Answer, Concealed, score};
    use super::*;

    #[test]
    fn only_effects_that_are_found_by_name_are_compared() {
        let case = |named: &str, driver: &str| {
            let truth = Concealed { kind: "one".to_owned(), ids: vec!["inertia".to_owned()], ..Concealed::default() };
            let left_out = LeftOut {
                verdict: "unexplained".to_owned(),
                named: Vec::new(),
                discovered: Some(Discovered { driver: driver.to_owned(), memory: "lag".to_owned() }),
                error_n: 1.2,
            };
            let named = vec![(named.to_owned(), Vec::new())];
            score(truth, Answer { named, augmented_n: 1.0, left_out: Some(left_out), ..Answer::default() })
        };
        let without = Without::of(&[case("inertia", "speed"), case("inertia", "time"), case("slack", "speed")]);
        let without = without.expect("two were found by name");
        assert_eq!((without.driver.met, without.driver.of, without.as_good.met), (1, 2, 2));
    }
}
