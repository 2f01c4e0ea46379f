//! Effects beyond eq. 11 in a model: the catalogue's ids with values.

use pam_muscle::effects::sentence::{EMPIRICAL, own};
use pam_muscle::effects::{self, CATALOGUE, Effect, Past, Sentence, Term};
use pam_recording::spelling::number;
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parameter_entry::ParameterEntry;

/// An effect beyond eq. 11.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct EffectEntry {
    /// Catalogue id, or `empirical` for a term that has no name.
    pub id: String,
    /// What an empirical term is, but for its amplitudes; none for an effect of the catalogue.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sentence: Option<Sentence>,
    /// Its shape and its amplitudes, in SI, under the names and in the units of the catalogue; behind them what the muscle has
    /// been through, where the effect keeps that for good.
    pub parameters: Vec<ParameterEntry>,
    /// Whether it acts in the recordings alone that the model was fitted to, since recordings that were held out are followed worse
    /// with it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub only_as_fitted: bool,
}

impl EffectEntry {
    /// Effect `id` of the catalogue with `parameters`, in every recording.
    pub fn new(id: &str, parameters: Vec<ParameterEntry>) -> Self {
        Self { id: id.to_owned(), sentence: None, parameters, only_as_fitted: false }
    }

    /// An empirical term with what `sentence` says and its amplitudes, in every recording.
    pub fn empirical(sentence: Sentence, amplitudes: Vec<ParameterEntry>) -> Self {
        Self { sentence: Some(sentence), ..Self::new(EMPIRICAL, amplitudes) }
    }

    /// The effect without its values.
    fn effect(&self) -> Result<&'static dyn Effect, String> {
        match &self.sentence {
            Some(sentence) if self.id == EMPIRICAL => {
                return own(sentence).map_err(|reason| format!("the sentence of effect {EMPIRICAL}: {reason}"));
            }
            Some(_) => return Err(format!("effect {} has a sentence, which belongs to {EMPIRICAL} alone", self.id)),
            None if self.id == EMPIRICAL => return Err(format!("effect {EMPIRICAL} lacks its sentence")),
            None => {}
        }
        effects::effect(&self.id).ok_or_else(|| {
            let mut known: Vec<&str> = CATALOGUE.iter().map(|effect| effect.page().id).collect();
            known.sort_by_key(|id| strsim::osa_distance(&self.id, id));
            format!("effect \"{}\" is unknown; the nearest are {}", self.id, known[..3].join(", "))
        })
    }

    /// The effect with its values, every parameter once and within the range of the catalogue.
    pub(super) fn term(&self) -> Result<Term, String> {
        let effect = self.effect()?;
        let shapes = effect.shape().iter().map(|shape| (shape.name, shape.unit, shape.range));
        let amplitudes = effect.amplitudes().iter().map(|amplitude| (amplitude.name, amplitude.unit, amplitude.range));
        // What the muscle has been through stands there wholly or not at all.
        let keeps = effect.keeps().iter().map(|kept| (kept.name, kept.unit, kept.range));
        let is_kept = |entry: &ParameterEntry| effect.keeps().iter().any(|kept| kept.name == entry.name);
        let keeps = keeps.filter(|_| self.parameters.iter().any(is_kept));
        let expected: Vec<_> = shapes.chain(amplitudes).chain(keeps).collect();
        if let Some(entry) = self.parameters.iter().find(|entry| expected.iter().all(|(name, ..)| *name != entry.name))
        {
            let names: Vec<&str> = expected.iter().map(|(name, ..)| *name).collect();
            return Err(format!("effect {} has no parameter {}; it has {}", self.id, entry.name, names.join(", ")));
        }
        let mut values = Vec::with_capacity(expected.len());
        for (index, (name, unit, (lowest, highest))) in expected.into_iter().enumerate() {
            let mut entries = self.parameters.iter().filter(|entry| entry.name == name);
            let Some(entry) = entries.next() else {
                let lacks = || {
                    format!(
                        "effect {} lacks its parameter {name}; a model of an earlier catalogue has to be diagnosed again",
                        self.id
                    )
                };
                values.push(effect.unless_stated(index).ok_or_else(lacks)?);
                continue;
            };
            if entries.next().is_some() {
                return Err(format!("parameter {name} of effect {} stands there twice", self.id));
            }
            if entry.unit != unit {
                return Err(format!("parameter {name} of effect {} is in {}; write it in {unit}", self.id, entry.unit));
            }
            // A value at the end of its range survives arithmetic that rounds it beyond.
            let slack = 1e-9 * (highest - lowest);
            if !(lowest - slack..=highest + slack).contains(&entry.value) {
                let unit = if unit == "1" { "" } else { unit };
                let message = format!(
                    "parameter {name} of effect {} is {}; physics allows {lowest} to {highest} {unit}",
                    self.id,
                    number(entry.value)
                );
                return Err(message.trim_end().to_owned());
            }
            values.push(entry.value);
        }
        let after = values.split_off(effect.shape().len() + effect.amplitudes().len());
        let amplitudes = values.split_off(effect.shape().len());
        let past = Past { after, ..Past::default() };
        Ok(Term { past, only_as_fitted: self.only_as_fitted, ..Term::new(effect, values, amplitudes) })
    }
}
