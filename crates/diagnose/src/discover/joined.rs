//! Sentences fitted together with the base and everything that was named, as a model will carry them.
//!
//! The curve of a sentence stands among the nuisances: drawn to zero by as much as a static map is, so that what a parameter of
//! eq. 11 can take as well is that parameter's.

use std::ops::Range;

use pam_muscle::effects::sentence::{Argument, own};
use pam_muscle::effects::{Amplitude, Sentence, Term};

use super::curve::curve;
use crate::joint::JointFit;
use crate::nuisance::{Group, Nuisance};
use crate::search::{Judged, judged};
use crate::state::{Setting, State};

/// Fits after which what scales take of the base follows its new parameters closely enough.
const ROUNDS: usize = 3;

/// `best` with `sentences` beside `bare`, which has none; and the nuisances with them.
pub(super) fn joined(
    setting: &Setting<'_>,
    bare: &Nuisance,
    best: &Judged,
    sentences: &[Sentence],
) -> Option<(Judged, Nuisance)> {
    let mut state = best.state.clone();
    let mut beside = bare.clone();
    for _ in 0..ROUNDS {
        beside = sentences.iter().fold(bare.clone(), |nuisance, sentence| {
            nuisance.with_term(columns(setting, &state, sentence), &setting.track.counted)
        });
        state = setting.beside(&beside).fit_near(best.state.guesses.clone(), &state)?;
    }
    let judged = judged(&setting.beside(&beside), state)?;
    Some((judged, beside))
}

/// Force per unit of each amplitude at every instant, one vector an amplitude.
fn columns(setting: &Setting<'_>, state: &State, sentence: &Sentence) -> Vec<Vec<f64>> {
    let n = setting.track.n();
    let mut columns = vec![vec![0.0; n]; sentence.n_amplitudes()];
    let mut row = vec![0.0; columns.len()];
    for range in &setting.track.recordings {
        let mut argument = Argument::of(sentence);
        for at in range.clone() {
            let (now, base) = (&state.sheet.seen[at], &state.sheet.base[at]);
            let value = argument.follow(now, base);
            sentence.columns(value, now, base, &mut row);
            columns.iter_mut().zip(&row).for_each(|(column, value)| column[at] = *value);
        }
    }
    columns
}

/// Which nuisances are the curve of each sentence, in order.
pub(super) fn curves(nuisance: &Nuisance) -> Vec<Range<usize>> {
    let of_terms = nuisance.groups.iter().filter(|(group, _)| *group == Group::Term);
    of_terms.map(|(_, columns)| columns.clone()).collect()
}

/// Amplitudes of every sentence in `fit`, in order.
pub(super) fn amplitudes(nuisance: &Nuisance, fit: &JointFit) -> Vec<Vec<f64>> {
    curves(nuisance).into_iter().map(|columns| nuisance.in_their_units(&fit.nuisances, columns)).collect()
}

/// Whether `sentences` are such as a model may carry, with their amplitudes in `state`: within what an amplitude may be, and nowhere
/// along their curves larger than all that the force ranged over. A bump between two samples may be of any height.
pub(super) fn is_within(setting: &Setting<'_>, sentences: &[Sentence], nuisance: &Nuisance, state: &State) -> bool {
    let (low_n, high_n) = setting.track.seen().force_n;
    sentences.iter().zip(amplitudes(nuisance, &state.fit)).all(|(sentence, amplitudes)| {
        let within = |(value, amplitude): (&f64, &Amplitude)| (amplitude.range.0..=amplitude.range.1).contains(value);
        let curve = curve(setting, state, sentence, &amplitudes, &[]);
        own(sentence).is_ok_and(|effect| amplitudes.iter().zip(effect.amplitudes()).all(within))
            && curve.force_n.iter().all(|force_n| force_n.abs() <= high_n - low_n)
    })
}

/// `sentences` as a model carries them, with their amplitudes in `state`.
pub(super) fn terms(sentences: &[Sentence], nuisance: &Nuisance, state: &State) -> Vec<Term> {
    let term = |(sentence, amplitudes): (&Sentence, Vec<f64>)| {
        let effect = own(sentence).ok()?;
        let within = |(value, amplitude): (f64, &Amplitude)| value.clamp(amplitude.range.0, amplitude.range.1);
        let amplitudes = amplitudes.into_iter().zip(effect.amplitudes()).map(within).collect();
        Some(Term::new(effect, Vec::new(), amplitudes))
    };
    sentences.iter().zip(amplitudes(nuisance, &state.fit)).filter_map(term).collect()
}

#[cfg(test)]
mod tests {
    use pam_muscle::effects::sentence::{Curve, Driver, Recall, Scale};

    use super::*;
    use crate::nuisance::NONE;
    use crate::rehearsal::tests::Given;

    /// Recordings with a bump of so many newtons at a contraction of 12 %.
    fn bumped(height_n: f64) -> Given {
        let mut given = Given::of(&["isobaric-triangles", "isometric-ramps"], &[]);
        for instant in &mut given.track.instants {
            let off = (instant.moment.contraction_ratio - 0.12) / 0.008;
            instant.force_n += height_n * (-off * off).exp();
        }
        given
    }

    /// Whether a model of `given` may carry such a bump, fitted beside the base; `among` has the forces that there were.
    fn is_carried(given: &Given, among: &Given) -> bool {
        let bump = Sentence {
            driver: Driver::Contraction,
            memory: Recall::None,
            scale: Scale::One,
            shape: Curve::Bump { center: 0.12, width: 0.008 },
            seen: [0.0, 0.25],
        };
        let setting = given.setting();
        let base = setting.fit(Vec::new(), &given.start, &given.model).and_then(|state| judged(&setting, state));
        let sentences = [bump];
        let fitted = joined(&setting, &NONE, &base.expect("a fit"), &sentences);
        let (judged, nuisance) = fitted.expect("a fit beside it");
        is_within(&among.setting(), &sentences, &nuisance, &judged.state)
    }

    #[test]
    fn what_no_muscle_pulls_with_is_carried_by_no_model() {
        let [small, large, endless] = [30.0, 3e3, 1e6].map(bumped);
        assert!(is_carried(&small, &small) && is_carried(&large, &large));
        assert!(!is_carried(&endless, &endless), "more than an amplitude may be");
        assert!(!is_carried(&large, &small), "more than all that the force ranged over");
    }
}
