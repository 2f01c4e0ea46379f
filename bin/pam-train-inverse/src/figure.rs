//! The figure of an inverse, from what was trained.

use pam_core::artifact::InverseArtifact;
use pam_inverse_model::report::{Outcome, Prepared};

/// The figure as SVG.
pub(crate) fn svg(_artifact: &InverseArtifact, _outcome: &Outcome, _prepared: &Prepared) -> anyhow::Result<String> {
    anyhow::bail!("not drawn yet")
}
