//! Artifacts: the files that programs hand to one another.
//!
//! Every artifact begins with `schema`, `tool`, `inputs`, `config` and `seed`. Equal inputs give equal bytes on
//! any thread count; time stamps stay out.
//!
//! In reading order: [`origin`] says what every artifact begins with, [`json`] how one is written and read, [`error`] why one is
//! refused. One artifact is one module, in the order in which they come about: [`summary`] and [`agreement`] of shards, [`model`]
//! (with [`estimates`], its parameters as a random vector), [`prediction`], [`diagnosis`], [`change`], [`group`], [`comparison`],
//! [`inverse`]. [`group_file`] is what people write for a group; [`schemas`] are the published JSON schemas.
//!
//! Conventions: SI inside, with the unit in the name of every key. What is written and read back stands here and nothing is
//! computed; muscles and recordings know nothing of it.

pub mod agreement;
pub mod change;
pub mod comparison;
pub mod diagnosis;
mod effect_entry;
mod empirical;
pub mod error;
pub mod estimates;
mod evidence;
mod fit_report;
pub mod group;
pub mod group_file;
mod identify_config;
pub mod inverse;
pub mod json;
pub mod model;
pub mod origin;
mod parameter_entry;
pub mod prediction;
pub mod schemas;
pub mod summary;

pub use agreement::AgreementArtifact;
pub use change::ChangeArtifact;
pub use comparison::ComparisonArtifact;
pub use diagnosis::DiagnosisArtifact;
pub use error::ArtifactError;
pub use estimates::Estimates;
pub use group::GroupArtifact;
pub use inverse::InverseArtifact;
pub use json::readable_json;
pub use model::ModelArtifact;
pub use origin::{Input, InputRole, Tool};
pub use prediction::PredictionArtifact;
pub use summary::SummaryArtifact;
