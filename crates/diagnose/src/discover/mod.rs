//! A mismatch without a name gets an equation.
//!
//! Where something is left that no effect of the catalogue explains, the [sentence](pam_core::effects::sentence) of the grammar
//! that foretells held-out blocks best, for its degrees of freedom, is fitted jointly with the base and what was named. It is
//! written only where held-out recordings, or where there are none the blocks, are foretold better with it.
//!
//! In reading order: [`lexicon`] is what sentences are made of, [`field`] judges one, [`screen`] finds the best, [`joined`] fits
//! it with everything else, [`confirm`] asks what was held out, [`stability`] whether other draws of blocks would choose it,
//! [`curve`], [`nearest`] and [`said`] are what a person reads of it.

mod confirm;
mod curve;
mod field;
mod joined;
mod lexicon;
mod nearest;
mod said;
mod screen;
mod stability;

use pam_core::artifact::diagnosis::{Empirical, EmpiricalGain, EmpiricalTerm, Stability, StabilityRival, Verdict};
use pam_core::artifact::model::ParameterEntry;
use pam_core::effects::{AugmentedModel, Sentence, Term};

use self::confirm::Left;
use self::field::Field;
use self::screen::Said;
use crate::diagnose::evidence;
use crate::joint::{HeldOut, JointFit};
use crate::nuisance::Nuisance;
use crate::search::{Found, Judged, again, chance, fitting};
use crate::state::Setting;
use crate::track::Track;
use crate::uncertainty::entry;
use crate::verdict::Sizes;

/// Terms that may be written.
const MOST_TERMS: usize = 2;
/// Sentences that are fitted jointly before the best of them is taken.
const FITTED: usize = 3;
/// Evidence over held-out blocks that a term needs.
const LEAST_LOG_RATIO: f64 = 3.0;
/// Share of the mean square over held-out blocks that it must take away.
const LEAST_SHARE: f64 = 0.05;
/// Sentences that are looked at, about, where chance is asked for.
const LOOKS: f64 = 500.0;
/// Chance that is no longer believed in, where no recording was held out to ask.
const CHANCE: f64 = 0.05;
/// Share of the mean square over held-out blocks that a static map must take up beside terms to be kept.
const WORTH_A_MAP: f64 = 0.02;
/// Times the sensors' noise that an explained mismatch may leave, root mean square, before more is looked for.
const LEAVES_ENOUGH: f64 = 1.5;

/// Terms without a name, fitted jointly with everything else.
#[derive(Debug)]
pub(crate) struct Discovery {
    /// Base and effects beside [`nuisance`](Self::nuisance).
    pub(crate) best: Judged,
    /// What is in beside them, the curves of the terms included.
    pub(crate) nuisance: Nuisance,
    terms: Vec<Written>,
    held_out: Option<[Left; 2]>,
    before: HeldOut,
}

/// A term that is written.
#[derive(Debug, Clone)]
struct Written {
    sentence: Sentence,
    without: HeldOut,
    with: HeldOut,
    /// What else was in question, with how often draws of blocks choose it, this one first.
    chosen: Vec<(Said, f64)>,
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
        terms.extend(self.nuisance.map_term(&state.fit.nuisances, track, &found.coordinates));
        terms.extend(joined::terms(&self.sentences(), &self.nuisance, state));
        AugmentedModel::new(state.model.clone(), terms)
    }
}

/// Looks for terms on what `found` leaves of `setting`, if `verdict` says that something is left; none where nothing gains on
/// `held`, or where there is nothing held out on the blocks.
pub(crate) fn discover(
    setting: &Setting<'_>,
    found: &Found,
    sizes: &Sizes,
    verdict: Verdict,
    held: Option<&Track>,
) -> Option<Discovery> {
    let left_over = match verdict {
        Verdict::Unexplained => true,
        Verdict::Explained => sizes.best_n > LEAVES_ENOUGH * sizes.sensors_n,
        Verdict::Consistent | Verdict::ExplainedInPart | Verdict::Ambiguous => false,
    };
    if !left_over {
        return None;
    }
    let left = |step: &Step| held.map(|held| Left::of(&step.model(found, setting.track), held));
    let start = Step { best: found.best.clone(), nuisance: found.nuisance.clone(), terms: Vec::new() };
    let before = left(&start);
    let (plain, mapped) = nuisances(setting, found)?;
    let mut smooth = Step { best: again(&setting.beside(&mapped), &found.best)?, nuisance: mapped.clone(), ..start };
    let mut kept: Option<Step> = None;
    let mut last = before.clone();
    while smooth.terms.len() < MOST_TERMS {
        let Some(next) = next_term(setting, &mapped, &smooth) else { break };
        let now_kept = without_map(setting, &plain, &next)?;
        let now = left(&now_kept);
        let written = &next.terms[next.terms.len() - 1];
        let is_confirmed = match (&last, &now) {
            (Some(last), Some(now)) => last.is_bettered_by(now),
            _ => chance(&written.without, &written.with) * LOOKS < CHANCE,
        };
        if !is_confirmed {
            break;
        }
        (smooth, last, kept) = (next, now, Some(now_kept));
    }
    let Step { best, nuisance, terms } = kept?;
    Some(Discovery {
        best,
        nuisance,
        terms,
        held_out: before.zip(last).map(<[Left; 2]>::from),
        before: found.best.held_out.clone(),
    })
}

/// What is in beside sentences: nuisances without a static map, and with one that is as smooth as foretells held-out blocks best,
/// so that nothing smooth and static is taken for a term.
fn nuisances(setting: &Setting<'_>, found: &Found) -> Option<(Nuisance, Nuisance)> {
    let plain = found.nuisance.without_map();
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

/// `step` with one more term that gains on held-out blocks; `mapped` is what is in beside terms.
fn next_term(setting: &Setting<'_>, mapped: &Nuisance, step: &Step) -> Option<Step> {
    let best = &step.best;
    let beside = setting.beside(&step.nuisance);
    let field = Field::of(&beside, &best.state)?;
    let said = screen::screen(&field, &beside, &best.state);
    let fitted = said.iter().take(FITTED).enumerate().filter_map(|(index, said)| {
        let sentences = [step.sentences(), vec![said.sentence.clone()]].concat();
        let (next, nuisance) = joined::joined(setting, mapped, best, &sentences)?;
        Some((best.held_out.log_ratio(&next.held_out) - said.charge(), index, next, nuisance))
    });
    let fitted: Vec<(f64, usize, Judged, Nuisance)> = fitted.collect();
    let (log_ratio, index, next, nuisance) = fitted.into_iter().max_by(|left, right| left.0.total_cmp(&right.0))?;
    let gained = best.held_out.mean_square() - next.held_out.mean_square();
    if log_ratio < LEAST_LOG_RATIO || gained < LEAST_SHARE * best.held_out.mean_square() {
        return None;
    }
    let shares = stability::chosen(&field, &said);
    let mut chosen: Vec<(Said, f64)> = said.into_iter().zip(shares).collect();
    let own = chosen.remove(index);
    chosen.sort_by(|left, right| right.1.total_cmp(&left.1));
    let sentence = own.0.sentence.clone();
    chosen.insert(0, own);
    let (without, with) = (best.held_out.clone(), next.held_out.clone());
    let mut terms = step.terms.clone();
    terms.push(Written { sentence, without, with, chosen });
    Some(Step { best: next, nuisance, terms })
}

impl Discovery {
    /// Verdict of a diagnosis that holds terms without a name: nothing is explained by them.
    pub(crate) fn verdict(&self, verdict: Verdict) -> Verdict {
        if verdict == Verdict::Explained { Verdict::ExplainedInPart } else { verdict }
    }

    /// The terms as a model carries them.
    pub(crate) fn terms(&self) -> Vec<Term> {
        let sentences: Vec<Sentence> = self.terms.iter().map(|written| written.sentence.clone()).collect();
        joined::terms(&sentences, &self.nuisance, &self.best.state)
    }

    /// What a diagnosis writes of the terms; `folds` each leave one fold out.
    pub(crate) fn written(&self, setting: &Setting<'_>, found: &Found, folds: &[JointFit]) -> Empirical {
        let state = &self.best.state;
        let by_fold: Vec<Vec<Vec<f64>>> = folds.iter().map(|fit| joined::amplitudes(&self.nuisance, fit)).collect();
        let terms = self.terms.iter().zip(self.terms()).enumerate().map(|(index, (written, term))| {
            let of_folds: Vec<Vec<f64>> = by_fold.iter().map(|fold| fold[index].clone()).collect();
            let curve = curve::curve(setting, state, &written.sentence, &term.amplitudes, &of_folds);
            EmpiricalTerm {
                equation: written.sentence.equation(),
                words: said::words(&written.sentence, &curve),
                sentence: written.sentence.clone(),
                parameters: parameters(&term, &of_folds),
                evidence: evidence(&written.without, &written.with, LOOKS as usize),
                stability: stability_of(&written.chosen),
                nearest: nearest::nearest(found, &self.best.held_out),
                curve,
            }
        });
        let gain = |rmse_without_n, rmse_with_n| EmpiricalGain { rmse_without_n, rmse_with_n };
        Empirical {
            terms: terms.collect(),
            blocks: gain(self.before.mean_square().sqrt(), self.best.held_out.mean_square().sqrt()),
            holdout: self.held_out.as_ref().map(|[before, after]| gain(before.together_n(), after.together_n())),
        }
    }
}

/// Amplitudes of a term, with standard errors by the jackknife over folds.
fn parameters(term: &Term, folds: &[Vec<f64>]) -> Vec<ParameterEntry> {
    let n = folds.len() as f64;
    let stderr = |index: usize| {
        let mean = folds.iter().map(|fold| fold[index]).sum::<f64>() / n;
        let squares: f64 = folds.iter().map(|fold| (fold[index] - mean).powi(2)).sum();
        ((n - 1.0) / n * squares).sqrt()
    };
    let values = term.effect.amplitudes().iter().zip(&term.amplitudes).enumerate();
    values
        .map(|(index, (amplitude, &value))| {
            let stderr = Some(stderr(index)).filter(|stderr| stderr.is_finite());
            entry(amplitude.name, amplitude.unit, value, amplitude.range, stderr)
        })
        .collect()
}

/// What the terms do and gain, to be said after the verdict.
pub(crate) fn statement(empirical: &Empirical) -> String {
    let words: Vec<&str> = empirical.terms.iter().map(|term| term.words.as_str()).collect();
    let (gain, on) = match empirical.holdout {
        Some(holdout) => (holdout, "held-out recordings"),
        None => (empirical.blocks, "held-out blocks"),
    };
    let number = if words.len() == 1 { "A term without a name models it" } else { "Terms without a name model it" };
    format!(
        " {number} and leaves {:.2} N of {:.2} N on {on}: {}.",
        gain.rmse_with_n,
        gain.rmse_without_n,
        words.join("; and ")
    )
}

/// Others that draws of blocks choose less often than this are not named.
const RARELY: f64 = 0.05;

fn stability_of(chosen: &[(Said, f64)]) -> Stability {
    let others = chosen.iter().skip(1).filter(|(_, share)| *share >= RARELY);
    Stability {
        chosen: chosen.first().map_or(0.0, |(_, share)| *share),
        others: others
            .map(|(said, share)| StabilityRival {
                sentence: said.sentence.clone(),
                words: said::in_short(&said.sentence),
                chosen: *share,
            })
            .collect(),
    }
}
