//! The file as written: units of the workshop, unknown keys rejected.

use std::path::Path;

use pam_recording::toml_file;
#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::LiftPlan;
use crate::error::ConfigError;

/// A configuration file; every key is explained in `configs/lift.toml`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct LiftConfig {
    pub(super) reference: ReferenceToml,
    pub(super) arm: ArmToml,
    pub(super) load: LoadToml,
    pub(super) plant: PlantToml,
    pub(super) valve: ValveToml,
    pub(super) sensors: SensorsToml,
    pub(super) controller: ControllerToml,
    pub(super) limits: LimitsToml,
    pub(super) trials: TrialsToml,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct ReferenceToml {
    pub(super) from_rad: f64,
    pub(super) to_rad: f64,
    pub(super) duration_s: f64,
    pub(super) handover_s: f64,
    pub(super) hold_s: f64,
    pub(super) settle_s: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct ArmToml {
    pub(super) upper_m: f64,
    pub(super) lower_m: f64,
    pub(super) load_arm_m: f64,
    pub(super) forearm_mass_kg: f64,
    pub(super) forearm_center_m: f64,
    pub(super) forearm_inertia_kg_m2: f64,
    pub(super) mounted_length_mm: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct LoadToml {
    pub(super) mass_kg: f64,
    pub(super) inertia_kg_m2: f64,
    pub(super) true_mass_kg: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct PlantToml {
    pub(super) step_ms: f64,
    pub(super) presliding_mm: f64,
    pub(super) friction_factor: f64,
    pub(super) friction_state: f64,
    pub(super) bowden_friction: f64,
    pub(super) damping_n_m_s: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(super) enum ValveKindToml {
    Proportional,
    OnOff,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct ValveToml {
    pub(super) kind: ValveKindToml,
    pub(super) lag_ms: f64,
    pub(super) delay_ms: f64,
    pub(super) lowest_kpa: f64,
    pub(super) highest_kpa: f64,
    pub(super) supply_kpa: f64,
    pub(super) conductance_l_per_s_bar: f64,
    pub(super) dead_volume_cm3: f64,
    pub(super) switching_hz: f64,
    pub(super) shortest_pulse_ms: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct SensorsToml {
    pub(super) angle_noise_mrad: f64,
    pub(super) angle_step_mrad: f64,
    pub(super) pressure_noise_kpa: f64,
    pub(super) pressure_step_kpa: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub(super) enum LengthToml {
    Measured,
    Reference,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct ControllerToml {
    pub(super) period_ms: f64,
    pub(super) kp_per_s2: f64,
    pub(super) kd_per_s: f64,
    pub(super) observer_rad_per_s: f64,
    pub(super) length: LengthToml,
    pub(super) integral_per_s3: f64,
    pub(super) disturbance_observer: bool,
    pub(super) lag_compensation: bool,
    /// Left out, it is off.
    #[serde(default)]
    pub(super) ramp: bool,
    pub(super) valve_lag_ms: f64,
    pub(super) pressure_loop_ms: f64,
    pub(super) hysteresis_aware: bool,
    pub(super) presliding_mm: f64,
    #[serde(default = "on")]
    pub(super) effect_memory: bool,
    pub(super) payload_estimation: bool,
}

/// Files from before there was the key have it switched on.
fn on() -> bool {
    true
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct LimitsToml {
    pub(super) diverged_rad: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct TrialsToml {
    pub(super) payload_percent: f64,
    pub(super) friction_percent: f64,
    pub(super) lag_percent: f64,
    pub(super) geometry_percent: f64,
    pub(super) mounting_mm: f64,
    pub(super) noise_percent: f64,
    pub(super) model_parameters: bool,
}

impl LiftConfig {
    /// Reads and checks a configuration file: as written, as checked, and its text.
    ///
    /// # Errors
    /// [`ConfigError`] names the file, and the key or the line, and what to do.
    pub fn read(path: &Path) -> Result<(Self, LiftPlan, String), ConfigError> {
        let text = toml_file::read_text(path, "configuration")?;
        let config = Self::parse(&text, path)?;
        let plan = config.clone().check(path)?;
        Ok((config, plan, text))
    }

    /// Parses the text of a configuration; `path` is for messages.
    ///
    /// # Errors
    /// [`ConfigError::File`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, ConfigError> {
        Ok(toml_file::parse(text, path)?)
    }
}
