//! Sentences fitted together with the base and everything that was named, as a model will carry them.
//!
//! The curve of a sentence stands among the nuisances: drawn to zero by as much as a static map is, so that what a parameter of
//! eq. 11 can take as well is that parameter's.

use std::ops::Range;

use pam_muscle::effects::sentence::{Argument, own};
use pam_muscle::effects::{Amplitude, Sentence, Term};

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

/// Whether the amplitudes of `sentences` in `state` are such as a model may carry.
pub(super) fn is_within(sentences: &[Sentence], nuisance: &Nuisance, state: &State) -> bool {
    sentences.iter().zip(amplitudes(nuisance, &state.fit)).all(|(sentence, amplitudes)| {
        own(sentence).is_ok_and(|effect| {
            let within =
                |(value, amplitude): (&f64, &Amplitude)| (amplitude.range.0..=amplitude.range.1).contains(value);
            amplitudes.iter().zip(effect.amplitudes()).all(within)
        })
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

    /// Whether a model may carry a bump of so many newtons at a contraction of 12 %, fitted beside the base.
    fn is_carried(height_n: f64) -> bool {
        let shape = Curve::Bump { center: 0.12, width: 0.008 };
        let bump =
            Sentence { driver: Driver::Contraction, memory: Recall::None, scale: Scale::One, shape, seen: [0.0, 0.25] };
        let mut given = Given::of(&["isobaric-triangles", "isometric-ramps"], &[]);
        for instant in &mut given.track.instants {
            let off = (instant.moment.contraction_ratio - 0.12) / 0.008;
            instant.force_n += height_n * (-off * off).exp();
        }
        let setting = given.setting();
        let base = setting.fit(Vec::new(), &given.start, &given.model).and_then(|state| judged(&setting, state));
        let sentences = [bump];
        let fitted = joined(&setting, &NONE, &base.expect("a fit"), &sentences);
        let (judged, nuisance) = fitted.expect("a fit beside it");
        is_within(&sentences, &nuisance, &judged.state)
    }

    #[test]
    fn what_no_muscle_pulls_with_is_carried_by_no_model() {
        assert!(is_carried(30.0));
        assert!(!is_carried(1e6));
    }
}
