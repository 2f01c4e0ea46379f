//! The search for terms: one after the other, as long as each gains where it was not fitted.

use pam_artifact::diagnosis::Verdict;
use pam_muscle::effects::{AugmentedModel, Sentence, Term};
use pam_muscle::force::ForceModel;

use super::bends::{PREFERRED, bends};
use super::field::Field;
use super::screen::{self, Said};
use super::{joined, stability};
use crate::borne_out::bears_out;
use crate::carried::OF_THE_FIT;
use crate::held_error::Left;
use crate::joint::HeldOut;
use crate::nuisance::{Group, Nuisance};
use crate::search::{Found, Judged, again, chance, fitting};
use crate::state::Setting;
use crate::track::Track;
use crate::verdict::Sizes;

/// Terms that may be written.
const MOST_TERMS: usize = 3;
/// Sentences that are fitted jointly before the best of them is taken.
const FITTED: usize = 3;
/// The best of so many drivers and memories are fitted as well, whichever scale they have.
const WORDS_FITTED: usize = 4;
/// Share of the evidence of the best at which another one is not told from it by blocks.
const CLOSE: f64 = 0.85;
/// Evidence over held-out blocks that a term needs.
const LEAST_LOG_RATIO: f64 = 3.0;
/// Share of the mean square over held-out blocks that it must take away.
const LEAST_SHARE: f64 = 0.05;
/// Sentences that are looked at, about, where chance is asked for.
pub(super) const LOOKS: f64 = 500.0;
/// Chance that is no longer believed in, where no recording was held out to ask.
const CHANCE: f64 = 0.05;
/// Share of the mean square over held-out blocks that a static map must take up beside terms to be kept.
const WORTH_A_MAP: f64 = 0.02;
/// Times the sensors' noise that an explained mismatch may leave, root mean square, before more is looked for.
const LEAVES_ENOUGH: f64 = 1.5;

/// Share of what a static map takes up, root mean square, that a static term, the same in both directions, must take up beside it to be
/// more than what such a map leaves of the form that eq. 11 has of no muscle. Of eight looked-at terms that stood so where nothing had to be
/// missing three were of healthy muscles and took up 0.05 to 0.08; the others took up 0.19 and more.
/// With half of it none of the three would be consistent, with double one that something touches would be.
const OF_THE_FORM: f64 = 0.1;

/// Terms without a name, fitted jointly with everything else.
#[derive(Debug)]
pub(crate) struct Discovery {
    /// Base and effects beside [`nuisance`](Self::nuisance).
    pub(crate) best: Judged,
    /// What is in beside them, the curves of the terms included.
    pub(crate) nuisance: Nuisance,
    pub(super) terms: Vec<Written>,
    /// Base, effects and map as they would be without the terms.
    pub(crate) without_terms: AugmentedModel,
    pub(super) before: HeldOut,
}

/// A term that is written.
#[derive(Debug, Clone)]
pub(super) struct Written {
    pub(super) sentence: Sentence,
    /// The named effect whose form it bends, if it does.
    pub(super) bends: Option<&'static str>,
    pub(super) without: HeldOut,
    pub(super) with: HeldOut,
    /// What else was in question, with how often draws of blocks choose it, this one first.
    pub(super) chosen: Vec<(Said, f64)>,
}

impl Written {
    /// Whether it is what the static map of `found` leaves of the form of eq. 11.
    fn is_of_the_form(&self, found: &Found) -> bool {
        let taken_up = |without: &HeldOut, with: &HeldOut| without.mean_square() - with.mean_square();
        let of_the_map = taken_up(&found.base.held_out, &found.whole.held_out);
        self.sentence.is_static()
            && !self.sentence.scale.has_direction()
            && taken_up(&self.without, &self.with) < OF_THE_FORM.powi(2) * of_the_map
    }
}

/// Base and effects with terms, and what is in beside them.
#[derive(Clone)]
struct Step {
    best: Judged,
    nuisance: Nuisance,
    terms: Vec<Written>,
}

impl Step {
    fn sentences(&self) -> Vec<Sentence> {
        self.terms.iter().map(|written| written.sentence.clone()).collect()
    }

    /// As a model carries it.
    fn model(&self, found: &Found, track: &Track) -> AugmentedModel {
        let state = &self.best.state;
        let mut terms = state.terms();
        terms.extend(self.nuisance.carried(&state.fit.nuisances, track, &found.coordinates));
        terms.extend(joined::terms(&self.sentences(), &self.nuisance, state));
        AugmentedModel::new(state.model.clone(), terms)
    }
}

/// A step with one more term that may be taken.
struct Candidate {
    step: Step,
    /// Evidence over held-out blocks, less what its degrees of freedom have to bring.
    log_ratio: f64,
    /// Whether the term bends what was named.
    bends: bool,
}

impl Candidate {
    /// Whether blocks hardly prefer `first` to it.
    fn is_as_good_as(&self, first: &Self) -> bool {
        self.bends == first.bends && self.log_ratio >= CLOSE * first.log_ratio
    }
}

/// Recordings that nothing was fitted to, and the model as it was given, which anything written must follow them better than.
#[derive(Clone, Copy)]
pub(crate) struct HeldAgainst<'a> {
    /// What a model leaves of them.
    pub(crate) left: &'a dyn Fn(&AugmentedModel) -> Left,
    /// The model as it was given.
    pub(crate) given: &'a ForceModel,
}

/// Looks for terms on what `found` leaves of `setting`, if `verdict` says that something is left; none where nothing gains on
/// `held`, or where there is nothing held out on the blocks.
pub(crate) fn discover(
    setting: &Setting<'_>,
    found: &Found,
    sizes: &Sizes,
    verdict: Verdict,
    held: Option<HeldAgainst<'_>>,
) -> Option<Discovery> {
    let left_over = match verdict {
        Verdict::Unexplained => true,
        Verdict::Explained | Verdict::Ambiguous => sizes.best_n > LEAVES_ENOUGH * sizes.sensors_n,
        Verdict::Consistent => held.is_some(),
        Verdict::ExplainedInPart => false,
    };
    if !left_over {
        return None;
    }
    let start = Step { best: found.best.clone(), nuisance: found.nuisance.clone(), terms: Vec::new() };
    let without_terms = start.model(found, setting.track);
    let (plain, mapped) = nuisances(setting, found)?;
    let left = |step: &Step| held.map(|held| (held.left)(&step.model(found, setting.track)));
    let mut last = held.map(|held| held.least(&without_terms, found));
    let mut smooth =
        Step { best: again(&setting.beside(&mapped), &found.best)?, nuisance: mapped.clone(), terms: Vec::new() };
    let mut kept: Option<Step> = None;
    while smooth.terms.len() < MOST_TERMS {
        let confirmed = |Candidate { step: next, .. }: Candidate| {
            let now_kept = without_map(setting, &plain, &next)?;
            let now = left(&now_kept);
            let written = &next.terms[next.terms.len() - 1];
            let is_no_chance = || chance(&written.without, &written.with) * LOOKS < CHANCE;
            let is_confirmed = match (&last, &now) {
                // Where nothing has to be missing, blocks and hold-outs have to agree, and a term is asked for what a name is.
                (Some(last), Some(now)) => {
                    last.is_surely_bettered_by(now)
                        && (verdict != Verdict::Consistent
                            || is_no_chance() && bears_out(last, now, sizes.sensors_n.powi(2)))
                }
                _ => is_no_chance(),
            };
            is_confirmed.then_some((next, now, now_kept))
        };
        let mut candidates = next_terms(setting, &mapped, &smooth);
        // What blocks hardly tell apart, hold-outs do.
        let close = candidates.iter().take_while(|candidate| candidate.is_as_good_as(&candidates[0])).count();
        let rest = candidates.split_off(if held.is_some() { close } else { close.min(1) });
        let left_n = |now: &Option<Left>| now.as_ref().map_or(0.0, Left::together_n);
        let best = candidates.into_iter().filter_map(confirmed);
        let best = best.min_by(|one, other| left_n(&one.1).total_cmp(&left_n(&other.1)));
        let next = best.or_else(|| rest.into_iter().find_map(confirmed));
        let Some((next, now, now_kept)) = next else { break };
        if verdict == Verdict::Consistent && next.terms.last().is_some_and(|term| term.is_of_the_form(found)) {
            break;
        }
        (smooth, last, kept) = (next, now, Some(now_kept));
    }
    let kept = kept?;
    let Step { best, nuisance, terms } = match held {
        Some(held) => foretells_most(setting, found, &[&plain, &mapped], kept, held),
        None => kept,
    };
    Some(Discovery { best, nuisance, terms, without_terms, before: found.best.held_out.clone() })
}

impl HeldAgainst<'_> {
    /// What the model as given leaves of them.
    pub(crate) fn left_as_given(&self) -> Left {
        (self.left)(&AugmentedModel::new(self.given.clone(), Vec::new()))
    }

    /// What is left by the best of `model`, the base of `found` refitted and the model as given: a map, or a base refitted, that
    /// carries held-out recordings away makes no gain of a term that brings them back.
    fn least(&self, model: &AugmentedModel, found: &Found) -> Left {
        let bare = [&found.base.state.model, self.given].map(|base| AugmentedModel::new(base.clone(), Vec::new()));
        let left = std::iter::once(model).chain(&bare).map(|model| (self.left)(model));
        left.min_by(|one, other| one.together_n().total_cmp(&other.together_n())).unwrap_or_else(Left::endless)
    }
}

/// `step` as it foretells `held` best: beside one of `beside`, or what a model carries of it.
fn foretells_most(
    setting: &Setting<'_>,
    found: &Found,
    beside: &[&Nuisance],
    step: Step,
    held: HeldAgainst<'_>,
) -> Step {
    let left_n = |step: &Step| (held.left)(&step.model(found, setting.track)).together_n();
    let others = beside.iter().flat_map(|&nuisance| [nuisance.clone(), nuisance.without(&OF_THE_FIT)]);
    let others = others.filter_map(|bare| {
        let (best, nuisance) = joined::joined(setting, &bare, &step.best, &step.sentences())?;
        Some(Step { best, nuisance, terms: step.terms.clone() })
    });
    let others: Vec<(f64, Step)> = others.map(|other| (left_n(&other), other)).collect();
    let as_it_is = (left_n(&step), step.clone());
    let all = std::iter::once(as_it_is).chain(others);
    all.min_by(|one, other| one.0.total_cmp(&other.0)).map_or(step, |(_, least)| least)
}

/// What is in beside sentences: nuisances without a static map, and with one that is as smooth as foretells held-out blocks best,
/// so that nothing smooth and static is taken for a term.
fn nuisances(setting: &Setting<'_>, found: &Found) -> Option<(Nuisance, Nuisance)> {
    let plain = found.nuisance.without(&[Group::EvenMap, Group::OddMap]);
    let mapped = plain.with_map(setting.track, &found.coordinates);
    let (_, mapped) = fitting(&setting.beside(&plain), &found.best, &mapped)?;
    Some((plain, mapped))
}

/// `step` without the static map where that gains nothing on held-out blocks.
fn without_map(setting: &Setting<'_>, plain: &Nuisance, step: &Step) -> Option<Step> {
    let (bare, nuisance) = joined::joined(setting, plain, &step.best, &step.sentences())?;
    let keeps = step.best.held_out.mean_square() < (1.0 - WORTH_A_MAP) * bare.held_out.mean_square();
    Some(if keeps { step.clone() } else { Step { best: bare, nuisance, terms: step.terms.clone() } })
}

/// `step` with one more term that gains on held-out blocks, the one that gains most first; `mapped` is what is in beside terms.
fn next_terms(setting: &Setting<'_>, mapped: &Nuisance, step: &Step) -> Vec<Candidate> {
    let best = &step.best;
    let beside = setting.beside(&step.nuisance);
    let Some(field) = Field::of(&beside, &best.state) else { return Vec::new() };
    let said = screen::screen(&field, &beside, &best.state);
    let bent = |said: &Said| bends(&said.sentence, &best.state.guesses);
    // The first that bends what was named is looked at wherever it stands.
    let first_bent = said.iter().position(|said| bent(said).is_some()).filter(|index| *index >= FITTED);
    let mut looked_at: Vec<usize> = (0..said.len().min(FITTED)).chain(first_bent).collect();
    let firsts = (0..said.len()).filter(|&index| !said[..index].iter().any(|before| before.has_words_of(&said[index])));
    looked_at.extend(firsts.take(WORDS_FITTED).filter(|index| !looked_at.contains(index)).collect::<Vec<_>>());
    let fitted = looked_at.into_iter().filter_map(|index| {
        let said = &said[index];
        let sentences = [step.sentences(), vec![said.sentence.clone()]].concat();
        let (next, nuisance) = joined::joined(setting, mapped, best, &sentences)?;
        if !joined::is_within(setting, &sentences, &nuisance, &next.state) {
            return None;
        }
        Some((best.held_out.log_ratio(&next.held_out) - said.charge(), index, next, nuisance))
    });
    let mut fitted: Vec<(f64, usize, Judged, Nuisance)> = fitted.collect();
    // Another form of what was named comes before anything else that is there.
    let most = fitted.iter().map(|fitted| fitted.0).fold(f64::NEG_INFINITY, f64::max);
    let is_bent =
        |fitted: &(f64, usize, Judged, Nuisance)| bent(&said[fitted.1]).is_some() && fitted.0 > PREFERRED * most;
    fitted.sort_by(|left, right| is_bent(right).cmp(&is_bent(left)).then(right.0.total_cmp(&left.0)));
    let gains = |fitted: &(f64, usize, Judged, Nuisance)| {
        let gained = best.held_out.mean_square() - fitted.2.held_out.mean_square();
        fitted.0 >= LEAST_LOG_RATIO && gained >= LEAST_SHARE * best.held_out.mean_square()
    };
    fitted.retain(gains);
    if fitted.is_empty() {
        return Vec::new();
    }
    let shares = stability::chosen(&field, &said);
    fitted.retain(|fitted| bent(&said[fitted.1]).is_some() || stability::is_steady(&said, &shares, fitted.1));
    let with = |(log_ratio, index, next, nuisance): (f64, usize, Judged, Nuisance)| {
        let mut chosen: Vec<(Said, f64)> = said.iter().cloned().zip(shares.iter().copied()).collect();
        let own = chosen.remove(index);
        chosen.sort_by(|left, right| right.1.total_cmp(&left.1));
        let sentence = own.0.sentence.clone();
        chosen.insert(0, own);
        let (without, with) = (best.held_out.clone(), next.held_out.clone());
        let mut terms = step.terms.clone();
        let bends = bends(&sentence, &best.state.guesses);
        terms.push(Written { sentence, bends, without, with, chosen });
        Candidate { log_ratio, bends: bends.is_some(), step: Step { best: next, nuisance, terms } }
    };
    fitted.into_iter().map(with).collect()
}

impl Discovery {
    /// Verdict of a diagnosis that holds terms without a name: nothing is explained by them.
    pub(crate) fn verdict(&self, verdict: Verdict) -> Verdict {
        match verdict {
            Verdict::Explained => Verdict::ExplainedInPart,
            Verdict::Consistent => Verdict::Unexplained,
            verdict => verdict,
        }
    }

    /// The terms as a model carries them.
    pub(crate) fn terms(&self) -> Vec<Term> {
        let sentences: Vec<Sentence> = self.terms.iter().map(|written| written.sentence.clone()).collect();
        joined::terms(&sentences, &self.nuisance, &self.best.state)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::OnceLock;

    use pam_muscle::effects::sentence::{Curve, Driver, Recall, Scale};

    use super::*;
    use crate::rehearsal::tests::Given;
    use crate::search::{Limits, search};
    use crate::verdict::verdict;

    const PROTOCOLS: [&str; 3] = ["isobaric-triangles", "isometric-ramps", "multisine"];

    /// What a search named in `given`, whose sensors leave 0.3 N.
    struct Searched {
        given: Given,
        limits: Limits,
        found: Found,
    }

    impl Searched {
        fn of(given: Given) -> Self {
            let excluded = vec!["braid-lockup".to_owned(), "end-taper".to_owned()];
            let limits = Limits { excluded, ..Limits::of_test(2, 0.3) };
            let setting = Setting { floor_square: 0.09, ..given.setting() };
            let found = search(&setting, &given.start, &given.model, &limits, &|| {}).expect("a search");
            Self { given, limits, found }
        }

        /// What is discovered beside it.
        fn discovered(&self, held: Option<&Given>) -> Vec<Sentence> {
            let Self { given, limits, found } = self;
            let setting = Setting { floor_square: 0.09, ..given.setting() };
            let sizes = Sizes::of(found, limits);
            let said = verdict(found, &sizes, false);
            let beside = setting.beside(&found.nuisance);
            let left = |model: &AugmentedModel| Left::of(model, &held.expect("a hold-out").track);
            let against = held.map(|held| HeldAgainst { left: &left, given: &held.model });
            let discovery = discover(&beside, found, &sizes, said, against);
            discovery.map_or_else(Vec::new, |discovery| discovery.terms.into_iter().map(|term| term.sentence).collect())
        }
    }

    /// Noise that neighbors share, of about 0.2 N, and a bump of `height_n` at a contraction of 12 %.
    fn bumped(height_n: f64) -> Given {
        let mut given = Given::of(&PROTOCOLS, &[]);
        given.disturb();
        for instant in &mut given.track.instants {
            let off = (instant.moment.contraction_ratio - 0.12) / 0.008;
            instant.force_n -= height_n * (-off * off).exp();
        }
        given
    }

    /// What a search names where something touches the muscle.
    fn touched() -> &'static Searched {
        static TOUCHED: OnceLock<Searched> = OnceLock::new();
        TOUCHED.get_or_init(|| Searched::of(bumped(8.0)))
    }

    #[test]
    fn what_touches_the_muscle_at_one_length_is_a_sentence_of_the_contraction() {
        let found = touched().discovered(None);
        let first = found.first().expect("a sentence");
        assert_eq!((first.driver, first.memory, first.scale), (Driver::Contraction, Recall::None, Scale::One));
    }

    #[test]
    fn where_nothing_is_missing_nothing_is_discovered() {
        assert_eq!(Searched::of(bumped(0.0)).discovered(None), []);
    }

    #[test]
    fn a_static_term_is_of_the_form_of_a_muscle_where_it_takes_up_less_than_a_tenth_of_what_a_map_does() {
        let held = |square: f64| HeldOut { blocks: vec![square; 8], counts: vec![10.0; 8], floor_square: 0.0 };
        let mut found = Searched::of(bumped(0.0)).found;
        (found.base.held_out, found.whole.held_out) = (held(101.0), held(1.0));
        let is_of_the_form = |driver: Driver, scale: Scale, gain_n: f64| {
            let sentence = Sentence { driver, memory: Recall::None, scale, shape: Curve::Line, seen: [0.0, 0.2] };
            let (without, with) = (held(2.0), held(2.0 - gain_n * gain_n));
            Written { sentence, bends: None, without, with, chosen: Vec::new() }.is_of_the_form(&found)
        };
        assert!(is_of_the_form(Driver::Contraction, Scale::Pressure, 0.99));
        assert!(!is_of_the_form(Driver::Contraction, Scale::Pressure, 1.01), "more than a map leaves");
        assert!(!is_of_the_form(Driver::Contraction, Scale::Friction, 0.5), "friction");
        assert!(!is_of_the_form(Driver::Speed, Scale::One, 0.5), "no static force");
    }

    #[test]
    fn what_held_out_recordings_do_not_show_is_not_written() {
        assert_eq!(touched().discovered(Some(&bumped(0.0))), []);
        assert!(!touched().discovered(Some(&bumped(8.0))).is_empty());
    }
}
