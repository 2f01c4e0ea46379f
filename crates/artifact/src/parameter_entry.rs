//! One parameter with its standard error and how it came about, in every artifact that lists parameters.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A parameter and what is known of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
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
