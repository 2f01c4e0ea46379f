//! The published JSON schemas, which programs print with `--schema`.
//!
//! They are written from the types by `scripts/schemas` and held against them by `cargo test -p pam-cli -p pam-bench`: derived in
//! the programs, they would be a good part of what is compiled into each.

macro_rules! published {
    ($($(#[$doc:meta])* $name:ident = $file:literal;)*) => {
        $($(#[$doc])* pub const $name: &str = include_str!(concat!("../schemas/", $file, ".json"));)*
    };
}

published! {
    /// What shards agree on.
    AGREEMENT = "pam-agreement-1";
    /// What the bench conceals.
    BENCH_TRUTH = "pam-bench-truth-1";
    /// What has changed since an earlier diagnosis.
    CHANGE = "pam-change-1";
    /// What columns mean, the file of `--channels`.
    CHANNELS = "pam-channels-1";
    /// Two models on the same recordings.
    COMPARISON = "pam-comparison-1";
    /// A diagnosis.
    DIAGNOSIS = "pam-diagnosis-1";
    /// Commands of a fleet.
    FLEET_PLAN = "pam-fleet-plan-1";
    /// What the muscles of one rig share.
    GROUP = "pam-group-1";
    /// The inverse of a model.
    INVERSE = "pam-inverse-1";
    /// Lines that `--format json` writes.
    MESSAGES = "pam-messages-1";
    /// Metrics of a lift.
    METRICS = "exo-metrics-1";
    /// A force model.
    MODEL = "pam-model-1";
    /// Metrics of a prediction.
    PREDICTION = "pam-prediction-1";
    /// A summary of one shard.
    SUMMARY = "pam-summary-1";
}
