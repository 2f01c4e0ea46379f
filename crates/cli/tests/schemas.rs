//! The published schemas are those of the types that are written and read; `scripts/schemas` writes them anew.

use pam_artifact::{
    AgreementArtifact, ChangeArtifact, ComparisonArtifact, DiagnosisArtifact, GroupArtifact, InverseArtifact,
    ModelArtifact, PredictionArtifact, SummaryArtifact, schemas,
};
use pam_cli::Message;
use pam_exo::artifact::MetricsArtifact;
use pam_fleet_survey::plan::FleetPlan;
use pam_recording::ChannelsFile;
use schemars::JsonSchema;

/// Where the published schemas lie.
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../artifact/schemas/");

/// Name, text as published and text by the type.
fn of<T: JsonSchema>(name: &'static str, published: &'static str) -> (&'static str, &'static str, String) {
    (name, published, format!("{:#}\n", schemars::schema_for!(T).to_value()))
}

#[test]
fn every_published_schema_is_that_of_its_type() {
    let every = [
        of::<AgreementArtifact>("pam-agreement-1", schemas::AGREEMENT),
        of::<ChangeArtifact>("pam-change-1", schemas::CHANGE),
        of::<ChannelsFile>("pam-channels-1", schemas::CHANNELS),
        of::<ComparisonArtifact>("pam-comparison-1", schemas::COMPARISON),
        of::<DiagnosisArtifact>("pam-diagnosis-1", schemas::DIAGNOSIS),
        of::<FleetPlan>("pam-fleet-plan-1", schemas::FLEET_PLAN),
        of::<GroupArtifact>("pam-group-1", schemas::GROUP),
        of::<InverseArtifact>("pam-inverse-1", schemas::INVERSE),
        of::<Message>("pam-messages-1", schemas::MESSAGES),
        of::<MetricsArtifact>("exo-metrics-1", schemas::METRICS),
        of::<ModelArtifact>("pam-model-1", schemas::MODEL),
        of::<PredictionArtifact>("pam-prediction-1", schemas::PREDICTION),
        of::<SummaryArtifact>("pam-summary-1", schemas::SUMMARY),
    ];
    for (name, published, text) in every {
        if std::env::var_os("PAM_WRITE_SCHEMAS").is_some() {
            std::fs::write(format!("{FOLDER}{name}.json"), text).expect("a writable folder");
        } else {
            assert!(published == text, "{name} is stale; run scripts/schemas");
        }
    }
}
