//! `pam-model/1`: an identified force model.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use super::effect_entry::EffectEntry;
pub use super::fit_report::{
    Domain, FitReport, FitStatistics, ImpliedParameter, RecordingFit, SearchReport, StartReport, UnboundedFit,
};
pub use super::identify_config::{
    Assumed, BladderLaw, FixedParameter, FrictionLaw, IdentifyConfig, Loss, StandstillFit,
};
use super::{ArtifactError, Input, InputRole, Tool};
use crate::direction::{Standstill, Thresholds};
use crate::effects::{AugmentedModel, Kind};
use crate::force::{BaseParameters, ForceModel, Form, Parameter};
use crate::muscle::{Dimension, Muscle};
use crate::quality::RecordingQuality;
use crate::spelling::{nearest, number};

/// Schema name and version.
pub const SCHEMA: &str = "pam-model/1";

/// An identified force model with everything that later programs need.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModelArtifact {
    /// `pam-model/1`.
    #[schemars(extend("const" = SCHEMA))]
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

/// A parameter and what is known of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterEntry {
    /// `k1`, `k2`, `k3`, `c10`, `c01`, `strand_modulus`, `rubber_friction`, `strand_friction`, or a
    /// dimension of the muscle.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Unit; `1` where it has none.
    pub unit: String,
    /// Standard error, autocorrelation of the residual respected; none for what was not fitted.
    pub stderr: Option<f64>,
    /// How the value came about.
    pub status: ParameterStatus,
}

/// How a value came about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ParameterStatus {
    /// Found by the fit, inside its range.
    Fitted,
    /// Not fitted.
    Fixed,
    /// One share of a composite: the data determine the composite alone.
    Composite,
    /// Pressed against the end of its range.
    AtBound,
}

/// A combination of parameters that the data determine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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
        let bytes = super::readable_json(self)?;
        self.check().map_err(|what| ArtifactError::Unreadable { what })?;
        Ok(bytes)
    }

    /// Reads and checks an artifact; gives its SHA-256 as well.
    ///
    /// # Errors
    /// [`ArtifactError`] names the file, the place and what to do.
    pub fn read(path: &Path) -> Result<(Self, String), ArtifactError> {
        let (artifact, sha256): (Self, String) = super::read(path, SCHEMA, "pam-identify")?;
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
mod tests {
    use super::*;
    use crate::muscle::tests::nominal;

    fn parameter(name: &str, value: f64, unit: &str) -> ParameterEntry {
        ParameterEntry {
            name: name.to_owned(),
            value,
            unit: unit.to_owned(),
            stderr: None,
            status: ParameterStatus::Fitted,
        }
    }

    fn effect(id: &str, parameters: Vec<ParameterEntry>) -> EffectEntry {
        EffectEntry { id: id.to_owned(), sentence: None, parameters }
    }

    fn artifact(effects: Vec<EffectEntry>) -> ModelArtifact {
        let statistics = FitStatistics {
            rmse_n: 1.0,
            rmse_all_n: 1.0,
            max_n: 3.0,
            r2: 0.999,
            fit_percent: 99.0,
            n_samples: 1000,
            n_unsettled: 0,
        };
        let values = [0.9, 1.05, 2.0, 118.4e3, 105.7e3, 3e9, 1.2e-3, 0.0];
        ModelArtifact {
            schema: SCHEMA.to_owned(),
            tool: Tool { name: "pam-identify".to_owned(), version: "0.1.0".to_owned() },
            inputs: Vec::new(),
            config: IdentifyConfig {
                n_particles: 60,
                n_iterations: 200,
                n_starts: 4,
                polish: true,
                loss: Loss::Square,
                freed: Vec::new(),
                fixed: Vec::new(),
                bladder_ratio: 0.89,
                assumed: Assumed::default(),
                accept_implausible: false,
            },
            seed: 1,
            muscle_name: None,
            geometry: nominal(),
            strand_modulus_pa: 3e9,
            form: Form::Corrected,
            parameters: Parameter::ALL
                .into_iter()
                .zip(values)
                .map(|(known, value)| parameter(known.artifact_name(), value, known.unit()))
                .collect(),
            composites: Vec::new(),
            effects,
            correlation: Correlation { names: Vec::new(), matrix: Vec::new() },
            fit: FitReport {
                estimation: statistics,
                validation: None,
                recordings: Vec::new(),
                noise_floor_n: 0.9,
                force_noise_n: 0.2,
                effective_samples: 500.0,
            },
            domain: Domain {
                pressure_pa: [500.0, 5e5],
                length_m: [0.211, 0.268],
                force_n: [4.5, 1119.0],
                length_rate_m_per_s: 0.03,
                pressure_rate_pa_per_s: 2.9e5,
            },
            direction: Thresholds {
                length_m: 150e-6,
                pressure_pa: 2.5e3,
                held_m: 0.0,
                turn_m: 0.0,
                standstill: Standstill::AT_ONCE,
            },
            standstill_laws: Vec::new(),
            quality: Vec::new(),
            search: SearchReport { starts: Vec::new(), converged: true, column_floor_rmse_n: 1.0 },
            unbounded: None,
            warnings: Vec::new(),
        }
    }

    fn rubber(width_n: f64) -> EffectEntry {
        // The order of the parameters does not matter.
        effect("rubber-hysteresis", vec![parameter("width_n", width_n, "N"), parameter("slip_distance_m", 1e-3, "m")])
    }

    #[test]
    fn effects_come_on_top_of_eq_11() {
        let artifact = artifact(vec![rubber(7.0)]);
        artifact.check().expect("a plausible artifact");
        let model = artifact.augmented_model();
        assert_eq!(
            (model.terms()[0].shape.as_slice(), model.terms()[0].amplitudes.as_slice()),
            (&[1e-3][..], &[7.0][..])
        );
        let difference_n = model.settled_force_n(3e5, 0.24, 1.0) - artifact.force_model().force_n(3e5, 0.24, 1.0);
        assert!((difference_n + 7.0).abs() < 1e-9);
    }

    #[test]
    fn an_artifact_survives_its_own_text_with_effects() {
        let artifact = artifact(vec![rubber(7.0)]);
        let text = serde_json::to_string(&artifact).expect("an artifact is JSON");
        assert_eq!(serde_json::from_str::<ModelArtifact>(&text).expect("its own text"), artifact);
    }

    #[test]
    fn a_parameter_of_another_unit_or_none_of_a_model_is_refused_by_name() {
        let refusal = |change: &dyn Fn(&mut ModelArtifact)| {
            let mut artifact = artifact(Vec::new());
            change(&mut artifact);
            artifact.check().expect_err("a refusal")
        };
        let messages = [
            refusal(&|artifact| artifact.parameters[3].unit = "kPa".to_owned()),
            refusal(&|artifact| artifact.parameters[0].unit = "N".to_owned()),
            refusal(&|artifact| artifact.parameters.push(parameter("rest_lenght", 0.26, "m"))),
            refusal(&|artifact| artifact.parameters.push(parameter("gears", 4.0, "1"))),
            refusal(&|artifact| {
                artifact.parameters.extend([0.26, 0.27].map(|value| parameter("rest_length", value, "m")));
            }),
            refusal(&|artifact| artifact.parameters[5].value = -1e300),
        ];
        insta::assert_snapshot!(messages.join("\n"), @r#"
        the unit of parameter c10 is "kPa", expected "Pa"
        the unit of parameter k1 is "N", expected "1"
        parameter "rest_lenght" is unknown; did you mean rest_length?
        parameter "gears" is unknown; a model has k1, k2, k3, c10, c01, strand_modulus, rubber_friction, strand_friction, rest_length, rest_radius, braid_angle, wall_thickness
        parameter rest_length stands there twice
        strand_modulus is -1e300, which no strand has
        "#);
        let mut fitted = artifact(Vec::new());
        fitted.parameters.push(parameter("braid_angle", 0.43, "rad"));
        fitted.check().expect("a model with a fitted dimension");
    }

    #[test]
    fn what_no_program_could_read_is_not_written() {
        let mut artifact = artifact(Vec::new());
        artifact.json().expect("a plausible artifact");
        artifact.fit.estimation.fit_percent = f64::NEG_INFINITY;
        insta::assert_snapshot!(artifact.json().expect_err("null is no number"), @"nothing is written, since no program could read it: fit_percent is no finite number");
    }

    #[test]
    fn what_the_catalogue_does_not_have_is_refused_by_name() {
        let refusal = |effects| artifact(effects).check().expect_err("a refusal");
        let one = |entries| refusal(vec![effect("rubber-hysteresis", entries)]);
        let width = || parameter("width_n", 7.0, "N");
        let distance = || parameter("slip_distance_m", 1e-3, "m");
        let messages = [
            refusal(vec![effect("stribek", vec![])]),
            one(vec![width()]),
            one(vec![width(), distance(), parameter("slope", 1.0, "1")]),
            one(vec![width(), width(), distance()]),
            one(vec![width(), parameter("slip_distance_m", 1.0, "mm")]),
            one(vec![parameter("width_n", -7.0, "N"), distance()]),
            one(vec![parameter("width_n", f64::NAN, "N"), distance()]),
            refusal(vec![rubber(7.0), rubber(8.0)]),
        ];
        insta::assert_snapshot!(messages.join("\n"), @r#"
        effect "stribek" is unknown; the nearest are stribeck, slack, inertia
        effect rubber-hysteresis lacks its parameter slip_distance_m; a model of an earlier catalogue has to be diagnosed again
        effect rubber-hysteresis has no parameter slope; it has slip_distance_m, width_n
        parameter width_n of effect rubber-hysteresis stands there twice
        parameter slip_distance_m of effect rubber-hysteresis is in mm; write it in m
        parameter width_n of effect rubber-hysteresis is -7; physics allows 0 to 200 N
        parameter width_n of effect rubber-hysteresis is NaN; physics allows 0 to 200 N
        effect rubber-hysteresis stands there twice
        "#);
    }

    #[test]
    fn a_direction_that_flips_before_it_turns_is_refused() {
        let mut turned = artifact(vec![]);
        turned.direction =
            Thresholds { length_m: 0.0, pressure_pa: 0.0, held_m: 0.0, turn_m: 0.0, standstill: Standstill::Held };
        turned.check().expect("no threshold is one");
        turned.direction.length_m = -1.0;
        assert_eq!(turned.check(), Err("a threshold of the direction is negative: -1 m, 0 Pa".to_owned()));
    }

    #[test]
    fn friction_that_slides_by_more_than_all_of_it_or_partly_at_once_is_refused() {
        for (over_pa, share, is_right) in [
            (0.0, 1.0, true),
            (4e4, 0.6, true),
            (0.0, 0.6, false),
            (4e4, 0.0, false),
            (4e4, 1.2, false),
            (-1.0, 1.0, false),
        ] {
            let mut slid = artifact(vec![]);
            slid.direction.standstill = Standstill::Slides { over_pa, share };
            assert_eq!(slid.check().is_ok(), is_right, "{over_pa} Pa, {share}");
        }
    }

    #[test]
    fn events_may_come_again() {
        let step = |instant_s| {
            let values = [("recording", 0.0, "1"), ("instant_s", instant_s, "s"), ("step_n", 2.0, "N")];
            effect("force-step", values.map(|(name, value, unit)| parameter(name, value, unit)).to_vec())
        };
        artifact(vec![step(3.0), step(9.0)]).check().expect("two events");
    }
}
