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
use pam_core::effects::Sentence;

use self::confirm::Left;
use self::field::Field;
use self::screen::Said;
use crate::diagnose::evidence;
use crate::joint::HeldOut;
use crate::search::{Found, Judged, chance};
use crate::state::{Setting, State};
use crate::track::Track;
use crate::uncertainty::{Uncertainty, entries};
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
/// Times the sensors' noise that an explained mismatch may leave, root mean square, before more is looked for.
const LEAVES_ENOUGH: f64 = 1.5;

/// Terms without a name, fitted jointly with everything else.
#[derive(Debug)]
pub(crate) struct Discovery {
    /// Base, effects and, after them, the terms.
    pub(crate) best: Judged,
    terms: Vec<Written>,
    held_out: Option<[Left; 2]>,
    before: HeldOut,
}

/// A term that is written.
#[derive(Debug)]
struct Written {
    sentence: Sentence,
    without: HeldOut,
    with: HeldOut,
    /// What else was in question, with how often draws of blocks choose it, this one first.
    chosen: Vec<(Said, f64)>,
}

/// Looks for terms on what `found` leaves of `track`, if `verdict` says that something is left; none where nothing gains on
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
    let left = |state: &State| held.map(|held| Left::of(state, found, setting.track, held));
    let before = left(&found.best.state);
    let mut best = found.best.clone();
    let mut last = before.clone();
    let mut terms: Vec<Written> = Vec::new();
    while terms.len() < MOST_TERMS {
        let Some((next, written)) = next_term(setting, &best) else { break };
        let now = left(&next.state);
        let is_confirmed = match (&last, &now) {
            (Some(last), Some(now)) => last.is_bettered_by(now),
            _ => chance(&written.without, &written.with) * LOOKS < CHANCE,
        };
        if !is_confirmed {
            break;
        }
        (best, last) = (next, now);
        terms.push(written);
    }
    let before_blocks = found.best.held_out.clone();
    (!terms.is_empty()).then(|| Discovery {
        best,
        terms,
        held_out: before.zip(last).map(|(a, b)| [a, b]),
        before: before_blocks,
    })
}

/// `best` with one more term that gains on held-out blocks.
fn next_term(setting: &Setting<'_>, best: &Judged) -> Option<(Judged, Written)> {
    let field = Field::of(setting, &best.state)?;
    let said = screen::screen(&field, setting, &best.state);
    let fitted = said.iter().take(FITTED).enumerate().filter_map(|(index, said)| {
        let next = joined::joined(setting, &field, best, &said.sentence)?;
        Some((best.held_out.log_ratio(&next.held_out), index, next))
    });
    let (log_ratio, index, next) = fitted.max_by(|left, right| left.0.total_cmp(&right.0))?;
    let gained = best.held_out.mean_square() - next.held_out.mean_square();
    if log_ratio < LEAST_LOG_RATIO || gained < LEAST_SHARE * best.held_out.mean_square() {
        return None;
    }
    let sentence = next.state.guesses.last()?.effect.sentence()?.clone();
    let shares = stability::chosen(&field, &said);
    let mut chosen: Vec<(Said, f64)> = said.into_iter().zip(shares).collect();
    let own = chosen.remove(index);
    chosen.sort_by(|left, right| right.1.total_cmp(&left.1));
    chosen.insert(0, own);
    let (without, with) = (best.held_out.clone(), next.held_out.clone());
    Some((next, Written { sentence, without, with, chosen }))
}

impl Discovery {
    /// Verdict of a diagnosis that holds terms without a name: nothing is explained by them.
    pub(crate) fn verdict(&self, verdict: Verdict) -> Verdict {
        if verdict == Verdict::Explained { Verdict::ExplainedInPart } else { verdict }
    }

    /// What a diagnosis writes of the terms.
    pub(crate) fn written(&self, setting: &Setting<'_>, found: &Found, uncertainty: &Uncertainty) -> Empirical {
        let state = &self.best.state;
        let folds = setting.fold_fits(state).unwrap_or_default();
        let first_term = state.guesses.len() - self.terms.len();
        let mut first = crate::hypothesis::n_amplitudes(&state.guesses[..first_term]);
        let mut terms = Vec::new();
        for (offset, written) in self.terms.iter().enumerate() {
            let index = first_term + offset;
            let n = state.guesses[index].amplitudes().len();
            let curve = curve::curve(setting, state, index, first, &folds);
            terms.push(EmpiricalTerm {
                equation: written.sentence.equation(),
                words: said::words(&written.sentence, &curve),
                sentence: written.sentence.clone(),
                parameters: entries(state, index, first, &[], uncertainty),
                evidence: evidence(&written.without, &written.with, LOOKS as usize),
                stability: stability_of(&written.chosen),
                nearest: nearest::nearest(found, &self.best.held_out),
                curve,
            });
            first += n;
        }
        let gain = |without_n, with_n| EmpiricalGain { rmse_without_n: without_n, rmse_with_n: with_n };
        Empirical {
            terms,
            blocks: gain(self.before.mean_square().sqrt(), self.best.held_out.mean_square().sqrt()),
            holdout: self.held_out.as_ref().map(|[before, after]| gain(before.together_n(), after.together_n())),
        }
    }
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
