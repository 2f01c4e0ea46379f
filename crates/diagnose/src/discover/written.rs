//! What a diagnosis writes of the terms that were discovered.

use pam_artifact::diagnosis::{Empirical, EmpiricalGain, EmpiricalTerm, Stability, StabilityRival};
use pam_artifact::model::ParameterEntry;
use pam_muscle::effects::Term;

use super::discovery::{Discovery, LOOKS};
use super::screen::Said;
use super::{curve, joined, nearest, said};
use crate::joint::JointFit;
use crate::named::evidence;
use crate::search::Found;
use crate::state::Setting;
use crate::uncertainty::{entry, jackknife_stderr};

impl Discovery {
    /// What a diagnosis writes of the terms; `folds` each leave one fold out.
    pub(crate) fn written(&self, setting: &Setting<'_>, found: &Found, folds: &[JointFit]) -> Empirical {
        let state = &self.best.state;
        let by_fold: Vec<Vec<Vec<f64>>> = folds.iter().map(|fit| joined::amplitudes(&self.nuisance, fit)).collect();
        let terms = self.terms.iter().zip(self.terms()).enumerate().map(|(index, (written, term))| {
            let of_folds: Vec<Vec<f64>> = by_fold.iter().map(|fold| fold[index].clone()).collect();
            let curve = curve::curve(setting, state, &written.sentence, &term.amplitudes, &of_folds);
            EmpiricalTerm {
                equation: written.sentence.equation(),
                words: said::words(&written.sentence, &curve, written.bends),
                bends: written.bends.map(str::to_owned),
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
            // Known once the models are compared at the rate of the recordings.
            holdout: None,
        }
    }
}

/// Amplitudes of a term, with standard errors by the jackknife over folds.
fn parameters(term: &Term, folds: &[Vec<f64>]) -> Vec<ParameterEntry> {
    let stderr = |index: usize| jackknife_stderr(folds.iter().map(|fold| fold[index]));
    let values = term.effect.amplitudes().iter().zip(&term.amplitudes).enumerate();
    values
        .map(|(index, (amplitude, &value))| {
            let stderr = Some(stderr(index)).filter(|stderr| stderr.is_finite());
            entry(amplitude.name, amplitude.unit, value, amplitude.range, stderr)
        })
        .collect()
}

/// What the terms do and gain, to be said after the verdict. Where nothing is named, a static map may stand beside them
/// (`with_map`), and the gain is that of both.
pub(crate) fn statement(empirical: &Empirical, beside_effects: bool, with_map: bool) -> String {
    let words: Vec<&str> = empirical.terms.iter().map(|term| term.words.as_str()).collect();
    let (gain, on) = match empirical.holdout {
        Some(holdout) => (holdout, "RMSE on held-out recordings"),
        None => (empirical.blocks, "cross-validated RMSE"),
    };
    let with_map = with_map && !beside_effects && empirical.holdout.is_some();
    let subject = match (words.len(), with_map) {
        (1, false) => "An empirical term models",
        (_, false) => "Empirical terms model",
        (1, true) => "An empirical term and a smooth static map model",
        (_, true) => "Empirical terms and a smooth static map model",
    };
    let object = if beside_effects { "the rest" } else { "it" };
    let verb = if gain.rmse_with_n < gain.rmse_without_n { "lower" } else { "raise" };
    let verb = if words.len() == 1 && !with_map { format!("{verb}s") } else { verb.to_owned() };
    let (without_n, with_n) = (gain.rmse_without_n, gain.rmse_with_n);
    format!(" {subject} {object} and {verb} the {on} from {without_n:.2} to {with_n:.2} N: {}.", words.join("; and "))
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
