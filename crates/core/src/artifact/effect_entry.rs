//! Effects beyond eq. 11 in a model: the catalogue's ids with values.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::model::ParameterEntry;
use crate::effects::{self, CATALOGUE, Term};
use crate::spelling::number;

/// An effect beyond eq. 11.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EffectEntry {
    /// Catalogue id.
    pub id: String,
    /// Its shape and its amplitudes, in SI, under the names and in the units of the catalogue.
    pub parameters: Vec<ParameterEntry>,
}

impl EffectEntry {
    /// The effect with its values, every parameter once and within the range of the catalogue.
    pub(super) fn term(&self) -> Result<Term, String> {
        let Some(effect) = effects::effect(&self.id) else {
            let mut known: Vec<&str> = CATALOGUE.iter().map(|effect| effect.page().id).collect();
            known.sort_by_key(|id| strsim::osa_distance(&self.id, id));
            return Err(format!("effect \"{}\" is unknown; the nearest are {}", self.id, known[..3].join(", ")));
        };
        let shapes = effect.shape().iter().map(|shape| (shape.name, shape.unit, shape.range));
        let amplitudes = effect.amplitudes().iter().map(|amplitude| (amplitude.name, amplitude.unit, amplitude.range));
        let expected: Vec<_> = shapes.chain(amplitudes).collect();
        if let Some(entry) = self.parameters.iter().find(|entry| expected.iter().all(|(name, ..)| *name != entry.name))
        {
            let names: Vec<&str> = expected.iter().map(|(name, ..)| *name).collect();
            return Err(format!("effect {} has no parameter {}; it has {}", self.id, entry.name, names.join(", ")));
        }
        let mut values = Vec::with_capacity(expected.len());
        for (name, unit, (lowest, highest)) in expected {
            let mut entries = self.parameters.iter().filter(|entry| entry.name == name);
            let entry = entries.next().ok_or_else(|| {
                format!(
                    "effect {} lacks its parameter {name}; a model of an earlier catalogue has to be diagnosed again",
                    self.id
                )
            })?;
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
        let amplitudes = values.split_off(effect.shape().len());
        Ok(Term { effect, shape: values, amplitudes })
    }
}
