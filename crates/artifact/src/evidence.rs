//! Why an effect or a term is believed.

#[cfg(feature = "schemas")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Evidence for an effect: base and effects fitted jointly to all blocks but one, judged on that one, in turn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemas", derive(JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// Log predictive ratio: sum over blocks left out of the fit of `ln(mean square without / mean square with)`.
    pub log_ratio: f64,
    /// Held-out RMSE without it, everything else refitted, in N.
    pub rmse_without_n: f64,
    /// Held-out RMSE with it, in N.
    pub rmse_with_n: f64,
    /// Held-out blocks that it improves.
    pub blocks_improved: usize,
    /// Held-out blocks.
    pub n_blocks: usize,
    /// Probability of such an improvement by chance, corrected for multiple comparisons.
    pub p_value: f64,
}
