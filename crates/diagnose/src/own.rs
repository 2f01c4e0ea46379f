//! Effects of a user's own, as a model carries them: the sentence with the numbers that were fitted, over the range that was seen.

use pam_artifact::model::EffectEntry;
use pam_muscle::effects::sentence::{Argument, own};
use pam_muscle::effects::{Sentence, Term};

use crate::state::{Setting, State};

/// The sentence of every effect of `state`, seen where the recordings went; none where the catalogue has the effect.
pub(crate) fn sentences(setting: &Setting<'_>, state: &State) -> Vec<Option<Sentence>> {
    let seen = |sentence: Sentence| Sentence { seen: seen(setting, state, &sentence), ..sentence };
    state.guesses.iter().map(|guess| guess.effect.sentence_at(&guess.shape).map(seen)).collect()
}

/// Lowest and highest value that `sentence` answers at the counted instants.
fn seen(setting: &Setting<'_>, state: &State, sentence: &Sentence) -> [f64; 2] {
    let mut seen = [f64::INFINITY, f64::NEG_INFINITY];
    for range in &setting.track.recordings {
        let mut argument = Argument::of(sentence);
        for at in range.clone() {
            let value = argument.follow(&state.sheet.seen[at], &state.sheet.base[at]);
            if setting.track.counted[at] && value.is_finite() {
                seen = [seen[0].min(value), seen[1].max(value)];
            }
        }
    }
    seen
}

/// `terms` of a state with its `sentences` in the place of what only this run knows.
pub(crate) fn terms(terms: Vec<Term>, sentences: &[Option<Sentence>]) -> Vec<Term> {
    let written = |(term, sentence): (Term, &Option<Sentence>)| match sentence.as_ref().map(own) {
        Some(Ok(effect)) => Term::new(effect, Vec::new(), term.amplitudes),
        _ => term,
    };
    terms.into_iter().zip(sentences).map(written).collect()
}

/// `entry` of an effect with `n_shapes` as every program reads it, whichever effects that knows.
pub(crate) fn entry(entry: EffectEntry, sentence: &Option<Sentence>, n_shapes: usize) -> EffectEntry {
    match sentence {
        Some(sentence) => {
            EffectEntry::empirical(sentence.clone(), entry.parameters.into_iter().skip(n_shapes).collect())
        }
        None => entry,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hypothesis::{Beginning, CandidateEffect, Sign};
    use crate::rehearsal::tests::Given;

    use pam_muscle::effects::sentence::{Curve, EMPIRICAL, custom_effects};

    #[test]
    fn a_model_carries_a_users_effect_with_its_fitted_numbers_where_the_recordings_went() {
        let text = r#"
            [[effect]]
            id = "touching-guard"
            name = "a guard that touches the muscle"
            driver = "contraction"
            shape = { saturation = { from = [0.02, 0.2], over = 0.01 } }
            amplitude = [0.0, 300.0]
        "#;
        let effect = custom_effects(text).expect("effects")[0];
        let given = Given::of(&["isobaric-triangles", "multisine"], &[]);
        let setting = given.setting();
        let guess = CandidateEffect { effect, shape: vec![0.06], sign: Sign::Any, beginning: Beginning::Fresh };
        let state = setting.fit(vec![guess], &given.start, &given.model).expect("a fit");
        let sentences = sentences(&setting, &state);
        let sentence = sentences[0].clone().expect("a sentence");
        let Curve::Saturation { from, over } = sentence.shape else { panic!("{sentence:?}") };
        assert_eq!((from, over), (0.06, 0.01));
        let contraction = |at: usize| state.sheet.seen[at].contraction_ratio;
        let highest = (0..given.track.n()).filter(|&at| given.track.counted[at]).map(contraction).fold(0.0, f64::max);
        assert!((sentence.seen[1] - highest).abs() < 1e-12);
        let terms = terms(state.terms(), &sentences);
        assert_eq!((terms[0].effect.page().id, terms[0].shape.len(), terms[0].amplitudes.len()), (EMPIRICAL, 0, 1));
        let written = EffectEntry::new("touching-guard", Vec::new());
        assert_eq!(entry(written, &sentences[0], 1).sentence.as_ref(), sentences[0].as_ref());
    }
}
