//! `pam-model/1`: an identified force model.

use std::path::Path;

use pam_muscle::direction::{Standstill, Thresholds};
use pam_muscle::effects::{AugmentedModel, Kind};
use pam_muscle::force::{BaseParameters, ForceModel, Form, Parameter};
use pam_muscle::{Dimension, Muscle};
use pam_recording::quality::RecordingQuality;
use pam_recording::spelling::{nearest, number};
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use super::effect_entry::EffectEntry;
use super::error::ArtifactError;
pub use super::fit_report::{
    Domain, FitReport, FitStatistics, ImpliedParameter, RecordingFit, SearchReport, StartReport, UnboundedFit,
};
pub use super::identify_config::{
    Assumed, BladderLaw, FixedParameter, FrictionLaw, IdentifyConfig, Loss, StandstillFit,
};
use super::origin::{Input, InputRole, Tool};
pub use super::parameter_entry::{ParameterEntry, ParameterStatus};

/// Schema name and version.
pub const SCHEMA: &str = "pam-model/1";

/// An identified force model with everything that later programs need.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct ModelArtifact {
    /// `pam-model/1`.
    #[cfg_attr(feature = "schemas", schemars(extend("const" = SCHEMA)))]
    pub schema: String,
    /// Program that wrote it.
    pub tool: Tool,
    /// Files that went into it.
    pub inputs: Vec<Input>,
    /// Options as resolved.
    pub config: IdentifyConfig,
    /// Seed of every random draw.
    pub seed: u64,
    /// Name of the muscle, where its file gives one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub muscle_name: Option<String>,
    /// Dimensions of the muscle, fitted ones as fitted.
    pub geometry: Muscle,
    /// Modulus of the strands that their contact was computed with, in Pa.
    pub strand_modulus_pa: f64,
    /// How eq. 11 is written.
    pub form: Form,
    /// Parameters of eq. 11, and fitted dimensions after them.
    pub parameters: Vec<ParameterEntry>,
    /// Sums and products that the data determine where the members cannot be told apart.
    pub composites: Vec<CompositeEntry>,
    /// Effects beyond eq. 11.
    pub effects: Vec<EffectEntry>,
    /// Correlation between the estimates of the fitted parameters.
    pub correlation: Correlation,
    /// How well the model agrees with the recordings.
    pub fit: FitReport,
    /// What pressures, lengths and rates the estimation recordings cover.
    pub domain: Domain,
    /// Thresholds of the direction of motion.
    pub direction: Thresholds,
    /// Laws of friction at standstill that the recordings compared, the one taken first; none where one was assumed.
    #[serde(default)]
    pub standstill_laws: Vec<StandstillFit>,
    /// Quality gate of every recording.
    pub quality: Vec<RecordingQuality>,
    /// How the search went.
    pub search: SearchReport,
    /// What the same columns reach with weights free of any sign or range; only where asked for.
    pub unbounded: Option<UnboundedFit>,
    /// What a person should know before using the model.
    pub warnings: Vec<String>,
}

/// A combination of parameters that the data determine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct CompositeEntry {
    /// The combination, as a formula of parameter names.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// Standard error.
    pub stderr: Option<f64>,
    /// Why the members cannot be told apart, in words.
    pub reason: String,
}

/// Correlation between estimates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Correlation {
    /// What was fitted, in the order of the matrix; a composite counts once.
    pub names: Vec<String>,
    /// Square matrix, row by row.
    pub matrix: Vec<Vec<f64>>,
}

impl ModelArtifact {
    /// The artifact as JSON that [`read`](Self::read) accepts.
    ///
    /// # Errors
    /// [`ArtifactError::Unreadable`] where it would not be.
    pub fn json(&self) -> Result<Vec<u8>, ArtifactError> {
        let bytes = super::json::readable_json(self)?;
        self.check().map_err(|what| ArtifactError::Unreadable { what })?;
        Ok(bytes)
    }

    /// Reads and checks an artifact; gives its SHA-256 as well.
    ///
    /// # Errors
    /// [`ArtifactError`] names the file, the place and what to do.
    pub fn read(path: &Path) -> Result<(Self, String), ArtifactError> {
        let (artifact, sha256): (Self, String) = super::json::read(path, SCHEMA, "pam-identify")?;
        artifact.check().map_err(|what| ArtifactError::Implausible { path: path.to_owned(), what })?;
        Ok((artifact, sha256))
    }

    fn check(&self) -> Result<(), String> {
        for parameter in Parameter::ALL {
            let name = parameter.artifact_name();
            match self.parameters.iter().filter(|entry| entry.name == name).count() {
                1 => {}
                0 => return Err(format!("parameter {name} is missing")),
                _ => return Err(format!("parameter {name} stands there twice")),
            }
        }
        for (index, entry) in self.parameters.iter().enumerate() {
            let of_eq_11 = Parameter::ALL.map(|known| (known.artifact_name(), known.unit()));
            let of_muscle = Dimension::ALL.map(|known| (known.parameter_name(), known.unit()));
            let known = || of_eq_11.iter().chain(&of_muscle);
            let Some((name, unit)) = known().find(|(name, _)| *name == entry.name) else {
                let names: Vec<&str> = known().map(|(name, _)| *name).collect();
                return Err(match nearest(&entry.name, names.iter().copied()) {
                    Some(near) => format!("parameter \"{}\" is unknown; did you mean {near}?", entry.name),
                    None => format!("parameter \"{}\" is unknown; a model has {}", entry.name, names.join(", ")),
                });
            };
            if entry.unit != *unit {
                return Err(format!("the unit of parameter {name} is \"{}\", expected \"{unit}\"", entry.unit));
            }
            if self.parameters[..index].iter().any(|other| other.name == entry.name) {
                return Err(format!("parameter {name} stands there twice"));
            }
        }
        let modulus = self.value(Parameter::StrandCompliance);
        if modulus <= 0.0 {
            return Err(format!("strand_modulus is {}, which no strand has", number(modulus)));
        }
        let Muscle { rest_length_m, rest_radius_m, braid_angle_rad, wall_thickness_m, strand_count, strand_diameter_m } =
            self.geometry;
        let dimensions =
            [rest_length_m, rest_radius_m, braid_angle_rad, wall_thickness_m, strand_count, strand_diameter_m];
        if dimensions.iter().any(|&value| value <= 0.0) || self.strand_modulus_pa <= 0.0 {
            return Err("a dimension of the muscle is not positive".to_owned());
        }
        let Thresholds { length_m, pressure_pa, .. } = self.direction;
        if length_m < 0.0 || pressure_pa < 0.0 {
            return Err(format!(
                "a threshold of the direction is negative: {} m, {} Pa",
                number(length_m),
                number(pressure_pa)
            ));
        }
        if let Standstill::Slides { over_pa, share } = self.direction.standstill
            && (over_pa < 0.0 || !(share > 0.0 && share <= 1.0) || over_pa == 0.0 && share < 1.0)
        {
            return Err(format!(
                "friction at standstill that slides over {} Pa, {} of it: a share is above 0 and up to 1, and less than 1 only over a pressure",
                number(over_pa),
                number(share)
            ));
        }
        if let Standstill::Relaxes { time_constant_s, to } = self.direction.standstill
            && !(time_constant_s > 0.0 && (0.0..1.0).contains(&to))
        {
            return Err(format!(
                "friction at standstill that relaxes within {} s, to {} of it: a time constant is positive, and what stays from 0 on and \
                 less than 1",
                number(time_constant_s),
                number(to)
            ));
        }
        for (index, entry) in self.effects.iter().enumerate() {
            let term = entry.term()?;
            // Events may come again, and so may terms without a name; what belongs to muscle or bench is there or not.
            let again = self.effects[..index].iter().any(|other| other.id == entry.id);
            if again && term.effect.kind() != Kind::Event && entry.sentence.is_none() {
                return Err(format!("effect {} stands there twice", entry.id));
            }
        }
        Ok(())
    }

    fn value(&self, parameter: Parameter) -> f64 {
        let name = parameter.artifact_name();
        self.parameters.iter().find(|entry| entry.name == name).map_or(f64::NAN, |entry| entry.value)
    }

    /// What to call the muscle: its name, or else that of its file, or else its dimensions.
    pub fn muscle_title(&self) -> String {
        if let Some(name) = &self.muscle_name {
            return name.clone();
        }
        let Muscle { rest_length_m, rest_radius_m, .. } = self.geometry;
        let size = format!("{:.0} mm, radius {:.1} mm", 1e3 * rest_length_m, 1e3 * rest_radius_m);
        let file = self.inputs.iter().find(|input| input.role == InputRole::Muscle);
        let stem = file.and_then(|input| Path::new(&input.path).file_stem()?.to_str());
        let name = stem.map(|stem| stem.trim_start_matches("muscle").trim_matches(['-', '_', ' ', '.']));
        match name.filter(|name| !name.is_empty()) {
            Some(name) => format!("muscle {name} ({size})"),
            None => format!("muscle of {size}"),
        }
    }

    /// Eq. 11 with the values of the artifact, without the effects beyond it.
    pub fn force_model(&self) -> ForceModel {
        let mut parameters = BaseParameters { theta: [0.0; 8] };
        for parameter in Parameter::ALL {
            parameters.theta[parameter.index()] = parameter.from_artifact(self.value(parameter));
        }
        ForceModel::new(&self.geometry, self.strand_modulus_pa, self.form, parameters)
    }

    /// Eq. 11 with the effects of the artifact, in their order.
    ///
    /// # Panics
    /// Where an effect is not of the catalogue or a parameter of it is missing or out of range, which
    /// [`read`](Self::read) refuses.
    pub fn augmented_model(&self) -> AugmentedModel {
        let terms = self.effects.iter().map(|entry| entry.term().expect("effects as checked")).collect();
        AugmentedModel::new(self.force_model(), terms)
    }
}

#[cfg(test)]
mod tests;
