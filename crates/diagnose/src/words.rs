//! The diagnosis in words.

use pam_artifact::diagnosis::{NamedEffect, Region, Verdict};
use pam_muscle::Coordinate;
use pam_muscle::effects::effect;

use crate::artifact::together;
use crate::given::Given;
use crate::nameless::Other;

/// The numbers that a statement gives: RMSE over counted samples at the rate of the recordings, in N, as in the tables and in the
/// report.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Numbers {
    /// Base model, refitted: the mismatch.
    pub(crate) before_n: f64,
    /// Base model and effects.
    pub(crate) after_n: f64,
    /// What noise leaves of a perfect model.
    pub(crate) floor_n: f64,
    /// Excess over the noise floor that would matter.
    pub(crate) matters_n: f64,
    /// What a smooth static map takes of the mismatch, where eq. 11 accounts for less in any muscle.
    pub(crate) static_n: Option<f64>,
    /// What the base model leaves of held-out recordings.
    pub(crate) held_n: Option<f64>,
    /// Whether a smooth static map stands beside the effects.
    pub(crate) with_map: bool,
    /// Empirical terms beside the effects.
    pub(crate) n_terms: usize,
}

impl Numbers {
    /// Share of the excess over the noise floor (mean squares) that is left; none where there is no excess.
    pub(crate) fn share_left(&self) -> f64 {
        let excess = |rmse_n: f64| rmse_n * rmse_n - self.floor_n * self.floor_n;
        let before = excess(self.before_n);
        if before > 0.0 { (excess(self.after_n) / before).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// The share that no effect explains: an empirical term describes, and explains nothing.
    pub(crate) fn share_unexplained(&self, effects: &[NamedEffect]) -> f64 {
        let alone = Self { after_n: self.before_n, ..*self };
        if effects.is_empty() { alone.share_left() } else { self.share_left() }
    }

    /// What the model with `effects` leaves of the mismatch.
    fn gain(&self, effects: &[NamedEffect]) -> String {
        let term = if self.n_terms == 1 { "an empirical term" } else { "empirical terms" };
        let map = match (self.with_map, self.n_terms) {
            (false, 0) => String::new(),
            (true, 0) => " and a smooth static map".to_owned(),
            (false, _) => format!(" and {term}"),
            (true, _) => format!(", a smooth static map and {term}"),
        };
        let goes_on = |named: &NamedEffect| {
            let keeps = effect(&named.id).map_or(&[][..], |effect| effect.keeps());
            keeps.iter().any(|kept| named.parameters.iter().any(|parameter| parameter.name == kept.name))
        };
        let on = if effects.iter().any(goes_on) { ", going on from one recording to the next as given," } else { "" };
        if self.after_n > self.before_n {
            // A fit lets such a memory go on from recording to recording.
            let outlasts = |named: &NamedEffect| effect(&named.id).is_some_and(|effect| effect.outlasts());
            let why = if effects.iter().any(outlasts) {
                ", since a model begins every recording without a memory of the one before"
            } else {
                ""
            };
            return format!(
                "with that{map}{on} the RMSE rises from {:.2} to {:.2} N{why}",
                self.before_n, self.after_n
            );
        }
        format!(
            "with that{map}{on} the RMSE falls from {:.2} to {:.2} N, {:.0} % of the excess over the noise floor of {:.2} N",
            self.before_n,
            self.after_n,
            100.0 * (1.0 - self.share_left()),
            self.floor_n
        )
    }
}

/// The verdict in one sentence.
pub(crate) fn statement(
    verdict: Verdict,
    effects: &[NamedEffect],
    numbers: &Numbers,
    regions: &[Region],
    unexplained: &[Region],
) -> String {
    let names: Vec<&str> = effects.iter().map(|effect| effect.name.as_str()).collect();
    match verdict {
        Verdict::Consistent => {
            let matters_n = numbers.matters_n;
            let left_much = numbers.before_n > numbers.floor_n.hypot(matters_n);
            let because = match numbers.held_n {
                _ if left_much && numbers.with_map && numbers.after_n < numbers.before_n => {
                    format!(
                        "; a smooth static map, which the form of eq. 11 leaves of any muscle, lowers that to {:.2} N",
                        numbers.after_n
                    )
                }
                Some(held_n) if left_much => format!(", and {held_n:.2} N of held-out recordings"),
                _ => format!(", and {matters_n:.2} N beyond that would matter"),
            };
            format!(
                "Nothing is missing that matters: refitted, the model leaves an RMSE of {:.2} N, where noise leaves {:.2} N{because}.",
                numbers.before_n, numbers.floor_n
            )
        }
        Verdict::Explained | Verdict::ExplainedInPart => format!(
            "Missing physics: {}; {}. The mismatch lies {}.",
            list(&names),
            numbers.gain(effects),
            regions.first().map_or_else(|| "nowhere in particular".to_owned(), place)
        ),
        Verdict::Ambiguous => {
            let others: Vec<String> = effects
                .iter()
                .filter(|effect| !effect.alternatives.is_empty())
                .map(|effect| format!("{} or {}", effect.id, effect.alternatives.join(" or ")))
                .collect();
            format!(
                "Missing physics: {}, but these recordings cannot distinguish {}; {}.",
                list(&names),
                others.join(", nor "),
                numbers.gain(effects)
            )
        }
        Verdict::Unexplained => {
            let smooth = |static_n: f64| format!("in a smooth function of pressure and length, of {static_n:.2} N");
            let anywhere = || numbers.static_n.map_or_else(|| "nowhere in particular".to_owned(), smooth);
            let place = unexplained.first().map_or_else(anywhere, place);
            if names.is_empty() {
                // What was held out is why, where the fitted recordings are followed better.
                let held = numbers.held_n.filter(|held_n| *held_n > numbers.before_n);
                let held =
                    held.map_or_else(String::new, |held_n| format!(", and {held_n:.2} N of held-out recordings"));
                format!(
                    "Unmodelled structure: refitted, the model leaves an RMSE of {:.2} N{held}, where noise leaves {:.2} N, and no \
                     effect of the catalogue explains it; it lies {place}.",
                    numbers.before_n, numbers.floor_n
                )
            } else {
                format!(
                    "Missing physics: {}; {}. Unmodelled structure is left {place}.",
                    list(&names),
                    numbers.gain(effects)
                )
            }
        }
    }
}

/// The name of the effect `id`; of a user's own, the id.
fn name(id: &str) -> String {
    effect(id).map_or_else(|| id.to_owned(), |effect| effect.page().name.to_owned())
}

/// What may be there in the place of the names that it was taken for, and what tells; nothing where there is none.
pub(crate) fn as_well(others: &[(&str, &Other)]) -> String {
    let words = |(id, other): &(&str, &Other)| {
        format!(" What looks like {} may as well be {}: {}.", name(id), other.name, other.told_by)
    };
    others.iter().map(words).collect()
}

/// What `nameless`, forces that explain more than the names that they were taken for, act like; nothing where there are none.
pub(crate) fn nameless(nameless: &[(&str, &str)]) -> String {
    let words = nameless.iter().map(|(id, force)| format!(" What looks like {} acts more like {force}.", name(id)));
    words.collect()
}

/// What a smooth static map alone models, by what is left without it and with it of what was `held` out, or where nothing was of what
/// was `fitted`, in N; nothing where that is no less.
pub(crate) fn of_map(held: Option<(f64, f64)>, fitted: (f64, f64)) -> String {
    let ((without_n, with_n), on) = match held {
        Some(held) => (held, "held-out recordings"),
        None => (fitted, "the fitted recordings"),
    };
    if with_n >= without_n {
        return String::new();
    }
    format!(
        " A smooth static map, which names nothing, models a part of it: it lowers the RMSE on {on} from {without_n:.2} to {with_n:.2} N."
    )
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_that_rises_is_not_said_to_fall_and_one_of_hold_outs_that_is_larger_is_said() {
        let numbers = |after_n| Numbers {
            before_n: 2.0,
            after_n,
            floor_n: 1.0,
            matters_n: 1.0,
            static_n: None,
            held_n: None,
            with_map: false,
            n_terms: 0,
        };
        assert!(numbers(1.5).gain(&[]).starts_with("with that the RMSE falls from 2.00 to 1.50 N, 58 % of the excess"));
        assert_eq!(numbers(2.5).gain(&[]), "with that the RMSE rises from 2.00 to 2.50 N");
        let unexplained = |held_n| statement(Verdict::Unexplained, &[], &Numbers { held_n, ..numbers(2.0) }, &[], &[]);
        assert!(unexplained(Some(5.0)).contains("an RMSE of 2.00 N, and 5.00 N of held-out recordings, where noise"));
        assert_eq!(unexplained(Some(1.9)), unexplained(None));
        let beside = Numbers { with_map: true, n_terms: 2, ..numbers(1.5) };
        assert!(beside.gain(&[]).starts_with("with that, a smooth static map and empirical terms the RMSE falls"));
        assert_eq!(beside.share_unexplained(&[]), 1.0);
    }

    #[test]
    fn a_force_without_a_name_is_said_beside_the_name_that_it_was_taken_for() {
        let words =
            nameless(&[("fatigue-wear", "a clamp that creeps under the load"), ("of-my-own", "a hose that kinks")]);
        assert_eq!(
            words,
            " What looks like fatigue and wear acts more like a clamp that creeps under the load. What looks like of-my-own acts more \
             like a hose that kinks."
        );
        assert_eq!(nameless(&[]), "");
        assert_eq!(
            as_well(&[("presliding-hysteresis", &crate::nameless::RIG)]),
            " What looks like pre-sliding hysteresis of the braid may as well be a rig that gives or has play: a rod in the place of the \
             muscle shows it as well if it is the rig."
        );
        assert_eq!(as_well(&[]), "");
    }

    #[test]
    fn a_map_is_said_to_model_a_part_where_it_lowers_the_error_of_what_was_held_out_or_else_of_what_was_fitted() {
        assert!(of_map(Some((3.0, 1.5)), (2.0, 1.0)).ends_with("the RMSE on held-out recordings from 3.00 to 1.50 N."));
        assert!(of_map(None, (2.0, 1.0)).ends_with("the RMSE on the fitted recordings from 2.00 to 1.00 N."));
        assert_eq!(of_map(Some((3.0, 3.1)), (2.0, 1.0)), "");
    }
}
